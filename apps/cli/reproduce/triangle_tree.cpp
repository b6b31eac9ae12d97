// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The only unit that knows Embree.

#include <embree3/rtcore.h>

#include <cmath>
#include <limits>

#include "reproduce/nearest_surface.h"
#include "vicinity/geometry/error.h"

namespace vicinity::report {

struct TriangleTree::Scene {
  std::vector<Corners> triangles;
  RTCDevice device = rtcNewDevice(nullptr);
  RTCScene scene = nullptr;

  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

namespace {

struct Search {
  const std::vector<Corners>& triangles;
  Vec3 p;
  TriangleTree::Nearest nearest{std::numeric_limits<double>::infinity(), 0};
};

// Embree's boxes are in float; the distance itself is ours, in double.
bool look_at(RTCPointQueryFunctionArguments* arguments) {
  Search& search = *static_cast<Search*>(arguments->userPtr);
  ++search.nearest.looked_at;
  const double distance = distance_to(search.triangles[arguments->primID], search.p);
  if (distance >= search.nearest.distance) return false;
  search.nearest.distance = distance;
  arguments->query->radius = std::nextafter(static_cast<float>(distance), INFINITY);
  return true;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<Corners> triangles) : scene_(std::make_unique<Scene>()) {
  scene_->triangles = std::move(triangles);
  if (scene_->device == nullptr) throw Error({.where = "Embree", .what = "gives no device"});
  const std::size_t count = scene_->triangles.size();
  RTCGeometry geometry = rtcNewGeometry(scene_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* const vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 3 * count));
  auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(unsigned), count));
  for (std::size_t corner = 0; corner < 3 * count; ++corner) {
    const Vec3& p = scene_->triangles[corner / 3][corner % 3];
    for (int axis = 0; axis < 3; ++axis) {
      vertices[3 * corner + static_cast<std::size_t>(axis)] = static_cast<float>(p[axis]);
    }
    indices[corner] = static_cast<unsigned>(corner);
  }
  rtcCommitGeometry(geometry);
  scene_->scene = rtcNewScene(scene_->device);
  rtcSetSceneFlags(scene_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcAttachGeometry(scene_->scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_->scene);
}

TriangleTree::~TriangleTree() = default;

TriangleTree::Nearest TriangleTree::nearest(const Vec3& p) const {
  Search search{scene_->triangles, p};
  RTCPointQuery query{};
  query.x = static_cast<float>(p.x());
  query.y = static_cast<float>(p.y());
  query.z = static_cast<float>(p.z());
  query.radius = INFINITY;
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(scene_->scene, &query, &context, look_at, &search);
  return search.nearest;
}

}  // namespace vicinity::report
