#include <cstdio>
#include <memory>

#include <vicinity/mesh/primitive.h>
#include <vicinity/mujoco/drag.h>
#include <vicinity/viscosity/build_field.h>

using namespace vicinity;

// Lets the arm fall from the side, until its tool passes over the middle of the table.
void swing(const mjModel* model, const ViscosityField* field) {
  mjData* data = mj_makeData(model);
  data->qpos[0] = 1.5;
  std::unique_ptr<AttachedDrag> drag;
  if (field != nullptr) {
    MuJoCoDragOptions options;
    options.points.weight = {{"upper", 20}, {"fore", 20}};  // as if it had 20 times its surface
    drag = std::make_unique<AttachedDrag>(model, data, *field, options);
  }
  do {
    mj_step(model, data);  // feels the field
  } while (data->site_xpos[0] < 0 && data->time < 10);
  mjtNum velocity[6];
  mj_objectVelocity(model, data, mjOBJ_SITE, 0, velocity, 0);
  std::printf("%s: over the table after %.2f s, at %.2f m/s\n", drag ? "with drag" : "freely",
              data->time, mju_norm3(velocity + 3));
  if (drag && drag->output().reason.object >= 0) {
    const Reason& reason = drag->output().reason;
    std::printf("which takes %.1f W there, most of it from %s near %s\n", drag->output().power,
                mj_id2name(model, mjOBJ_BODY, reason.link),
                field->objects()[reason.object].name.c_str());
  }
  drag.reset();  // before its data
  mj_deleteData(data);
}

int main(int argc, char** argv) {
  char why[1000] = "usage: swing arm.xml";
  mjModel* model = argc == 2 ? mj_loadXML(argv[1], nullptr, why, sizeof why) : nullptr;
  if (model == nullptr) return std::puts(why), 2;
  Scene scene;  // a table that the tool passes 40 mm above
  scene.objects.push_back({.name = "table", .shape = primitive::box({0.6, 0.4, 0.3})});
  scene.objects.back().X_WO.translation().z() = 0.235;
  const ViscosityField field = build_field(scene).field;
  swing(model, nullptr);
  swing(model, &field);
  mj_deleteModel(model);
}
