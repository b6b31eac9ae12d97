// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The sparse layers of an image that is known to be whole.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "vicinity/viscosity/field_image.h"

namespace vicinity {

/// Root, regions and bricks as they lie in an image.
struct ImageLayer {
  std::span<const std::uint32_t> root, regions;
  std::span<const std::byte> bricks;
};

/// The codes of an image that from_image() has taken, or its distances where it keeps any.
inline ImageLayer layer_of_image(std::span<const std::byte> image, bool distances) {
  const auto& header = *reinterpret_cast<const FieldHeader*>(image.data());
  const std::size_t first = distances ? 5 : 2;
  const auto section = [&](std::size_t s) {
    return image.subspan(header.sections[s].offset, header.sections[s].size);
  };
  const auto references = [&](std::size_t s) {
    const auto bytes = section(s);
    return std::span(reinterpret_cast<const std::uint32_t*>(bytes.data()), bytes.size() / 4);
  };
  return {references(first), references(first + 1), section(first + 2)};
}

}  // namespace vicinity
