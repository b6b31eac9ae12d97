// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "served.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

#include "cli/small_arm.h"
#include "replay/real_time.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/scene_file.h"

namespace vicinity::viewer_test {

const char* const scene_text = R"(voxel_size: 0.01
defaults: {m: 2, q: 3, coding: [30, 20, 10]}
objects:
  - name: block
    primitive: {box: {size: [0.2, 0.1, 0.1]}}
  - name: ball
    primitive: {sphere: {radius: 0.05}}
    pose: {xyz: [0.22, 0, 0]}
)";

ScratchFolder::ScratchFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "vicinity_viewer_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

ScratchFolder::~ScratchFolder() { std::filesystem::remove_all(path_); }

std::filesystem::path ScratchFolder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

Served::Served(const viewer::WebOptions& options) {
  const auto scene_file = folder_.write("small.yaml", scene_text);
  const auto scene = std::make_shared<const Scene>(read_scene(scene_file));
  field_ = build_field(*scene, {.threads = 1, .progress = {}}).field;
  robot_ = parse_urdf(cli_test::small_arm, folder_.path() / "arm.urdf").robot;
  viewer::Workplace workplace;
  workplace.name = "small.yaml";
  workplace.field = workplace.original = field_;
  workplace.scene = scene;
  workplace.document = viewer::read_document(scene_file, folder_.path());
  viewer::ViewerArm arm;
  arm.robot = robot_;
  BodyPointOptions points;
  points.total = 900;
  arm.points = sample_body_points(robot_, points);
  arm.X_WB = cli_test::small_arm_X_WB();
  arm.link_meshes.resize(robot_.links.size());
  arm.q = AxisVector::Zero(3);
  arm.q[0] = 0.9;
  viewer_ = std::make_unique<viewer::Viewer>(std::move(arm), std::move(workplace),
                                             folder_.path() / "files",
                                             std::vector<std::filesystem::path>{});
  server_ = std::make_unique<viewer::WebServer>(options, *viewer_);
  viewer_->answer_by(*server_);
  serving_ = std::thread([this] { server_->run(); });
}

Served::~Served() {
  server_->stop();
  serving_.join();
  viewer_->stop();
}

nlohmann::json json_of(const PageClient::Message& message) {
  return nlohmann::json::parse(message.text());
}

std::uint64_t resident_bytes() { return cli::process_use().resident_bytes; }

}  // namespace vicinity::viewer_test
