#include <cstdio>

#include <vicinity/drag/drag.h>
#include <vicinity/mesh/primitive.h>
#include <vicinity/viscosity/build_field.h>

int main() {
  vicinity::Scene scene;  // 5 mm voxels; an upright vessel, 0.4 m wide and 1.2 m tall
  scene.objects.push_back({.name = "vessel", .shape = vicinity::primitive::cylinder(0.2, 1.2)});
  const vicinity::ViscosityField field = vicinity::build_field(scene).field;
  for (double x = 0.36; x > 0.2; x -= 0.02) {  // towards its side at 0.1 m/s, 4 cm² of tool
    const vicinity::FieldSample here = field.at({x, 0, 0});
    const vicinity::Vec3 F = vicinity::drag_force(here.viscosity, 4e-4, {-0.1, 0, 0});
    std::printf("%3.0f mm away: rank %d, drag %.5f N\n", 1e3 * (x - 0.2), here.record.rank, F.x());
  }
}
