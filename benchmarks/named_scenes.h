// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The scenes that benchmarks are named after.
#pragma once

#include <string>
#include <vector>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/scene.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity::benchmarks {

/// One object on a grid that is `voxels` long on the object's longest side with all its layers.
struct NamedObject {
  std::string name;  ///< "statue_512"
  TriangleMesh mesh;
  Workspace workspace;
};

/// Layers as the design's default: m = 4, q = 6.
inline constexpr int layers_m = 4;
inline constexpr int layers_q = 6;

/// A torus that we make ourselves, and, where VICINITY_DATA has them, a scanned statue and a
/// slender CAD part, each at the given length. Made once for each length.
const std::vector<NamedObject>& named_objects(int voxels);

/// Whole scenes: the embedded hot cell.
Scene hot_cell();

}  // namespace vicinity::benchmarks
