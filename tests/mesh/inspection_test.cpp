// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>

#include "mesh_data.h"
#include "vicinity/geometry/vec3.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

using ::testing::HasSubstr;

/// Both meshes as one, vertices not joined.
TriangleMesh together(TriangleMesh a, const TriangleMesh& b) {
  const auto offset = static_cast<std::uint32_t>(a.vertices.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (auto t : b.triangles) {
    for (auto& corner : t) corner += offset;
    a.triangles.push_back(t);
  }
  return a;
}

TriangleMesh moved(const TriangleMesh& mesh, const Vec3& by) {
  return place(mesh, 1, pose_from_rpy(by, Vec3::Zero()));
}

const MeshProblem* problem(const MeshInspection& found, const char* what) {
  const auto at = std::find_if(found.problems.begin(), found.problems.end(),
                               [&](const MeshProblem& p) { return p.what == what; });
  return at == found.problems.end() ? nullptr : &*at;
}

TEST(Inspection, AClosedMeshIsOk) {
  const MeshInspection found = inspect(primitive::torus(0.5, 0.2));
  EXPECT_EQ(found.verdict, MeshInspection::Verdict::ok);
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.shells, 1u);
  EXPECT_TRUE(found.problems.empty());
  EXPECT_STREQ(to_string(found.verdict), "ok");
}

TEST(Inspection, PartsThatShareNoVertexAreShells) {
  const TriangleMesh ball = primitive::sphere(0.1, 12);
  const MeshInspection found =
      inspect(together(together(ball, moved(ball, Vec3(1, 0, 0))), moved(ball, Vec3(2, 0, 0))));
  EXPECT_EQ(found.shells, 3u);
  EXPECT_EQ(found.verdict, MeshInspection::Verdict::ok);
}

TEST(Inspection, EachMissingTriangleIsAHoleOfThreeEdges) {
  TriangleMesh ball = primitive::sphere(0.5, 24);
  std::swap(ball.triangles[100], ball.triangles.back());
  ball.triangles.pop_back();
  std::swap(ball.triangles[200], ball.triangles.back());
  ball.triangles.pop_back();
  const MeshInspection found = inspect(ball);
  EXPECT_FALSE(found.closed);
  EXPECT_EQ(found.open_edges, 6u);
  EXPECT_EQ(found.holes, 2u);
  EXPECT_EQ(found.crack_edges, 0u);
  EXPECT_EQ(found.verdict, MeshInspection::Verdict::usable);
  ASSERT_NE(problem(found, "open edges"), nullptr);
  EXPECT_THAT(problem(found, "open edges")->means, HasSubstr("2 holes"));
}

TEST(Inspection, ACrackIsToldFromAHole) {
  // The upper half of a box, lifted by a little and by a lot from its lower half.
  const auto split = [](double gap) {
    TriangleMesh lower = primitive::box(Vec3(1, 1, 1)), upper = lower;
    const auto faces = [&](TriangleMesh& mesh, double at) {
      std::erase_if(mesh.triangles, [&](const auto& t) {
        return mesh.vertices[t[0]].z() == at && mesh.vertices[t[1]].z() == at &&
               mesh.vertices[t[2]].z() == at;
      });
    };
    faces(lower, 0.5);
    faces(upper, -0.5);
    return together(lower, moved(upper, Vec3(0, 0, 1 + gap)));
  };
  const MeshInspection hairline = inspect(split(1e-5));
  EXPECT_EQ(hairline.open_edges, 8u);
  EXPECT_EQ(hairline.crack_edges, 8u);
  EXPECT_FALSE(hairline.closed);
  ASSERT_NE(problem(hairline, "crack edges"), nullptr);
  EXPECT_THAT(problem(hairline, "crack edges")->means, HasSubstr("builds as if it were whole"));
  EXPECT_EQ(problem(hairline, "open edges"), nullptr);

  const MeshInspection gap = inspect(split(1e-4));
  EXPECT_EQ(gap.open_edges, 8u);
  EXPECT_EQ(gap.crack_edges, 0u);
  EXPECT_EQ(gap.holes, 2u);
}

TEST(Inspection, ATurnedTriangleDisagreesWithItsThreeNeighbours) {
  TriangleMesh box = primitive::box(Vec3::Ones());
  std::swap(box.triangles[5][0], box.triangles[5][1]);
  const MeshInspection found = inspect(box);
  EXPECT_EQ(found.inconsistent_edges, 3u);
  EXPECT_TRUE(found.closed);
  EXPECT_EQ(found.verdict, MeshInspection::Verdict::usable);
}

TEST(Inspection, AFinMakesANonManifoldEdge) {
  TriangleMesh box = primitive::box(Vec3::Ones());
  const auto [a, b, c] = box.triangles[0];
  box.vertices.emplace_back(3, 3, 3);
  box.triangles.push_back({a, b, static_cast<std::uint32_t>(box.vertices.size() - 1)});
  const MeshInspection found = inspect(box);
  EXPECT_EQ(found.non_manifold_edges, 1u);
  EXPECT_EQ(found.open_edges, 2u);
  EXPECT_FALSE(found.closed);
}

TEST(Inspection, CopiesAreDuplicatesAndTheTurnedOnesCancel) {
  const TriangleMesh box = primitive::box(Vec3::Ones());
  TriangleMesh copied = box;
  copied.triangles.push_back({box.triangles[3][1], box.triangles[3][2], box.triangles[3][0]});
  EXPECT_EQ(inspect(copied).duplicate_triangles, 1u);
  EXPECT_THAT(problem(inspect(copied), "duplicate triangles")->means, HasSubstr("as with one"));

  TriangleMesh sheet = box;
  for (const auto& [a, b, c] : box.triangles) sheet.triangles.push_back({a, c, b});
  const MeshInspection found = inspect(sheet);
  EXPECT_EQ(found.duplicate_triangles, 12u);
  EXPECT_TRUE(found.closed);
  EXPECT_THAT(problem(found, "duplicate triangles")->means, HasSubstr("nothing will be inside"));
}

TEST(Inspection, ATriangleWithoutAreaIsDegenerate) {
  TriangleMesh box = primitive::box(Vec3::Ones());
  box.triangles.push_back({0, 0, 1});
  box.vertices.push_back((box.vertices[0] + box.vertices[1]) / 2);
  box.triangles.push_back({0, 1, static_cast<std::uint32_t>(box.vertices.size() - 1)});
  const MeshInspection found = inspect(box);
  EXPECT_EQ(found.degenerate_triangles, 2u);
  EXPECT_EQ(found.verdict, MeshInspection::Verdict::usable);
}

TEST(Inspection, AMeshWithoutAreaIsUnusable) {
  const TriangleMesh line{.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)},
                          .triangles = {{0, 1, 2}, {0, 1, 1}}};
  for (const TriangleMesh& mesh : {line, TriangleMesh{}}) {
    const MeshInspection found = inspect(mesh);
    EXPECT_EQ(found.verdict, MeshInspection::Verdict::unusable);
    EXPECT_FALSE(found.closed);
    ASSERT_FALSE(found.problems.empty());
    EXPECT_THAT(found.problems.back().means, HasSubstr("no surface"));
  }
}

TEST(Inspection, DoesNotDependOnTheOrderOfTrianglesOrVertices) {
  TriangleMesh mesh = together(primitive::sphere(0.5, 16), primitive::box(Vec3::Ones()));
  mesh.triangles.resize(mesh.triangles.size() - 1);
  mesh.triangles.push_back(mesh.triangles[7]);
  std::swap(mesh.triangles[20][0], mesh.triangles[20][1]);
  const MeshInspection plain = inspect(mesh);
  for (unsigned seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    TriangleMesh shuffled = mesh;
    std::vector<std::uint32_t> order(mesh.vertices.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::shuffle(order.begin(), order.end(), random);
    for (std::uint32_t i = 0; i < order.size(); ++i) shuffled.vertices[order[i]] = mesh.vertices[i];
    for (auto& t : shuffled.triangles) {
      for (auto& corner : t) corner = order[corner];
      std::rotate(t.begin(), t.begin() + 1, t.end());
    }
    std::shuffle(shuffled.triangles.begin(), shuffled.triangles.end(), random);
    const MeshInspection found = inspect(shuffled);
    EXPECT_EQ(found.shells, plain.shells);
    EXPECT_EQ(found.open_edges, plain.open_edges);
    EXPECT_EQ(found.holes, plain.holes);
    EXPECT_EQ(found.inconsistent_edges, plain.inconsistent_edges);
    EXPECT_EQ(found.non_manifold_edges, plain.non_manifold_edges);
    EXPECT_EQ(found.duplicate_triangles, plain.duplicate_triangles);
    ASSERT_EQ(found.problems.size(), plain.problems.size());
    for (std::size_t i = 0; i < found.problems.size(); ++i) {
      EXPECT_EQ(found.problems[i].means, plain.problems[i].means);
    }
  }
}

}  // namespace
}  // namespace vicinity
