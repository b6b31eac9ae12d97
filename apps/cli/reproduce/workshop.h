// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Where the report is made: its folder, its parts, and the ordinary way from an STL file to a
/// field.
#pragma once

#include <filesystem>
#include <string>

#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/field.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity::report {

/// Edge of a voxel [m]. The paper counts in voxels and names no size.
inline constexpr double voxel_m = 0.005;

/// An object of the paper, where it stands in its workspace. Lengths in voxels.
struct Part {
  std::string name;
  TriangleMesh mesh;
  VoxelIndex dims;  ///< the workspace, from voxel (0,0,0)
};

/// How a part is wrapped.
struct Layers {
  int m = 4, q = 6;
  LayerShape shape = LayerShape::sphere;
  Coding coding = named_coding("paper", 6);
  BoundaryMethod boundary = BoundaryMethod::exact;
  InnerMethod inner = InnerMethod::winding;
};

class Workshop {
 public:
  /// Errors: throws Error where the folder cannot be made.
  explicit Workshop(std::filesystem::path folder);

  const std::filesystem::path& folder() const noexcept { return folder_; }

  /// A file of the report by its name below the folder, "fig22/tracks.csv"; makes its folder.
  std::filesystem::path file(const std::string& name) const;

  /// Writes the part as an STL file in millimetres, meshes/NAME.stl.
  std::filesystem::path write_mesh(const Part& part) const;

  /// The part as the ordinary reader sees that file, in metres.
  TriangleMesh read_back(const Part& part) const;

  /// Writes the part's STL file and builds its field from it.
  ViscosityField field(const Part& part, const Layers& layers) const;

  /// The part's field of exact distances, known up to `reach` voxels from the surface: what ranks
  /// are held against. It is another algorithm than theirs.
  ViscosityField distances(const Part& part, int reach) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace vicinity::report
