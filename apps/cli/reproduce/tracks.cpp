// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "reproduce/tracks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "reproduce/csv_table.h"
#include "reproduce/figures.h"
#include "reproduce/parts.h"

namespace vicinity::report {
namespace {

const Coding text_coding = named_coding("paper", 6);         // §5.2 and the text on fig. 23
const Coding caption_coding = named_coding("nonlinear", 6);  // under fig. 23: 32, 20, 13, 11, 10, 9

// Through the middles of voxels.
Pass along_x(std::string name, double y, double z, double to, double speed = unit_speed) {
  return {.name = std::move(name),
          .from_vox = {0.5, y + 0.5, z + 0.5},
          .to_vox = {to - 0.5, y + 0.5, z + 0.5},
          .speed = speed};
}
Pass along_y(std::string name, double x, double z, double to, double speed = unit_speed) {
  return {.name = std::move(name),
          .from_vox = {x + 0.5, 0.5, z + 0.5},
          .to_vox = {x + 0.5, to - 0.5, z + 0.5},
          .speed = speed};
}

std::filesystem::path write_passes(const Workshop& workshop, const std::string& file,
                                   const std::vector<Pass>& passes) {
  CsvTable table("track,way_vox,kind,rank,mu_Ns_m3,drag_N");
  for (const Pass& pass : passes) {
    for (const TraceSample& s : pass.samples) {
      table.row(pass.name, pass.way_vox(s), to_string(s.record.kind), int{s.record.rank}, s.mu,
                s.force_W.norm());
    }
  }
  const std::filesystem::path path = workshop.file(file);
  table.write(path);
  return path;
}

cli::Chart drag_chart(const std::vector<Pass>& passes, const std::string& x_label) {
  cli::Chart chart;
  chart.x_label = x_label;
  chart.panels = {{"drag |F| [N]", {}}};
  for (const Pass& pass : passes) chart.panels[0].series.push_back(drag_series(pass));
  return chart;
}

std::vector<double> peaks_of(const std::vector<Pass>& passes) {
  std::vector<double> peaks;
  for (const Pass& pass : passes) peaks.push_back(pass.peak());
  return peaks;
}

// Drag takes no values but those of the coding, times area and speed.
Check is_stepped(const std::vector<Pass>& passes, const Coding& coding) {
  std::size_t between = 0, samples = 0;
  for (const Pass& pass : passes) {
    for (const TraceSample& sample : pass.samples) {
      const double mu = sample.force_W.norm() / (unit_area * pass.speed);
      const auto is_it = [&](double value) { return std::abs(mu - value) < 1e-9; };
      ++samples;
      if (!is_it(0) && !is_it(coding.skin) && std::ranges::none_of(coding.mu, is_it)) ++between;
    }
  }
  return {"drag is stepped, one step a layer",
          fmt::format("{} of {} samples lie between the steps", between, samples), between == 0};
}

}  // namespace

// ---------------------------------------------------------------------------------------- fig. 5

std::vector<Pass> approach_slow_and_fast(const ViscosityField& field,
                                         const ViscosityField& distances) {
  std::vector<Pass> passes;
  for (const double speed : {0.05, 0.2}) {
    Pass pass = along_y(fmt::format("{:g} m/s", speed), 64, 40, 43.5, speed);
    passes.push_back(walk(std::move(pass), field, distances));
  }
  return passes;
}

std::vector<Check> check_fig5(const std::vector<Pass>& slow_and_fast, double at_rest) {
  const Pass &slow = slow_and_fast.front(), &fast = slow_and_fast.back();
  const double ratio = fast.speed / slow.speed;
  double off = 0;
  for (std::size_t n = 0; n < std::min(slow.samples.size(), fast.samples.size()); ++n) {
    off = std::max(
        off, std::abs(fast.samples[n].force_W.norm() - ratio * slow.samples[n].force_W.norm()));
  }
  std::vector<double> steps;
  bool falls = false;
  for (const TraceSample& sample : fast.samples) {
    const double drag = sample.force_W.norm();
    if (steps.empty() || drag != steps.back()) {
      falls |= !steps.empty() && drag < steps.back();
      steps.push_back(drag);
    }
  }
  return {{"drag rises layer by layer towards the surface",
           fmt::format("fast point: {} N", listed(steps)), !falls && steps.size() == 6},
          {"in every layer the fast point meets more drag, by the ratio of speeds",
           fmt::format("{:g} times, off by {:.1g} N at most", ratio, off), off < 1e-9},
          {"a point that stops meets none", fmt::format("{:g} N in rank 1", at_rest), at_rest == 0},
          viscosity_tells_distance(slow_and_fast, text_coding, 4),
          force_is_drag(slow_and_fast)};
}

Outcome fig5(Workshop& workshop) {
  const Part part = circular_cylinder();
  const ViscosityField field = workshop.field(part, {.m = 4, .q = 5});
  const std::vector<Pass> passes = approach_slow_and_fast(field, workshop.distances(part, 24));
  const Vec3 in_rank_1 = voxel_m * Vec3(64.5, 42.5, 40.5);
  const TraceSample standing = trace(field, {.from_W = in_rank_1, .to_W = in_rank_1}).front();
  Outcome outcome{.checks = check_fig5(passes, standing.force_W.norm()), .figures = {}};
  outcome.figures = {chart(
      workshop, "fig5/drag_by_layer.svg",
      drag_chart(passes, "way towards the surface, which is at 44 [voxels]"),
      "Drag against layer, slow and fast",
      "The lower line is the paper's path a, the upper one its path b. Five layers, each four "
      "voxels thick.")};
  outcome.data = {write_passes(workshop, "fig5/drag_by_layer.csv", passes)};
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 22

namespace {
constexpr std::array track_heights{1, 10, 20, 30, 40, 45};
}

std::vector<Pass> six_tracks(const ViscosityField& field, const ViscosityField& distances) {
  std::vector<Pass> tracks;
  for (const int z : track_heights) {
    tracks.push_back(walk(along_y(fmt::format("z = {}", z), cone_axis + cone_base_radius, z, 120),
                          field, distances));
  }
  return tracks;
}

std::vector<Check> check_fig22(const std::vector<Pass>& tracks) {
  const std::vector<double> peaks = peaks_of(tracks);
  bool peak_in_middle = true;
  for (const Pass& track : tracks) {
    const auto drag_at = [&](double y) {
      const auto n = static_cast<std::size_t>(std::lround((y - track.from_vox.y()) * 5));
      return track.samples[n].force_W.norm();
    };
    peak_in_middle &= drag_at(cone_axis + 0.5) == track.peak();
  }
  return {{"drag falls with the height of the track",
           fmt::format("peaks {} N at z = {}", listed(peaks), fmt::join(track_heights, ", ")),
           std::ranges::is_sorted(peaks, std::greater<>()) && peaks.front() > 2 * peaks[4]},
          {"the sixth track meets no layer", fmt::format("{:g} N", peaks.back()),
           peaks.back() == 0 && peaks[4] > 0},
          {"each track peaks beside the axis", peak_in_middle ? "all do" : "not all do",
           peak_in_middle},
          is_stepped(tracks, text_coding),
          viscosity_tells_distance(tracks, text_coding, 4),
          force_is_drag(tracks)};
}

Outcome fig22(Workshop& workshop) {
  const Part part = cone();
  const ViscosityField field = workshop.field(part, {});
  const std::vector<Pass> tracks = six_tracks(field, workshop.distances(part, 32));
  Outcome outcome{.checks = check_fig22(tracks), .figures = {}};
  outcome.figures = {
      chart(workshop, "fig22/six_tracks.svg", drag_chart(tracks, "y [voxels]"),
            "Drag on six tracks by the cone",
            "Unit surface at unit speed, so that newtons are the viscosity's number. The higher "
            "the track, "
            "the farther it is from the cone's side; the sixth stays outside all layers."),
      section(workshop, "fig22/plane_of_the_tracks.png", field, 0,
              static_cast<int>(cone_axis + cone_base_radius), "The plane of the tracks",
              "The layers in the vertical plane that touches the cone at its base, x = 85: the "
              "tracks cross it from left to right.")};
  outcome.data = {write_passes(workshop, "fig22/six_tracks.csv", tracks)};
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 23

std::vector<Pass> three_tracks(const ViscosityField& field, const ViscosityField& distances) {
  std::vector<Pass> tracks;
  for (const int y : {20, 50, 80}) {
    tracks.push_back(walk(along_x(fmt::format("y = {}", y), y, 40, 200), field, distances));
  }
  return tracks;
}

namespace {

// Local maxima of the drag that are as high as rank 2 at least, from left to right.
std::vector<double> local_peaks(const Pass& pass, const Coding& coding) {
  std::vector<double> levels;
  for (const TraceSample& sample : pass.samples) {
    if (levels.empty() || levels.back() != sample.mu) levels.push_back(sample.mu);
  }
  std::vector<double> peaks;
  for (std::size_t n = 1; n + 1 < levels.size(); ++n) {
    if (levels[n] > levels[n - 1] && levels[n] > levels[n + 1] && levels[n] >= coding.mu[1]) {
      peaks.push_back(levels[n]);
    }
  }
  return peaks;
}

}  // namespace

std::vector<Check> check_fig23(const std::vector<Pass>& text, const std::vector<Pass>& caption) {
  const std::vector<double> peaks = local_peaks(text[0], text_coding);
  const auto work = [](const Pass& pass) {
    double sum = 0;
    for (const TraceSample& s : pass.samples) sum += s.force_W.norm() * voxel_m / 5;
    return sum;
  };
  std::vector<Pass> both = text;
  both.insert(both.end(), caption.begin(), caption.end());
  const auto of_coding = [](const char* whose, Check check) {
    check.claim += fmt::format(", coding of the {}", whose);
    return check;
  };
  return {{"y = 20 passes close by without contact", fmt::format("peak {:g} N", text[0].peak()),
           text[0].peak() == text_coding.mu[0]},
          {"two peaks there, of different height", fmt::format("{} N", listed(peaks)),
           peaks.size() == 2 && peaks[0] != peaks[1]},
          {"y = 50 and y = 80 meet the body and feel its skin",
           fmt::format("{} and {} N", text[1].peak(), text[2].peak()),
           text[1].peak() == text_coding.skin && text[2].peak() == text_coding.skin},
          {"the caption's coding takes less work at y = 20 and has the same first layer",
           fmt::format("{:.3g} J against {:.3g} J", work(caption[0]), work(text[0])),
           work(caption[0]) < work(text[0]) && caption[0].peak() == text[0].peak()},
          of_coding("text", is_stepped(text, text_coding)),
          of_coding("caption", is_stepped(caption, caption_coding)),
          of_coding("text", viscosity_tells_distance(text, text_coding, 4)),
          of_coding("caption", viscosity_tells_distance(caption, caption_coding, 4)),
          force_is_drag(both)};
}

Outcome fig23(Workshop& workshop) {
  const Part part = complex_cylinder();
  const ViscosityField field = workshop.field(part, {});
  const ViscosityField recoded = field.with_codings({caption_coding});
  const ViscosityField distances = workshop.distances(part, 32);
  const std::vector<Pass> text = three_tracks(field, distances);
  const std::vector<Pass> caption = three_tracks(recoded, distances);
  Outcome outcome{.checks = check_fig23(text, caption), .figures = {}};
  outcome.figures = {
      section(
          workshop, "fig23/middle_z40.png", field, 2, 40, "At mid height, z = 40",
          "The narrow concavity A, on the right of the top, is full of the first layers; the wider "
          "ones let the arm in farther."),
      section(workshop, "fig23/near_top_z58.png", field, 2, 58, "Near the top, z = 58", ""),
      section(
          workshop, "fig23/above_top_z72.png", field, 2, 72, "Above the top, z = 72",
          "All voxels are neighbours here, of the body 12 voxels below, and the zone is smaller.")};
  for (std::size_t n = 0; n < text.size(); ++n) {
    Pass as_text = text[n], as_caption = caption[n];
    as_text.name = "as the text: 32, 25, 20, 17, 15, 13";
    as_caption.name = "as the caption: 32, 20, 13, 11, 10, 9";
    outcome.figures.push_back(chart(
        workshop, fmt::format("fig23/drag_{}.svg", text[n].name.substr(4)),
        drag_chart({as_text, as_caption}, "x [voxels]"), "Drag along " + text[n].name + ", z = 40",
        n == 0 ? "Past two lips of a concavity, the left one nearer."
               : "Into the body: its skin has 100."));
  }
  outcome.data = {write_passes(workshop, "fig23/coding_of_the_text.csv", text),
                  write_passes(workshop, "fig23/coding_of_the_caption.csv", caption)};
  return outcome;
}

// --------------------------------------------------------------------------------------- fig. 24

std::vector<Pass> same_track_at_speeds(const ViscosityField& field,
                                       const ViscosityField& distances) {
  std::vector<Pass> passes;
  for (const double speed : {0.25, 0.5, 1.0}) {
    passes.push_back(
        walk(along_y(fmt::format("{:g} m/s", speed), cone_axis + cone_base_radius, 10, 120, speed),
             field, distances));
  }
  return passes;
}

std::vector<Check> check_fig24(const std::vector<Pass>& by_speed) {
  double off = 0;
  const Pass& fastest = by_speed.back();
  for (const Pass& pass : by_speed) {
    for (std::size_t n = 0; n < pass.samples.size() && n < fastest.samples.size(); ++n) {
      off = std::max(off, std::abs(pass.samples[n].force_W.norm() / pass.speed -
                                   fastest.samples[n].force_W.norm() / fastest.speed));
    }
  }
  // What a faster move adds, near the cone and in the outermost layer.
  double added_near = 0, added_far = INFINITY;
  const std::vector<TraceSample>& slow = by_speed.front().samples;
  for (std::size_t n = 0; n < std::min(slow.size(), fastest.samples.size()); ++n) {
    const double added = fastest.samples[n].force_W.norm() - slow[n].force_W.norm();
    if (fastest.samples[n].mu == 0) continue;
    added_near = std::max(added_near, added);
    added_far = std::min(added_far, added);
  }
  return {{"faster moves meet more drag", fmt::format("peaks {} N", listed(peaks_of(by_speed))),
           std::ranges::is_sorted(peaks_of(by_speed)) &&
               by_speed.front().peak() < by_speed.back().peak()},
          {"drag is in proportion to speed",
           fmt::format("drag over speed differs by {:.1g} N·s/m at most", off), off < 1e-9},
          {"speed adds more in closer vicinity",
           fmt::format("{:.3g} N nearest to the cone, {:.3g} N in the outermost layer", added_near,
                       added_far),
           added_near > added_far},
          viscosity_tells_distance(by_speed, text_coding, 4),
          force_is_drag(by_speed)};
}

Outcome fig24(Workshop& workshop) {
  const Part part = cone();
  const ViscosityField field = workshop.field(part, {});
  const std::vector<Pass> passes = same_track_at_speeds(field, workshop.distances(part, 32));
  Outcome outcome{.checks = check_fig24(passes), .figures = {}};
  outcome.figures = {chart(workshop, "fig24/drag_by_speed.svg", drag_chart(passes, "y [voxels]"),
                           "The same track at three speeds",
                           "Beside the cone at z = 10, through the second layer.")};
  outcome.data = {write_passes(workshop, "fig24/drag_by_speed.csv", passes)};
  return outcome;
}

}  // namespace vicinity::report
