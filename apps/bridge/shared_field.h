// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// What whoever shares a field and whoever follows it have alike: its topics, and how it stands.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "dds/participant.h"
#include "field_messages.h"
#include "ros2/messages.h"

namespace vicinity::bridge {

/// For a person: a sentence for each thing that happens.
using Say = std::function<void(const std::string& sentence)>;

/// How a shared field stands, for diagnostics.
struct FieldStanding {
  std::byte level = ros2::DiagnosticStatus::ok;
  std::string words;
  bool operator==(const FieldStanding&) const = default;
};

/// What went over the wire.
struct FieldTraffic {
  std::uint64_t fields = 0;                    ///< manifests sent, or whole fields received
  std::uint64_t chunks = 0;                    ///< sent, or received and used
  std::uint64_t bytes = 0;                     ///< in those
  std::uint64_t asked_again = 0, refused = 0;  ///< chunks that did not come; that were not whole
};

// One chunk is worth some packets; a follower asks for as many as this at once.
inline constexpr std::uint64_t window_bytes = 256 * 1024;

// A manifest stands until the next; wishes and chunks that are lost are asked for again.
inline constexpr dds::Quality manifest_quality{.depth = 1, .latched = true, .named_alone = true};
inline constexpr dds::Quality chunk_quality{.depth = 128, .named_alone = true};

template <class Message>
std::string field_topic(const std::string& name) {
  return name + std::string(Message::topic);
}

/// 16 hexadecimal digits.
std::string hex(std::uint64_t checksum);

}  // namespace vicinity::bridge
