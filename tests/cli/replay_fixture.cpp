// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay_fixture.h"

#include <algorithm>
#include <sstream>

#include "vicinity/robot/body_points.h"
#include "vicinity/robot/urdf_file.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli_test {
namespace {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',') {
      cells.emplace_back();
    } else {
      cells.back() += c;
    }
  }
  return cells;
}

}  // namespace

std::vector<Row> rows_of(const std::filesystem::path& csv) {
  std::istringstream text(text_of(csv));
  std::string line;
  std::getline(text, line);
  const std::vector<std::string> header = cells_of(line);
  std::vector<Row> rows;
  while (std::getline(text, line)) {
    const std::vector<std::string> cells = cells_of(line);
    EXPECT_EQ(cells.size(), header.size()) << line;
    Row row;
    for (std::size_t n = 0; n < std::min(cells.size(), header.size()); ++n)
      row[header[n]] = cells[n];
    rows.push_back(row);
  }
  return rows;
}

Vec3 torque_of(const Row& row) {
  return {std::stod(row.at("tau_turn")), std::stod(row.at("tau_bend")),
          std::stod(row.at("tau_slide"))};
}

Folder* Replay::folder_ = nullptr;

void Replay::SetUpTestSuite() {
  folder_ = new Folder;
  folder_->write("scene.yaml", small_scene);
  folder_->write("arm.urdf", small_arm);
  folder_->write("log.csv", log_of(parabola, every(1000, length_s)));
  ASSERT_EQ(folder_->run({"build", "scene.yaml", "-o", "f.vicinity"}).code, 0);
}
void Replay::TearDownTestSuite() {
  delete folder_;
  folder_ = nullptr;
}

std::vector<std::string> Replay::arguments(const std::string& log,
                                           const std::vector<std::string>& more) {
  std::vector<std::string> all = {
      "replay",       "f.vicinity", "--robot",  "arm.urdf", std::string("--base=") + small_arm_base,
      "--trajectory", log,          "--points", "900"};
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

Answer Replay::replay(const std::string& log, const std::vector<std::string>& more) {
  return folder_->run(arguments(log, more));
}

std::vector<Output> Replay::direct(const Motion& motion, int ticks,
                                   const TeleoperationOptions& options, const Motion& velocity) {
  const RobotModel robot = read_urdf(*folder_ / "arm.urdf").robot;
  BodyPointOptions points;
  points.total = 900;
  const ViscosityField field = open_field(*folder_ / "f.vicinity");
  Teleoperation teleoperation(robot, sample_body_points(robot, points), field, options);
  std::vector<Output> outputs(static_cast<std::size_t>(ticks));
  for (int k = 0; k < ticks; ++k) {
    const Vec3 q = motion(k / 1000.0);
    const Vec3 qd = velocity ? velocity(k / 1000.0) : Vec3::Zero();
    const Input input{.time_s = k / 1000.0,
                      .q = q.data(),
                      .qd = velocity ? qd.data() : nullptr,
                      .joint_count = 3,
                      .X_WB = small_arm_X_WB()};
    (void)teleoperation.tick(input, outputs[static_cast<std::size_t>(k)]);
  }
  return outputs;
}

void Replay::expect_equal(const std::vector<Row>& rows, const std::vector<Output>& outputs,
                          double slack) {
  ASSERT_EQ(rows.size(), outputs.size());
  double most = 0;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const Vec3 torque = outputs[k].torque;
    ASSERT_LE((torque_of(rows[k]) - torque).norm(), slack)
        << "tick " << k << ": " << torque_of(rows[k]).transpose() << " is not "
        << torque.transpose();
    most = std::max(most, torque.norm());
  }
  EXPECT_GT(most, 1e-3) << "nothing was felt";
}

}  // namespace vicinity::cli_test
