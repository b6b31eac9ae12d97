// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Reads an MCAP file from its beginning, whole or cut off.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "mcap/record.h"

namespace vicinity::mcap {

/// How the file ended.
struct Ending {
  bool whole = true;                      ///< else it was cut off: the recorder never finished it
  std::uint64_t used = 0, file_size = 0;  ///< so many bytes hold what was read [bytes]
  std::string why = {};                   ///< what is wrong where it was cut off, as a clause
};

using MessageHandler =
    std::function<void(const Schema& schema, const Channel& channel, const Message& message)>;

/// Hands every message to `handler`, in the order of the file, chunk by chunk: memory is that of
/// the largest chunk. Checksums are compared before anything of a chunk is handed over.
///
/// A file without its end (footer and magic) was cut off, by a power failure say: all whole chunks
/// are read, and the rest is told in the Ending. It is scanned, not looked up in the summary, which
/// such a file does not have.
///
/// Errors: throws Error for a file that cannot be read, that is no MCAP file of version 0, that
/// has its end and yet is damaged in the middle, or that is compressed by anything but zstd.
Ending read(const std::filesystem::path& path, const MessageHandler& handler);

}  // namespace vicinity::mcap
