// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "exit_code.h"

#include <exception>
#include <iostream>
#include <new>

#include "interruption.h"
#include "vicinity/geometry/error.h"

namespace vicinity::cli {
namespace {

constexpr int our_failure = 1;
constexpr int unusable = 2;
constexpr int interrupted = 130;

}  // namespace

int exit_code_of(const std::function<int()>& run) noexcept {
  try {
    const int code = run();
    std::cout.flush();
    if (std::cout) return code;
    std::cerr << "vicinity: standard output could not be written; try a disk with space left\n";
    return our_failure;
  } catch (const Error& error) {
    std::cerr << "vicinity: " << error.what() << '\n';
    return unusable;
  } catch (const Interrupted&) {
    return interrupted;
  } catch (const std::bad_alloc&) {
    std::cerr << "vicinity: this machine has too little memory for that; try a larger "
                 "--voxel-size, smaller bounds, or fewer ranks\n";
    return our_failure;
  } catch (const std::exception& error) {
    std::cerr << "vicinity: " << error.what()
              << "; this should not have happened, and a report of it would help\n";
    return our_failure;
  }
}

}  // namespace vicinity::cli
