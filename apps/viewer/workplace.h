// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The field that is shown and felt, and where it came from.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "scene_document.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity::viewer {

/// Never changed once it is shown: another one takes its place.
struct Workplace {
  std::uint32_t generation = 1;
  std::string name;                    ///< of the field's or scene's file
  ViscosityField original;             ///< with the codings of its build
  ViscosityField field;                ///< with the codings in force
  SceneDocument document;              ///< scene is null where the field was opened as such
  std::shared_ptr<const Scene> scene;  ///< where its meshes are; null as above
};

}  // namespace vicinity::viewer
