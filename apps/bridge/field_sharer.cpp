// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "field_sharer.h"

#include <fmt/format.h>

#include <exception>
#include <utility>

#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/field_image.h"

namespace vicinity::bridge {
namespace {

constexpr std::chrono::milliseconds look_every{300};

}  // namespace

std::string hex(std::uint64_t checksum) { return fmt::format("{:016x}", checksum); }

FieldSharer::FieldSharer(dds::Participant& participant, const std::string& name,
                         WatchedInput& input, ViscosityField field, Say say)
    : input_(input),
      say_(std::move(say)),
      manifest_writer_(
          participant.writer<FieldManifest>(field_topic<FieldManifest>(name), manifest_quality)),
      chunk_writer_(participant.writer<FieldChunk>(field_topic<FieldChunk>(name), chunk_quality)),
      wanted_reader_(
          participant.reader<FieldWanted>(field_topic<FieldWanted>(name), chunk_quality)),
      waiter_(participant, {wanted_reader_}) {
  share(std::move(field));
}

std::optional<ViscosityField> FieldSharer::step(double seconds) {
  waiter_.wait(seconds);
  answer_wishes();
  const auto now = std::chrono::steady_clock::now();
  if (now - looked_ < look_every) return {};
  looked_ = now;
  if (!input_.changed()) return {};
  try {
    ViscosityField field = input_.field();
    broken_ = false;
    if (checksum_of(field.image()) == manifest_.checksum) return {};
    share(std::move(field));
    return field_;
  } catch (const std::exception& error) {  // too little memory is no end either
    broken_ = true;
    say_(std::string(error.what()) + "; the field stays as it was");
  }
  return {};
}

FieldStanding FieldSharer::standing() const {
  if (broken_) {
    return {ros2::DiagnosticStatus::warn, "shared as it was: what is on disk cannot be used"};
  }
  return {ros2::DiagnosticStatus::ok, "shared"};
}

void FieldSharer::share(ViscosityField field) {
  field_ = std::move(field);
  chunks_.clear();
  manifest_ = {.checksum = checksum_of(field_.image()), .chunks = {}, .sizes = {}};
  for (const Chunk& chunk : chunks_of(field_.image())) {
    manifest_.chunks.push_back(chunk.checksum);
    manifest_.sizes.push_back(chunk.size);
    chunks_.emplace(chunk.checksum, chunk);
  }
  if (!dds::send(manifest_writer_, manifest_, bytes_)) {
    throw Error({.where = "DDS", .what = "the field's manifest was not taken"});
  }
  ++traffic_.fields;
  say_(fmt::format("sharing field {}: {} bytes in {} chunks", hex(manifest_.checksum),
                   field_.image().size(), manifest_.chunks.size()));
}

void FieldSharer::answer_wishes() {
  FieldWanted wanted;
  while (dds::take(wanted_reader_, bytes_)) {
    if (!ros2::read_cdr(bytes_, wanted)) continue;
    // More than a follower asks for at once is no wish of a follower.
    std::uint64_t given = 0;
    for (const std::uint64_t checksum : wanted.chunks) {
      const auto found = chunks_.find(checksum);
      if (found == chunks_.end()) continue;  // of a field that was; its new manifest is under way
      if (given > window_bytes) break;
      const auto data = field_.image().subspan(found->second.offset, found->second.size);
      message_.checksum = checksum;
      const auto* begin = reinterpret_cast<const std::uint8_t*>(data.data());
      message_.data.assign(begin, begin + data.size());
      dds::Sample chunk;
      if (!dds::send(chunk_writer_, message_, chunk)) continue;  // it will be asked for again
      given += data.size();
      ++traffic_.chunks;
      traffic_.bytes += data.size();
    }
  }
}

}  // namespace vicinity::bridge
