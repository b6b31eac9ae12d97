#include <cstdio>

#include <vicinity/mesh/primitive.h>
#include <vicinity/mujoco/drag.h>
#include <vicinity/viscosity/build_field.h>

using namespace vicinity;

// Lets the arm go from the side, until its tool passes over the middle of the table.
void swing(const mjModel* model, mjData* data, const char* how) {
  mj_resetData(model, data);
  data->qpos[0] = 1.5;
  while (data->site_xpos[0] <= 0 && data->time < 10) mj_step(model, data);
  mjtNum velocity[6];
  mj_objectVelocity(model, data, mjOBJ_SITE, 0, velocity, 0);
  std::printf("%s: over the table after %.2f s, at %.2f m/s\n", how, data->time,
              mju_norm3(velocity + 3));
}

int main(int argc, char** argv) {
  char why[1000] = "usage: swing arm.xml";
  mjModel* model = argc == 2 ? mj_loadXML(argv[1], nullptr, why, sizeof why) : nullptr;
  if (model == nullptr) return std::puts(why), 2;
  mjData* data = mj_makeData(model);

  Scene scene;  // a table that the tool passes 40 mm above
  scene.objects.push_back({.name = "table", .shape = primitive::box({0.6, 0.4, 0.3})});
  scene.objects.back().X_WO.translation().z() = 0.235;
  const ViscosityField field = build_field(scene).field;

  swing(model, data, "freely");
  MuJoCoDragOptions options;
  options.points.weight = {{"upper", 20}, {"fore", 20}};  // as if it had 20 times its surface
  {
    const AttachedDrag drag(model, data, field, options);  // from here on, mj_step() feels it
    swing(model, data, "with drag");
    const Reason& reason = drag.output().reason;
    if (reason.object < 0) return 1;
    std::printf("which takes %.1f W there, most of it from %s near %s\n", drag.output().power,
                mj_id2name(model, mjOBJ_BODY, reason.link),
                field.objects()[reason.object].name.c_str());
  }
  mj_deleteData(data);
  mj_deleteModel(model);
}
