// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// Faces, edges and vertices of a mesh, which of them meet, and the distance to each.
///
/// The point of a surface nearest to p lies inside a face, inside an edge, or at a vertex, and p
/// then lies in that feature's own region:
///
///            edge        face: the prism over the triangle, on both sides
///         \   |   /      edge: between its end planes, and not in front of any face that meets in
///     face \  |  / face        it (the wedge between the prisms)
///     ______\ | /______  vertex: not in front of any edge that meets in it (a cone)
///             v
///
/// (after Mauch's closest point transform, without a sign and for any soup of triangles). So the
/// distance at p is the least of the features' own distances, to plane, segment or point, over
/// those regions that hold p. Every region is convex and is cut to the farthest distance that
/// matters.
///
/// A region may only ever be too large, never too small: then no centre falls between two regions.
/// A segment, a point or a triangle is a part of the surface, so that its distance is right
/// wherever it is taken. A plane's, in single precision, is taken a little outside of its triangle
/// as well, and counts as so much less sure; beyond sharp corners, where sides that are widened
/// meet far off, two more planes cut the region.
///
/// Grid coordinates here have voxel centres at integers, and the voxel's length is 1.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "nearest_region.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "vicinity/voxel/huge_pages.h"
#include "vicinity/voxel/workspace.h"

namespace vicinity {

class SurfaceFeatures {
 public:
  /// @param reach  the farthest distance that matters [voxels]
  SurfaceFeatures(const TriangleMesh& mesh, const Workspace& workspace, double reach);

  std::size_t size() const noexcept {
    return faces_.size() + edges_.size() + used_vertices_.size();
  }
  /// The surface's own bounds, without what is in reach of it.
  const Box& bounds() const noexcept { return bounds_; }

  /// Builds the region of a feature. False where no centre can be nearest to it.
  bool region_of(std::size_t feature, NearestRegion& region) const;

  /// Squared distance from p to a feature, of a face to the triangle itself.
  double squared_distance(std::size_t feature, const Vec3& p) const;

 private:
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

  struct LongestSide {
    std::uint32_t from, to;
    double length;
  };

  /// And the height of the triangle over it.
  std::pair<LongestSide, double> longest_side(const Face& face) const;
  Face make_face(std::array<std::uint32_t, 3> triangle) const;
  void join_edges();
  void join_vertices();
  bool face_region(const Face& face, NearestRegion& region) const;
  bool edge_region(const Edge& edge, NearestRegion& region) const;
  bool vertex_region(std::uint32_t vertex, NearestRegion& region) const;
  bool comes_before(std::uint32_t a, std::uint32_t b) const noexcept;

  /// Square to the face's side from `a` to `b`, in its plane and out of it; as long as the side.
  Vec3 out_of_face(const Face& face, std::uint32_t a, std::uint32_t b) const {
    const Vec3 out = (points_[b] - points_[a]).cross(face.normal);
    // 0-1 and 1-2 run around the triangle as its normal turns, 0-2 runs against it.
    return a == face.vertices[0] && b == face.vertices[2] ? Vec3(-out) : out;
  }

  double reach_;
  Box bounds_;
  HugeVector<Vec3> points_;
  HugeVector<Face> faces_;
  HugeVector<Edge> edges_;
  HugeVector<std::uint32_t> edge_faces_;     ///< of edge e: from first_face, face_count of them
  HugeVector<std::uint32_t> used_vertices_;  ///< those of a triangle
  HugeVector<std::uint32_t> first_edge_;     ///< vertex -> where its edges start in vertex_edges_
  HugeVector<std::uint32_t> vertex_edges_;
};

}  // namespace vicinity
