// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// A mesh as fine and as rough as a laser scan, made from a coarse one: what large meshes are
/// measured with, since none is given.
#pragma once

#include <cstddef>
#include <cstdint>

#include "vicinity/mesh/triangle_mesh.h"

namespace vicinity::benchmarks {

/// Cuts every triangle into n x n, with the smallest n that gives `at_least_triangles`, and moves
/// each vertex along its normal by noise of up to a fifth of a small triangle's side. A closed
/// mesh stays closed: what triangles share before, they share after. Coordinates are whole floats,
/// so that the mesh written to STL and read back has the same vertices. Equal arguments give equal
/// meshes on every machine.
///
///     const TriangleMesh statue = read_mesh(clean / "Plato.stl");         // 17,064 triangles
///     const TriangleMesh scan_70k = scanned_mesh(statue, 68'000, 1);      // n = 2:    68,256
///     const TriangleMesh scan_1m = scanned_mesh(statue, 1'000'000, 1);    // n = 8: 1,092,096
TriangleMesh scanned_mesh(const TriangleMesh& coarse, std::size_t at_least_triangles,
                          std::uint64_t seed);

}  // namespace vicinity::benchmarks
