// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// From triangles to boundary and inner voxels: figures 9 and 11 to 14. Lengths in voxels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "reproduce/item.h"
#include "vicinity/voxel/voxel_set.h"

namespace vicinity::report {

/// One horizontal section of a voxelised body.
struct BodySection {
  int z = 0;
  std::uint64_t boundary = 0, inner = 0;
  bool closed = false;  ///< no inner voxel is reached from outside without crossing boundary voxels
  double true_area = 0;
  /// Boundary voxels lie half inside, in the mean.
  double area() const noexcept {
    return static_cast<double>(inner) + 0.5 * static_cast<double>(boundary);
  }
};

BodySection body_section(const ViscosityField& field, int z, double true_area);

/// Fig. 9: the cylinder's top layer and an intermediate one.
std::vector<Check> check_fig9(const BodySection& top, const BodySection& intermediate);
Outcome fig9(Workshop& workshop);

/// Fig. 12: voxels of the wedge and the cube against their volumes.
struct BodyVolume {
  std::string part;
  std::uint64_t boundary = 0, inner = 0;
  double true_volume = 0;
  double volume() const noexcept {
    return static_cast<double>(inner) + 0.5 * static_cast<double>(boundary);
  }
};
std::vector<Check> check_fig12(const std::vector<BodyVolume>& volumes);
Outcome fig12(Workshop& workshop);

/// Fig. 13: widths of the cone's vertical section through the apex, one for each height from 0.
struct ConeProfile {
  std::vector<BodySection> sections;
  std::vector<double> width, true_width;
};
std::vector<Check> check_fig13(const ConeProfile& profile);
Outcome fig13(Workshop& workshop);

/// Fig. 14: how wide the wedge's V is at a height.
struct WedgeGap {
  int z = 0;
  double width = 0, true_width = 0;
};
std::vector<Check> check_fig14(const std::vector<WedgeGap>& from_base);
Outcome fig14(Workshop& workshop);

/// Which grid lines a triangle is intersected with.
enum class ProbeLines {
  largest_face,   ///< normal to the largest face of its bounding brick, as in §4.1.2
  always_z,       ///< no choice
  smallest_face,  ///< the worst choice
};

/// Boundary voxels by probe vectors, against the exact definition.
struct ProbeResult {
  std::string part;
  ProbeLines lines = ProbeLines::largest_face;
  std::uint64_t exact = 0;    ///< voxels that a triangle passes through
  std::uint64_t missed = 0;   ///< of those, met by no line
  std::uint64_t doubled = 0;  ///< met more than once
};

/// @param mesh  in metres, as Workshop::read_back()
ProbeResult probe(const std::string& part, const TriangleMesh& mesh, ProbeLines lines);

/// Fig. 11. @param results  all three kinds of line for each part
std::vector<Check> check_fig11(const std::vector<ProbeResult>& results);
Outcome fig11(Workshop& workshop);

}  // namespace vicinity::report
