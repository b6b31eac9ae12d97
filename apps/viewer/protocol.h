// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The viewer's binary protocol, as docs/viewer_protocol.md lays it out: messages into bytes, and
/// commands out of them.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "live/drive.h"
#include "live/snapshot.h"
#include "show/shells.h"
#include "show/slice_codes.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/triangle_mesh.h"
#include "web/outbox.h"

namespace vicinity::viewer {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

inline constexpr std::uint16_t protocol_version = 1;

enum class MessageType : std::uint16_t {
  hello = 1,
  points = 2,
  snapshot = 3,
  mesh = 4,
  shell = 5,
  slice = 6,
  pick = 7,
  feel = 8,
  recording = 9,
  progress = 10,
  scene = 11,
  files = 12,
  done = 13,
  error = 14,
};

enum class CommandType : std::uint16_t {
  drive = 64,
  slice = 65,
  shell = 66,
  mesh = 67,
  pick = 68,
  feel = 69,
  open_recording = 70,
  follow = 71,
  build = 72,
  save_scene = 73,
  open_scene = 74,
  save_field = 75,
  list = 76,
  rate = 77,
};

/// Appends numbers as they lie in memory.
class ByteWriter {
 public:
  ByteWriter(MessageType type, std::uint32_t id);

  template <class T>
  void put(T value) {
    static_assert(std::is_arithmetic_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  template <class Range>
  void put_all(const Range& values) {
    bytes_.append(reinterpret_cast<const char*>(std::data(values)),
                  std::size(values) * sizeof(*std::data(values)));
  }
  void put_text(std::string_view text) { bytes_.append(text); }
  /// Zeros until the size is a multiple of that.
  void pad_to(std::size_t multiple);
  /// x, y, z and a quaternion x, y, z, w, as seven floats.
  void put_pose(const Pose& X);
  /// As three floats.
  void put_vector(const Vec3& v);
  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }

  SharedBytes done() && { return std::make_shared<const std::string>(std::move(bytes_)); }

 private:
  std::string bytes_;
};

/// A command that came: its header, and what follows it.
struct Command {
  CommandType type{};
  std::uint32_t id = 0;
  std::string_view message;         ///< whole: offsets count from its start
  std::uint64_t drives_before = 0;  ///< DRIVEs of all pages that had come when it came

  /// A number at an offset; nothing where the message ends before it.
  template <class T>
  std::optional<T> number(std::size_t offset) const {
    if (message.size() < sizeof(T) || offset > message.size() - sizeof(T)) return {};
    T value;
    std::memcpy(&value, message.data() + offset, sizeof value);
    return value;
  }
  std::string_view payload() const { return message.substr(8); }
};

/// Errors: throws Error for a message that is shorter than its header, of another version, or of
/// no known type.
Command read_command(std::string_view message);

/// The id, where there is one; else 0.
std::uint32_t command_id(std::string_view message) noexcept;

/// Of DRIVE. @param joints  that the robot has
/// Errors: throws Error for a mode that is none, and for a length that does not fit it.
Drive read_drive(const Command& command, std::size_t joints);

/// The JSON of a command. Errors: throws Error for what is no JSON object.
nlohmann::json read_json(const Command& command);

SharedBytes json_message(MessageType type, std::uint32_t id, const nlohmann::ordered_json& json);
SharedBytes error_message(std::uint32_t id, const Error& error);
SharedBytes error_message(std::uint32_t id, const std::string& sentence);

/// @param shown  indices of the points shown, their links, positions and areas
struct PointsMessage {
  std::uint32_t all = 0;
  std::vector<std::uint32_t> links;
  std::vector<float> p_LR;  ///< three for each
  std::vector<float> areas;
  std::vector<std::uint32_t> points;
};
SharedBytes points_message(const PointsMessage& points);

SharedBytes snapshot_message(const Snapshot& snapshot);

/// What a MESH is of, and what became of it. The numbers are those of the protocol.
enum class MeshOf : std::uint8_t { object = 0, link = 1 };
enum class MeshDetail : std::uint8_t { whole = 0, simplified = 1, none = 2 };
SharedBytes mesh_message(std::uint32_t id, std::uint32_t generation, MeshOf of, MeshDetail detail,
                         std::uint16_t index, const TriangleMesh& mesh);

/// The parts of one shell.
std::vector<SharedBytes> shell_messages(std::uint32_t id, std::uint32_t generation,
                                        const Shells& shells, std::uint16_t rank);

/// @param code_count  of the field's records: one byte a code is enough up to 256
SharedBytes slice_message(std::uint32_t id, std::uint32_t generation, int axis,
                          const SliceCodes& slice, std::size_t code_count);

}  // namespace vicinity::viewer
