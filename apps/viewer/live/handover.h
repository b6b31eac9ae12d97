// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Something large, from a thread that makes it to one that uses it and never waits, and back to be
/// freed.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace vicinity::viewer {

/// One giving thread at a time, one taking thread.
template <class T>
class Handover {
 public:
  Handover() = default;
  ~Handover() {
    delete offered_.load();
    delete given_up_.load();
  }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// Takes the place of one that was offered and not taken yet. Frees what has been given up.
  void offer(std::unique_ptr<T> next) {
    delete given_up_.exchange(nullptr, std::memory_order_acquire);
    delete offered_.exchange(next.release(), std::memory_order_acq_rel);
  }

  /// Puts what is offered in place of what is in use. Frees nothing: while what was given up last
  /// has not been collected, nothing is taken.
  bool take(std::unique_ptr<T>& in_use) noexcept {
    if (offered_.load(std::memory_order_relaxed) == nullptr ||
        given_up_.load(std::memory_order_acquire) != nullptr) {
      return false;
    }
    std::unique_ptr<T> next(offered_.exchange(nullptr, std::memory_order_acquire));
    if (next == nullptr) return false;
    given_up_.store(in_use.release(), std::memory_order_release);
    in_use = std::move(next);
    return true;
  }

 private:
  std::atomic<T*> offered_{nullptr}, given_up_{nullptr};
};

}  // namespace vicinity::viewer
