// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Work that the web server's thread hands on, one after the other.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace vicinity::viewer {

/// One thread, and a queue that holds no more than so many.
class Jobs {
 public:
  explicit Jobs(std::size_t most_waiting);
  /// What waits is dropped; what is being done is done.
  ~Jobs();
  Jobs(const Jobs&) = delete;
  Jobs& operator=(const Jobs&) = delete;

  /// False where the queue is full. @param job  where it throws, it has told whom it may concern
  bool add(std::function<void()> job);

 private:
  void work();

  std::size_t most_waiting_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace vicinity::viewer
