// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "arguments.h"
#include "commands/csv_cell.h"
#include "drag_words.h"
#include "fresh_file.h"
#include "outputs.h"
#include "picture/chart.h"
#include "picture/rank_palette.h"
#include "readable.h"
#include "vicinity/drag/trace.h"
#include "vicinity/viscosity/field_file.h"

namespace vicinity::cli {
namespace {

std::string object_name(const ViscosityField& field, const VoxelRecord& record) {
  return record.kind == VoxelKind::empty ? "" : field.objects()[record.object].name;
}

std::string as_csv(const ViscosityField& field, const std::vector<TraceSample>& samples) {
  std::string text = "t,x,y,z,kind,object,rank,mu,mu_e,fx,fy,fz\n";
  for (const TraceSample& s : samples) {
    const Vec3 force = s.force_W + Vec3::Zero();  // no "-0"
    // Ten digits: a nanometre in a room, and no tails of binary fractions.
    fmt::format_to(
        std::back_inserter(text),
        "{:.10g},{:.10g},{:.10g},{:.10g},{},{},{},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g}\n", s.t,
        s.p_WR.x(), s.p_WR.y(), s.p_WR.z(), to_string(s.record.kind),
        csv_cell(object_name(field, s.record)), s.record.rank, s.mu, s.mu_e, force.x(), force.y(),
        force.z());
  }
  return text;
}

// What the point passes, in the colours of the slices.
std::vector<ChartBand> bands_along(const ViscosityField& field,
                                   const std::vector<TraceSample>& samples, double speed) {
  const int q = most_ranks(field);
  std::vector<ChartBand> bands;
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    const VoxelRecord& record = samples[begin].record;
    while (end < samples.size() && samples[end].record.kind == record.kind &&
           samples[end].record.rank == record.rank) {
      ++end;
    }
    const double last = samples[std::min(end, samples.size() - 1)].t;
    bands.push_back({speed * samples[begin].t, speed * last, colour_of(record, q)});
  }
  return bands;
}

void plot(const TraceOptions& options, const ViscosityField& field,
          const std::vector<TraceSample>& samples) {
  Series mu{.name = "μ under the point", .points = {}, .steps = true};
  Series mu_e{
      .name = "effective μ after memory '" + options.memory + "'", .points = {}, .steps = true};
  Series force{.name = "|F|", .points = {}, .steps = true};
  for (const TraceSample& s : samples) {
    const double distance = options.speed * s.t;
    mu.points.emplace_back(distance, s.mu);
    mu_e.points.emplace_back(distance, s.mu_e);
    force.points.emplace_back(distance, s.force_W.norm());
  }
  draw_chart({.title = "Viscosity and drag along a straight track",
              .caption = fmt::format(
                  "{}, from ({}) to ({}) m at {:g} m/s, sampled at {:g} Hz, S = {:g} m², drag on "
                  "{}, {}. Strip: what the point passes, in the colours of slices.",
                  options.field.filename().string(), options.from, options.to, options.speed,
                  options.rate, options.area,
                  options.direction == "all" ? "all motion" : "closing motion", options.traversal),
              .x_label = "distance along the track [m]",
              .panels = {{"viscosity [N·s/m³]", {mu, mu_e}}, {"drag [N]", {force}}},
              .strips = {{"", bands_along(field, samples, options.speed), {}}}},
             options.plot);
}

std::string summary(const TraceOptions& options, const ViscosityField& field,
                    const std::vector<TraceSample>& samples) {
  const auto strongest = std::max_element(
      samples.begin(), samples.end(), [](const TraceSample& a, const TraceSample& b) {
        return a.force_W.squaredNorm() < b.force_W.squaredNorm();
      });
  std::string text =
      fmt::format("{}: {} samples over {:.4g} m\n", options.output.string(),
                  grouped(samples.size()), (samples.back().p_WR - samples.front().p_WR).norm());
  if (strongest->force_W.isZero()) return text + "no drag anywhere on this track\n";
  const std::string object = object_name(field, strongest->record);
  return text + fmt::format("most drag: {:.4g} N at ({:.4g}, {:.4g}, {:.4g}) m{}\n",
                            strongest->force_W.norm(), strongest->p_WR.x(), strongest->p_WR.y(),
                            strongest->p_WR.z(), object.empty() ? "" : ", near " + object);
}

}  // namespace

int trace(const TraceOptions& options, std::ostream& out, std::ostream&) {
  const Track track{.from_W = point_from("--from", options.from),
                    .to_W = point_from("--to", options.to),
                    .speed = options.speed,
                    .rate = options.rate};
  const DragOptions drag{.area = options.area,
                         .memory = named_memory(options.memory),
                         .direction = direction_from(options.direction),
                         .traversal = traversal_from(options.traversal)};
  check_outputs({{"-o", options.output}, {"--plot", options.plot}}, {options.field});
  const ViscosityField field = recoded(open_field(options.field), options.coding);

  const std::vector<TraceSample> samples = vicinity::trace(field, track, drag);
  if (!options.plot.empty()) plot(options, field, samples);
  if (options.output.empty()) {
    out << as_csv(field, samples);
    return 0;
  }
  FreshFile file(options.output);
  file.write(as_csv(field, samples));
  file.commit();
  out << summary(options, field, samples);
  return 0;
}

}  // namespace vicinity::cli
