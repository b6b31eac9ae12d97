// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/body_points.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "exposed_surface.h"
#include "surface_samples.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

constexpr std::size_t smallest_part = 8;  // points whose order among themselves does not matter

// FNV-1a: a link's samples depend on its name, and not on which other links there are.
std::uint64_t hash(const std::string& name) noexcept {
  std::uint64_t bits = 0xcbf29ce484222325;
  for (const char c : name) bits = (bits ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return bits;
}

void check_options(const RobotModel& robot, const BodyPointOptions& options) {
  const auto must_be_link = [&](const std::string& name) {
    if (robot.find_link(name)) return;
    std::string links;
    for (const Link& link : robot.links) links += (links.empty() ? "" : ", ") + link.name;
    throw Error({.where = "body points",
                 .what = fmt::format("robot '{}' has no such link", robot.name),
                 .found = fmt::format("'{}'", name),
                 .expected = "one of " + links});
  };
  const auto must_not_be_negative = [](const std::string& what, double value) {
    if (value >= 0 && std::isfinite(value)) return;
    throw Error({.where = "body points",
                 .what = what + " must be zero or more",
                 .found = fmt::format("{}", value)});
  };
  must_not_be_negative("points_per_m2", options.points_per_m2);
  for (const std::string& link : options.exclude) must_be_link(link);
  for (const auto& [link, weight] : options.weight) {
    must_be_link(link);
    must_not_be_negative(fmt::format("weight of link '{}'", link), weight);
  }
  for (const auto& [link, point] : options.named) {
    must_be_link(link);
    must_not_be_negative(fmt::format("area of the point on link '{}'", link), point.area);
    if (!point.p_LR.allFinite()) {
      throw Error({.where = "body points",
                   .what = fmt::format("the point on link '{}' is not finite", link)});
    }
  }
}

// One link on its way to becoming points.
struct Surface {
  std::size_t link = 0;
  std::vector<Corners> triangles;
  double area = 0;
  std::size_t count = 0;
};

std::vector<Surface> surfaces_to_sample(const RobotModel& robot, const BodyPointOptions& options) {
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const Link& link = robot.links[i];
    if (options.named.contains(link.name) || std::ranges::count(options.exclude, link.name) > 0) {
      continue;
    }
    Surface surface{.link = i, .triangles = {}};
    for (const LinkGeometry& geometry : link.geometries) {
      for (const auto& [a, b, c] : geometry.mesh.triangles) {
        const auto& vertices = geometry.mesh.vertices;
        const Corners corners{vertices[a], vertices[b], vertices[c]};
        if (area_of(corners) > 0) surface.triangles.push_back(corners);
      }
    }
    surface.triangles = exposed_surface(std::move(surface.triangles));
    // Summed from the smallest up: the same to the last bit whatever the order of triangles.
    std::vector<double> areas;
    for (const Corners& corners : surface.triangles) areas.push_back(area_of(corners));
    std::ranges::sort(areas);
    surface.area = std::accumulate(areas.begin(), areas.end(), 0.);
    if (surface.area > 0) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

// By density, or a total shared out by area with the largest remainders rounded up.
void choose_counts(std::vector<Surface>& surfaces, const BodyPointOptions& options) {
  const double total_area =
      std::accumulate(surfaces.begin(), surfaces.end(), 0.,
                      [](double sum, const Surface& s) { return sum + s.area; });
  const double wanted =
      options.total ? static_cast<double>(*options.total) : options.points_per_m2 * total_area;
  if (!(wanted <= static_cast<double>(BodyPoints::most)) || !std::isfinite(total_area)) {
    const std::string density =
        options.total ? "" : fmt::format(", {:g} on each of them", options.points_per_m2);
    throw Error(
        {.where = "body points",
         .what = "the arm has too many",
         .found = fmt::format("{:.4g} on {:.4g} m² of surface{}", wanted, total_area, density),
         .expected = fmt::format("at most {}", BodyPoints::most),
         .hint = "fewer points, or, where the surface is far too large, meshes in metres: a "
                 "URDF's scale=\"0.001 0.001 0.001\" makes them of millimetres"});
  }
  if (wanted == 0) {
    surfaces.clear();
    return;
  }
  if (!options.total) {
    for (Surface& surface : surfaces) {
      surface.count = std::max<std::size_t>(
          1, static_cast<std::size_t>(std::llround(options.points_per_m2 * surface.area)));
    }
    return;
  }
  std::size_t given = 0;
  std::vector<std::pair<double, std::size_t>> remainders;
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    const double share = wanted * surfaces[i].area / total_area;
    surfaces[i].count = static_cast<std::size_t>(share);
    given += surfaces[i].count;
    remainders.emplace_back(static_cast<double>(surfaces[i].count) - share, i);
  }
  std::ranges::sort(remainders);
  for (const auto& [_, i] : remainders) {
    if (given++ < *options.total) ++surfaces[i].count;
  }
  std::erase_if(surfaces, [](const Surface& surface) { return surface.count == 0; });
}

// Orders ids[begin, end) so that each half is one side of a cut across the longest extent. Cuts
// fall on multiples of the cluster size, so that every cluster is a compact patch.
void order_along_surface(const std::vector<Eigen::Vector3f>& points,
                         std::vector<std::uint32_t>& ids, std::size_t begin, std::size_t end) {
  const std::size_t size = end - begin;
  if (size <= smallest_part) return;
  const std::size_t part =
      size > BodyPoints::cluster_size ? BodyPoints::cluster_size : smallest_part;
  const std::size_t middle = begin + (size / 2 + part - 1) / part * part;
  Eigen::AlignedBox3f box;
  for (std::size_t i = begin; i < end; ++i) box.extend(points[ids[i]]);
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto at = [&](std::size_t i) { return ids.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(points[a][axis], a) < std::pair(points[b][axis], b);
  });
  order_along_surface(points, ids, begin, middle);
  order_along_surface(points, ids, middle, end);
}

// Bădoiu and Clarkson 2003: step towards the farthest point, each step shorter than the last. The
// best centre on the way is kept, so that it is never worse than the box's.
BoundingSphere bounding_sphere(const BodyPoints& points, std::uint32_t begin, std::uint32_t end) {
  const auto at = [&](std::uint32_t i) {
    return Eigen::Vector3f(points.x[i], points.y[i], points.z[i]);
  };
  const auto farthest_from = [&](const Eigen::Vector3f& centre) {
    std::pair<float, std::uint32_t> farthest{-1.f, begin};
    for (std::uint32_t i = begin; i < end; ++i) {
      const float squared = (at(i) - centre).squaredNorm();
      if (squared > farthest.first) farthest = {squared, i};
    }
    return farthest;
  };
  Eigen::AlignedBox3f box;
  for (std::uint32_t i = begin; i < end; ++i) box.extend(at(i));
  BoundingSphere sphere;
  float best_squared = std::numeric_limits<float>::infinity();
  Eigen::Vector3f centre = box.center();
  for (int step = 2; step <= 32; ++step) {
    const auto [squared, farthest] = farthest_from(centre);
    if (squared < best_squared) {
      best_squared = squared;
      sphere.centre = centre;
    }
    centre += (at(farthest) - centre) / static_cast<float>(step);
  }
  // The allowance covers the rounding of whoever compares.
  sphere.radius = std::sqrt(best_squared) * (1 + 1e-5f);
  return sphere;
}

// Appends one link's points, ordered, padded and clustered.
void append(BodyPoints& to, std::size_t link, const std::vector<Eigen::Vector3f>& points,
            const std::vector<double>& shares) {
  std::vector<std::uint32_t> ids(points.size());
  std::iota(ids.begin(), ids.end(), 0u);
  order_along_surface(points, ids, 0, ids.size());

  BodyPoints::LinkRange range;
  range.link = static_cast<int>(link);
  range.begin = static_cast<std::uint32_t>(to.x.size());
  range.end = range.begin + static_cast<std::uint32_t>(points.size());
  range.first_cluster = static_cast<std::uint32_t>(to.clusters.size());
  const auto put = [&](const Eigen::Vector3f& point, float area) {
    to.x.push_back(point.x());
    to.y.push_back(point.y());
    to.z.push_back(point.z());
    to.area.push_back(area);
  };
  for (const std::uint32_t id : ids) {
    put(points[id], static_cast<float>(shares[id]));
    range.area += shares[id];
  }
  while (to.x.size() % BodyPoints::lane != 0) put(points[ids.back()], 0.f);

  for (std::uint32_t begin = range.begin; begin < range.end;) {
    const auto full = begin + static_cast<std::uint32_t>(BodyPoints::cluster_size);
    const std::uint32_t end = std::min(full, range.end);
    to.clusters.push_back({begin, end, bounding_sphere(to, begin, end)});
    begin = end;
  }
  range.last_cluster = static_cast<std::uint32_t>(to.clusters.size());
  range.sphere = bounding_sphere(to, range.begin, range.end);
  to.links.push_back(range);
}

}  // namespace

std::size_t BodyPoints::count() const noexcept {
  std::size_t sum = 0;
  for (const LinkRange& range : links) sum += range.end - range.begin;
  return sum;
}

BodyPoints sample_body_points(const RobotModel& robot, const BodyPointOptions& options) {
  check(robot);
  check_options(robot, options);
  std::vector<Surface> surfaces = surfaces_to_sample(robot, options);
  choose_counts(surfaces, options);

  BodyPoints points;
  auto surface = surfaces.begin();
  for (std::size_t link = 0; link < robot.links.size(); ++link) {
    const std::string& name = robot.links[link].name;
    if (const auto named = options.named.find(name); named != options.named.end()) {
      append(points, link, {named->second.p_LR.cast<float>()}, {named->second.area});
    } else if (surface != surfaces.end() && surface->link == link) {
      SurfaceSamples samples =
          sample_surface(std::move(surface->triangles), surface->count, options.seed ^ hash(name));
      const auto weight = options.weight.find(name);
      if (weight != options.weight.end()) {
        for (double& share : samples.shares) share *= weight->second;
      }
      append(points, link, samples.points, samples.shares);
      ++surface;
    }
  }
  return points;
}

}  // namespace vicinity
