// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The arm for Python: a robot, its body points, and the tick.

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "casters.h"
#include "docstrings.h"
#include "parts.h"
#include "vicinity/robot/body_points.h"
#include "vicinity/robot/robot_model.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/teleop/device.h"
#include "vicinity/teleop/limiter.h"
#include "vicinity/teleop/tick.h"

namespace py = pybind11;
using namespace py::literals;

namespace vicinity::python {
namespace {

using Unlocked = py::call_guard<py::gil_scoped_release>;

void add_robot(py::module_& module) {
  py::enum_<JointType>(module, "JointType", doc::JointType)
      .value(VICINITY_PLAIN_VALUE(JointType, fixed))
      .value(VICINITY_VALUE(JointType, revolute))
      .value(VICINITY_VALUE(JointType, continuous))
      .value(VICINITY_VALUE(JointType, prismatic));
  py::class_<JointLimits>(module, "JointLimits", doc::JointLimits)
      .def_readonly(VICINITY_MEMBER(JointLimits, lower))
      .def_readonly(VICINITY_MEMBER(JointLimits, upper))
      .def_readonly(VICINITY_MEMBER(JointLimits, velocity))
      .def_readonly(VICINITY_MEMBER(JointLimits, effort));
  py::class_<Joint>(module, "Joint", doc::Joint)
      .def_readonly(VICINITY_PLAIN_MEMBER(Joint, name))
      .def_readonly(VICINITY_PLAIN_MEMBER(Joint, type))
      .def_readonly(VICINITY_PLAIN_MEMBER(Joint, limits));
  py::class_<RobotModel>(module, "RobotModel", doc::RobotModel)
      .def_readonly(VICINITY_PLAIN_MEMBER(RobotModel, name))
      .def_property_readonly(
          "links",
          [](const RobotModel& robot) {
            std::vector<std::string> names;
            for (const Link& link : robot.links) names.push_back(link.name);
            return names;
          },
          "Names of the links, the base first.")
      .def_readonly(VICINITY_PLAIN_MEMBER(RobotModel, joints))
      .def_readonly(VICINITY_MEMBER(RobotModel, coordinates))
      .def("find_link", &RobotModel::find_link, "name"_a)
      .def("find_joint", &RobotModel::find_joint, "name"_a);
  py::class_<RobotLoad>(module, "RobotLoad", doc::RobotLoad)
      .def_readonly(VICINITY_PLAIN_MEMBER(RobotLoad, robot))
      .def_readonly(VICINITY_PLAIN_MEMBER(RobotLoad, remarks));
  module.def(
      "read_urdf",
      [](const std::filesystem::path& path, std::vector<std::filesystem::path> package_folders) {
        return read_urdf(path, {.package_folders = std::move(package_folders)});
      },
      "path"_a, "package_folders"_a = UrdfOptions().package_folders, Unlocked(), doc::read_urdf);
}

void add_points(py::module_& module) {
  py::class_<NamedPoint>(module, "NamedPoint", doc::NamedPoint)
      .def(py::init([](const Vec3& p_LR, double area) {
             return NamedPoint{p_LR, area};
           }),
           "p_LR"_a, "area"_a)
      .def_readonly(VICINITY_MEMBER(NamedPoint, p_LR))
      .def_readonly(VICINITY_MEMBER(NamedPoint, area));
  py::class_<BodyPoints> points(module, "BodyPoints", doc::BodyPoints);
  using LinkRange = BodyPoints::LinkRange;
  py::class_<LinkRange>(points, "LinkRange", doc::BodyPoints_LinkRange)
      .def_readonly("link", &LinkRange::link, doc::BodyPoints_LinkRange_link)
      .def_readonly("begin", &LinkRange::begin)
      .def_readonly("end", &LinkRange::end)
      .def_readonly("area", &LinkRange::area, doc::BodyPoints_LinkRange_area);
  const auto lane = [](BodyPoints::Lane BodyPoints::*member) {
    return [member](const py::object& self) {
      const BodyPoints::Lane& numbers = self.cast<const BodyPoints&>().*member;
      return view<float>({static_cast<py::ssize_t>(numbers.size())}, numbers.data(), self);
    };
  };
  points.def_property_readonly("x", lane(&BodyPoints::x), doc::BodyPoints_z)
      .def_property_readonly("y", lane(&BodyPoints::y), doc::BodyPoints_z)
      .def_property_readonly("z", lane(&BodyPoints::z), doc::BodyPoints_z)
      .def_property_readonly("area", lane(&BodyPoints::area), doc::BodyPoints_area)
      .def_readonly(VICINITY_MEMBER(BodyPoints, links))
      .def("count", &BodyPoints::count, doc::BodyPoints_count);

  const BodyPointOptions usual;
  const std::string says =
      std::string(doc::sample_body_points) +
      "\n\npoints_per_m2: " + doc::BodyPointOptions_points_per_m2 +
      "\ntotal: " + doc::BodyPointOptions_total + "\nseed: " + doc::BodyPointOptions_seed +
      "\nexclude: " + doc::BodyPointOptions_exclude + "\nweight: " + doc::BodyPointOptions_weight +
      "\nnamed: " + doc::BodyPointOptions_named;
  module.def(
      "sample_body_points",
      [](const RobotModel& robot, double points_per_m2, std::optional<std::size_t> total,
         std::uint64_t seed, std::vector<std::string> exclude, std::map<std::string, double> weight,
         std::map<std::string, NamedPoint> named) {
        return sample_body_points(robot, {points_per_m2, total, seed, std::move(exclude),
                                          std::move(weight), std::move(named)});
      },
      "robot"_a, py::kw_only(), "points_per_m2"_a = usual.points_per_m2, "total"_a = usual.total,
      "seed"_a = usual.seed, "exclude"_a = usual.exclude, "weight"_a = usual.weight,
      "named"_a = usual.named, Unlocked(), says.c_str());
}

void add_limiter(py::module_& module) {
  py::enum_<LimiterMode>(module, "LimiterMode", doc::LimiterMode)
      .value(VICINITY_VALUE(LimiterMode, strict))
      .value(VICINITY_VALUE(LimiterMode, device));
  py::enum_<DragLimit>(module, "DragLimit", doc::DragLimit)
      .value(VICINITY_PLAIN_VALUE(DragLimit, none))
      .value(VICINITY_VALUE(DragLimit, damping))
      .value(VICINITY_VALUE(DragLimit, mass))
      .value(VICINITY_VALUE(DragLimit, quantisation))
      .value(VICINITY_VALUE(DragLimit, force))
      .value(VICINITY_VALUE(DragLimit, torque));
  py::enum_<LimiterStatus>(module, "LimiterStatus", doc::LimiterStatus)
      .value(VICINITY_VALUE(LimiterStatus, limited))
      .value(VICINITY_VALUE(LimiterStatus, deadline_missed))
      .value(VICINITY_VALUE(LimiterStatus, input_stale))
      .value(VICINITY_VALUE(LimiterStatus, drag_not_passive))
      .value(VICINITY_VALUE(LimiterStatus, not_finite))
      .value(VICINITY_VALUE(LimiterStatus, wrong_size));
  py::class_<Device>(module, "Device", doc::Device)
      .def_readonly(VICINITY_PLAIN_MEMBER(Device, name))
      .def_readonly(VICINITY_MEMBER(Device, axis_count));
  py::class_<LimiterOptions>(module, "LimiterOptions", doc::LimiterOptions)
      .def_readonly(VICINITY_PLAIN_MEMBER(LimiterOptions, mode))
      .def_readwrite(VICINITY_MEMBER(LimiterOptions, period_s))
      .def_readwrite(VICINITY_MEMBER(LimiterOptions, delay))
      .def_readwrite(VICINITY_MEMBER(LimiterOptions, longest_hold))
      .def_readwrite(VICINITY_MEMBER(LimiterOptions, ramp_s));
  module.def("find_device", &find_device, "name_or_file"_a, doc::find_device);
  module.def("limiter_options", &limiter_options, "device"_a, "mode"_a, doc::limiter_options);
}

void add_output(py::module_& module) {
  py::enum_<Status>(module, "Status", py::arithmetic(), doc::Status)
      .value(VICINITY_PLAIN_VALUE(Status, ok))
      .value(VICINITY_VALUE(Status, started))
      .value(VICINITY_VALUE(Status, beyond_joint_limits))
      .value(VICINITY_VALUE(Status, outside_field))
      .value(VICINITY_VALUE(Status, deadline_missed))
      .value(VICINITY_VALUE(Status, time_stood_still))
      .value(VICINITY_PLAIN_VALUE(Status, time_ran_backwards))
      .value(VICINITY_VALUE(Status, not_finite))
      .value(VICINITY_VALUE(Status, wrong_size))
      .value(VICINITY_VALUE(Status, jumped))
      .value(VICINITY_VALUE(Status, not_passive));
  py::class_<Wrench>(module, "Wrench", doc::Wrench)
      .def_readonly(VICINITY_MEMBER(Wrench, force))
      .def_readonly(VICINITY_MEMBER(Wrench, moment));
  py::class_<Reason>(module, "Reason", doc::Reason)
      .def_readonly(VICINITY_MEMBER(Reason, point))
      .def_readonly(VICINITY_MEMBER(Reason, link))
      .def_readonly(VICINITY_MEMBER(Reason, object))
      .def_readonly(VICINITY_PLAIN_MEMBER(Reason, kind))
      .def_readonly(VICINITY_PLAIN_MEMBER(Reason, rank))
      .def_readonly(VICINITY_MEMBER(Reason, share))
      .def_readonly(VICINITY_MEMBER(Reason, distance_m))
      .def_readonly(VICINITY_MEMBER(Reason, time_to_contact_s));
  py::class_<LimiterOutput>(module, "LimiterOutput")
      .def_readonly(VICINITY_PLAIN_MEMBER(LimiterOutput, status))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, scale))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, ramp))
      .def_readonly(VICINITY_PLAIN_MEMBER(LimiterOutput, limit))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, asked))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, given))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, power_asked))
      .def_readonly(VICINITY_MEMBER(LimiterOutput, power_given));
  py::class_<EnergyBalance>(module, "EnergyBalance", doc::EnergyBalance)
      .def_readonly(VICINITY_MEMBER(EnergyBalance, drag))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, device))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, lowest))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, lowest_drag))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, passive))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, records))
      .def_readonly(VICINITY_MEMBER(EnergyBalance, unaccounted));
  py::class_<Counts>(module, "Counts")
      .def_readonly(VICINITY_PLAIN_MEMBER(Counts, ticks))
      .def_readonly(VICINITY_PLAIN_MEMBER(Counts, refused))
      .def_readonly(VICINITY_PLAIN_MEMBER(Counts, missed_deadlines))
      .def_readonly(VICINITY_PLAIN_MEMBER(Counts, fields_taken))
      .def_readonly(VICINITY_MEMBER(Counts, points_felt))
      .def_readonly(VICINITY_MEMBER(Counts, points_looked));
  py::class_<PointDrag>(module, "PointDrag", doc::PointDrag)
      .def_readonly(VICINITY_MEMBER(PointDrag, mu_e))
      .def_readonly(VICINITY_MEMBER(PointDrag, force_W));
  py::class_<Output>(module, "Output",
                     "What a tick leaves. Its arrays are read-only views of its memory: the next "
                     "tick with the\nsame Output writes over them.")
      .def(py::init())
      .def_readonly(VICINITY_PLAIN_MEMBER(Output, status))
      .def_readonly(VICINITY_MEMBER(Output, torque))
      .def_readonly(VICINITY_MEMBER(Output, tool))
      .def_readonly(VICINITY_MEMBER(Output, device_force))
      .def_readonly(VICINITY_MEMBER(Output, master_force))
      .def_readonly(VICINITY_MEMBER(Output, power))
      .def_readonly(VICINITY_PLAIN_MEMBER(Output, reason))
      .def_readonly(VICINITY_MEMBER(Output, limiter))
      .def_readonly(VICINITY_PLAIN_MEMBER(Output, energy))
      .def_readonly(VICINITY_PLAIN_MEMBER(Output, counts));
}

// An arm whose field any Python thread may swap, one at a time.
struct Arm {
  Teleoperation teleoperation;
  std::mutex swapping;

  Arm(const RobotModel& robot, const BodyPoints& points, const ViscosityField& field,
      const TeleoperationOptions& options)
      : teleoperation(robot, points, field, options) {}
};

// Keeps the interpreter lock: to give it up would let another Python thread hold the tick back by
// milliseconds, and two could tick one arm at once.
py::object tick(Arm& arm, double time_s, const Numbers& q, const std::optional<Numbers>& qd,
                const std::optional<Pose>& X_WB, double tau2, py::object out) {
  if (out.is_none()) out = py::cast(Output());
  if (!py::isinstance<Output>(out)) throw py::type_error("out: not an Output");
  Input input{.time_s = time_s, .q = q.data(), .tau2 = tau2};
  // Another shape is another size: refused by status, as every input of a tick is.
  const bool fits = q.ndim() == 1 && (!qd || (qd->ndim() == 1 && qd->size() == q.size()));
  input.joint_count = fits ? static_cast<int>(q.size()) : -1;
  if (qd) input.qd = qd->data();
  if (X_WB) input.X_WB = *X_WB;
  (void)arm.teleoperation.tick(input, out.cast<Output&>());
  return out;
}

void add_teleoperation(py::module_& module) {
  py::class_<MasterArm>(module, "MasterArm", doc::MasterArm)
      .def(py::init())
      .def_readwrite(VICINITY_MEMBER(MasterArm, mass))
      .def_readwrite(VICINITY_MEMBER(MasterArm, damping))
      .def_readwrite(VICINITY_MEMBER(MasterArm, gain))
      .def_readwrite(VICINITY_MEMBER(MasterArm, attenuation))
      .def_readwrite(VICINITY_MEMBER(MasterArm, lever))
      .def_readwrite(VICINITY_MEMBER(MasterArm, torque_constant));

  const TeleoperationOptions usual;
  const std::string options_say =
      std::string(doc::Teleoperation_Teleoperation) +
      "\n\nmemory: none, sustained, fading, short or rising; None is none."
      "\nlimiter: " +
      doc::TeleoperationOptions_limiter +
      "\nvelocity_window_s: " + doc::TeleoperationOptions_velocity_window_s +
      "\nnoise_band: " + doc::TeleoperationOptions_noise_band +
      "\ntool_link: " + doc::TeleoperationOptions_tool_link +
      "\nlongest_period_s: " + doc::TeleoperationOptions_longest_period_s +
      "\nlongest_jump_m: " + doc::TeleoperationOptions_longest_jump_m;
  const std::string tick_says =
      std::string(doc::Teleoperation_tick) + "\n\nq: " + doc::Input_q + "\nqd: " + doc::Input_qd +
      "\nX_WB: " + doc::Input_X_WB + "\ntau2: " + doc::Input_tau2 +
      "\nout: an Output to write into and return; without it a new one is made.\n"
      "Arrays of float64 are read where they lie. The tick itself allocates nothing but a new "
      "Output.\n"
      "The interpreter lock is kept: another thread that took it would hold the loop up.";
  py::class_<Arm>(module, "Teleoperation", doc::Teleoperation)
      .def(py::init([](const RobotModel& robot, const BodyPoints& points,
                       const ViscosityField& field, const std::optional<std::string>& memory,
                       DragDirection direction, Traversal traversal,
                       const std::optional<LimiterOptions>& limiter, double velocity_window_s,
                       double noise_band, const MasterArm& master, int tool_link,
                       double longest_period_s, double longest_jump_m) {
             TeleoperationOptions options;
             if (memory) options.memory = named_memory(*memory);
             options.direction = direction;
             options.traversal = traversal;
             options.limiter = limiter;
             options.velocity_window_s = velocity_window_s;
             options.noise_band = noise_band;
             options.master = master;
             options.tool_link = tool_link;
             options.longest_period_s = longest_period_s;
             options.longest_jump_m = longest_jump_m;
             return std::make_unique<Arm>(robot, points, field, options);
           }),
           "robot"_a, "points"_a, "field"_a, py::kw_only(), "memory"_a = py::none(),
           "direction"_a = usual.direction, "traversal"_a = usual.traversal,
           "limiter"_a = usual.limiter, "velocity_window_s"_a = usual.velocity_window_s,
           "noise_band"_a = usual.noise_band, py::arg_v("master", usual.master, "MasterArm()"),
           "tool_link"_a = usual.tool_link, "longest_period_s"_a = usual.longest_period_s,
           "longest_jump_m"_a = usual.longest_jump_m, options_say.c_str())
      .def_property_readonly("joint_count",
                             [](const Arm& arm) { return arm.teleoperation.joint_count(); })
      .def("tick", &tick, "time_s"_a, "q"_a, "qd"_a = py::none(), "X_WB"_a = py::none(),
           "tau2"_a = Input().tau2, "out"_a = py::none(), tick_says.c_str())
      .def(
          "point_drag",
          [](const Arm& arm, std::uint32_t point) {
            if (point >= arm.teleoperation.points().x.size())
              throw py::index_error("no such point");
            return arm.teleoperation.point_drag(point);
          },
          "point"_a, doc::Teleoperation_point_drag)
      .def(
          "restart", [](Arm& arm) { arm.teleoperation.restart(); }, doc::Teleoperation_restart)
      .def(
          "swap_field",
          [](Arm& arm, const ViscosityField& field) {
            const std::lock_guard one_at_a_time(arm.swapping);
            arm.teleoperation.swap_field(field);
          },
          "field"_a, Unlocked(), doc::Teleoperation_swap_field);
}

}  // namespace

void add_arm(py::module_& module) {
  add_robot(module);
  add_points(module);
  add_limiter(module);
  add_output(module);
  add_teleoperation(module);
}

}  // namespace vicinity::python
