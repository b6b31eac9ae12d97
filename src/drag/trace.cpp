// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/drag/trace.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

// A gigabyte of samples; a track of 1 m at 1 mm/s and 1 kHz has a million.
constexpr double most_samples = 1e7;

void require(bool fulfilled, const char* where, double found, const char* expected) {
  if (fulfilled) return;
  throw Error({.where = where,
               .what = "cannot be used for a track",
               .found = std::to_string(found),
               .expected = expected});
}

void require_usable(double rate, double area) {
  require(rate > 0 && std::isfinite(rate), "rate", rate, "a positive number of samples per second");
  require(area >= 0 && std::isfinite(area), "area", area, "a number of m², zero or more");
}

/// A point that leaves a sample wherever it comes.
class TracedPoint {
 public:
  TracedPoint(const ViscosityField& field, const DragOptions& options)
      : field_(field), options_(options) {}

  TraceSample sample(double t, const Vec3& p_WR, const Vec3& v_WR) {
    const FieldSample here = field_.at(p_WR);
    TraceSample sample{.t = t, .p_WR = p_WR, .record = here.record, .mu = here.viscosity};
    sample.mu_e = point_.advance(field_, options_.memory, options_.traversal, p_WR);
    sample.force_W =
        options_.direction == DragDirection::all
            ? drag_force(sample.mu_e, options_.area, v_WR)
            : closing_drag_force(sample.mu_e, options_.area, v_WR, point_.towards_surface(field_));
    return sample;
  }

 private:
  const ViscosityField& field_;
  const DragOptions& options_;
  MovingPoint point_;
};

}  // namespace

std::vector<TraceSample> trace(const ViscosityField& field, const Track& track,
                               const DragOptions& options) {
  for (const double end : {track.from_W.sum(), track.to_W.sum()}) {
    require(std::isfinite(end), "from, to", end, "three finite coordinates [m]");
  }
  require(track.speed > 0 && std::isfinite(track.speed), "speed", track.speed,
          "a positive number of m/s");
  require_usable(track.rate, options.area);
  const Vec3 way = track.to_W - track.from_W;
  const double length = way.norm(), duration = length / track.speed;
  // An end that rounding puts just behind the last regular sample is that sample.
  const double steps = std::ceil(duration * track.rate - 1e-9);
  require(steps < most_samples, "rate", steps, "at most ten million samples on a track");

  const Vec3 v_WR = length > 0 ? Vec3(track.speed / length * way) : Vec3::Zero();
  const auto last = static_cast<std::size_t>(std::max(0.0, steps));
  std::vector<TraceSample> samples(last + 1);
  TracedPoint point(field, options);
  for (std::size_t n = 0; n <= last; ++n) {
    const double t = n < last ? static_cast<double>(n) / track.rate : duration;
    samples[n] = point.sample(t, n < last ? Vec3(track.from_W + t * v_WR) : track.to_W, v_WR);
  }
  return samples;
}

std::vector<TraceSample> trace(const ViscosityField& field, std::span<const Vec3> path_W,
                               double rate, const DragOptions& options) {
  require_usable(rate, options.area);
  std::vector<TraceSample> samples(path_W.size());
  TracedPoint point(field, options);
  for (std::size_t n = 0; n < path_W.size(); ++n) {
    const Vec3& p_WR = path_W[n];
    if (!p_WR.allFinite()) {
      throw Error({.where = "path", .what = "position " + std::to_string(n) + " is not finite"});
    }
    const Vec3 v_WR = n > 0 ? Vec3(rate * (p_WR - path_W[n - 1])) : Vec3::Zero();
    samples[n] = point.sample(static_cast<double>(n) / rate, p_WR, v_WR);
  }
  return samples;
}

}  // namespace vicinity
