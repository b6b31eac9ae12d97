// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "protocol.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace vicinity::viewer {
namespace {

constexpr std::size_t header_bytes = 8;
// One part of a shell is about a megabyte: a page draws the first while others come.
constexpr std::size_t quads_in_part = 65'536;

bool is_known(std::uint16_t type) {
  return type >= static_cast<std::uint16_t>(CommandType::drive) &&
         type <= static_cast<std::uint16_t>(CommandType::rate);
}

Error wrong_length(const char* what, std::size_t found, std::size_t expected) {
  return Error({.where = what,
                .what = "the message has another length",
                .found = fmt::format("{} bytes", found),
                .expected = fmt::format("{} bytes", expected)});
}

void put_vectors(ByteWriter& writer, std::initializer_list<const AxisVector*> vectors) {
  for (const AxisVector* each : vectors) {
    writer.put_all(std::span<const double>(each->data(), static_cast<std::size_t>(each->size())));
  }
}

}  // namespace

ByteWriter::ByteWriter(MessageType type, std::uint32_t id) {
  put(static_cast<std::uint16_t>(type));
  put(protocol_version);
  put(id);
}

void ByteWriter::pad_to(std::size_t multiple) {
  bytes_.append((multiple - bytes_.size() % multiple) % multiple, '\0');
}

void ByteWriter::put_vector(const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) put(static_cast<float>(v[axis]));
}

void ByteWriter::put_pose(const Pose& X) {
  put_vector(X.translation());
  const Eigen::Quaterniond turn(X.linear());
  for (const double each : {turn.x(), turn.y(), turn.z(), turn.w()}) put(static_cast<float>(each));
}

std::uint32_t command_id(std::string_view message) noexcept {
  std::uint32_t id = 0;
  if (message.size() >= header_bytes) std::memcpy(&id, message.data() + 4, sizeof id);
  return id;
}

Command read_command(std::string_view message) {
  Command command{.message = message};
  const auto type = command.number<std::uint16_t>(0), version = command.number<std::uint16_t>(2);
  if (!type || !version || message.size() < header_bytes) {
    throw Error({.what = "a message is shorter than its header",
                 .found = fmt::format("{} bytes", message.size()),
                 .expected = "8 or more"});
  }
  if (*version != protocol_version) {
    throw Error({.what = "the page speaks another version of the protocol",
                 .found = std::to_string(*version),
                 .expected = std::to_string(protocol_version),
                 .hint = "loading the page again"});
  }
  if (!is_known(*type)) {
    throw Error({.what = "there is no such command", .found = std::to_string(*type)});
  }
  command.type = static_cast<CommandType>(*type);
  command.id = command_id(message);
  return command;
}

Drive read_drive(const Command& command, std::size_t joints) {
  constexpr std::size_t fixed = 16;
  Drive drive;
  drive.q = AxisVector::Zero(static_cast<Eigen::Index>(joints));
  const auto mode = command.number<std::uint8_t>(8);
  if (!mode || *mode > static_cast<std::uint8_t>(DriveMode::joints)) {
    throw Error({.where = "drive", .what = "there is no such mode", .expected = "0, 1 or 2"});
  }
  drive.mode = static_cast<DriveMode>(*mode);
  const std::size_t numbers = drive.mode == DriveMode::tool     ? 7
                              : drive.mode == DriveMode::joints ? joints
                                                                : 0;
  const std::size_t least = fixed + 8 * numbers;
  if (command.message.size() < least ||
      (drive.mode == DriveMode::joints && command.number<std::uint16_t>(10) != joints)) {
    throw wrong_length("drive", command.message.size(), least);
  }
  const auto at = [&](std::size_t n) { return *command.number<double>(fixed + 8 * n); };
  if (drive.mode == DriveMode::tool) {
    drive.orientation_counts = command.number<std::uint8_t>(9) == std::uint8_t{1};
    drive.p_WT = {at(0), at(1), at(2)};
    drive.R_WT = Eigen::Quaterniond(at(6), at(3), at(4), at(5));
  } else if (drive.mode == DriveMode::joints) {
    for (std::size_t n = 0; n < joints; ++n) drive.q[static_cast<Eigen::Index>(n)] = at(n);
  }
  return drive;
}

nlohmann::json read_json(const Command& command) {
  const auto json = nlohmann::json::parse(command.payload(), nullptr, false);
  if (!json.is_object()) throw Error({.what = "the command is not a JSON object"});
  return json;
}

SharedBytes json_message(MessageType type, std::uint32_t id, const nlohmann::ordered_json& json) {
  ByteWriter writer(type, id);
  // Names of files may hold what is no UTF-8.
  writer.put_text(json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  return std::move(writer).done();
}

SharedBytes error_message(std::uint32_t id, const Error& error) {
  const ErrorParts& parts = error.parts();
  nlohmann::ordered_json json{{"sentence", error.what()}};
  const auto add = [&](const char* key, const std::string& text) {
    if (!text.empty()) json[key] = text;
  };
  add("where", parts.where);
  add("what", parts.what);
  add("found", parts.found);
  add("expected", parts.expected);
  add("hint", parts.hint);
  return json_message(MessageType::error, id, json);
}

SharedBytes error_message(std::uint32_t id, const std::string& sentence) {
  return json_message(MessageType::error, id, {{"sentence", sentence}});
}

SharedBytes points_message(const PointsMessage& points) {
  ByteWriter writer(MessageType::points, 0);
  writer.put(static_cast<std::uint32_t>(points.links.size()));
  writer.put(points.all);
  writer.put_all(points.links);
  writer.put_all(points.p_LR);
  writer.put_all(points.areas);
  writer.put_all(points.points);
  return std::move(writer).done();
}

SharedBytes snapshot_message(const Snapshot& s) {
  ByteWriter writer(MessageType::snapshot, 0);
  const std::size_t n = static_cast<std::size_t>(s.q.size()), l = s.links.size();
  const std::size_t p = s.points.size();
  writer.reserve(264 + 24 * n + 28 * l + 16 * p + 4 * s.histogram.size());
  writer.put(s.generation);
  writer.put(s.number);
  writer.put(s.time_s);
  for (const std::uint64_t count : {s.ticks, s.skipped, s.missed, s.refused}) writer.put(count);
  for (const std::size_t size : {n, l, p, s.histogram.size()}) {
    writer.put(static_cast<std::uint16_t>(size));
  }
  const Output& out = s.output;
  writer.put(static_cast<std::uint8_t>(out.status));
  writer.put(static_cast<std::uint8_t>(s.drive));
  writer.put(s.limiter_mode);
  writer.put(static_cast<std::uint8_t>(out.limiter.limit));
  writer.put(static_cast<std::uint8_t>(out.limiter.status));
  writer.put(static_cast<std::uint8_t>(out.energy.passive ? 1 : 0));
  writer.put(static_cast<std::uint16_t>(std::min<std::uint32_t>(out.counts.points_felt, 65'535)));
  writer.put(out.energy.drag);
  writer.put(out.energy.device);
  writer.put(out.energy.lowest);
  writer.put(out.energy.unaccounted);

  const auto single = [&](double value) { writer.put(static_cast<float>(value)); };
  writer.put_vector(out.tool.force);
  writer.put_vector(out.tool.moment);
  writer.put_pose(s.tool);
  writer.put_vector(s.v_WT);
  single(out.master_force);
  single(out.power);
  single(s.scale);
  single(out.limiter.asked);
  single(out.limiter.given);
  single(s.felt);
  single(s.lag);
  double highest = 0;
  for (const PointDrag& point : s.points) highest = std::max(highest, point.mu_e);
  single(highest);
  writer.put_vector(s.pulled_to);
  const Reason& reason = out.reason;
  for (const int each :
       {reason.point, reason.link, reason.object, static_cast<int>(reason.kind), reason.rank}) {
    writer.put(static_cast<std::int32_t>(each));
  }
  single(reason.share);
  single(reason.distance_m);
  single(reason.time_to_contact_s);
  for (const float each : {s.last_second.p50_us, s.last_second.p99_us, s.last_second.largest_us,
                           s.last_second.latest_us}) {
    writer.put(each);
  }
  single(s.recording_s);

  put_vectors(writer, {&s.q, &s.qd, &out.torque});
  for (const Pose& X_WL : s.links) writer.put_pose(X_WL);
  for (const PointDrag& point : s.points) single(point.mu_e);
  for (const PointDrag& point : s.points) writer.put_vector(point.force_W);
  writer.put_all(s.histogram);
  return std::move(writer).done();
}

SharedBytes mesh_message(std::uint32_t id, std::uint32_t generation, MeshOf of, MeshDetail detail,
                         std::uint16_t index, const TriangleMesh& mesh) {
  ByteWriter writer(MessageType::mesh, id);
  writer.reserve(24 + 12 * (mesh.vertices.size() + mesh.triangles.size()));
  writer.put(generation);
  writer.put(static_cast<std::uint8_t>(of));
  writer.put(static_cast<std::uint8_t>(detail));
  writer.put(index);
  writer.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  writer.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Vec3& vertex : mesh.vertices) writer.put_vector(vertex);
  for (const auto& triangle : mesh.triangles) writer.put_all(triangle);
  return std::move(writer).done();
}

std::vector<SharedBytes> shell_messages(std::uint32_t id, std::uint32_t generation,
                                        const Shells& shells, std::uint16_t rank) {
  const std::span<const Quad> quads = shells.by_rank[rank];
  const std::size_t parts =
      std::max<std::size_t>(1, (quads.size() + quads_in_part - 1) / quads_in_part);
  std::vector<SharedBytes> messages;
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * quads_in_part;
    const auto these = quads.subspan(begin, std::min(quads_in_part, quads.size() - begin));
    ByteWriter writer(MessageType::shell, id);
    writer.reserve(32 + these.size_bytes());
    writer.put(generation);
    writer.put(rank);
    writer.put(static_cast<std::uint16_t>(shells.step));
    writer.put(static_cast<std::uint32_t>(part));
    writer.put(static_cast<std::uint32_t>(parts));
    writer.put(static_cast<std::uint32_t>(these.size()));
    writer.put(std::uint32_t{0});
    writer.put_all(these);
    messages.push_back(std::move(writer).done());
  }
  return messages;
}

SharedBytes slice_message(std::uint32_t id, std::uint32_t generation, int axis,
                          const SliceCodes& slice, std::size_t code_count) {
  const bool narrow = code_count <= 256;
  ByteWriter writer(MessageType::slice, id);
  writer.reserve(40 + 2 * slice.codes.size());
  writer.put(generation);
  writer.put(static_cast<std::uint8_t>(axis));
  writer.put(static_cast<std::uint8_t>(narrow ? 1 : 2));
  writer.put(static_cast<std::uint16_t>(slice.step));
  writer.put(slice.index);
  writer.put(slice.width);
  writer.put(slice.height);
  writer.put(std::uint32_t{0});
  writer.put(slice.where);
  if (narrow) {
    for (const VoxelCode code : slice.codes) writer.put(static_cast<std::uint8_t>(code));
  } else {
    writer.put_all(slice.codes);
  }
  return std::move(writer).done();
}

}  // namespace vicinity::viewer
