// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Fields on disk. The file is the image, byte for byte.
#pragma once

#include <filesystem>

#include "vicinity/viscosity/field.h"

namespace vicinity {

/// Writes a field beside `path` and renames it into place once it is safely on disk: whoever opens
/// `path` finds the old file or the whole new one. A symbolic link stays one: what it leads to is
/// replaced.
/// Errors: throws Error where it cannot be written, or something that is no regular file is there
/// (a folder, a device, a pipe), and leaves `path` as it was and nothing beside
/// it.
void save_field(const ViscosityField& field, const std::filesystem::path& path);

/// Maps a field file into memory, to be read and shared by any number of processes. The file may
/// be replaced by save_field() meanwhile; it must not be overwritten in place.
/// Errors: throws Error for a file that cannot be read, and as ViscosityField::from_image().
ViscosityField open_field(const std::filesystem::path& path);

}  // namespace vicinity
