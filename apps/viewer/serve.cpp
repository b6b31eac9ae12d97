// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "serve.h"

#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "arguments.h"
#include "outputs.h"
#include "page_files.h"
#include "probe.h"
#include "progress_bar.h"
#include "screenshot.h"
#include "shot_view.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/scene_file.h"
#include "viewer.h"
#include "web/gate.h"
#include "web/web_server.h"

namespace vicinity::viewer {
namespace {

bool is_scene(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

ViscosityField build(const Scene& scene, std::ostream& err) {
  cli::ProgressBar bar(err);
  BuildOptions options;
  options.progress = [&](std::string_view stage, double done) { bar.show(stage, done); };
  return build_field(scene, options).field;
}

Workplace open_workplace(const ServeOptions& options, std::ostream& err) {
  Workplace workplace;
  workplace.name = options.input.filename().string();
  const std::filesystem::path scene = is_scene(options.input) ? options.input : options.arm.scene;
  if (!scene.empty()) {
    workplace.scene = std::make_shared<const Scene>(read_scene(scene));
    workplace.document = read_document(scene, options.folder);
  }
  workplace.field =
      is_scene(options.input) ? build(*workplace.scene, err) : open_field(options.input);
  workplace.original = workplace.field;
  return workplace;
}

TriangleMesh surface_of(const Link& link) {
  TriangleMesh all;
  for (const LinkGeometry& geometry : link.geometries) {
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    const auto& mesh = geometry.mesh;
    all.vertices.insert(all.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const auto& [a, b, c] : mesh.triangles) {
      all.triangles.push_back({first + a, first + b, first + c});
    }
  }
  return all;
}

std::vector<TriangleMesh> surfaces_of(const RobotModel& robot) {
  std::vector<TriangleMesh> surfaces;
  for (const Link& link : robot.links) surfaces.push_back(surface_of(link));
  return surfaces;
}

// The arm is drawn as it looks; it feels by its collision shapes.
std::vector<TriangleMesh> looks_of(const cli::ArmOptions& options, const RobotModel& robot) {
  const std::filesystem::path urdf =
      options.robot.empty() ? read_scene(options.scene).robot->urdf : options.robot;
  const RobotLoad looks = read_urdf(
      urdf, {.package_folders = options.packages, .geometry = LinkGeometry::Role::visual});
  std::vector<TriangleMesh> surfaces = surfaces_of(robot);
  for (std::size_t n = 0; n < robot.links.size(); ++n) {
    if (const auto link = looks.robot.find_link(robot.links[n].name)) {
      TriangleMesh look = surface_of(looks.robot.links[static_cast<std::size_t>(*link)]);
      if (!look.triangles.empty()) surfaces[n] = std::move(look);
    }
  }
  return surfaces;
}

AxisVector start_of(const ServeOptions& options, const RobotModel& robot, bool probe) {
  const auto n = robot.coordinates.size();
  AxisVector q = AxisVector::Zero(static_cast<Eigen::Index>(n));
  std::vector<double> said;
  if (!options.start.empty()) said = cli::numbers_from("--start", options.start, n);
  for (std::size_t c = 0; c < n; ++c) {
    const auto at = static_cast<Eigen::Index>(c);
    const JointLimits& limits = robot.joints[static_cast<std::size_t>(robot.coordinates[c])].limits;
    const bool limited = std::isfinite(limits.lower) && std::isfinite(limits.upper);
    if (!said.empty()) {
      if (said[c] < limits.lower || said[c] > limits.upper) {
        throw Error({.where = "--start",
                     .what = fmt::format("joint '{}' cannot be there", cli::joint_name(robot, c)),
                     .found = fmt::format("{:.10g}", said[c]),
                     .expected = fmt::format("{:.10g} to {:.10g}", limits.lower, limits.upper)});
      }
      q[at] = said[c];
    } else if (limited && (probe || limits.lower > 0 || limits.upper < 0)) {
      q[at] = 0.5 * (limits.lower + limits.upper);
    }
  }
  return q;
}

// As the words of the command line have it.
FeelWords words_of(const cli::ArmOptions& options) {
  return {.memory = options.memory,
          .direction = options.direction,
          .traversal = options.traversal,
          .device = options.device,
          .mode = options.mode};
}

ViewerArm arm_of(const ServeOptions& options, const Workplace& workplace) {
  cli::ArmOptions said = options.arm;
  if (is_scene(options.input)) said.scene = options.input;
  const bool scene_has_robot = workplace.scene != nullptr && workplace.scene->robot.has_value();
  if (!scene_has_robot) said.scene.clear();
  ViewerArm shown;
  shown.words = words_of(said);
  if (said.robot.empty() && !scene_has_robot) {
    const cli::Arm arm = cli::bodiless_arm(said);
    shown.probe = true;
    shown.robot = probe_robot(workplace.field.workspace());
    shown.points = probe_points(shown.robot);
    shown.link_meshes = surfaces_of(shown.robot);
    shown.rate = arm.rate;
    shown.like = arm.teleoperation;
  } else {
    cli::Arm arm = cli::read_arm(said);
    shown.link_meshes = looks_of(said, arm.robot);
    shown.robot = std::move(arm.robot);
    shown.points = std::move(arm.points);
    shown.X_WB = arm.X_WB;
    shown.rate = arm.rate;
    shown.like = arm.teleoperation;
    shown.remarks = std::move(arm.remarks);
  }
  shown.q = start_of(options, shown.robot, shown.probe);
  return shown;
}

std::atomic<WebServer*> served{nullptr};

extern "C" void stop_serving(int) {
  if (WebServer* const server = served.load()) server->stop();
}

// Ctrl-C ends the serving, and not the program in the midst of it.
class UntilSignal {
 public:
  explicit UntilSignal(WebServer& server) {
    served.store(&server);
    struct sigaction stop {};
    stop.sa_handler = stop_serving;
    sigaction(SIGINT, &stop, &interrupt_before_);
    sigaction(SIGTERM, &stop, &terminate_before_);
  }
  ~UntilSignal() {
    sigaction(SIGINT, &interrupt_before_, nullptr);
    sigaction(SIGTERM, &terminate_before_, nullptr);
    served.store(nullptr);
  }
  UntilSignal(const UntilSignal&) = delete;
  UntilSignal& operator=(const UntilSignal&) = delete;

 private:
  struct sigaction interrupt_before_ {
  }, terminate_before_{};
};

// Stops the server after a while, or not at all.
class UntilTime {
 public:
  UntilTime(WebServer& server, std::optional<double> seconds) {
    if (!seconds) return;
    thread_ = std::jthread([&server, seconds](const std::stop_token& over) {
      std::mutex mutex;
      std::unique_lock lock(mutex);
      std::condition_variable_any changed;
      changed.wait_for(lock, over, std::chrono::duration<double>(*seconds), [] { return false; });
      server.stop();
    });
  }

 private:
  std::jthread thread_;
};

void say_what_listens(const ServeOptions& options, const WebServer& server, const Viewer& viewer,
                      std::ostream& out) {
  const std::string token = options.token.empty() ? "" : "?token=" + options.token;
  out << fmt::format("Open {}{} in a browser; Ctrl-C ends it.\n", server.address(), token);
  out << (is_loopback(options.bind)
              ? std::string("Only this machine reaches it; pages of other sites are refused.\n")
              : fmt::format("Listening on {} port {}: every machine that reaches it may drive the "
                            "arm, if it has the token. There is no encryption: a tunnel has it.\n",
                            options.bind, server.port()));
  const WebOptions limits;
  out << fmt::format(
      "Messages of {} kB and uploads of {} MB at most, {:g} messages a second. Files "
      "of pages go to {}/. The arm's loop is {}.\n",
      limits.message_bytes >> 10, limits.upload_bytes >> 20, limits.messages_per_s,
      options.folder.string(), viewer.loop().granted());
  if (page_files().empty()) {
    out << "This vicinity was built without its page (npm was not there): only the protocol is "
           "served, at /ws.\n";
  }
  out << std::flush;
}

void draw(const ServeOptions& options, WebServer& server, std::ostream& err) {
  std::exception_ptr failed;
  std::thread serving([&] { server.run(); });
  try {
    const std::string view = options.shot_view.empty() ? "" : "&" + options.shot_view;
    const std::string token = options.token.empty() ? "" : "&token=" + options.token;
    take_screenshot(server.address() + "?shot" + view + token, options.shot, err);
  } catch (...) {
    failed = std::current_exception();
  }
  server.stop();
  serving.join();
  if (failed) std::rethrow_exception(failed);
}

void check(const ServeOptions& options) {
  if (options.port < 0 || options.port > 65'535) {
    throw Error({.where = "--port",
                 .what = "not a port",
                 .found = std::to_string(options.port),
                 .expected = "0 to 65535; 0 takes one that is free"});
  }
  if (std::filesystem::exists(options.folder) && !std::filesystem::is_directory(options.folder)) {
    throw Error({.where = "--folder " + options.folder.string(),
                 .what = "is there, and is no folder",
                 .hint = "another --folder"});
  }
  for (const auto& recording : options.recordings) {
    if (std::filesystem::is_regular_file(recording)) continue;
    throw Error({.where = "--recording " + recording.string(),
                 .what = "there is no such file",
                 .hint = "an output of vicinity replay, or a joint log"});
  }
  if (options.shot.empty()) {
    if (options.shot_view.empty()) return;
    throw Error({.where = "--shot-view", .what = "is for a picture", .hint = "--shot PICTURE.png"});
  }
  check_shot_view(options.shot_view);
  std::vector<std::filesystem::path> inputs = cli::files_of(options.arm);
  inputs.push_back(options.input);
  inputs.insert(inputs.end(), options.recordings.begin(), options.recordings.end());
  cli::check_outputs({{"--shot", options.shot}}, inputs);
  if (options.shot.extension() != ".png") {
    throw Error({.where = "--shot " + options.shot.string(),
                 .what = "pictures of the page are PNG files",
                 .hint = "a name that ends in .png"});
  }
  if (page_files().empty()) {
    throw Error({.where = "--shot",
                 .what = "this vicinity was built without its page",
                 .hint = "building it where npm is"});
  }
  if (!find_browser()) {
    throw Error({.where = "--shot",
                 .what = "needs a browser to draw the page",
                 .found = "no chromium on PATH",
                 .hint = "apt-get install chromium"});
  }
}

}  // namespace

int serve(const ServeOptions& options, std::ostream& out, std::ostream& err) {
  check(options);
  Workplace workplace = open_workplace(options, err);
  ViewerArm arm = arm_of(options, workplace);
  Viewer viewer(std::move(arm), std::move(workplace), options.folder, options.recordings);
  WebOptions web;
  web.address = options.bind;
  web.port = static_cast<std::uint16_t>(options.shot.empty() ? options.port : 0);
  web.token = options.token;
  WebServer server(web, viewer);
  viewer.answer_by(server);
  // Its answers go to the server: they end before that goes.
  const struct Stopped {
    Viewer& viewer;
    ~Stopped() { viewer.stop(); }
  } stopped{viewer};
  if (!options.shot.empty()) {
    draw(options, server, err);
  } else {
    const UntilSignal until_signal(server);
    const UntilTime until_time(server, options.seconds);
    say_what_listens(options, server, viewer, out);
    server.run();
  }
  return 0;
}

}  // namespace vicinity::viewer
