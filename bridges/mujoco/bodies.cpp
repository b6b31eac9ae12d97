// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "bodies.h"

#include <utility>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

Vec3 triple(const mjtNum* at) { return {at[0], at[1], at[2]}; }

// Vertices and faces of one mesh, in the frame of the geoms that show it.
TriangleMesh mesh_of(const mjModel& model, int mesh) {
  TriangleMesh triangles;
  const float* vertex = model.mesh_vert + 3 * model.mesh_vertadr[mesh];
  for (int n = 0; n < model.mesh_vertnum[mesh]; ++n, vertex += 3) {
    triangles.vertices.emplace_back(vertex[0], vertex[1], vertex[2]);
  }
  const int* face = model.mesh_face + 3 * model.mesh_faceadr[mesh];
  for (int n = 0; n < model.mesh_facenum[mesh]; ++n, face += 3) {
    triangles.triangles.push_back({static_cast<std::uint32_t>(face[0]),
                                   static_cast<std::uint32_t>(face[1]),
                                   static_cast<std::uint32_t>(face[2])});
  }
  return triangles;
}

// Planes and height fields have no place on a body that moves, and no surface here.
TriangleMesh shape_of(const mjModel& model, int geom) {
  const Vec3 size = triple(model.geom_size + 3 * geom);
  switch (model.geom_type[geom]) {
    case mjGEOM_SPHERE:
      return primitive::sphere(size.x());
    case mjGEOM_CAPSULE:
      return primitive::capsule(size.x(), 2 * size.y());
    case mjGEOM_ELLIPSOID: {
      TriangleMesh ball = primitive::sphere(1);
      for (Vec3& vertex : ball.vertices) vertex = vertex.cwiseProduct(size);
      return ball;
    }
    case mjGEOM_CYLINDER:
      return primitive::cylinder(size.x(), 2 * size.y());
    case mjGEOM_BOX:
      return primitive::box(2 * size);
    case mjGEOM_MESH:
      return mesh_of(model, model.geom_dataid[geom]);
    default:
      return {};
  }
}

TriangleMesh placed_shape(const mjModel& model, int geom) {
  const mjtNum* const quat = model.geom_quat + 4 * geom;
  Pose X_BG = Pose::Identity();
  X_BG.linear() = Eigen::Quaterniond(quat[0], quat[1], quat[2], quat[3]).toRotationMatrix();
  X_BG.translation() = triple(model.geom_pos + 3 * geom);
  TriangleMesh mesh = shape_of(model, geom);
  for (Vec3& vertex : mesh.vertices) vertex = X_BG * vertex;
  return mesh;
}

std::vector<LinkGeometry> geometries_of(const mjModel& model, int body) {
  std::vector<LinkGeometry> collision, visual;
  for (int n = 0; n < model.body_geomnum[body]; ++n) {
    const int geom = model.body_geomadr[body] + n;
    const bool collides = model.geom_contype[geom] != 0 || model.geom_conaffinity[geom] != 0;
    TriangleMesh mesh = placed_shape(model, geom);
    if (mesh.triangles.empty()) continue;
    if (collides) {
      collision.push_back({LinkGeometry::Role::collision, std::move(mesh)});
    } else {
      visual.push_back({LinkGeometry::Role::visual, std::move(mesh)});
    }
  }
  return collision.empty() ? visual : collision;
}

// Which bodies count, by number; parents come before their children.
std::vector<bool> bodies_that_count(const mjModel& model, const std::vector<std::string>& counted) {
  std::vector<bool> counts(static_cast<std::size_t>(model.nbody), counted.empty());
  for (const std::string& name : counted) {
    const int body = mj_name2id(&model, mjOBJ_BODY, name.c_str());
    if (body < 0) {
      std::vector<std::string> names;
      for (int b = 1; b < model.nbody; ++b) names.push_back(name_of_body(model, b));
      throw Error({.where = "drag in MuJoCo",
                   .what = "the model has no such body",
                   .found = "'" + name + "'",
                   .hint = nearest_word(name, names)});
    }
    counts[static_cast<std::size_t>(body)] = true;
  }
  for (int body = 1; body < model.nbody; ++body) {
    const auto parent = static_cast<std::size_t>(model.body_parentid[body]);
    if (counts[parent]) counts[static_cast<std::size_t>(body)] = true;
  }
  return counts;
}

}  // namespace

std::string name_of_body(const mjModel& model, int body) {
  const char* const name = mj_id2name(&model, mjOBJ_BODY, body);
  return name != nullptr && *name != '\0' ? name : "body " + std::to_string(body);
}

RobotModel surfaces_of(const mjModel& model, const std::vector<std::string>& counted) {
  const std::vector<bool> counts = bodies_that_count(model, counted);
  RobotModel bodies{.name = model.names, .links = {}, .joints = {}, .coordinates = {}};
  for (int body = 0; body < model.nbody; ++body) {
    Link link{.name = name_of_body(model, body)};
    const bool moves = model.body_weldid[body] != 0;
    if (moves && counts[static_cast<std::size_t>(body)]) {
      link.geometries = geometries_of(model, body);
    }
    if (body > 0) bodies.joints.push_back({.name = link.name, .limits = {}});
    bodies.links.push_back(std::move(link));
  }
  return bodies;
}

}  // namespace vicinity
