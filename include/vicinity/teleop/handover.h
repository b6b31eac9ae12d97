// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Something large, from a thread that makes it to one that uses it and never waits, and back to be
/// freed.
#pragma once

#include <atomic>
#include <memory>
#include <utility>

namespace vicinity {

/// One giving thread at a time, one taking thread. What is offered last is taken, whatever the two
/// do at the same time.
template <class T>
class Handover {
 public:
  Handover() = default;
  ~Handover() {
    delete offered_.load();
    free(given_up_.load());
  }
  Handover(const Handover&) = delete;
  Handover& operator=(const Handover&) = delete;

  /// Takes the place of one that was offered and not taken yet. Frees what has been given up.
  void offer(std::unique_ptr<T> next) {
    auto node = std::make_unique<Node>(Node{std::move(next), nullptr});
    free(given_up_.exchange(nullptr, std::memory_order_acquire));
    delete offered_.exchange(node.release(), std::memory_order_acq_rel);
  }

  /// Whether take() has something to take, if only the taking thread takes.
  bool waits() const noexcept { return offered_.load(std::memory_order_relaxed) != nullptr; }

  /// Puts what is offered in place of what is in use, if anything is. Frees nothing.
  bool take(std::unique_ptr<T>& in_use) noexcept {
    if (!waits()) return false;
    Node* const node = offered_.exchange(nullptr, std::memory_order_acquire);
    std::swap(node->value, in_use);
    // Each waits in the place of the one that came for it: however many there are, none is in the
    // way of the next.
    node->next = given_up_.load(std::memory_order_relaxed);
    while (!given_up_.compare_exchange_weak(node->next, node, std::memory_order_release,
                                            std::memory_order_relaxed)) {
    }
    return true;
  }

 private:
  struct Node {
    std::unique_ptr<T> value;
    Node* next;
  };

  static void free(Node* first) noexcept {
    while (first != nullptr) delete std::exchange(first, first->next);
  }

  std::atomic<Node*> offered_{nullptr}, given_up_{nullptr};
};

}  // namespace vicinity
