// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "mcap/writer.h"

#include <zstd.h>

#include <algorithm>
#include <stdexcept>

#include "mcap/crc32.h"

namespace vicinity::mcap {
namespace {

// Fast, and half the size of none; higher levels gain little on numbers.
constexpr int compression_level = 1;

void put_record(Fields& to, Opcode opcode, std::string_view body) {
  to.u8(static_cast<std::uint8_t>(opcode)).u64(body.size()).bytes(body);
}

void put_schema(Fields& to, const Schema& schema) {
  Fields body;
  body.u16(schema.id).text(schema.name).text(schema.encoding).text(schema.data);
  put_record(to, Opcode::schema, body.all());
}

void put_channel(Fields& to, const Channel& channel) {
  Fields body;
  body.u16(channel.id).u16(channel.schema_id).text(channel.topic).text(channel.message_encoding);
  body.u32(0);  // no metadata
  put_record(to, Opcode::channel, body.all());
}

std::string packed(const std::string& bytes) {
  std::string out(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), compression_level);
  if (ZSTD_isError(size) != 0) throw std::runtime_error(ZSTD_getErrorName(size));
  out.resize(size);
  return out;
}

// The span of times, as one more comes.
void widen(std::uint64_t& first, std::uint64_t& last, std::uint64_t time, bool is_first) {
  first = is_first ? time : std::min(first, time);
  last = is_first ? time : std::max(last, time);
}

}  // namespace

Writer::Writer(Sink sink, std::string_view profile, std::string_view library)
    : sink_(std::move(sink)) {
  Fields start, body;
  start.bytes(magic);
  body.text(profile).text(library);
  put_record(start, Opcode::header, body.all());
  hand_over(start);
}

std::uint16_t Writer::add_schema(std::string_view name, std::string_view encoding,
                                 std::string_view data) {
  // Ids of schemas begin at 1: 0 is none.
  const auto id = static_cast<std::uint16_t>(schemas_.size() + 1);
  schemas_.push_back({.id = id,
                      .name = std::string(name),
                      .encoding = std::string(encoding),
                      .data = std::string(data)});
  Fields record;
  put_schema(record, schemas_.back());
  hand_over(record);
  return id;
}

std::uint16_t Writer::add_channel(std::string_view topic, std::uint16_t schema,
                                  std::string_view message_encoding) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  channels_.push_back({.channel = {.id = id,
                                   .schema_id = schema,
                                   .topic = std::string(topic),
                                   .message_encoding = std::string(message_encoding)},
                       .written = 0,
                       .in_chunk = {}});
  Fields record;
  put_channel(record, channels_.back().channel);
  hand_over(record);
  return id;
}

void Writer::write(std::uint16_t channel, std::uint64_t time_ns, std::span<const std::byte> data) {
  ChannelState& state = channels_.at(channel);
  widen(chunk_first_ns_, chunk_last_ns_, time_ns, chunk_.all().empty());
  widen(first_ns_, last_ns_, time_ns, messages_ == 0);
  state.in_chunk.emplace_back(time_ns, chunk_.all().size());
  constexpr std::size_t before_data = 2 + 4 + 8 + 8;
  chunk_.u8(static_cast<std::uint8_t>(Opcode::message)).u64(before_data + data.size());
  chunk_.u16(channel).u32(state.written++).u64(time_ns).u64(time_ns);
  chunk_.bytes({reinterpret_cast<const char*>(data.data()), data.size()});
  ++messages_;
  if (chunk_.all().size() >= full_chunk) close_chunk();
}

void Writer::close_chunk() {
  if (chunk_.all().empty()) return;
  const std::string& records = chunk_.all();
  const std::string compressed = packed(records);
  Fields body, out;
  body.u64(chunk_first_ns_).u64(chunk_last_ns_).u64(records.size()).u32(crc32(records));
  body.text("zstd").u64(compressed.size()).bytes(compressed);
  put_record(out, Opcode::chunk, body.all());
  ChunkPlace place{.first_ns = chunk_first_ns_,
                   .last_ns = chunk_last_ns_,
                   .start = at_,
                   .length = out.all().size(),
                   .index_length = 0,
                   .packed = compressed.size(),
                   .unpacked = records.size(),
                   .indexes = {}};
  for (ChannelState& state : channels_) {
    if (state.in_chunk.empty()) continue;
    // A reader that follows the index meets messages in the order of their times.
    std::ranges::stable_sort(state.in_chunk, {}, [](const auto& entry) { return entry.first; });
    place.indexes.emplace_back(state.channel.id, at_ + out.all().size());
    Fields index;
    index.u16(state.channel.id).u32(static_cast<std::uint32_t>(16 * state.in_chunk.size()));
    for (const auto& [time, offset] : state.in_chunk) index.u64(time).u64(offset);
    put_record(out, Opcode::message_index, index.all());
    state.in_chunk.clear();
  }
  place.index_length = out.all().size() - place.length;
  chunks_.push_back(std::move(place));
  chunk_.all().clear();
  hand_over(out);
}

void Writer::finish() {
  close_chunk();
  Fields end, crc;
  crc.u32(crc_);
  put_record(end, Opcode::data_end, crc.all());
  put_summary(end);
  end.bytes(magic);
  hand_over(end);
}

void Writer::put_summary(Fields& end) const {
  Fields summary, offsets;
  const std::uint64_t summary_start = at_ + end.all().size();
  const auto group = [&](Opcode opcode, const auto& put_all) {
    const std::size_t begin = summary.all().size();
    put_all();
    if (summary.all().size() == begin) return;
    Fields body;
    body.u8(static_cast<std::uint8_t>(opcode)).u64(summary_start + begin);
    body.u64(summary.all().size() - begin);
    put_record(offsets, Opcode::summary_offset, body.all());
  };
  group(Opcode::schema, [&] {
    for (const Schema& schema : schemas_) put_schema(summary, schema);
  });
  group(Opcode::channel, [&] {
    for (const ChannelState& state : channels_) put_channel(summary, state.channel);
  });
  group(Opcode::chunk_index, [&] {
    for (const ChunkPlace& place : chunks_) {
      Fields body;
      body.u64(place.first_ns).u64(place.last_ns).u64(place.start).u64(place.length);
      body.u32(static_cast<std::uint32_t>(10 * place.indexes.size()));
      for (const auto& [channel, where] : place.indexes) body.u16(channel).u64(where);
      body.u64(place.index_length).text("zstd").u64(place.packed).u64(place.unpacked);
      put_record(summary, Opcode::chunk_index, body.all());
    }
  });
  group(Opcode::statistics, [&] {
    Fields body;
    body.u64(messages_).u16(static_cast<std::uint16_t>(schemas_.size()));
    body.u32(static_cast<std::uint32_t>(channels_.size()));
    body.u32(0).u32(0);  // attachments, metadata
    body.u32(static_cast<std::uint32_t>(chunks_.size())).u64(first_ns_).u64(last_ns_);
    body.u32(static_cast<std::uint32_t>(10 * channels_.size()));
    for (const ChannelState& state : channels_) body.u16(state.channel.id).u64(state.written);
    put_record(summary, Opcode::statistics, body.all());
  });
  const std::uint64_t offsets_start = summary_start + summary.all().size();
  // The checksum covers the footer too, up to itself.
  Fields covered;
  covered.bytes(summary.all()).bytes(offsets.all());
  covered.u8(static_cast<std::uint8_t>(Opcode::footer)).u64(footer_body);
  covered.u64(summary_start).u64(offsets_start);
  end.bytes(covered.all()).u32(crc32(covered.all()));
}

void Writer::hand_over(const Fields& records) {
  at_ += records.all().size();
  crc_ = crc32(records.all(), crc_);
  sink_(records.all());
}

}  // namespace vicinity::mcap
