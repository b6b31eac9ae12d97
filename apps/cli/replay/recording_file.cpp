// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/recording_file.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/csv_cell.h"
#include "fresh_file.h"
#include "replay/mcap_recording.h"

namespace vicinity::cli {
namespace {

enum class Format { csv, json_lines };

// Words are made ready for the format once, not for every line.
struct Words {
  std::vector<std::string> torques, positions, links, objects, statuses;
};

std::string ready(const std::string& word, Format format) {
  return format == Format::csv ? csv_cell(word) : nlohmann::json(word).dump();
}

Words words_of(const RobotModel& robot, const ViscosityField& field, Format format) {
  Words words;
  for (std::size_t c = 0; c < robot.coordinates.size(); ++c) {
    words.torques.push_back(ready("tau_" + joint_name(robot, c), format));
    words.positions.push_back(ready("q_" + joint_name(robot, c), format));
  }
  for (const Link& link : robot.links) words.links.push_back(ready(link.name, format));
  for (const FieldObject& object : field.objects()) {
    words.objects.push_back(ready(object.name, format));
  }
  for (int status = 0; status <= static_cast<int>(Status::not_passive); ++status) {
    words.statuses.push_back(ready(to_string(static_cast<Status>(status)), format));
  }
  return words;
}

// Writes one line after the other, piece by piece: "name":value, or value.
class Lines {
 public:
  Lines(Format format, const Words& words) : format_(format), words_(words) {}

  std::string& text() { return text_; }

  void header() {
    text_ = "t";
    for (const std::string& torque : words_.torques) text_ += "," + torque;
    text_ +=
        ",fx,fy,fz,mx,my,mz,master_force,status,reason_link,reason_object,reason_rank,"
        "reason_distance_mm";
    for (const std::string& position : words_.positions) (text_ += ',') += position;
    text_ += '\n';
  }

  void line(const TickRecord& tick, double t, std::span<const double> torque,
            std::span<const double> position) {
    first_ = true;
    if (format_ == Format::json_lines) text_ += '{';
    value("\"t\"", fmt::format("{}", t));
    for (std::size_t c = 0; c < torque.size(); ++c) number(words_.torques[c], torque[c]);
    number("\"fx\"", tick.tool.force.x());
    number("\"fy\"", tick.tool.force.y());
    number("\"fz\"", tick.tool.force.z());
    number("\"mx\"", tick.tool.moment.x());
    number("\"my\"", tick.tool.moment.y());
    number("\"mz\"", tick.tool.moment.z());
    number("\"master_force\"", tick.master_force);
    value("\"status\"", words_.statuses[static_cast<std::size_t>(tick.status)]);
    reason(tick.reason);
    for (std::size_t c = 0; c < position.size(); ++c) number(words_.positions[c], position[c]);
    text_ += format_ == Format::json_lines ? "}\n" : "\n";
  }

 private:
  void value(std::string_view name, std::string_view words) {
    if (!first_) text_ += ',';
    first_ = false;
    if (format_ == Format::json_lines) {
      text_ += name;
      text_ += ':';
    }
    text_ += words;
  }
  // Ten digits, as in a trace; no "-0".
  void number(std::string_view name, double x) { value(name, fmt::format("{:.10g}", x + 0.0)); }

  void reason(const Reason& reason) {
    const std::string nothing = format_ == Format::csv ? "" : "null";
    const bool felt = reason.link >= 0, known = felt && reason.object >= 0;
    value("\"reason_link\"", felt ? words_.links[static_cast<std::size_t>(reason.link)] : nothing);
    value("\"reason_object\"",
          known ? words_.objects[static_cast<std::size_t>(reason.object)] : nothing);
    value("\"reason_rank\"", known ? std::to_string(reason.rank) : nothing);
    value("\"reason_distance_mm\"",
          known ? fmt::format("{:.6g}", 1000 * reason.distance_m) : nothing);
  }

  Format format_;
  const Words& words_;
  std::string text_;
  bool first_ = true;
};

void write_mcap(const Recording& recording, const Arm& arm, const ViscosityField& field,
                double t_start, FreshFile& file) {
  McapRecording out([&](std::string_view bytes) { file.write(bytes); }, arm.robot,
                    object_names(field), arm.teleoperation.tool_link);
  for (std::size_t k = 0; k < recording.ticks().size(); ++k) {
    const TickRecord& tick = recording.ticks()[k];
    out.add(nanoseconds(t_start + tick.time_s), recording.position(k), recording.torque(k),
            tick.tool, tick.master_force, tick.reason, arm.X_WB, to_string(tick.status),
            FeltMessages::level_of(tick.status));
  }
  out.file().finish();
  file.commit();
}

}  // namespace

bool is_mcap(const std::filesystem::path& path) { return path.extension() == ".mcap"; }

void write_recording(const Recording& recording, const Arm& arm, const ViscosityField& field,
                     double t_start, const std::filesystem::path& path) {
  FreshFile file(path);
  if (is_mcap(path)) return write_mcap(recording, arm, field, t_start, file);
  constexpr std::size_t piece = std::size_t{1} << 20;
  const Format format = path.extension() == ".jsonl" ? Format::json_lines : Format::csv;
  const Words words = words_of(arm.robot, field, format);
  Lines lines(format, words);
  if (format == Format::csv) lines.header();
  for (std::size_t k = 0; k < recording.ticks().size(); ++k) {
    const TickRecord& tick = recording.ticks()[k];
    lines.line(tick, t_start + tick.time_s, recording.torque(k), recording.position(k));
    if (lines.text().size() < piece) continue;
    file.write(lines.text());
    lines.text().clear();
  }
  file.write(lines.text());
  file.commit();
}

}  // namespace vicinity::cli
