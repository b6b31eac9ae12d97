// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The point of a surface nearest to p lies inside a face, inside an edge, or at a vertex, and p
// then lies in that feature's own region:
//
//            edge        face: the prism over the triangle, on both sides
//         \   |   /      edge: between its end planes, and not in front of any face that meets in
//     face \  |  / face        it (the wedge between the prisms)
//     ______\ | /______  vertex: not in front of any edge that meets in it (a cone)
//             v
//
// (after Mauch's closest point transform, without a sign and for any soup of triangles). So the
// distance at p is the least of the features' own distances, to plane, line or point, over those
// regions that hold p. Every region is convex and is cut to the farthest distance that matters:
// voxel centres in it are found row by row, as the run between its half-spaces.
//
// A region may only ever be too large, never too small: then no centre falls between two regions.
// Each is widened by a millionth of a voxel. A line or a point is a part of the surface, so that
// its distance is right wherever it is taken; a plane's, taken just outside of its triangle, is at
// most that millionth too small.
//
// Grid coordinates here have voxel centres at integers.

#include "vicinity/layers/distance_layers.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

/// How much regions are widened, in voxels: far above rounding (1e-12), far below a step (8e-3).
constexpr double widening = 1e-6;

/// Triangles no higher than this, in voxels, are left to their edges, which are then nowhere more
/// than half of it farther away. A higher triangle's normal is good enough, see slop_of().
constexpr double least_height = 2e-6;

/// A distance this little below a step, in steps, counts as that step, so that 2.5 voxels are
/// stored as 2.5 voxels however they were rounded. In voxels: 8e-9.
constexpr double forgiven_steps = 1e-6;

struct HalfSpace {
  Vec3 normal;
  double offset;  ///< holds p where normal · p <= offset
};

/// Where a feature can be nearest, and its distance there.
struct Region {
  void reset(const Vec3& a, const Eigen::Matrix3d& P) {
    half_spaces.clear();
    anchor = a;
    projection = P;
    bounds.setEmpty();
  }
  void keep(const Vec3& normal, const Vec3& through, double slack) {
    half_spaces.push_back({normal, normal.dot(through) + slack});
  }

  std::vector<HalfSpace> half_spaces;
  Box bounds;  ///< holds all of it
  /// The distance from p to the feature's plane, line or point is |projection * (p - anchor)|.
  Vec3 anchor;
  Eigen::Matrix3d projection;
};

/// A triangle as a feature. Its vertices are put in order of their coordinates, so that neither
/// their order in the mesh nor the winding shows in the last bit of a distance.
struct Face {
  std::array<std::uint32_t, 3> vertices;
  Vec3 normal = Vec3::Zero();  ///< zero: too thin for a region
  double slop = 0;             ///< how much its side planes can be off within reach [voxels]
};

struct Edge {
  std::uint32_t a, b;  ///< vertices, in order of their coordinates
  std::uint32_t first_face, face_count;
};

/// Faces, edges and vertices, and which of them meet.
class Features {
 public:
  Features(const TriangleMesh& mesh, const Workspace& workspace, double reach);

  std::size_t size() const noexcept {
    return faces_.size() + edges_.size() + used_vertices_.size();
  }
  Box bounds() const {
    Box box;
    for (const std::uint32_t v : used_vertices_) box.extend(points_[v]);
    return box;
  }

  /// Builds the region of a feature. False where no centre can be nearest to it.
  bool region_of(std::size_t feature, Region& region) const {
    if (feature < faces_.size()) return face_region(faces_[feature], region);
    feature -= faces_.size();
    if (feature < edges_.size()) return edge_region(edges_[feature], region);
    return vertex_region(used_vertices_[feature - edges_.size()], region);
  }

 private:
  bool face_region(const Face& face, Region& region) const;
  bool edge_region(const Edge& edge, Region& region) const;
  bool vertex_region(std::uint32_t vertex, Region& region) const;
  bool bound_cone(Region& region) const;
  Face make_face(std::array<std::uint32_t, 3> triangle) const;
  void join_edges();
  void join_vertices();

  bool comes_before(std::uint32_t a, std::uint32_t b) const noexcept {
    const Vec3 &p = points_[a], &q = points_[b];
    return std::tie(p.x(), p.y(), p.z(), a) < std::tie(q.x(), q.y(), q.z(), b);
  }
  /// Direction in the face's plane, square to its edge a-b and into the face.
  Vec3 into_face(const Face& face, std::uint32_t a, std::uint32_t b) const {
    std::uint32_t apex = face.vertices[0];
    for (const std::uint32_t v : face.vertices) {
      if (v != a && v != b) apex = v;
    }
    const Vec3 into = face.normal.cross(points_[b] - points_[a]).normalized();
    return into.dot(points_[apex] - points_[a]) < 0 ? Vec3(-into) : into;
  }

  double reach_;
  std::vector<Vec3> points_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  std::vector<std::uint32_t> edge_faces_;     ///< of edge e: from first_face, face_count of them
  std::vector<std::uint32_t> used_vertices_;  ///< those of a triangle
  std::vector<std::uint32_t> first_edge_;     ///< vertex -> where its edges start in vertex_edges_
  std::vector<std::uint32_t> vertex_edges_;
};

Features::Features(const TriangleMesh& mesh, const Workspace& workspace, double reach)
    : reach_(reach) {
  points_.reserve(mesh.vertices.size());
  for (const Vec3& p_W : mesh.vertices) {
    points_.push_back(workspace.to_grid(p_W) - Vec3::Constant(0.5));
  }
  faces_.reserve(mesh.triangles.size());
  for (const auto& triangle : mesh.triangles) faces_.push_back(make_face(triangle));
  join_edges();
  join_vertices();
}

Face Features::make_face(std::array<std::uint32_t, 3> triangle) const {
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

void Features::join_edges() {
  // Sides of triangles, gathered by their first vertex, then put in order of the second.
  struct Side {
    std::uint32_t b, face;
  };
  std::vector<std::uint32_t> start(points_.size() + 1, 0);
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
  std::vector<Side> sides(3 * faces_.size());
  std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
  for_each_side([&](std::uint32_t a, std::uint32_t b, std::uint32_t f) {
    sides[fill[a]++] = {b, f};
  });
  for (std::uint32_t a = 0; a < points_.size(); ++a) {
    const std::span<Side> of_a(sides.data() + start[a], start[a + 1] - start[a]);
    std::sort(of_a.begin(), of_a.end(), [](const Side& s, const Side& t) {
      return std::tie(s.b, s.face) < std::tie(t.b, t.face);
    });
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

void Features::join_vertices() {
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
  std::vector<std::uint32_t> fill(first_edge_.begin(), first_edge_.end() - 1);
  for (std::uint32_t e = 0; e < edges_.size(); ++e) {
    vertex_edges_[fill[edges_[e].a]++] = e;
    vertex_edges_[fill[edges_[e].b]++] = e;
  }
}

bool Features::face_region(const Face& face, Region& region) const {
  const Vec3& n = face.normal;
  if (n.isZero(0)) return false;
  const Vec3& a = points_[face.vertices[0]];
  region.reset(a, n * n.transpose());
  region.keep(n, a, reach_);
  region.keep(-n, a, reach_);
  for (int side = 0; side < 3; ++side) {
    const std::uint32_t from = face.vertices[static_cast<std::size_t>(side == 2 ? 1 : 0)];
    const std::uint32_t to = face.vertices[static_cast<std::size_t>(side == 0 ? 1 : 2)];
    region.keep(-into_face(face, from, to), points_[from], widening + face.slop);
  }
  for (const std::uint32_t v : face.vertices) region.bounds.extend(points_[v]);
  const Vec3 margin = reach_ * n.cwiseAbs() + Vec3::Constant(widening + face.slop);
  region.bounds.min() -= margin;
  region.bounds.max() += margin;
  return true;
}

bool Features::edge_region(const Edge& edge, Region& region) const {
  const Vec3 &a = points_[edge.a], &b = points_[edge.b];
  const double length = (b - a).norm();
  if (length == 0) return false;
  const Vec3 along = (b - a) / length;
  region.reset(a, Eigen::Matrix3d::Identity() - along * along.transpose());
  const std::span<const std::uint32_t> faces(edge_faces_.data() + edge.first_face, edge.face_count);
  std::array<Vec3, 2> into;
  double slop = 0;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const Face& face = faces_[faces[f]];
    const Vec3 t = into_face(face, edge.a, edge.b);
    region.keep(t, a, widening + face.slop);
    slop = std::max(slop, face.slop);
    if (f < 2) into[f] = t;
  }
  region.keep(-along, a, widening);
  region.keep(along, b, widening);
  region.bounds.extend(a);
  region.bounds.extend(b);

  Vec3 margin = reach_ * (Vec3::Ones() - along.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  if (faces.size() == 2) {
    const Vec3 bend = into[0] + into[1];
    // Two faces in one plane: what is behind both sides within reach lies in the widened prisms.
    if (reach_ * bend.norm() <= 2 * widening) return false;
    const double cosine = into[0].dot(into[1]);
    const double opening = std::sqrt(std::max(0.0, (1 - cosine) / 2));  // cosine of half the wedge
    // Narrower than 120 degrees, and so wide that its middle is known: cut the wedge off there and
    // bound it by the triangle that is left.
    if (opening > 0.5 && bend.norm() > 1e-6 + 1e3 * slop) {
      const Vec3 middle = -bend.normalized();
      region.keep(middle, a, reach_);
      const double sine = std::sqrt(1 - cosine * cosine);
      for (const auto& [t, other] : {std::pair(into[0], into[1]), std::pair(into[1], into[0])}) {
        const Vec3 ray = (cosine * t - other) / sine * (reach_ / opening);
        region.bounds.extend(a + ray);
        region.bounds.extend(b + ray);
      }
      margin = Vec3::Constant(4 * slop / bend.norm());
    }
  }
  margin += Vec3::Constant(widening);
  region.bounds.min() -= margin;
  region.bounds.max() += margin;
  return true;
}

bool Features::vertex_region(std::uint32_t vertex, Region& region) const {
  const Vec3& v = points_[vertex];
  region.reset(v, Eigen::Matrix3d::Identity());
  for (std::uint32_t e = first_edge_[vertex]; e < first_edge_[vertex + 1]; ++e) {
    const Edge& edge = edges_[vertex_edges_[e]];
    const Vec3 along = points_[edge.a == vertex ? edge.b : edge.a] - v;
    const double length = along.norm();
    if (length > 0) region.keep(along / length, v, widening);
  }
  return bound_cone(region);
}

// A cone of half-spaces through the anchor, cut at the farthest distance that matters. Most
// vertices of a smooth mesh have a thin one or none, so that close bounds save most of the work on
// them. A pointed cone is held by its extreme rays, each of which lies on two of the planes.
bool Features::bound_cone(Region& region) const {
  const Vec3 v = region.anchor;
  const std::size_t count = region.half_spaces.size();
  const auto plane = [&](std::size_t i) -> const Vec3& { return region.half_spaces[i].normal; };
  // Rays are good to 1e-10 where planes meet at more than 1e-6; a ray must not be lost to rounding.
  constexpr double least_angle = 1e-6, rounding = 1e-9;
  constexpr std::size_t most_planes = 16;  // beyond, n³ steps cost more than they save
  region.bounds = Box(v - Vec3::Constant(reach_), v + Vec3::Constant(reach_));
  if (count > most_planes) return true;
  const auto holds = [&](const Vec3& ray) {
    for (std::size_t i = 0; i < count; ++i) {
      if (plane(i).dot(ray) > rounding) return false;
    }
    return true;
  };
  std::array<Vec3, 2 * most_planes * most_planes> rays;
  std::size_t ray_count = 0;
  bool planes_meet = false;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      Vec3 ray = plane(i).cross(plane(j));
      const double sine = ray.norm();
      if (sine == 0) continue;
      if (sine < least_angle) return true;
      ray /= sine;
      planes_meet = true;
      const bool holds_ray = holds(ray), holds_opposite = holds(-ray);
      if (holds_ray && holds_opposite) {  // all edges in one plane
        for (std::size_t k = 0; k < count; ++k) {
          const Vec3 in_plane = ray.cross(plane(k));
          if (holds(in_plane) || holds(-in_plane)) return true;
        }
        // ... and all around the vertex, so that only the normal is left.
        const Vec3 margin = reach_ * ray.cwiseAbs() + Vec3::Constant(widening);
        region.bounds = Box(v - margin, v + margin);
        return true;
      }
      if (holds_ray) rays[ray_count++] = ray;
      if (holds_opposite) rays[ray_count++] = -ray;
    }
  }
  if (!planes_meet) return true;
  if (ray_count == 0) return false;
  Vec3 axis = Vec3::Zero();
  for (std::size_t r = 0; r < ray_count; ++r) axis += rays[r];
  axis.normalize();
  Box bounds(v);
  for (std::size_t r = 0; r < ray_count; ++r) {
    const double cosine = rays[r].dot(axis);
    if (!(cosine > 0.5)) return true;
    bounds.extend(v + reach_ / cosine * rays[r]);
  }
  region.keep(axis, v, reach_);
  region.bounds =
      Box(bounds.min() - Vec3::Constant(widening), bounds.max() + Vec3::Constant(widening));
  return true;
}

/// Cuts a slice of constant z out of regions, to learn which rows it holds.
class Slice {
 public:
  /// Lowest and highest y of a region at z within a rectangle; low > high where there is none.
  std::pair<double, double> extent(std::span<const HalfSpace> half_spaces, double z, double x_low,
                                   double x_high, double y_low, double y_high) {
    polygon_.assign({{x_low, y_low}, {x_high, y_low}, {x_high, y_high}, {x_low, y_high}});
    for (const HalfSpace& h : half_spaces) {
      const double offset = h.offset - h.normal.z() * z;
      double least = std::numeric_limits<double>::infinity(), most = -least;
      for (Point& p : polygon_) {
        p.excess = h.normal.x() * p.x + h.normal.y() * p.y - offset;
        least = std::min(least, p.excess);
        most = std::max(most, p.excess);
      }
      if (least > 0) return {1, 0};
      if (most <= 0) continue;
      clipped_.clear();
      const Point* previous = &polygon_.back();
      for (const Point& p : polygon_) {
        if ((p.excess > 0) != (previous->excess > 0)) {
          const double t = previous->excess / (previous->excess - p.excess);
          clipped_.push_back(
              {previous->x + t * (p.x - previous->x), previous->y + t * (p.y - previous->y)});
        }
        if (p.excess <= 0) clipped_.push_back(p);
        previous = &p;
      }
      polygon_.swap(clipped_);
    }
    double low = polygon_[0].y, high = polygon_[0].y;
    for (const Point& p : polygon_) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
    return {low - widening, high + widening};
  }

 private:
  struct Point {
    double x, y;
    double excess = 0;  ///< over the half-space at hand
  };
  std::vector<Point> polygon_, clipped_;
};

/// 64 x 64 x 16 voxels: their squared distances stay in the second-level cache, and two whole slabs
/// belong to one layer of tiles, so that layers of tiles can be worked on at the same time.
constexpr std::int32_t tile_shift_i = 6, tile_shift_j = 6, tile_shift_k = 4;
constexpr std::int32_t tile_i = 1 << tile_shift_i, tile_j = 1 << tile_shift_j,
                       tile_k = 1 << tile_shift_k;

/// False where one half-space of a region alone leaves out the tile whose first voxel is `lo`.
bool touches_tile(const Region& region, const VoxelIndex& lo) {
  const Vec3 half_size(0.5 * (tile_i - 1), 0.5 * (tile_j - 1), 0.5 * (tile_k - 1));
  const Vec3 centre = Vec3(lo.i, lo.j, lo.k) + half_size;
  return std::all_of(region.half_spaces.begin(), region.half_spaces.end(), [&](const HalfSpace& h) {
    return h.normal.dot(centre) - h.normal.cwiseAbs().dot(half_size) <= h.offset + widening;
  });
}

class Tile {
 public:
  Tile() : squared_(static_cast<std::size_t>(tile_i * tile_j * tile_k)) {}

  /// Starts the tile whose first voxel is `lo`. Returns false where none of its voxels is wanted.
  bool start(const VoxelIndex& lo, const VoxelBox& box, const VoxelSet& inner) {
    lo_ = lo;
    std::fill(squared_.begin(), squared_.end(), std::numeric_limits<double>::infinity());
    std::uint64_t in_box = 0;
    for (std::int32_t i = 0; i < tile_i; ++i) {
      in_box |= std::uint64_t{lo.i + i >= box.lo.i && lo.i + i < box.hi.i} << i;
    }
    std::uint64_t any = 0;
    for (std::int32_t k = 0; k < tile_k; ++k) {
      for (std::int32_t j = 0; j < tile_j; ++j) {
        const std::int32_t row_j = lo.j + j, row_k = lo.k + k;
        const bool row_in_box =
            row_j >= box.lo.j && row_j < box.hi.j && row_k >= box.lo.k && row_k < box.hi.k;
        std::uint64_t& row = wanted_[row_of(j, k)];
        row = row_in_box ? in_box & ~inner.word(lo.i >> 6, row_j, row_k) : 0;
        any |= row;
      }
    }
    return any != 0;
  }

  /// Lowers the distances of the centres in a region to those of its feature.
  void lower(const Region& region) {
    // The least and the highest centre of the tile in the region's bounds.
    const auto clip = [](double low, double high, std::int32_t start, std::int32_t size) {
      return std::pair(std::max(std::ceil(low), static_cast<double>(start)),
                       std::min(std::floor(high), static_cast<double>(start + size - 1)));
    };
    const auto [x_low, x_high] =
        clip(region.bounds.min().x(), region.bounds.max().x(), lo_.i, tile_i);
    const auto [y_low, y_high] =
        clip(region.bounds.min().y(), region.bounds.max().y(), lo_.j, tile_j);
    const auto [z_low, z_high] =
        clip(region.bounds.min().z(), region.bounds.max().z(), lo_.k, tile_k);
    if (x_low > x_high || y_low > y_high) return;
    for (double z = z_low; z <= z_high; ++z) {
      const auto [low, high] = slice_.extent(region.half_spaces, z, x_low - 0.5, x_high + 0.5,
                                             y_low - 0.5, y_high + 0.5);
      const double row_low = std::max(std::ceil(low), y_low);
      const double row_high = std::min(std::floor(high), y_high);
      if (row_low > row_high) continue;
      start_slice(region, z);
      for (double y = row_low; y <= row_high; ++y) {
        lower_row(x_low - lo_.i, x_high - lo_.i, y, static_cast<std::int32_t>(z));
      }
    }
  }

  /// Squared distances of 64 voxels, infinite where nothing is in reach.
  std::span<const double, 64> row(std::int32_t j, std::int32_t k) const noexcept {
    return std::span<const double, 64>(&squared_[row_of(j, k) * 64], 64);
  }
  std::uint64_t wanted(std::int32_t j, std::int32_t k) const noexcept {
    return wanted_[row_of(j, k)];
  }

 private:
  static std::size_t row_of(std::int32_t j, std::int32_t k) noexcept {
    return static_cast<std::size_t>((k & (tile_k - 1)) * tile_j + (j & (tile_j - 1)));
  }

  /// Where rows of a slice meet a plane: x = at_zero + per_y * y, in voxels from the tile's first.
  struct RowBound {
    double at_zero, per_y;
  };

  /// Prepares what the rows of one slice share.
  void start_slice(const Region& region, double z) {
    from_.clear();
    to_.clear();
    parallel_.clear();
    for (const HalfSpace& h : region.half_spaces) {
      const double rest = h.offset - h.normal.z() * z;
      // Parallel to the rows, up to a thousandth of the widening over a tile.
      constexpr double parallel = 1e-11;
      if (std::abs(h.normal.x()) <= parallel) {
        parallel_.push_back({rest + widening, -h.normal.y()});
      } else {
        (h.normal.x() > 0 ? to_ : from_)
            .push_back({rest / h.normal.x() - lo_.i, -h.normal.y() / h.normal.x()});
      }
    }
    away_at_zero_ = region.projection * (Vec3(lo_.i, 0, z) - region.anchor);
    away_per_y_ = region.projection.col(1);
    away_per_x_ = region.projection.col(0);
    square_ = away_per_x_.dot(away_per_x_);
  }

  /// Lowers the run of row (y,z) between all planes; x from the tile's first voxel.
  void lower_row(double x_low, double x_high, double y, std::int32_t z) {
    for (const RowBound& bound : parallel_) {
      if (bound.at_zero + bound.per_y * y < 0) return;
    }
    for (const RowBound& bound : from_) x_low = std::max(x_low, bound.at_zero + bound.per_y * y);
    for (const RowBound& bound : to_) x_high = std::min(x_high, bound.at_zero + bound.per_y * y);
    if (!(x_low <= x_high)) return;
    std::int32_t first = static_cast<std::int32_t>(x_low);  // 0 <= x_low: rounds down
    if (first < x_low) ++first;
    const std::int32_t last = static_cast<std::int32_t>(x_high);
    if (first > last) return;
    const std::size_t row = row_of(static_cast<std::int32_t>(y) - lo_.j, z - lo_.k);
    const std::uint64_t run = (~std::uint64_t{0} >> (63 - (last - first))) << first;
    const std::uint64_t wanted = wanted_[row] & run;
    if (wanted == 0) return;
    // Along the row the squared distance is a parabola.
    const Vec3 away = away_at_zero_ + y * away_per_y_;
    const double constant = away.dot(away), linear = 2 * away.dot(away_per_x_);
    const int end = 64 - std::countl_zero(wanted);
    double* const squared = &squared_[row * 64];
    for (int i = std::countr_zero(wanted); i < end; ++i) {
      const double value = constant + i * (linear + i * square_);
      squared[i] = value < squared[i] ? value : squared[i];
    }
  }

  VoxelIndex lo_;
  std::vector<double> squared_;
  std::array<std::uint64_t, static_cast<std::size_t>(tile_j* tile_k)> wanted_{};
  Slice slice_;
  std::vector<RowBound> from_, to_, parallel_;   ///< of the slice at hand
  Vec3 away_at_zero_, away_per_y_, away_per_x_;  ///< projection * (p - anchor) along its rows
  double square_ = 0;
};

/// The box, grown to hold the voxels of all points in `bounds`.
VoxelBox hull(const VoxelBox& box, const Box& bounds) {
  if (bounds.isEmpty()) return box;
  const auto voxel = [](double centre) {
    return static_cast<std::int32_t>(std::floor(centre + 0.5));
  };
  const Vec3 &lo = bounds.min(), &hi = bounds.max();
  return {{std::min(box.lo.i, voxel(lo.x())), std::min(box.lo.j, voxel(lo.y())),
           std::min(box.lo.k, voxel(lo.z()))},
          {std::max(box.hi.i, voxel(hi.x()) + 1), std::max(box.hi.j, voxel(hi.y()) + 1),
           std::max(box.hi.k, voxel(hi.z()) + 1)}};
}

/// Reads ranks and stored distances off the tile's squared distances.
void read_off(const Tile& tile, const BlockIndex& block, const VoxelSet& boundary, int m, int q,
              DistanceLayers& layers) {
  const double farthest = q * m + half_diagonal_vox;
  const BitBlock* const boundary_block = boundary.blocks().find(block);
  DistanceBlock* distances = nullptr;
  std::array<BitBlock*, 32> ranks{};
  std::array<double, 64> distance;
  std::array<std::uint64_t, 33> of_rank;  // [n - 1] -> voxels of rank n in the row; [q]: beyond
  for (std::int32_t k = 0; k < 8; ++k) {
    for (std::int32_t j = 0; j < 8; ++j) {
      const std::uint64_t wanted = tile.wanted(block.j * 8 + j, block.k * 8 + k);
      if (wanted == 0) continue;
      const std::size_t row = BitBlock::row(j, k);
      const std::uint64_t skin = boundary_block == nullptr ? 0 : boundary_block->words[row];
      const auto squared = tile.row(block.j * 8 + j, block.k * 8 + k);
      for (std::size_t i = 0; i < 64; ++i) {
        distance[i] = std::sqrt(std::clamp(squared[i], 0.0, farthest * farthest));
      }
      of_rank.fill(0);
      for (std::size_t i = 0; i < 64; ++i) {
        const double s = std::max(0.0, distance[i] - half_diagonal_vox);
        const int n = squared[i] < farthest * farthest ? std::min(static_cast<int>(s / m), q) : q;
        of_rank[static_cast<std::size_t>(n)] |= std::uint64_t{1} << i;
      }
      std::uint64_t kept = wanted & skin;
      for (std::size_t n = 0; n < static_cast<std::size_t>(q); ++n) {
        const std::uint64_t voxels = of_rank[n] & wanted & ~skin;
        if (voxels == 0) continue;
        if (ranks[n] == nullptr) ranks[n] = &layers.neighbours.ranks[n].blocks().make(block);
        ranks[n]->words[row] = voxels;
        kept |= voxels;
      }
      if (kept == 0) continue;
      if (distances == nullptr) distances = &layers.distances.make(block);
      for (std::size_t i = 0; i < 64; ++i) {
        const auto steps = static_cast<int>(distance[i] / distance_step_vox + forgiven_steps);
        distances->steps[row * 64 + i] =
            static_cast<std::uint16_t>(((kept >> i) & 1) != 0 ? steps : 0);
      }
    }
  }
}

}  // namespace

DistanceLayers distance_layers(const TriangleMesh& mesh, const VoxelSet& boundary,
                               const VoxelSet& inner, const Workspace& workspace, int m, int q) {
  if (m < 1 || m > 8) {
    throw Error({.where = "m",
                 .what = "not a number of voxels per rank",
                 .found = std::to_string(m),
                 .expected = "1 to 8"});
  }
  if (q < 0 || q > 32) {
    throw Error({.where = "q",
                 .what = "not a number of ranks",
                 .found = std::to_string(q),
                 .expected = "0 to 32"});
  }
  const double reach = q * m + half_diagonal_vox + distance_step_vox;
  const Features features(mesh, workspace, reach);

  // `probe` can leave parts of the surface a voxel outside of the boundary's box, and a centre
  // q*m + half_diagonal_vox away can lie a voxel beyond q*m voxels.
  VoxelBox box = boundary.box();
  if (!box.empty() && q > 0) box = hull(box, features.bounds()).grown(q * m + 1);
  DistanceLayers layers{{std::vector<VoxelSet>(static_cast<std::size_t>(q), VoxelSet(box))},
                        BlockGrid<DistanceBlock>(box)};
  if (box.empty()) return layers;

  // Tiles that each feature's region touches.
  struct TileRange {
    VoxelIndex lo, hi;  // both inside, in tiles; lo.k > hi.k where there is no region
  };
  std::vector<TileRange> ranges(features.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, features.size(), 256),
      [&](const tbb::blocked_range<std::size_t>& some) {
        Region region;
        for (std::size_t f = some.begin(); f < some.end(); ++f) {
          ranges[f] = {{0, 0, 1}, {0, 0, 0}};
          if (!features.region_of(f, region)) continue;
          const Vec3 lo = region.bounds.min().cwiseMax(Vec3(box.lo.i, box.lo.j, box.lo.k));
          const Vec3 hi =
              region.bounds.max().cwiseMin(Vec3(box.hi.i - 1, box.hi.j - 1, box.hi.k - 1));
          if ((lo.array() > hi.array()).any()) continue;
          const auto tile = [](const Vec3& p) {
            return VoxelIndex{static_cast<std::int32_t>(std::floor(p.x())) >> tile_shift_i,
                              static_cast<std::int32_t>(std::floor(p.y())) >> tile_shift_j,
                              static_cast<std::int32_t>(std::floor(p.z())) >> tile_shift_k};
          };
          ranges[f] = {tile(lo), tile(hi)};
        }
      });
  const std::int32_t first_layer = box.lo.k >> tile_shift_k;
  const std::int32_t last_layer = (box.hi.k - 1) >> tile_shift_k;
  std::vector<std::vector<std::uint32_t>> features_of_layer(
      static_cast<std::size_t>(last_layer - first_layer + 1));
  for (std::uint32_t f = 0; f < features.size(); ++f) {
    for (std::int32_t k = ranges[f].lo.k; k <= ranges[f].hi.k; ++k) {
      features_of_layer[static_cast<std::size_t>(k - first_layer)].push_back(f);
    }
  }

  tbb::parallel_for(first_layer, last_layer + 1, [&](std::int32_t layer) {
    struct Visit {
      std::int32_t j, i;  // tile
      std::uint32_t feature;
    };
    std::vector<Visit> visits;
    for (const std::uint32_t f : features_of_layer[static_cast<std::size_t>(layer - first_layer)]) {
      for (std::int32_t j = ranges[f].lo.j; j <= ranges[f].hi.j; ++j) {
        for (std::int32_t i = ranges[f].lo.i; i <= ranges[f].hi.i; ++i) visits.push_back({j, i, f});
      }
    }
    std::sort(visits.begin(), visits.end(), [](const Visit& a, const Visit& b) {
      return std::tie(a.j, a.i, a.feature) < std::tie(b.j, b.i, b.feature);
    });
    Tile tile;
    Region region;
    for (auto visit = visits.begin(); visit != visits.end();) {
      const auto [j, i, _] = *visit;
      const auto end =
          std::find_if(visit, visits.end(), [&](const Visit& v) { return v.j != j || v.i != i; });
      const VoxelIndex lo{i * tile_i, j * tile_j, layer * tile_k};
      // A tile is only set up once a region is known to touch it: a large slanting triangle has a
      // tile range of which it touches little.
      bool started = false, any_wanted = true;
      for (; visit != end && any_wanted; ++visit) {
        if (!features.region_of(visit->feature, region) || !touches_tile(region, lo)) continue;
        if (!started) any_wanted = tile.start(lo, box, inner);
        started = true;
        if (any_wanted) tile.lower(region);
      }
      for (std::int32_t k = 0; started && any_wanted && k < tile_k; k += 8) {
        for (std::int32_t row = 0; row < tile_j; row += 8) {
          read_off(tile, block_of({lo.i, lo.j + row, lo.k + k}), boundary, m, q, layers);
        }
      }
      visit = end;
    }
  });
  return layers;
}

}  // namespace vicinity
