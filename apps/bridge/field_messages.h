// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What two machines say to each other about a field: of what chunks it is made, which are wanted,
/// and those.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vicinity::bridge {

/// The field that is shared: its file, byte for byte. Latched.
struct FieldManifest {
  static constexpr std::string_view type = "vicinity_msgs/msg/FieldManifest";
  static constexpr std::string_view topic = "/field_manifest";  // behind the field's name
  std::uint64_t checksum = 0;         ///< of the whole file: XXH3, 64 bits
  std::vector<std::uint64_t> chunks;  ///< checksum of each, in the order of the file
  std::vector<std::uint32_t> sizes;   ///< of each [bytes]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("checksum", self.checksum);
    visit("chunks", self.chunks);
    visit("sizes", self.sizes);
  }
};

/// From whoever lacks some.
struct FieldWanted {
  static constexpr std::string_view type = "vicinity_msgs/msg/FieldWanted";
  static constexpr std::string_view topic = "/field_wanted";
  std::vector<std::uint64_t> chunks;  ///< checksums

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("chunks", self.chunks);
  }
};

struct FieldChunk {
  static constexpr std::string_view type = "vicinity_msgs/msg/FieldChunk";
  static constexpr std::string_view topic = "/field_chunk";
  std::uint64_t checksum = 0;  ///< of data
  std::vector<std::uint8_t> data;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("checksum", self.checksum);
    visit("data", self.data);
  }
};

}  // namespace vicinity::bridge
