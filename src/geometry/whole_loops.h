// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Parallel loops that are run to their end, or throw.
///
/// TBB's own do a third thing: where a loop around them is given up, since another thread's part of
/// it threw, they return as if they were done, and whoever goes on finds half of what he wrote.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/parallel_pipeline.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_group.h>

#include <exception>
#include <utility>

namespace vicinity::whole {

/// Thrown within a loop that is given up. What ended that loop is what its caller sees; this is not
/// seen outside, but by a caller who gave up a TBB context of his own.
class GivenUp : public std::exception {
 public:
  const char* what() const noexcept override { return "the work was given up"; }
};

/// Runs loop(context), with a context of its own.
/// Errors: what the loop throws; GivenUp where a loop around it is given up.
template <class Loop>
void run(const Loop& loop) {
  tbb::task_group_context context;  // TBB hands it down when those around it are given up
  loop(context);
  if (context.is_group_execution_cancelled()) throw GivenUp();
}

/// As in TBB, without a context.
template <class... Arguments>
void parallel_for(Arguments&&... arguments) {
  run([&](auto& context) { tbb::parallel_for(std::forward<Arguments>(arguments)..., context); });
}
template <class Range, class Value, class... Arguments>
Value parallel_reduce(const Range& range, const Value& identity, Arguments&&... arguments) {
  Value value;
  run([&](auto& context) {
    value = tbb::parallel_reduce(range, identity, std::forward<Arguments>(arguments)..., context);
  });
  return value;
}
template <class... Arguments>
void parallel_pipeline(Arguments&&... arguments) {
  run([&](auto& context) {
    tbb::parallel_pipeline(std::forward<Arguments>(arguments)..., context);
  });
}

}  // namespace vicinity::whole
