// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Ctrl-C that leaves nothing half done.
#pragma once

#include <exception>

namespace vicinity::cli {

/// Thrown where a write notices that it should stop; main() answers with exit code 130.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// From now on SIGINT and SIGTERM end the program at once, except while a file is being written;
/// a second signal ends it even then.
void catch_interruptions();

/// While one of these lives, a signal only asks: the file is finished or taken back first. At the
/// end of the last one the program leaves if it was asked to.
class WhileWriting {
 public:
  WhileWriting() noexcept;
  ~WhileWriting();
  WhileWriting(const WhileWriting&) = delete;
  WhileWriting& operator=(const WhileWriting&) = delete;
};

/// The same for a program that serves until it is told to: then it has done what it should, and
/// goes on to its end. Not within a WhileWriting.
class UntilAsked {
 public:
  UntilAsked() noexcept;
  ~UntilAsked();
  UntilAsked(const UntilAsked&) = delete;
  UntilAsked& operator=(const UntilAsked&) = delete;
};

/// Whether a signal has asked while one of these lived.
bool interruption_asked() noexcept;

/// For long writes: throws Interrupted if a signal has asked.
void stop_if_interrupted();

}  // namespace vicinity::cli
