// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "recorder.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <exception>

#include "announcer.h"
#include "vicinity/geometry/error.h"

namespace vicinity::bridge {
namespace {

int opened(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
  if (file >= 0) {
    // The file's name must outlast a power failure too.
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    const int names = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (names >= 0) {
      fsync(names);
      close(names);
    }
    return file;
  }
  throw Error({.where = path.string(),
               .what = "cannot be opened for writing",
               .found = std::strerror(errno)});
}

}  // namespace

std::filesystem::path keep_earlier(const std::filesystem::path& recording) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(recording, none)) return {};
  std::filesystem::path kept;
  int n = 0;
  do {
    kept = recording;
    kept.replace_extension("." + std::to_string(++n) + recording.extension().string());
  } while (std::filesystem::exists(kept));
  std::filesystem::rename(recording, kept, none);
  if (!none) return kept;
  throw Error({.where = recording.string(),
               .what = "an earlier recording cannot be kept as " + kept.string(),
               .found = none.message()});
}

Recorder::Recorder(const std::filesystem::path& path, const FieldInUse& field,
                   const RobotModel& robot, int tool_link)
    : path_(path),
      field_(field),
      file_(opened(path)),
      recording_([this](std::string_view bytes) { write(bytes); }, robot, {}, tool_link) {
  thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  came_.notify_one();
  thread_.join();
  close(file_);
}

void Recorder::add(const Answer& answer) {
  if (answer.sample.heard != Heard::state) return;
  {
    const std::lock_guard lock(mutex_);
    if (failure_.empty()) waiting_.push_back(answer);
  }
  came_.notify_one();
}

std::string Recorder::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

void Recorder::run() {
  std::deque<Answer> now;
  auto closed = std::chrono::steady_clock::now();
  try {
    for (bool last = false; !last;) {
      {
        std::unique_lock lock(mutex_);
        came_.wait_for(lock, longest_chunk, [&] { return stop_ || !waiting_.empty(); });
        now.clear();
        now.swap(waiting_);
        last = stop_;
      }
      for (const Answer& answer : now) {
        if (named_.is_new(answer)) recording_.name_objects(field_.objects(answer));
        record(answer);
      }
      if (std::chrono::steady_clock::now() - closed < longest_chunk) continue;
      recording_.file().close_chunk();
      closed = std::chrono::steady_clock::now();
    }
    recording_.file().finish();
  } catch (const std::exception& error) {
    const std::lock_guard lock(mutex_);
    failure_ = error.what();
    waiting_.clear();
  }
}

void Recorder::record(const Answer& answer) {
  const ArmSample& sample = answer.sample;
  const Output& output = answer.output;
  const std::uint64_t time_ns = cli::nanoseconds_of(sample.stamp);
  if (!sample.q.allFinite()) {  // no place, and no axes that a wrench could be in
    recording_.say(time_ns, output.reason, status_of(answer), level_of(answer));
    return;
  }
  const auto n = static_cast<std::size_t>(sample.q.size());
  recording_.add(time_ns, {sample.q.data(), n}, {output.torque.data(), n}, output.tool,
                 output.master_force, output.reason, sample.X_WB, status_of(answer),
                 level_of(answer));
}

void Recorder::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      throw Error(
          {.where = path_.string(), .what = "cannot be written", .found = std::strerror(errno)});
    }
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  fdatasync(file_);
}

}  // namespace vicinity::bridge
