// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "recorded.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <string_view>

#include "protocol.h"
#include "replay/arm.h"
#include "replay/csv_table.h"
#include "replay/log_text.h"
#include "vicinity/geometry/error.h"
#include "vicinity/robot/forward_kinematics.h"

namespace vicinity::viewer {
namespace {

constexpr std::size_t most_rows = 20'000, most_frames = 2'000, most_columns = 256;
constexpr double nothing = std::numeric_limits<double>::quiet_NaN();

double number_in(std::string_view cell) {
  double value = nothing;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() ? value : nothing;
}

/// Which columns a file has.
struct Header {
  std::optional<std::size_t> t, status, link, object;
  std::vector<std::size_t> numbers;
};

Header header_of(const cli::CsvTable& table, const std::string& where) {
  Header header;
  const std::vector<std::string>& names = table.header();
  if (names.size() > most_columns) {
    throw Error({.where = where,
                 .what = "too many columns for a recording",
                 .found = std::to_string(names.size()),
                 .expected = fmt::format("at most {}", most_columns)});
  }
  for (std::size_t n = 0; n < names.size(); ++n) {
    if (names[n] == "t" || names[n] == "time") {
      header.t = n;
    } else if (names[n] == "status") {
      header.status = n;
    } else if (names[n] == "reason_link") {
      header.link = n;
    } else if (names[n] == "reason_object") {
      header.object = n;
    } else {
      header.numbers.push_back(n);
    }
  }
  if (!header.t) {
    throw Error({.where = where,
                 .what = "not a recording: it has no column of time",
                 .expected = "a column 't' or 'time' [s], as vicinity replay -o writes it"});
  }
  return header;
}

/// Every row as it stands, thinned out while it is read.
struct Rows {
  struct Row {
    double t = 0;
    std::vector<double> values;
    std::string status, link, object;
  };
  std::vector<Row> rows;
  std::size_t in_file = 0;
};

Rows read_rows(cli::CsvTable& table, const Header& header, const std::string& where) {
  Rows read;
  std::size_t every = 1;
  double last_t = -std::numeric_limits<double>::infinity();
  cli::CsvTable::Line line;
  for (; table.next(line); ++read.in_file) {
    const auto cell = [&](std::size_t n) {
      return n < line.cells.size() ? line.cells[n] : std::string_view{};
    };
    const auto word = [&](const std::optional<std::size_t>& n) {
      return n ? std::string(cell(*n)) : std::string();
    };
    const double t = number_in(cell(*header.t));
    if (!std::isfinite(t) || t <= last_t) {
      throw Error({.where = fmt::format("{}, line {}", where, line.number),
                   .what = "time must rise",
                   .found = std::string(cell(*header.t))});
    }
    last_t = t;
    if (read.in_file % every != 0) continue;
    Rows::Row row{.t = t,
                  .values = {},
                  .status = word(header.status),
                  .link = word(header.link),
                  .object = word(header.object)};
    for (const std::size_t n : header.numbers) row.values.push_back(number_in(cell(n)));
    read.rows.push_back(std::move(row));
    if (read.rows.size() <= most_rows) continue;
    for (std::size_t n = 0; 2 * n < read.rows.size(); ++n) {
      if (n > 0) read.rows[n] = std::move(read.rows[2 * n]);
    }
    read.rows.resize((read.rows.size() + 1) / 2);
    every *= 2;
  }
  if (read.rows.size() < 2) {
    throw Error({.where = where, .what = "a recording needs two rows at least"});
  }
  return read;
}

void add_changes(const Rows& rows, const Header& header, Recorded& recorded) {
  const auto column = [&](std::string_view name) {
    return static_cast<std::size_t>(std::ranges::find(recorded.columns, name) -
                                    recorded.columns.begin());
  };
  const std::size_t rank = column("reason_rank"), distance = column("reason_distance_mm");
  const auto value = [&](std::size_t n, std::size_t row) {
    return n < recorded.values.size() ? recorded.values[n][row] : nothing;
  };
  for (std::size_t n = 0; n < rows.rows.size(); ++n) {
    const Rows::Row& row = rows.rows[n];
    if (header.status &&
        (recorded.statuses.empty() || recorded.statuses.back().status != row.status)) {
      recorded.statuses.push_back({n, row.status});
    }
    if (!header.link) continue;
    Recorded::ReasonChange reason{n, row.link, row.object, value(rank, n), value(distance, n)};
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    const auto unchanged = [&](const Recorded::ReasonChange& last) {
      return last.link == reason.link && last.object == reason.object &&
             same(last.rank, reason.rank) && same(last.distance_mm, reason.distance_mm);
    };
    if (recorded.reasons.empty() || !unchanged(recorded.reasons.back())) {
      recorded.reasons.push_back(std::move(reason));
    }
  }
}

std::optional<cli::JointLog> motion_of(const Recorded& recorded, const RobotModel& robot) {
  const auto joints = static_cast<Eigen::Index>(robot.coordinates.size());
  cli::JointLog log{.t = recorded.t,
                    .q = Eigen::MatrixXd(joints, static_cast<Eigen::Index>(recorded.t.size())),
                    .qd = {}};
  for (Eigen::Index c = 0; c < joints; ++c) {
    const std::string& name = cli::joint_name(robot, static_cast<std::size_t>(c));
    auto found = std::ranges::find(recorded.columns, "q_" + name);
    if (found == recorded.columns.end()) found = std::ranges::find(recorded.columns, name);
    if (found == recorded.columns.end()) return {};
    const auto& values =
        recorded.values[static_cast<std::size_t>(found - recorded.columns.begin())];
    log.q.row(c) = Eigen::Map<const Eigen::VectorXd>(values.data(), log.q.cols());
  }
  return log.q.allFinite() ? std::optional(std::move(log)) : std::nullopt;
}

nlohmann::ordered_json json_of(const Recorded& recorded, std::uint32_t number) {
  nlohmann::ordered_json json{{"name", recorded.name},
                              {"recording", number},
                              {"duration", recorded.t.back()},
                              {"rows", recorded.rows_in_file},
                              {"columns", recorded.columns}};
  json["status"] = nlohmann::ordered_json::array();
  for (const auto& change : recorded.statuses) {
    json["status"].push_back(nlohmann::ordered_json::array({change.status, change.row}));
  }
  json["reasons"] = nlohmann::ordered_json::array();
  for (const auto& change : recorded.reasons) {
    const auto text = [](const std::string& word) {
      return word.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(word);
    };
    // NaN becomes null.
    json["reasons"].push_back(nlohmann::ordered_json::array(
        {change.row, text(change.link), text(change.object), change.rank, change.distance_mm}));
  }
  return json;
}

}  // namespace

Recorded read_recorded(const std::filesystem::path& path, const std::string& name,
                       const RobotModel& robot) {
  cli::CsvTable table(name, cli::read_log_text(path).csv);
  const Header header = header_of(table, name);
  const Rows rows = read_rows(table, header, name);
  Recorded recorded;
  recorded.name = name;
  recorded.rows_in_file = rows.in_file;
  for (const std::size_t n : header.numbers) recorded.columns.push_back(table.header()[n]);
  recorded.values.resize(recorded.columns.size());
  for (const Rows::Row& row : rows.rows) {
    recorded.t.push_back(row.t - rows.rows.front().t);
    for (std::size_t n = 0; n < row.values.size(); ++n) recorded.values[n].push_back(row.values[n]);
  }
  add_changes(rows, header, recorded);
  recorded.motion = motion_of(recorded, robot);
  return recorded;
}

SharedBytes recorded_message(std::uint32_t id, const Recorded& recorded, std::uint32_t number,
                             const RobotModel& robot, const Pose& X_WB) {
  const std::string json =
      json_of(recorded, number)
          .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  const std::size_t rows = recorded.t.size();
  const std::size_t frames = recorded.motion ? std::min(rows, most_frames) : 0;
  ByteWriter writer(MessageType::recording, id);
  writer.reserve(64 + json.size() + 8 * rows * (1 + recorded.columns.size()) +
                 frames * (8 + 28 * robot.links.size()));
  for (const std::size_t size : {json.size(), rows, frames, robot.links.size()}) {
    writer.put(static_cast<std::uint32_t>(size));
  }
  writer.put_text(json);
  writer.pad_to(8);
  writer.put_all(recorded.t);
  for (const auto& column : recorded.values) writer.put_all(column);
  const auto row_of = [&](std::size_t frame) {
    return frames < 2 ? 0 : frame * (rows - 1) / (frames - 1);
  };
  for (std::size_t f = 0; f < frames; ++f) writer.put(recorded.t[row_of(f)]);
  ForwardKinematics kinematics(robot);
  const Eigen::VectorXd rest =
      Eigen::VectorXd::Zero(static_cast<Eigen::Index>(robot.coordinates.size()));
  for (std::size_t f = 0; f < frames; ++f) {
    const Eigen::VectorXd q = recorded.motion->q.col(static_cast<Eigen::Index>(row_of(f)));
    kinematics.update(q.data(), rest.data(), X_WB);
    for (std::size_t link = 0; link < robot.links.size(); ++link) {
      writer.put_pose(kinematics.X_WL(link));
    }
  }
  return std::move(writer).done();
}

}  // namespace vicinity::viewer
