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

}  // namespace

std::vector<TraceSample> trace(const ViscosityField& field, const Track& track,
                               const DragOptions& options) {
  for (const double end : {track.from_W.sum(), track.to_W.sum()}) {
    require(std::isfinite(end), "from, to", end, "three finite coordinates [m]");
  }
  require(track.speed > 0 && std::isfinite(track.speed), "speed", track.speed,
          "a positive number of m/s");
  require(track.rate > 0 && std::isfinite(track.rate), "rate", track.rate,
          "a positive number of samples per second");
  require(options.area >= 0 && std::isfinite(options.area), "area", options.area,
          "a number of m², zero or more");
  const Vec3 way = track.to_W - track.from_W;
  const double length = way.norm(), duration = length / track.speed;
  // An end that rounding puts just behind the last regular sample is that sample.
  const double steps = std::ceil(duration * track.rate - 1e-9);
  require(steps < most_samples, "rate", steps, "at most ten million samples on a track");

  const Vec3 v_WR = length > 0 ? Vec3(track.speed / length * way) : Vec3::Zero();
  const auto last = static_cast<std::size_t>(std::max(0.0, steps));
  std::vector<TraceSample> samples(last + 1);
  MovingPoint point;
  for (std::size_t n = 0; n <= last; ++n) {
    TraceSample& sample = samples[n];
    sample.t = n < last ? static_cast<double>(n) / track.rate : duration;
    sample.p_WR = n < last ? Vec3(track.from_W + sample.t * v_WR) : track.to_W;
    const FieldSample here = field.at(sample.p_WR);
    sample.record = here.record;
    sample.mu = here.viscosity;
    sample.mu_e = point.advance(field, options.memory, options.traversal, sample.p_WR);
    sample.force_W =
        options.direction == DragDirection::all
            ? drag_force(sample.mu_e, options.area, v_WR)
            : closing_drag_force(sample.mu_e, options.area, v_WR, point.towards_surface(field));
  }
  return samples;
}

}  // namespace vicinity
