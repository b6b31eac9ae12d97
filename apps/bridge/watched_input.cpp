// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "watched_input.h"

#include <cstddef>
#include <fstream>
#include <memory>
#include <system_error>
#include <variant>

#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::bridge {
namespace {

// Not mapped, as open_field() would: whoever writes the file in place would change the field under
// the tick, or cut it off.
ViscosityField field_in_memory(const std::filesystem::path& path) {
  std::error_code none;
  std::ifstream file(path, std::ios::binary);
  const bool readable = file && std::filesystem::is_regular_file(path, none);
  const std::uintmax_t size = readable ? std::filesystem::file_size(path, none) : 0;
  if (!readable || none) {
    throw Error({.where = path.string(),
                 .what = "cannot be opened",
                 .found = "no file that can be read",
                 .expected = "a file that vicinity build has written"});
  }
  const auto bytes = std::make_shared_for_overwrite<std::byte[]>(size);
  file.read(reinterpret_cast<char*>(bytes.get()), static_cast<std::streamsize>(size));
  const auto read = static_cast<std::size_t>(file.gcount());
  return ViscosityField::from_image(bytes, read, path.string());
}

}  // namespace

bool is_scene(const std::filesystem::path& input) {
  return input.extension() == ".yaml" || input.extension() == ".yml";
}

WatchedInput::WatchedInput(std::filesystem::path input)
    : input_(std::move(input)), files_({input_}) {}

ViscosityField WatchedInput::field(const BuildOptions& options) {
  used_ = last_ = look();
  if (!is_scene(input_)) return field_in_memory(input_);
  const Scene scene = read_scene(input_);
  files_ = {input_};
  for (const SceneObject& object : scene.objects) {
    if (const auto* mesh = std::get_if<MeshFile>(&object.shape)) files_.push_back(mesh->path);
  }
  // The scene as it was before it was read: what is written meanwhile is another.
  const auto scene_file = used_.front();
  used_ = look();
  used_.front() = scene_file;
  last_ = used_;
  return builder_.build(scene, options).field;
}

bool WatchedInput::changed() {
  const Look now = look();
  const bool settled = now == last_;
  last_ = now;
  return settled && now != used_;
}

WatchedInput::Look WatchedInput::look() const {
  Look look;
  for (const std::filesystem::path& file : files_) {
    std::error_code none;
    const auto time = std::filesystem::last_write_time(file, none);
    const auto size = std::filesystem::file_size(file, none);
    look.emplace_back(time, size);
  }
  return look;
}

}  // namespace vicinity::bridge
