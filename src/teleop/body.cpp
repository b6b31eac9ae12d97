// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "body.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include "vicinity/drag/approach.h"
#include "vicinity/drag/recorded_path.h"
#include "vicinity/layers/shaping_element.h"

namespace vicinity {
namespace {

Eigen::Matrix3d cross_matrix(const Vec3& r) noexcept {
  Eigen::Matrix3d m;
  m << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
  return m;
}

// Single precision rounds each coordinate by less than this much of the sum of its terms.
constexpr double single_rounding = 5.0 / (1 << 24);

constexpr auto cluster_points = static_cast<std::uint32_t>(BodyPoints::cluster_size);

// After so many ticks a cluster's sums are made anew, so that the rounding of their changes does
// not add up.
constexpr std::uint32_t refresh_period = 256;

// How far a point has gone along one axis since its key was made.
std::int32_t way_along(int axis, VoxelKey now, VoxelKey then) noexcept {
  const int shift = key_bits * axis;
  const auto way = static_cast<std::int32_t>((now >> shift) - (then >> shift)) & (key_span - 1);
  return way < key_span / 2 ? way : way - key_span;
}

// Whole lanes: the gap behind a link's last point holds copies of it, without area.
std::size_t whole_lanes(const BodyPoints::Cluster& cluster) noexcept {
  return (cluster.end - cluster.begin + BodyPoints::lane - 1) / BodyPoints::lane * BodyPoints::lane;
}

CoarseMap coarse_map(const Pose& X_WL, const Workspace& workspace, const BoundingSphere& sphere) {
  const Eigen::Matrix3d turn = X_WL.linear() / workspace.voxel_size;
  const Vec3 shift = workspace.to_grid(X_WL.translation());
  const Vec3 centre = sphere.centre.cast<double>();
  const double reach = centre.norm() + static_cast<double>(sphere.radius);
  CoarseMap map;
  for (int axis = 0; axis < 3; ++axis) {
    const double middle = turn.row(axis).dot(centre) + shift[axis];
    const double t = shift[axis] - key_span * std::round(middle / key_span);
    for (int column = 0; column < 3; ++column) {
      map.a[axis][column] = static_cast<float>(turn(axis, column));
    }
    map.t[axis] = static_cast<float>(t);
    const double terms = turn.row(axis).cwiseAbs().sum() * reach + std::abs(t) + 1;
    map.error = std::max(map.error, static_cast<float>(single_rounding * terms));
  }
  return map;
}

}  // namespace

Teleoperation::FieldView::FieldView(const ViscosityField& of) : field(of), clearance(of) {
  const double h = of.workspace().voxel_size;
  std::map<std::tuple<LayerShape, int, int>, std::vector<double>> known;
  for (const FieldObject& object : of.objects()) {
    const auto [at, is_new] = known.try_emplace({object.layers, object.m, object.q});
    if (is_new) {
      at->second = nearest_by_rank_vox(object.layers, object.m, object.q);
      for (double& nearest : at->second) nearest *= h;
    }
    nearest_m.push_back(at->second);
  }
}

Teleoperation::Body::Body(BodyPoints points, std::size_t link_count,
                          const TeleoperationOptions& options)
    : points_(std::move(points)),
      weights_(checked(options.memory)),
      traversal_(options.traversal),
      closing_(options.direction == DragDirection::closing),
      motion_(link_count),
      reach_(link_count, 0),
      link_drag_(link_count, Matrix6::Zero()),
      links_(points_.links.size()),
      clusters_(points_.clusters.size()),
      key_(points_.x.size(), left_voxel),
      drag_(points_.x.size(), 0.f),
      memories_(points_.x.size(), options.memory),
      remembers_(points_.x.size(), 0),
      towards_x_(closing_ ? points_.x.size() : 0, 0.f),
      towards_y_(towards_x_),
      towards_z_(towards_x_) {
  for (const BodyPoints::LinkRange& range : points_.links) {
    double& reach = reach_[static_cast<std::size_t>(range.link)];
    reach = std::max(reach, static_cast<double>(range.sphere.centre.norm() + range.sphere.radius));
  }
}

void Teleoperation::Body::restart() noexcept {
  std::fill(clusters_.begin(), clusters_.end(), ClusterState{});
  std::fill(links_.begin(), links_.end(), LinkState{});
  look_again_ = true;
  moved_ = false;
}

bool Teleoperation::Body::move(const ForwardKinematics& kinematics, double longest_jump_m,
                               double voxel_size) noexcept {
  bool jumped = false;
  const double longest_way = std::min(longest_jump_m, (key_span / 2 - 2) * voxel_size);
  for (std::size_t link = 0; link < motion_.size(); ++link) {
    LinkMotion& motion = motion_[link];
    const Pose X_WL = kinematics.X_WL(link);
    motion.last_X_WL = moved_ ? motion.X_WL : X_WL;
    motion.X_WL = X_WL;
    motion.v_WLo = kinematics.v_WLo(link);
    motion.w_WL = kinematics.w_WL(link);
    motion.v_L = X_WL.linear().transpose() * motion.v_WLo;
    motion.w_L = X_WL.linear().transpose() * motion.w_WL;
    motion.turned = (X_WL.linear() - motion.last_X_WL.linear()).norm();
    const Vec3 way = X_WL.translation() - motion.last_X_WL.translation();
    // The norm of a difference of turns is the square root of 2 times what a point 1 m from the
    // axis goes.
    jumped |= !(way.norm() + std::numbers::sqrt2 / 2 * motion.turned * reach_[link] <= longest_way);
  }
  moved_ = true;
  if (jumped) restart();
  return !jumped;
}

bool Teleoperation::Body::far_away(const BoundingSphere& sphere, const LinkMotion& motion,
                                   const FieldView& view) const noexcept {
  const Workspace& workspace = view.field.workspace();
  const Vec3 centre_L = sphere.centre.cast<double>();
  const Vec3 centre_W = motion.X_WL * centre_L;
  const Vec3 grid = workspace.to_grid(centre_W);
  if (!grid.allFinite()) return true;
  // No point of the ball has moved farther than its centre and its turn together.
  const double radius = sphere.radius;
  const double moved = (centre_W - motion.last_X_WL * centre_L).norm() + motion.turned * radius;
  return view.clearance.clearance_vox(grid) * workspace.voxel_size > radius + moved;
}

void Teleoperation::Body::feel(const FieldView& view) noexcept {
  largest_ = {};
  points_felt_ = points_looked_ = 0;
  ++tick_;
  for (std::size_t l = 0; l < points_.links.size(); ++l) {
    const BodyPoints::LinkRange& range = points_.links[l];
    LinkState& state = links_[l];
    Matrix6& drag = link_drag_[static_cast<std::size_t>(range.link)];
    drag.setZero();
    const LinkMotion& motion = motion_[static_cast<std::size_t>(range.link)];
    if (state.remembering == 0 && far_away(range.sphere, motion, view)) {
      state.asleep = true;
    } else {
      feel_link(range, motion, view, state, drag);
      state.asleep = false;
    }
  }
  look_again_ = false;
  if (!closing_) find_largest();
}

void Teleoperation::Body::feel_link(const BodyPoints::LinkRange& range, const LinkMotion& motion,
                                    const FieldView& view, LinkState& link,
                                    Matrix6& drag) noexcept {
  const CoarseMap map = coarse_map(motion.X_WL, view.field.workspace(), range.sphere);
  DragMoments sums;
  link.remembering = 0;
  for (std::uint32_t c = range.first_cluster; c < range.last_cluster; ++c) {
    const BodyPoints::Cluster& cluster = points_.clusters[c];
    ClusterState& state = clusters_[c];
    if (link.asleep) fall_asleep(state);
    if (state.remembering == 0 && far_away(cluster.sphere, motion, view)) {
      fall_asleep(state);
      continue;
    }
    look(cluster, state, map, motion, view);
    link.remembering += state.remembering;
    points_felt_ += state.feeling;
    if (state.feeling == 0) {
      state.sums = {};
      state.highest = 0;
    } else if (closing_) {
      drag += closing_drag(cluster, motion, range.link);
    } else {
      if ((tick_ + c) % refresh_period == 0) sum_up(cluster, state);
      sums += state.sums;
    }
  }
  if (!closing_ && sums.w > 0) drag = drag_of(sums, motion);
}

// Nothing is looked up any more, so that keys get out of date.
void Teleoperation::Body::fall_asleep(ClusterState& state) noexcept {
  using Past = ClusterState::Past;
  if (state.past == Past::known) state.past = Past::far;
  if (state.past == Past::none) state.past = Past::blank;
}

// Makes memories and keys those of the last tick, whatever has become of them since.
void Teleoperation::Body::wake(const BodyPoints::Cluster& cluster, ClusterState& state,
                               const LinkMotion& motion, const FieldView& view) noexcept {
  const Workspace& workspace = view.field.workspace();
  for (std::uint32_t p = cluster.begin; p < cluster.end; ++p) {
    const VoxelIndex voxel = voxel_of(to_reachable_grid(workspace, motion.last_X_WL * position(p)));
    key_[p] = key_of(voxel.i, voxel.j, voxel.k);
    if (state.past == ClusterState::Past::far) continue;
    memories_[p].start(0);
    remembers_[p] = 0;
    drag_[p] = 0;
    if (closing_) turn_towards(p, Eigen::Vector3f::Zero());
  }
}

void Teleoperation::Body::look(const BodyPoints::Cluster& cluster, ClusterState& state,
                               const CoarseMap& map, const LinkMotion& motion,
                               const FieldView& view) noexcept {
  using Past = ClusterState::Past;
  const bool start = state.past == Past::none;
  if (state.past != Past::known) wake(cluster, state, motion, view);
  state.past = Past::known;
  const std::uint32_t count = cluster.end - cluster.begin;
  points_looked_ += count;

  // Where viscosity is interpolated it changes within a voxel too.
  const bool every_point = start || look_again_ || view.field.keeps_distance();
  std::uint64_t moved = ~std::uint64_t{0} >> (BodyPoints::cluster_size - count);
  if (!every_point) {
    const std::uint32_t b = cluster.begin;
    moved &= find_moved(&points_.x[b], &points_.y[b], &points_.z[b], &key_[b], whole_lanes(cluster),
                        map);
  }
  for (; moved != 0; moved &= moved - 1) {
    const std::uint32_t p = cluster.begin + static_cast<std::uint32_t>(std::countr_zero(moved));
    const Vec3 p_L = position(p), p_W = motion.X_WL * p_L;
    const Vec3 to = to_reachable_grid(view.field.workspace(), p_W);
    const VoxelIndex voxel = voxel_of(to);
    const VoxelKey key = key_of(voxel.i, voxel.j, voxel.k);
    if (!every_point && key == key_[p]) continue;  // it was only near a face
    const VoxelCode code = view.field.code_at(voxel);
    const double mu =
        view.field.keeps_distance() ? view.field.at(p_W).viscosity : view.field.viscosities()[code];
    PointMemories::Memory memory = memories_[p];
    double mu_e = mu;
    if (start) {
      memory.start(mu);
      mu_e = memory.effective(weights_);
      key_[p] = key;
    } else {
      mu_e = advance(p, memory, motion.last_X_WL * p_L, to, voxel, mu, view);
    }
    if (closing_ && mu_e > 0 && view.field.records()[code].kind != VoxelKind::empty) {
      turn_towards(p, towards_surface(view.field, p_W).cast<float>());
    }
    const std::uint8_t remembers = mu_e > 0 || memory.remembers() ? 1 : 0;
    state.remembering += remembers;
    state.remembering -= remembers_[p];
    remembers_[p] = remembers;
    const float before = drag_[p], now = static_cast<float>(mu_e) * points_.area[p];
    if (now == before) continue;
    drag_[p] = now;
    state.feeling += now > 0 ? 1 : 0;
    state.feeling -= before > 0 ? 1 : 0;
    state.highest = std::max(state.highest, now);
    state.sums.add(static_cast<double>(now) - static_cast<double>(before), p_L.x(), p_L.y(),
                   p_L.z());
  }
}

// From the voxel of its key to another one, or on within the same: its mu_e, with what it crossed.
double Teleoperation::Body::advance(std::uint32_t point, PointMemories::Memory& memory,
                                    const Vec3& last_p_W, const Vec3& to, const VoxelIndex& voxel,
                                    double mu, const FieldView& view) noexcept {
  const VoxelKey then = key_[point], now = key_of(voxel.i, voxel.j, voxel.k);
  key_[point] = now;
  const VoxelIndex way{way_along(0, now, then), way_along(1, now, then), way_along(2, now, then)};
  const std::int32_t steps = std::abs(way.i) + std::abs(way.j) + std::abs(way.k);
  if (steps == 0) {
    memory.update(mu);
  } else if (steps == 1 || traversal_ == Traversal::sampled) {
    memory.enter_voxel(mu);
  } else {
    VoxelIndex recorded{voxel.i - way.i, voxel.j - way.j, voxel.k - way.k};
    const Vec3 from = to_reachable_grid(view.field.workspace(), last_p_W);
    const double highest = record_path(view.field, weights_, from, to, mu, recorded, memory);
    // A layer that was crossed on the way counts in this tick alone: look again in the next one.
    if (highest != memory.effective(weights_)) key_[point] |= left_voxel;
    return highest;
  }
  return memory.effective(weights_);
}

void Teleoperation::Body::sum_up(const BodyPoints::Cluster& cluster, ClusterState& state) noexcept {
  const std::uint32_t b = cluster.begin;
  const std::size_t count = cluster.end - b;
  state.sums =
      sum_moments(&points_.x[b], &points_.y[b], &points_.z[b], &drag_[b], whole_lanes(cluster));
  state.highest = *std::max_element(&drag_[b], &drag_[b] + count);
}

// In the link's frame r is constant, and the drag of all points together is
//   force = -(W v + omega x M),  moment about Lo = -(M x v + I omega)
// with W = sum w, M = sum w r and I = sum w (r.r 1 - r r').
Matrix6 Teleoperation::Body::drag_of(const DragMoments& sums,
                                     const LinkMotion& motion) const noexcept {
  const Eigen::Matrix3d& R_WL = motion.X_WL.linear();
  const Eigen::Matrix3d M = R_WL * cross_matrix({sums.wx, sums.wy, sums.wz}) * R_WL.transpose();
  Eigen::Matrix3d I;
  I << sums.wyy + sums.wzz, -sums.wxy, -sums.wxz,  //
      -sums.wxy, sums.wxx + sums.wzz, -sums.wyz,   //
      -sums.wxz, -sums.wyz, sums.wxx + sums.wyy;
  Matrix6 drag;
  drag << sums.w * Eigen::Matrix3d::Identity(), -M, M, R_WL * I * R_WL.transpose();
  return drag;
}

// A cluster's points take out no more power than its highest drag at its highest speed would: few
// clusters need to be looked at one point at a time.
void Teleoperation::Body::find_largest() noexcept {
  const auto each_feeling = [&](const auto& visit) {
    for (std::size_t l = 0; l < points_.links.size(); ++l) {
      if (links_[l].remembering == 0) continue;
      const BodyPoints::LinkRange& range = points_.links[l];
      const LinkMotion& motion = motion_[static_cast<std::size_t>(range.link)];
      for (std::uint32_t c = range.first_cluster; c < range.last_cluster; ++c) {
        if (clusters_[c].feeling > 0) visit(c, range.link, motion);
      }
    }
  };
  const auto look_into = [&](std::uint32_t c, int link, const LinkMotion& motion) {
    const BodyPoints::Cluster& cluster = points_.clusters[c];
    const std::uint32_t b = cluster.begin;
    offer_largest(cluster,
                  most_power(&points_.x[b], &points_.y[b], &points_.z[b], &drag_[b],
                             whole_lanes(cluster), motion.v_L.data(), motion.w_L.data()),
                  link);
  };
  double most = 0;
  std::uint32_t most_at = 0;
  int most_link = -1;
  each_feeling([&](std::uint32_t c, int link, const LinkMotion& motion) {
    const BoundingSphere& sphere = points_.clusters[c].sphere;
    const double speed = (motion.v_L + motion.w_L.cross(sphere.centre.cast<double>())).norm() +
                         motion.w_L.norm() * static_cast<double>(sphere.radius);
    // Single precision rounds down too.
    clusters_[c].power_bound =
        static_cast<float>(1.0001 * static_cast<double>(clusters_[c].highest) * speed * speed);
    if (clusters_[c].power_bound > most) {
      most = clusters_[c].power_bound;
      most_at = c;
      most_link = link;
    }
  });
  if (most_link < 0) return;
  look_into(most_at, most_link, motion_[static_cast<std::size_t>(most_link)]);
  each_feeling([&](std::uint32_t c, int link, const LinkMotion& motion) {
    if (c != most_at && clusters_[c].power_bound > largest_.power) look_into(c, link, motion);
  });
}

// Where it is not known where the surface lies, the whole velocity is opposed.
Matrix6 Teleoperation::Body::closing_drag(const BodyPoints::Cluster& cluster,
                                          const LinkMotion& motion, int link) noexcept {
  const std::uint32_t b = cluster.begin;
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> R_WL = motion.X_WL.linear();
  const ClosingSums sums = sum_closing(
      &points_.x[b], &points_.y[b], &points_.z[b], &towards_x_[b], &towards_y_[b], &towards_z_[b],
      &drag_[b], whole_lanes(cluster), R_WL.data(), motion.v_WLo.data(), motion.w_WL.data());
  offer_largest(cluster, sums.most, link);
  Matrix6 drag;
  for (Eigen::Index row = 0, n = 0; row < 6; ++row) {
    for (Eigen::Index column = row; column < 6; ++column, ++n) {
      drag(row, column) = drag(column, row) = sums.upper[n];
    }
  }
  if (sums.undirected) drag += undirected_drag(cluster, motion, link);
  return drag;
}

Matrix6 Teleoperation::Body::undirected_drag(const BodyPoints::Cluster& cluster,
                                             const LinkMotion& motion, int link) noexcept {
  const std::uint32_t b = cluster.begin;
  const std::size_t n = whole_lanes(cluster);
  float w[BodyPoints::cluster_size];
  for (std::uint32_t p = 0; p < n; ++p) {
    const bool known = towards_x_[b + p] != 0 || towards_y_[b + p] != 0 || towards_z_[b + p] != 0;
    w[p] = known ? 0 : drag_[b + p];
  }
  offer_largest(cluster,
                most_power(&points_.x[b], &points_.y[b], &points_.z[b], w, n, motion.v_L.data(),
                           motion.w_L.data()),
                link);
  return drag_of(sum_moments(&points_.x[b], &points_.y[b], &points_.z[b], w, n), motion);
}

void Teleoperation::Body::offer_largest(const BodyPoints::Cluster& cluster, const MostPower& most,
                                        int link) noexcept {
  if (!(most.power > largest_.power)) return;
  largest_ = {.point = cluster.begin + static_cast<std::uint32_t>(most.point),
              .link = link,
              .power = most.power};
}

PointDrag Teleoperation::Body::point_drag(std::uint32_t point) const noexcept {
  PointDrag felt;
  const auto range =
      std::ranges::find_if(points_.links, [point](const BodyPoints::LinkRange& link) {
        return point >= link.begin && point < link.end;
      });
  if (range == points_.links.end() || !(drag_[point] > 0)) return felt;
  const std::uint32_t cluster = range->first_cluster + (point - range->begin) / cluster_points;
  // What is skipped as far away feels nothing; its drag may be that of before a new start.
  if (clusters_[cluster].past != ClusterState::Past::known) return felt;
  const double area = static_cast<double>(points_.area[point]);
  const LinkMotion& motion = motion_[static_cast<std::size_t>(range->link)];
  felt.mu_e = static_cast<double>(drag_[point]) / area;
  const Vec3 r_W = motion.X_WL.linear() * position(point);
  const Vec3 v_WR = motion.v_WLo + motion.w_WL.cross(r_W);
  const Vec3 towards_W = closing_ ? Vec3(static_cast<double>(towards_x_[point]),
                                         static_cast<double>(towards_y_[point]),
                                         static_cast<double>(towards_z_[point]))
                                  : Vec3::Zero();
  // Where it is not known where the surface lies, the whole velocity is opposed.
  felt.force_W = closing_drag_force(felt.mu_e, area, v_WR, towards_W);
  return felt;
}

Reason Teleoperation::Body::reason(const FieldView& view) const noexcept {
  Reason reason;
  if (largest_.link < 0) return reason;
  const LinkMotion& motion = motion_[static_cast<std::size_t>(largest_.link)];
  const Vec3 p_WR = motion.X_WL * position(largest_.point);
  const Vec3 v_WR = motion.v_WLo + motion.w_WL.cross(p_WR - motion.X_WL.translation());
  reason.point = static_cast<int>(largest_.point);
  reason.link = largest_.link;
  double power = 0;
  for (std::size_t link = 0; link < link_drag_.size(); ++link) {
    Vector6 twist;
    twist << motion_[link].v_WLo, motion_[link].w_WL;
    power += twist.dot(link_drag_[link] * twist);
  }
  reason.share = std::min(1.0, largest_.power / power);
  const FieldSample here = view.field.at(p_WR);
  reason.kind = here.record.kind;
  if (here.record.kind == VoxelKind::empty) return reason;
  reason.object = here.record.object;
  reason.rank = here.record.rank;
  if (here.distance_m >= 0) {
    reason.distance_m = here.distance_m;
  } else if (here.record.kind == VoxelKind::neighbour) {
    const std::size_t rank = here.record.rank;
    reason.distance_m = view.nearest_m[here.record.object][rank - 1];
  }
  const double speed = v_WR.norm();
  if (speed > 0) reason.time_to_contact_s = reason.distance_m / speed;
  return reason;
}

bool Teleoperation::Body::touches(const Workspace& workspace) const noexcept {
  for (const BodyPoints::LinkRange& range : points_.links) {
    const Vec3 centre_W =
        motion_[static_cast<std::size_t>(range.link)].X_WL * range.sphere.centre.cast<double>();
    const Vec3 grid = workspace.to_grid(centre_W);
    const Vec3 dims(workspace.dims.i, workspace.dims.j, workspace.dims.k);
    const Vec3 outside = (-grid).cwiseMax(grid - dims).cwiseMax(0.0);
    if (outside.norm() * workspace.voxel_size <= range.sphere.radius) return true;
  }
  return false;
}

}  // namespace vicinity
