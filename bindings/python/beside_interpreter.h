// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Long work beside the interpreter: other Python threads go on, progress is told, Ctrl-C stops it.
///
///   work, in a thread of its own        the caller's thread
///     says how far it is     ------>      now and then: takes the lock, tells `progress`,
///     is told to stop        <------      and asks whether Ctrl-C was pressed
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

namespace vicinity::python {

/// How far the work is: stage, and how much of the whole is done, 0..1.
using Report = std::function<void(std::string_view stage, double done)>;

/// What report() throws in the work that is to stop.
struct Stopped {};

/// Calls work(report) without the interpreter lock and returns what it returns. The work must not
/// touch Python; its exceptions, those of `progress`, and KeyboardInterrupt come out here.
/// @param progress  None, or called as progress(stage, done) from the caller's own thread
template <class Work>
auto beside_interpreter(const pybind11::object& progress, Work&& work) {
  constexpr std::chrono::milliseconds between_looks(50);  // a person sees no delay
  struct News {
    std::string stage;
    double done = 0;
  };
  std::mutex mutex;
  std::condition_variable ended_now;
  std::optional<News> news;
  bool ended = false;
  std::atomic<bool> stop = false;
  std::optional<decltype(work(Report()))> result;
  std::exception_ptr failure;

  const Report report = [&](std::string_view stage, double done) {
    if (stop) throw Stopped();
    const std::lock_guard lock(mutex);
    news = News{std::string(stage), done};
  };
  std::thread worker([&] {
    try {
      result.emplace(work(report));
    } catch (...) {
      failure = std::current_exception();
    }
    const std::lock_guard lock(mutex);
    ended = true;
    ended_now.notify_one();
  });

  std::optional<pybind11::error_already_set> in_python;
  for (bool last = false; !last;) {
    std::optional<News> latest;
    {
      const pybind11::gil_scoped_release unlocked;
      std::unique_lock lock(mutex);
      last = ended_now.wait_for(lock, between_looks, [&] { return ended; });
      latest = std::exchange(news, std::nullopt);
    }
    if (in_python) continue;  // it only has to end
    try {
      if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
      if (latest && !progress.is_none()) progress(latest->stage, latest->done);
    } catch (pybind11::error_already_set& error) {
      in_python.emplace(std::move(error));
      stop = true;
    }
  }
  worker.join();
  if (in_python) throw *std::move(in_python);
  if (failure) std::rethrow_exception(failure);
  return *std::move(result);
}

}  // namespace vicinity::python
