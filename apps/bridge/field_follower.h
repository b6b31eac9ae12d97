// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The side without the scene: keeps a copy of a shared field, and fetches what differs.
///
///   manifest --> chunks that the copy has, or what came before the end of the last run
///            --> the others are wanted, again and again until they are here
///            --> FIELD.part, whole and verified --> renamed to FIELD --> felt
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "shared_field.h"
#include "vicinity/viscosity/field.h"

namespace vicinity::bridge {

/// A file's bytes, mapped; empty where there is no such file, or no room for it.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path);
  explicit MappedFile(int file) { map(file); }
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  std::span<const std::byte> bytes() const noexcept { return bytes_; }

 private:
  void map(int file);

  std::span<const std::byte> bytes_;
};

/// For one thread. Not real-time. May end at any moment: whatever was on disk by then is used by
/// the next one.
class FieldFollower {
 public:
  /// @param name  in front of the field's topics: "/cell"
  /// @param copy  where it is kept; need not be there yet
  FieldFollower(dds::Participant& participant, const std::string& name, std::filesystem::path copy,
                Say say);
  ~FieldFollower();
  FieldFollower(const FieldFollower&) = delete;
  FieldFollower& operator=(const FieldFollower&) = delete;

  /// What the copy holds, where it is a field: nobody else is needed to feel it.
  std::optional<ViscosityField> open_copy();

  /// Listens and asks for so long. Returns a field that has become whole.
  /// Errors: throws Error where the disk does not take it.
  std::optional<ViscosityField> step(double seconds);

  FieldStanding standing() const;
  const FieldTraffic& traffic() const noexcept { return traffic_; }
  /// Of the copy; 0: there is none.
  std::uint64_t checksum() const noexcept { return copy_checksum_; }

 private:
  using Clock = std::chrono::steady_clock;
  struct Missing {
    std::vector<std::uint64_t> offsets;  // in the file: equal chunks are fetched once
    std::uint32_t size = 0;
    std::optional<Clock::time_point> asked;
  };

  void hear_manifest();
  void begin();
  void hear_chunks();
  void ask();
  std::optional<ViscosityField> finish();
  void write(std::uint64_t offset, std::span<const std::byte> bytes);

  std::filesystem::path copy_, part_;
  Say say_;
  dds_entity_t manifest_reader_, chunk_reader_, wanted_writer_;
  dds::Participant::Waiter waiter_;
  std::uint64_t copy_checksum_ = 0;
  // The field that is being fetched, or was last.
  FieldManifest manifest_;
  std::map<std::uint64_t, Missing> missing_;
  std::size_t wanted_ = 0;  // chunks that were missing at first
  bool fetching_ = false, confirmed_ = false;
  std::set<std::uint64_t> unusable_;  // fields that came whole and are none
  int file_ = -1;
  dds::Sample bytes_;
  FieldTraffic traffic_;
};

}  // namespace vicinity::bridge
