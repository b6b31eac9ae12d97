// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "random_scene.h"

#include <algorithm>
#include <cmath>

#include "seeds.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity::test {

TriangleMesh random_solid(std::mt19937& random, const Vec3& centre) {
  constexpr double h = random_scene_voxel;
  TriangleMesh mesh;
  switch (whole(random, 0, 3)) {
    case 0:
      mesh =
          primitive::box(h * Vec3(real(random, 1, 20), real(random, 1, 20), real(random, 1, 20)));
      break;
    case 1:
      mesh = primitive::sphere(h * real(random, 2, 9), 12);
      break;
    case 2:
      mesh = primitive::cone(h * real(random, 2, 9), h * real(random, 4, 20), 16);
      break;
    default:
      mesh = primitive::torus(h * real(random, 6, 9), h * real(random, 1, 4), 16);
  }
  const Vec3 angles(real(random, -3, 3), real(random, -3, 3), real(random, -3, 3));
  mesh = place(std::move(mesh), 1, pose_from_rpy(centre, angles));
  for (Vec3& p : mesh.vertices) p = (p * 0x1p20).array().round() * 0x1p-20;
  return mesh;
}

Scene random_scene(std::mt19937& random, int objects, double extent_vox) {
  Scene scene;
  scene.voxel_size = random_scene_voxel;
  for (int o = 0; o < objects; ++o) {
    SceneObject object;
    object.name = std::string(1, static_cast<char>('a' + o));
    const double extent = extent_vox * scene.voxel_size;
    object.shape = random_solid(
        random, Vec3(real(random, 0, extent), real(random, 0, extent), real(random, 0, extent)));
    object.m = whole(random, 1, 3);
    object.q = whole(random, 0, 5);
    object.layers = static_cast<LayerShape>(whole(random, 0, 2));
    object.inner = whole(random, 0, 3) == 0 ? InnerMethod::none : InnerMethod::winding;
    // Few different values, in any order, so that ties and rising codings happen.
    object.coding.mu.clear();
    for (int n = 0; n < object.q; ++n) object.coding.mu.push_back(5.0 * whole(random, 0, 6));
    object.coding.skin = 50.0 * whole(random, 1, 2);
    scene.objects.push_back(object);
  }
  std::shuffle(scene.objects.begin(), scene.objects.end(), random);
  return scene;
}

}  // namespace vicinity::test
