// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A recording that grows while the bridge runs, and outlasts a power failure up to its last chunk.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <string>
#include <thread>

#include "arm_loop.h"
#include "field_in_use.h"
#include "replay/mcap_recording.h"

namespace vicinity::bridge {

/// Gives an earlier recording of this name another, so that whoever is started again with the same
/// words loses nothing: felt.mcap becomes felt.1.mcap, or the first number that is free. Returns
/// it; empty: there was none. Errors: throws Error where the folder does not let it.
std::filesystem::path keep_earlier(const std::filesystem::path& recording);

/// Writes in a thread of its own: a disk may take its time.
class Recorder {
 public:
  /// Errors: throws Error where the file is there already, or cannot be written.
  Recorder(const std::filesystem::path& path, const FieldInUse& field, const RobotModel& robot,
           int tool_link);
  /// Ends the file with its summary.
  ~Recorder();
  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Only states that were ticked are recorded; of one whose positions are not finite, its status.
  void add(const Answer& answer);
  /// Why it gave up; empty: it did not.
  std::string failure() const;

 private:
  /// Every chunk is on the disk before the next is begun; one is closed after so long.
  static constexpr std::chrono::seconds longest_chunk{1};

  void run();
  void record(const Answer& answer);
  void write(std::string_view bytes);

  std::filesystem::path path_;
  const FieldInUse& field_;
  FieldNumber named_;
  int file_ = -1;
  cli::McapRecording recording_;
  mutable std::mutex mutex_;
  std::condition_variable came_;
  std::deque<Answer> waiting_;
  std::string failure_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace vicinity::bridge
