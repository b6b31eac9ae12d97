// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Writes an MCAP file: indexed, in compressed chunks that each stand for themselves.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mcap/record.h"

namespace vicinity::mcap {

/// Takes what comes next in the file. Called with whole records only: a sink that makes each call
/// last (fsync) leaves, whenever the power fails, a file that can be read up to there.
using Sink = std::function<void(std::string_view bytes)>;

class Writer {
 public:
  /// A chunk is closed once it holds so much [bytes]: small enough that little is lost in a cut,
  /// large enough that compression and index pay.
  static constexpr std::size_t full_chunk = std::size_t{1} << 20;

  /// @param profile  as in MCAP's registry: "ros2"
  Writer(Sink sink, std::string_view profile, std::string_view library);

  std::uint16_t add_schema(std::string_view name, std::string_view encoding, std::string_view data);
  std::uint16_t add_channel(std::string_view topic, std::uint16_t schema,
                            std::string_view message_encoding);

  /// @param channel  from add_channel()
  void write(std::uint16_t channel, std::uint64_t time_ns, std::span<const std::byte> data);

  /// Hands the messages so far to the sink, though the chunk is not full.
  void close_chunk();

  /// The summary and the end. Without it the file is one that was cut. Nothing may follow.
  void finish();

  std::uint64_t messages() const noexcept { return messages_; }

 private:
  struct ChunkPlace {
    std::uint64_t first_ns, last_ns, start, length, index_length, packed, unpacked;
    std::vector<std::pair<std::uint16_t, std::uint64_t>> indexes;  // channel, where
  };
  struct ChannelState {
    Channel channel;
    std::uint32_t written = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> in_chunk;  // time, offset
  };

  void hand_over(const Fields& records);
  void put_summary(Fields& end) const;

  Sink sink_;
  std::uint64_t at_ = 0, messages_ = 0, first_ns_ = 0, last_ns_ = 0;
  std::uint32_t crc_ = 0;
  std::vector<Schema> schemas_;
  std::vector<ChannelState> channels_;
  std::vector<ChunkPlace> chunks_;
  Fields chunk_;
  std::uint64_t chunk_first_ns_ = 0, chunk_last_ns_ = 0;
};

}  // namespace vicinity::mcap
