// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "surroundings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>
#include <vector>

#include "announcer.h"

namespace vicinity::bridge {
namespace {

struct Ball {
  Vec3 centre;
  double radius;
};

constexpr double metres_per_newton = 0.1;

}  // namespace

Surroundings::Surroundings(const RobotModel& robot, const BodyPoints& points, int tool_link,
                           std::string world)
    : robot_(robot),
      points_(points),
      tool_link_(tool_link < 0 ? robot.links.size() - 1 : static_cast<std::size_t>(tool_link)),
      world_(std::move(world)),
      kinematics_(robot),
      at_rest_(AxisVector::Zero(static_cast<Eigen::Index>(robot.coordinates.size()))) {}

ros2::PointCloud2 Surroundings::layers(const Answer& answer) {
  ros2::PointCloud2 cloud;
  cloud.header = {answer.sample.stamp, world_};
  for (const char* name : {"x", "y", "z", "rank"}) {
    cloud.columns.push_back(
        {.name = name, .offset = static_cast<std::uint32_t>(4 * cloud.columns.size())});
  }
  cloud.point_step = 16;
  if (!field_ || answer.sample.heard != Heard::state || !answer.sample.q.allFinite()) return cloud;

  kinematics_.update(answer.sample.q.data(), at_rest_.data(), answer.sample.X_WB);
  std::vector<Ball> balls;
  Eigen::AlignedBox3d around;
  for (const BodyPoints::LinkRange& range : points_.links) {
    for (std::uint32_t n = range.first_cluster; n < range.last_cluster; ++n) {
      const BoundingSphere& sphere = points_.clusters[n].sphere;
      const Ball& ball = balls.emplace_back(
          kinematics_.X_WL(static_cast<std::size_t>(range.link)) * sphere.centre.cast<double>(),
          sphere.radius + near_m);
      around.extend(Vec3(ball.centre.array() - ball.radius));
      around.extend(Vec3(ball.centre.array() + ball.radius));
    }
  }
  // Its voxels, as far as there are any.
  const Workspace& space = field_->workspace();
  const Vec3 dims(space.dims.i, space.dims.j, space.dims.k);
  const Eigen::Vector3i first =
      space.to_grid(around.min()).cwiseMax(0.0).cwiseMin(dims).array().floor().cast<int>();
  const Eigen::Vector3i last =
      space.to_grid(around.max()).cwiseMax(0.0).cwiseMin(dims).array().ceil().cast<int>();
  std::vector<std::array<float, 4>> found;
  for (int k = first[2]; k < last[2]; ++k) {
    for (int j = first[1]; j < last[1]; ++j) {
      for (int i = first[0]; i < last[0]; ++i) {
        const VoxelRecord& record = field_->records()[field_->code_at({i, j, k})];
        if (record.kind != VoxelKind::neighbour) continue;
        const Vec3 p = space.origin + space.voxel_size * Vec3(i + 0.5, j + 0.5, k + 0.5);
        const bool is_near = std::ranges::any_of(balls, [&](const Ball& ball) {
          return (p - ball.centre).squaredNorm() <= ball.radius * ball.radius;
        });
        if (!is_near) continue;
        const Eigen::Vector3f place = p.cast<float>();
        found.push_back({place.x(), place.y(), place.z(), static_cast<float>(record.rank)});
      }
    }
  }
  const std::size_t every = found.size() / most_points + 1;
  cloud.width = static_cast<std::uint32_t>((found.size() + every - 1) / every);
  cloud.row_step = cloud.width * cloud.point_step;
  cloud.data.resize(cloud.row_step);
  for (std::size_t n = 0; n < cloud.width; ++n) {
    std::memcpy(&cloud.data[16 * n], found[n * every].data(), 16);
  }
  return cloud;
}

ros2::MarkerArray Surroundings::markers(const Answer& answer) {
  ros2::MarkerArray array;
  ros2::Marker& force = array.markers.emplace_back();
  force.header = {answer.sample.stamp, world_};
  force.ns = "vicinity";
  force.lifetime = {.sec = 1, .nanosec = 0};  // whoever stops hearing us stops seeing it
  force.scale = {0.01, 0.02, 0.02};
  force.color = {1.0F, 0.45F, 0.1F, 1.0F};
  ros2::Marker why = force;
  why.id = 1;
  why.kind = ros2::Marker::text_view_facing;
  why.scale = {0, 0, 0.04};
  why.color = {1, 1, 1, 1};
  why.text = status_of(answer);
  const bool known = field_ && answer.sample.heard == Heard::state && answer.sample.q.allFinite();
  if (!known) {
    force.action = ros2::Marker::remove;
    array.markers.push_back(std::move(why));
    return array;
  }
  kinematics_.update(answer.sample.q.data(), at_rest_.data(), answer.sample.X_WB);
  const Vec3 from = kinematics_.p_WL(tool_link_);
  const Vec3 to = from + metres_per_newton * answer.output.tool.force;
  force.points = {{from.x(), from.y(), from.z()}, {to.x(), to.y(), to.z()}};
  why.pose.position = {from.x(), from.y(), from.z() + 0.1};
  const Reason& reason = answer.output.reason;
  if (reason.link >= 0 && reason.object >= 0) {
    why.text = fmt::format("{} near {}: rank {}, {:.0f} mm, {:.3g} N",
                           robot_.links[static_cast<std::size_t>(reason.link)].name,
                           field_->objects()[static_cast<std::size_t>(reason.object)].name,
                           reason.rank, 1000 * reason.distance_m, answer.output.tool.force.norm());
  }
  array.markers.push_back(std::move(why));
  return array;
}

}  // namespace vicinity::bridge
