// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// One object on its way from scene to field, and how it is known again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <system_error>
#include <variant>

#include "object_voxel_array.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/viscosity/scene.h"

namespace vicinity {

/// What must stay the same for an object's voxels to be kept.
struct ObjectIdentity {
  SceneObject object;  // its coding does not matter
  std::uintmax_t file_size = 0;
  std::filesystem::file_time_type file_time;

  explicit ObjectIdentity(const SceneObject& o) : object(o) {
    if (const auto* file = std::get_if<MeshFile>(&o.shape)) {
      std::error_code none;  // a file that is missing is an error when it is read
      file_size = std::filesystem::file_size(file->path, none);
      file_time = std::filesystem::last_write_time(file->path, none);
    }
  }

  bool operator==(const ObjectIdentity& other) const {
    const SceneObject &a = object, &b = other.object;
    const auto same_shape = [&] {
      if (a.shape.index() != b.shape.index()) return false;
      if (const auto* file = std::get_if<MeshFile>(&a.shape)) {
        const auto& its = std::get<MeshFile>(b.shape);
        return file->path == its.path && file->units == its.units && file_size == other.file_size &&
               file_time == other.file_time;
      }
      const auto &mesh = std::get<TriangleMesh>(a.shape), &its = std::get<TriangleMesh>(b.shape);
      return mesh.triangles == its.triangles && mesh.vertices == its.vertices;
    };
    return a.name == b.name && a.X_WO.matrix() == b.X_WO.matrix() && a.scale == b.scale &&
           a.m == b.m && a.q == b.q && a.layers == b.layers && a.boundary == b.boundary &&
           a.inner == b.inner && same_shape();
  }
};

/// One object on its way through the stages, and what is kept of it.
struct ObjectWork {
  explicit ObjectWork(const SceneObject& o) : object(&o), identity(o) {}

  const SceneObject* object;
  ObjectIdentity identity;
  TriangleMesh mesh;
  MeshInspection inspection;  // in W
  std::shared_ptr<const ObjectVoxelArray> array;
};

}  // namespace vicinity
