// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "surface_features.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "geometry/whole_loops.h"

namespace vicinity {
namespace {

/// How far beyond its sides a face is asked at all, in voxels: far above rounding (1e-12), far
/// below a step (8e-3).
constexpr double widening = 1e-6;

/// Triangles no higher than this, in voxels, are left to their edges, which are then nowhere more
/// than half of it farther away. A higher triangle's normal is good enough, see Face::slop.
constexpr double least_height = 2e-6;

double squared_distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length = (b - a).norm();
  const Vec3 along = length > 0 ? Vec3((b - a) / length) : Vec3(Vec3::Zero());
  return (p - a - std::clamp(along.dot(p - a), 0.0, length) * along).squaredNorm();
}

}  // namespace

SurfaceFeatures::SurfaceFeatures(const TriangleMesh& mesh, const Workspace& workspace, double reach)
    : reach_(reach) {
  points_.resize(mesh.vertices.size());
  whole::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t v) {
    points_[v] = workspace.to_grid(mesh.vertices[v]) - Vec3::Constant(0.5);
  });
  faces_.resize(mesh.triangles.size());
  whole::parallel_for(std::size_t{0}, faces_.size(),
                      [&](std::size_t t) { faces_[t] = make_face(mesh.triangles[t]); });
  join_edges();
  join_vertices();
  for (const std::uint32_t v : used_vertices_) bounds_.extend(points_[v]);
}

bool SurfaceFeatures::comes_before(std::uint32_t a, std::uint32_t b) const noexcept {
  const Vec3 &p = points_[a], &q = points_[b];
  return std::tie(p.x(), p.y(), p.z(), a) < std::tie(q.x(), q.y(), q.z(), b);
}

SurfaceFeatures::Face SurfaceFeatures::make_face(std::array<std::uint32_t, 3> triangle) const {
  std::sort(triangle.begin(), triangle.end(),
            [&](std::uint32_t a, std::uint32_t b) { return comes_before(a, b); });
  Face face{.vertices = triangle};
  const Vec3 u = points_[triangle[1]] - points_[triangle[0]];
  const Vec3 v = points_[triangle[2]] - points_[triangle[0]];
  const Vec3 cross = u.cross(v);
  const double longest = std::max({u.norm(), v.norm(), (v - u).norm()});
  const double twice_area = cross.norm();
  if (!(twice_area > least_height * longest)) return face;
  face.normal = cross / twice_area;
  // The cross product is off by about 2^-52 * longest², which turns the normal, and with it the
  // side planes, by that over twice the area.
  face.slop = 4e-16 * longest * longest / twice_area * (reach_ + longest);
  return face;
}

void SurfaceFeatures::join_edges() {
  // Sides of triangles, gathered by their first vertex, then put in order of the second.
  struct Side {
    std::uint32_t b, face;
  };
  HugeVector<std::uint32_t> start(points_.size() + 1, 0);
  const auto for_each_side = [&](const auto& visit) {
    for (std::size_t f = 0; f < faces_.size(); ++f) {
      const auto& [u, v, w] = faces_[f].vertices;
      visit(u, v, static_cast<std::uint32_t>(f));
      visit(u, w, static_cast<std::uint32_t>(f));
      visit(v, w, static_cast<std::uint32_t>(f));
    }
  };
  for_each_side([&](std::uint32_t a, std::uint32_t, std::uint32_t) { ++start[a + 1]; });
  for (std::size_t v = 0; v < points_.size(); ++v) start[v + 1] += start[v];
  HugeVector<Side> sides(3 * faces_.size());
  HugeVector<std::uint32_t> fill(start.begin(), start.end() - 1);
  for_each_side([&](std::uint32_t a, std::uint32_t b, std::uint32_t f) {
    sides[fill[a]++] = {b, f};
  });
  const auto sides_of = [&](std::size_t a) {
    return std::span<Side>(sides.data() + start[a], start[a + 1] - start[a]);
  };
  whole::parallel_for(std::size_t{0}, points_.size(), [&](std::size_t a) {
    const std::span<Side> of_a = sides_of(a);
    std::sort(of_a.begin(), of_a.end(), [](const Side& s, const Side& t) {
      return std::tie(s.b, s.face) < std::tie(t.b, t.face);
    });
  });
  for (std::uint32_t a = 0; a < points_.size(); ++a) {
    const std::span<Side> of_a = sides_of(a);
    for (std::size_t s = 0; s < of_a.size(); ++s) {
      if (s == 0 || of_a[s].b != of_a[s - 1].b) {
        edges_.push_back({a, of_a[s].b, static_cast<std::uint32_t>(edge_faces_.size()), 0});
      }
      if (faces_[of_a[s].face].normal.isZero(0)) continue;
      edge_faces_.push_back(of_a[s].face);
      ++edges_.back().face_count;
    }
  }
}

void SurfaceFeatures::join_vertices() {
  first_edge_.assign(points_.size() + 1, 0);
  for (const Edge& edge : edges_) {
    ++first_edge_[edge.a + 1];
    ++first_edge_[edge.b + 1];
  }
  for (std::uint32_t v = 0; v < points_.size(); ++v) {
    if (first_edge_[v + 1] != 0) used_vertices_.push_back(v);
    first_edge_[v + 1] += first_edge_[v];
  }
  vertex_edges_.resize(2 * edges_.size());
  HugeVector<std::uint32_t> fill(first_edge_.begin(), first_edge_.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    vertex_edges_[fill[edges_[e].a]++] = e;
    vertex_edges_[fill[edges_[e].b]++] = e;
  }
}

bool SurfaceFeatures::region_of(std::size_t feature, NearestRegion& region,
                                Eigen::AlignedBox3f& bounds) const {
  if (feature < faces_.size()) return face_region(faces_[feature], region, bounds);
  feature -= faces_.size();
  if (feature < edges_.size()) return edge_region(edges_[feature], region, bounds);
  return vertex_region(used_vertices_[feature - edges_.size()], region, bounds);
}

double SurfaceFeatures::squared_distance(std::size_t feature, const Vec3& p) const {
  if (feature < faces_.size()) {
    const Face& face = faces_[feature];
    bool in_front = false;
    double to_sides = std::numeric_limits<double>::infinity();
    for (const auto& [u, v] : sides_of(face)) {
      const Vec3 &a = points_[u], &b = points_[v];
      const Vec3 out = out_of_face(face, u, v);
      const double beyond = out.dot(p - a);
      if (beyond > (widening + face.slop) * out.norm()) {
        return std::numeric_limits<double>::infinity();
      }
      in_front |= beyond > 0;
      to_sides = std::min(to_sides, squared_distance_to_segment(p, a, b));
    }
    if (in_front) return to_sides;
    const double away = face.normal.dot(p - points_[face.vertices[0]]);
    return away * away;
  }
  feature -= faces_.size();
  if (feature < edges_.size()) {
    return squared_distance_to_segment(p, points_[edges_[feature].a], points_[edges_[feature].b]);
  }
  return (p - points_[used_vertices_[feature - edges_.size()]]).squaredNorm();
}

bool SurfaceFeatures::face_region(const Face& face, NearestRegion& region,
                                  Eigen::AlignedBox3f& bounds) const {
  const Vec3& n = face.normal;
  if (n.isZero(0)) return false;
  Box triangle;
  for (const std::uint32_t v : face.vertices) triangle.extend(points_[v]);
  const Vec3& a = points_[face.vertices[0]];
  region = NearestRegion(FeatureKind::face, a, triangle.sizes().sum(), reach_);
  region.direction = n.cast<float>();
  for (const auto& [u, v] : sides_of(face)) {
    // Shorter than 1, at least 1 / sqrt(3): good enough, and no root.
    const double longer = (points_[v] - points_[u]).lpNorm<1>();
    region.keep_behind(out_of_face(face, u, v) / longer, points_[u], face.slop);
  }
  region.set_doubt(face.slop);
  region.keep_behind(n, a, reach_);
  region.keep_behind(-n, a, reach_);
  bounds = region.bounds(triangle, reach_ * n.cwiseAbs() + Vec3::Constant(face.slop));
  return true;
}

bool SurfaceFeatures::edge_region(const Edge& edge, NearestRegion& region,
                                  Eigen::AlignedBox3f& bounds) const {
  const Vec3 &a = points_[edge.a], &b = points_[edge.b];
  const double length = (b - a).norm();
  if (length == 0) return false;
  const Vec3 along = (b - a) / length;
  // Two faces are enough: further ones would only make the region smaller.
  const std::size_t faces = std::min<std::uint32_t>(edge.face_count, 2);
  Vec3 into[2];
  double slop = 0;
  for (std::size_t f = 0; f < faces; ++f) {
    const Face& face = faces_[edge_faces_[edge.first_face + f]];
    into[f] = out_of_face(face, edge.a, edge.b) / -length;
    slop = std::max(slop, face.slop);
  }
  const double bend = faces == 2 ? (into[0] + into[1]).norm() : 0;
  // Two faces in one plane: what is behind both sides within reach lies in the widened prisms.
  if (edge.face_count == 2 && reach_ * bend <= 2 * widening) return false;

  region = NearestRegion(FeatureKind::edge, a, length, reach_);
  region.direction = along.cast<float>();
  region.length = static_cast<float>(length);
  region.keep_behind(-along, a, 0);
  region.keep_behind(along, b, 0);
  for (std::size_t f = 0; f < faces; ++f) region.keep_behind(into[f], a, slop);
  if (bend > 1e-6 + 1e3 * slop) {  // the middle of the wedge is known
    const Vec3 middle = -(into[0] + into[1]) / bend;
    region.keep_behind(-middle, a, 2 * slop / bend);
    region.keep_behind(middle, a, reach_);
  }
  Box segment(a);
  segment.extend(b);
  bounds =
      region.bounds(segment, reach_ * (Vec3::Ones() - along.cwiseAbs2()).cwiseMax(0).cwiseSqrt());
  return true;
}

bool SurfaceFeatures::vertex_region(std::uint32_t vertex, NearestRegion& region,
                                    Eigen::AlignedBox3f& bounds) const {
  const Vec3& v = points_[vertex];
  region = NearestRegion(FeatureKind::vertex, v, 0, reach_);
  // All its edges' planes are too many. Four that look far apart, and their mean, come near.
  std::array<Vec3, 16> along;
  std::size_t count = 0;
  for (std::uint32_t e = first_edge_[vertex]; e < first_edge_[vertex + 1]; ++e) {
    const Edge& edge = edges_[vertex_edges_[e]];
    const Vec3 to_other = points_[edge.a == vertex ? edge.b : edge.a] - v;
    const double length = to_other.norm();
    if (length > 0 && count < along.size()) along[count++] = to_other / length;
  }
  Vec3 mean = Vec3::Zero();
  std::array<double, 16> likeness;  // to the most alike of those chosen
  likeness.fill(-1);
  for (int chosen = 0; chosen < 4 && count > 0; ++chosen) {
    const auto least = std::min_element(likeness.begin(), likeness.begin() + count);
    if (*least > 1 - 1e-9) break;
    const Vec3 d = along[static_cast<std::size_t>(least - likeness.begin())];
    region.keep_behind(d, v, 0);
    mean += d;
    for (std::size_t e = 0; e < count; ++e) likeness[e] = std::max(likeness[e], d.dot(along[e]));
  }
  const double length = mean.norm();
  if (length > 1e-3) {
    mean /= length;
    region.keep_behind(mean, v, 0);
    region.keep_behind(-mean, v, reach_);
  }
  bounds = region.bounds(Box(v), Vec3::Constant(reach_));
  return true;
}

}  // namespace vicinity
