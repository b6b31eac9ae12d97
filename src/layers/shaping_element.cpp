// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/layers/shaping_element.h"

namespace vicinity {

const char* to_string(LayerShape shape) noexcept {
  switch (shape) {
    case LayerShape::cube:
      return "cube";
    case LayerShape::sphere:
      return "sphere";
    case LayerShape::distance:
      return "distance";
  }
  return "unknown";
}

}  // namespace vicinity
