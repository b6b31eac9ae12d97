// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Scenes as YAML files, written by people.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "vicinity/viscosity/scene.h"

namespace vicinity {

/// Reads a scene file. Its keys, with what they are where left out:
///
///   voxel_size: 0.005          [m]
///   bounds: auto               or [[x, y, z], [x, y, z]] [m]
///   defaults:                  for every object that does not say otherwise:
///     m: 4                     radius of the floating analyser zone, 1..8 voxels
///     q: 6                     ranks, 0..32
///     shape: sphere            cube, sphere or distance
///     coding: paper            a list, rank 1 first, or linear, nonlinear, jnd, paper [N·s/m³]
///     skin: 100                of boundary and inner voxels [N·s/m³]
///     boundary: exact          or probe
///     inner: winding           raster or none
///   objects:                   each with a name of its own, and every key of defaults
///     - name: bench
///       mesh: bench.stl        relative to the scene file
///       units: mm              of the mesh file: mm, cm, m or in; must be stated
///       pose: {xyz: [0, 0, 0], rpy: [0, 0, 0]}      or quaternion: [x, y, z, w]
///       scale: 1
///     - name: vessel
///       primitive: {cylinder: {radius: 0.4, height: 1.2}}     in place of mesh and units [m]
///   robot:                     may be left out
///     urdf: arm.urdf
///     base: {xyz: [0, 0, 0], rpy: [0, 0, 0]}
///     points_per_m2: 2000
///     exclude: [link, ...]
///     tool: frame
///
/// Primitives, by the names and parameters of vicinity/mesh/primitive.h: box, sphere, cylinder,
/// cone, torus, tube, extrusion, revolution, pipe, v_block, complex_cylinder.
///
/// Errors: throws Error, naming file and line, for text that is not YAML, an unknown key (naming
/// the nearest known one), a value of the wrong type or out of range, two objects of one name, a
/// coding shorter than q, and a mesh file without a unit (with its size read as mm, m and inches).
/// Text that aliases blow up beyond 200,000 numbers is refused too.
Scene read_scene(const std::filesystem::path& path);

/// Reads a scene from text.
/// @param base_folder  what paths in the text are relative to
/// @param where        names the text in errors
/// Errors: as read_scene().
Scene parse_scene(std::string_view text, const std::filesystem::path& base_folder,
                  const std::string& where);

}  // namespace vicinity
