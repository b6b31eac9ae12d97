// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "fresh_file.h"

#include "src/geometry/file_beside.h"

namespace vicinity::cli {

FreshFile::FreshFile(const std::filesystem::path& path)
    : file_(std::make_unique<FileBeside>(path)) {}

FreshFile::~FreshFile() = default;

void FreshFile::write(std::string_view text) { file_->write(text); }

void FreshFile::commit() { file_->move_into_place(); }

}  // namespace vicinity::cli
