// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The side that has the scene: says of what chunks its field is made, and gives those that are
/// wanted.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "chunks.h"
#include "shared_field.h"
#include "vicinity/viscosity/field.h"
#include "watched_input.h"

namespace vicinity::bridge {

/// For one thread. Not real-time.
class FieldSharer {
 public:
  /// @param name   in front of its topics: "/cell"
  /// @param input  already made into `field`; outlives it
  FieldSharer(dds::Participant& participant, const std::string& name, WatchedInput& input,
              ViscosityField field, Say say);

  /// Answers wishes for so long, and looks now and then whether the input has changed. A changed
  /// one is made into a field, shared, and returned; one that cannot be used is said, and the old
  /// field stays.
  std::optional<ViscosityField> step(double seconds);

  FieldStanding standing() const;
  const FieldTraffic& traffic() const noexcept { return traffic_; }
  std::uint64_t checksum() const noexcept { return manifest_.checksum; }

 private:
  void share(ViscosityField field);
  void answer_wishes();

  WatchedInput& input_;
  Say say_;
  dds_entity_t manifest_writer_, chunk_writer_, wanted_reader_;
  dds::Participant::Waiter waiter_;
  ViscosityField field_;
  FieldManifest manifest_;
  std::unordered_map<std::uint64_t, Chunk> chunks_;
  dds::Sample bytes_;
  FieldChunk message_;
  std::chrono::steady_clock::time_point looked_;
  bool broken_ = false;
  FieldTraffic traffic_;
};

}  // namespace vicinity::bridge
