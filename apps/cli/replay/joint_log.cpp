// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "replay/joint_log.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <numbers>
#include <optional>
#include <string_view>
#include <utility>

#include "replay/csv_table.h"
#include "replay/log_oddities.h"
#include "replay/log_text.h"
#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"

namespace vicinity::cli {
namespace {

// What a column's unit is turned into.
enum class Quantity { time, angle, length };

struct Unit {
  std::string_view name;
  Quantity quantity;
  double factor;
};

constexpr double degree = std::numbers::pi / 180;
// Of positions; velocities are the same by the second.
constexpr std::array units = {
    Unit{"s", Quantity::time, 1},       Unit{"sec", Quantity::time, 1},
    Unit{"ms", Quantity::time, 1e-3},   Unit{"us", Quantity::time, 1e-6},
    Unit{"µs", Quantity::time, 1e-6},   Unit{"ns", Quantity::time, 1e-9},
    Unit{"rad", Quantity::angle, 1},    Unit{"deg", Quantity::angle, degree},
    Unit{"°", Quantity::angle, degree}, Unit{"m", Quantity::length, 1},
    Unit{"cm", Quantity::length, 1e-2}, Unit{"mm", Quantity::length, 1e-3},
};

// "Time [ms]" -> "Time" and "ms".
struct HeaderName {
  explicit HeaderName(std::string_view cell) : name(cell) {
    if (cell.empty() || (cell.back() != ']' && cell.back() != ')')) return;
    const std::size_t open = cell.rfind(cell.back() == ']' ? '[' : '(');
    if (open == std::string_view::npos || open == 0) return;
    unit = cell.substr(open + 1, cell.size() - open - 2);
    name = cell.substr(0, open);
    name = name.substr(0, name.find_last_not_of(' ') + 1);
  }
  std::string_view name, unit;
};

struct Source {
  std::size_t column = 0;
  double factor = 1;
};

// Finds the columns of one log's header.
class Columns {
 public:
  Columns(std::string where, const std::vector<std::string>& header, const ColumnMap& map)
      : where_(std::move(where)), header_(header), map_(map) {}

  // The column of a quantity that the map names, or else of the first of these names there is.
  std::optional<Source> find(const std::string& quantity, Quantity kind, bool velocity,
                             const std::vector<std::string>& names) const {
    const auto stated = map_.find(quantity);
    if (stated == map_.end()) {
      for (const std::string& name : names) {
        if (const auto column = index_of(name)) {
          return Source{*column, unit_of(*column, kind, velocity)};
        }
      }
      return std::nullopt;
    }
    const auto column = index_of(stated->second.name);
    if (!column)
      refuse(quantity, "the log has no column '" + stated->second.name + "'", stated->second.name);
    const auto& factor = stated->second.factor;
    return Source{*column, factor ? *factor : unit_of(*column, kind, velocity)};
  }

  [[noreturn]] void refuse(const std::string& quantity, const std::string& what,
                           const std::string& wanted) const {
    std::vector<std::string> free;
    std::ranges::copy_if(header_, std::back_inserter(free), [&](const std::string& cell) {
      return quantity == "t" || !is_time(cell);
    });
    const std::string nearest = nearest_word(wanted, free);
    throw Error({.where = where_,
                 .what = what,
                 .found = "columns " + list_of_columns(),
                 .hint = nearest.empty() ? "--columns " + quantity + "=COLUMN"
                                         : "--columns " + quantity + "=" + nearest});
  }

 private:
  bool is_time(const std::string& cell) const {
    const std::string name(HeaderName(cell).name);
    const auto stated = map_.find("t");
    if (stated == map_.end()) return name == "t" || name == "time";
    return cell == stated->second.name || name == stated->second.name;
  }

  std::optional<std::size_t> index_of(const std::string& wanted) const {
    std::optional<std::size_t> found;
    for (std::size_t n = 0; n < header_.size(); ++n) {
      if (header_[n] != wanted && HeaderName(header_[n]).name != wanted) continue;
      if (found) {
        throw Error({.where = where_,
                     .what = "two columns have the name '" + wanted + "'",
                     .found = fmt::format("columns {} and {}", *found + 1, n + 1)});
      }
      found = n;
    }
    return found;
  }

  double unit_of(std::size_t column, Quantity kind, bool velocity) const {
    const HeaderName cell(header_[column]);
    std::string_view unit = cell.unit;
    if (unit.empty()) return 1;
    if (velocity && unit.ends_with("/s")) unit.remove_suffix(2);
    std::vector<std::string> fitting;
    for (const Unit& known : units) {
      if (known.quantity != kind) continue;
      if (unit == known.name) return known.factor;
      fitting.push_back(std::string(known.name) + (velocity ? "/s" : ""));
    }
    throw Error({.where = where_,
                 .what = fmt::format("the unit of column '{}' does not fit", header_[column]),
                 .found = fmt::format("'{}'", cell.unit),
                 .expected = fmt::format("one of {}", fmt::join(fitting, ", ")),
                 .hint = "a factor in --columns"});
  }

  std::string list_of_columns() const {
    constexpr std::size_t most = 12;
    const std::size_t shown = std::min(header_.size(), most);
    return fmt::format(
        "{}{}", fmt::join(header_.begin(), header_.begin() + shown, ", "),
        shown < header_.size() ? fmt::format(" and {} more", header_.size() - shown) : "");
  }

  std::string where_;
  const std::vector<std::string>& header_;
  const ColumnMap& map_;
};

struct Sources {
  Source time;
  std::vector<Source> positions, velocities;  // velocities: none, or one for each joint
};

void refuse_unknown_quantities(const ColumnMap& map, const std::vector<std::string>& joints) {
  std::vector<std::string> known = {"t"};
  for (const std::string& joint : joints) {
    known.push_back(joint);
    known.push_back("qd_" + joint);
  }
  for (const auto& [quantity, column] : map) {
    if (std::ranges::count(known, quantity) > 0) continue;
    throw Error({.where = "--columns",
                 .what = "there is no such quantity",
                 .found = "'" + quantity + "'",
                 .expected = fmt::format("t, {}, or qd_ and a joint", fmt::join(joints, ", ")),
                 .hint = nearest_word(quantity, known)});
  }
}

Sources sources_of(const Columns& columns, const RobotModel& robot,
                   const std::vector<std::string>& joints) {
  Sources sources;
  const auto time = columns.find("t", Quantity::time, false, {"t", "time"});
  if (!time) columns.refuse("t", "the log has no column 't' or 'time'", "time");
  sources.time = *time;
  for (std::size_t c = 0; c < joints.size(); ++c) {
    const Joint& joint = robot.joints[static_cast<std::size_t>(robot.coordinates[c])];
    const Quantity kind = joint.type == JointType::prismatic ? Quantity::length : Quantity::angle;
    const auto position = columns.find(joints[c], kind, false, {joints[c]});
    if (!position) {
      columns.refuse(joints[c], "the log has no column for joint '" + joints[c] + "'", joints[c]);
    }
    sources.positions.push_back(*position);
    const std::string velocity = "qd_" + joints[c];
    if (const auto source = columns.find(velocity, kind, true, {velocity})) {
      sources.velocities.push_back(*source);
    }
  }
  if (!sources.velocities.empty() && sources.velocities.size() != joints.size()) {
    throw Error({.where = "--columns",
                 .what = "velocities are of use for all joints or none",
                 .found = fmt::format("{} of {}", sources.velocities.size(), joints.size())});
  }
  return sources;
}

// Cells that nobody named; empty ones, as a comma at the end of a line leaves them, do no harm. A
// decimal comma would be read as two numbers.
void refuse_cells_too_many(const std::string& where, const CsvTable& table,
                           const CsvTable::Line& line) {
  const std::size_t named = table.header().size();
  std::size_t filled = line.cells.size();
  while (filled > named && line.cells[filled - 1].empty()) --filled;
  if (filled <= named) return;
  throw Error({.where = fmt::format("{}:{}", where, line.number),
               .what = "the line is too long: a decimal comma?",
               .found = fmt::format("{} cells where the header has {}", filled, named),
               .hint = "decimal points, or semicolons between the cells"});
}

double number_in(const std::string& where, const CsvTable& table, const CsvTable::Line& line,
                 const Source& source) {
  const auto refuse = [&](const std::string& what, const std::string& found) {
    throw Error({.where = fmt::format("{}:{}", where, line.number), .what = what, .found = found});
  };
  if (source.column >= line.cells.size()) {
    refuse("the line is too short", fmt::format("{} cells where the header has {}",
                                                line.cells.size(), table.header().size()));
  }
  std::string_view cell = line.cells[source.column];
  const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
  double number = 0;
  const auto [rest, error] = std::from_chars(digits.begin(), digits.end(), number);
  if (error != std::errc() || rest != digits.end() || !std::isfinite(number)) {
    refuse(fmt::format("column '{}' holds no finite number", table.header()[source.column]),
           fmt::format("'{}'", cell));
  }
  return number * source.factor;
}

}  // namespace

JointLog read_joint_log(const std::filesystem::path& path, const RobotModel& robot,
                        const ColumnMap& columns) {
  const std::string where = path.string();
  std::vector<std::string> joints;
  for (const int joint : robot.coordinates) {
    joints.push_back(robot.joints[static_cast<std::size_t>(joint)].name);
  }
  refuse_unknown_quantities(columns, joints);
  LogText text = read_log_text(path);
  CsvTable table(where, std::move(text.csv));
  const Sources sources = sources_of(Columns(where, table.header(), columns), robot, joints);

  JointLog log;
  log.remarks = std::move(text.remarks);
  std::vector<double> q, qd;
  std::vector<std::size_t> lines;
  for (CsvTable::Line line; table.next(line);) {
    refuse_cells_too_many(where, table, line);
    const double t = number_in(where, table, line, sources.time);
    if (!log.t.empty() && !(t > log.t.back())) {
      throw Error({.where = fmt::format("{}:{}", where, line.number),
                   .what = "time does not rise",
                   .found = fmt::format("{} s after {} s", t, log.t.back())});
    }
    log.t.push_back(t);
    lines.push_back(line.number);
    for (const Source& source : sources.positions)
      q.push_back(number_in(where, table, line, source));
    for (const Source& source : sources.velocities) {
      qd.push_back(number_in(where, table, line, source));
    }
  }
  if (log.t.size() < 2) {
    throw Error({.where = where,
                 .what = "a motion needs at least two samples",
                 .found = fmt::format("{}", log.t.size())});
  }
  const auto samples = static_cast<Eigen::Index>(log.t.size());
  const auto count = static_cast<Eigen::Index>(joints.size());
  log.q = Eigen::Map<const Eigen::MatrixXd>(q.data(), count, samples);
  if (!qd.empty()) log.qd = Eigen::Map<const Eigen::MatrixXd>(qd.data(), count, samples);
  unwrap_continuous_joints(robot, log);
  remark_on_times(lines, sources.time.factor != 1, log);
  remark_on_motion(robot, log);
  return log;
}

}  // namespace vicinity::cli
