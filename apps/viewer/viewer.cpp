// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "viewer.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "hello.h"
#include "page_files.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/placement.h"

namespace vicinity::viewer {
namespace {

// Commands that wait: of one page, and of all.
constexpr int most_of_one = 64;
constexpr std::size_t most_of_all = 1024;
constexpr int snapshots_per_s = 60;

std::vector<bool> non_empty(const std::vector<TriangleMesh>& meshes) {
  std::vector<bool> any;
  for (const TriangleMesh& mesh : meshes) any.push_back(!mesh.triangles.empty());
  return any;
}

std::string text_of(const std::filesystem::path& path) {
  std::string text(std::filesystem::file_size(path), '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return text;
}

// Deeper than any command; a tree that is copied and written by recursion must not be deeper.
constexpr int deepest_json = 32;

bool nests_too_deep(std::string_view text) {
  int depth = 0;
  bool quoted = false;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    if (quoted) {
      if (c == '\\') ++n;
      if (c == '"') quoted = false;
    } else if (c == '"') {
      quoted = true;
    } else if (c == '[' || c == '{') {
      if (++depth > deepest_json) return true;
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
  return false;
}

bool is_slow(CommandType type) {
  return type == CommandType::shell || type == CommandType::mesh ||
         type == CommandType::open_recording || type == CommandType::save_field;
}

bool has_json(CommandType type) {
  return type >= CommandType::feel && type <= CommandType::save_field;
}

}  // namespace

Viewer::Viewer(ViewerArm arm, Workplace workplace, const std::filesystem::path& folder,
               const std::vector<std::filesystem::path>& recordings)
    : arm_(std::move(arm)),
      folder_(folder),
      own_device_(arm_.words.device),
      loop_({.robot = arm_.robot,
             .points = arm_.points,
             .X_WB = arm_.X_WB,
             .rate = arm_.rate,
             .q = arm_.q},
            workplace.field, workplace.generation, feel_options(arm_.like, arm_.words)),
      words_(arm_.words),
      allowed_meshes_(mesh_paths(workplace.document.scene)),
      quick_(std::in_place, most_of_all),
      slow_(std::in_place, most_of_all) {
  workplace_ = std::make_shared<const Workplace>(std::move(workplace));
  for (const auto& path : recordings) recordings_.emplace_back(path.filename().string(), path);
  robot_json_ = robot_json({.robot = arm_.robot,
                            .X_WB = arm_.X_WB,
                            .tool_link = loop_.tool_link(),
                            .probe = arm_.probe,
                            .points = arm_.points.count(),
                            .points_shown = loop_.shown().size(),
                            .remarks = arm_.remarks,
                            .has_mesh = non_empty(arm_.link_meshes)});
}

Viewer::~Viewer() { stop(); }

void Viewer::stop() {
  stopping_.store(true);
  quick_.reset();
  slow_.reset();
  if (builder_.joinable()) builder_.join();
}

Viewer::WorkplacePointer Viewer::workplace() const {
  const std::lock_guard lock(state_);
  return workplace_;
}

// Files of the page, and nothing of this machine: what is not in the table is not there.
std::optional<HttpResponse> Viewer::page_file(std::string_view path) {
  const std::string_view name = path == "/" ? "/index.html" : path;
  for (const PageFile& file : page_files()) {
    if (file.path != name) continue;
    return HttpResponse{.type = std::string(content_type(name)),
                        .body = std::make_shared<const std::string>(file.bytes)};
  }
  if (path == "/") {
    return sentence(200,
                    "This vicinity was built without its page: npm was not there. What the page "
                    "speaks is served all the same, at /ws.");
  }
  return {};
}

void Viewer::file_wanted(ClientId connection, const std::string& name) {
  const bool taken = slow_->add([this, connection, name] {
    HttpResponse response = sentence(404, "there is no such file");
    try {
      const std::filesystem::path path = folder_.any(name);
      std::error_code error;
      if (std::filesystem::is_regular_file(path, error)) {
        response = {.type = std::string(content_type(name)),
                    .body = std::make_shared<const std::string>(text_of(path))};
      }
    } catch (const Error& refused) {
      response = sentence(400, refused.what());
    } catch (const std::bad_alloc&) {
      response = sentence(500, "there is too little memory for that file");
    } catch (const std::exception& failed) {
      response = sentence(500, failed.what());
    }
    server_->respond(connection, std::move(response));
  });
  if (!taken) server_->respond(connection, sentence(429, "too much is waiting"));
}

std::variant<std::filesystem::path, HttpResponse> Viewer::upload_begins(const std::string& name) {
  try {
    if (name.ends_with(".yaml") || name.ends_with(".yml") || name.ends_with(".vicinity")) {
      return sentence(400, "only meshes and recordings can be uploaded");
    }
    (void)folder_.any(name);  // refuses a name that is none
    return folder_.scratch();
  } catch (const Error& error) {
    return sentence(400, error.what());
  }
}

void Viewer::upload_came(ClientId connection, const std::string& name,
                         const std::filesystem::path& file) {
  const bool taken = slow_->add([this, connection, name, file] {
    HttpResponse response;
    try {
      response = store_upload(name, file);
    } catch (const Error& error) {
      response = sentence(400, error.what());
    } catch (const std::exception& error) {
      response = sentence(500, error.what());
    }
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    const bool stored = response.status == 201;
    server_->respond(connection, std::move(response));
    if (stored) tell_files();
  });
  if (taken) return;
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  server_->respond(connection, sentence(429, "too much is waiting"));
}

HttpResponse Viewer::store_upload(const std::string& name, const std::filesystem::path& file) {
  const std::filesystem::path at = folder_.any(name);
  // Readers go by the ending.
  const std::filesystem::path named = file.string() + at.extension().string();
  std::filesystem::rename(file, named);
  struct Removed {
    const std::filesystem::path& path;
    ~Removed() {
      std::error_code ignored;
      std::filesystem::remove(path, ignored);
    }
  } const removed{named};
  nlohmann::ordered_json json{{"name", name}};
  if (at.parent_path().filename() == "recordings") {
    (void)read_recorded(named, name, arm_.robot);
    json["recording"] = name;
  } else {
    const TriangleMesh mesh = read_mesh(named);
    const MeshInspection found = inspect(mesh);
    json["mesh"] = "meshes/" + name;
    json["triangles"] = found.triangles;
    json["closed"] = found.closed;
    json["verdict"] = to_string(found.verdict);
    json["problems"] = nlohmann::ordered_json::array();
    for (const MeshProblem& problem : found.problems) {
      json["problems"].push_back(
          {{"what", problem.what}, {"count", problem.count}, {"means", problem.means}});
    }
    const Vec3 size = found.bounds.sizes();
    json["size"] = {size.x(), size.y(), size.z()};
    json["readings"] = size_in_units(found.bounds);
  }
  folder_.place(named, at);
  return {.status = 201,
          .type = "application/json",
          .body = std::make_shared<const std::string>(json.dump())};
}

void Viewer::opened(ClientId client) {
  const bool taken = quick_->add([this, client] {
    const std::lock_guard change(changing_);  // or a newer HELLO may overtake this one
    server_->send(client, hello_message());
    server_->send(client, points_message());
    server_->set_rate(client, snapshots_per_s);
  });
  if (!taken) server_->send(client, error_message(0, "too much is waiting; load the page again"));
}

void Viewer::closed(ClientId client) {
  {
    const std::lock_guard lock(state_);
    waiting_.erase(client);
  }
  // A page that is gone no longer pulls.
  if (client != driver_) return;
  driver_ = 0;
  Drive hold;
  hold.q = AxisVector::Zero(arm_.q.size());
  loop_.drive(hold);
}

void Viewer::message(ClientId client, std::string_view payload) {
  try {
    const Command command = read_command(payload);
    if (command.type == CommandType::drive) return drive(client, command);
    if (command.type == CommandType::follow) driver_ = 0;  // from now on no page pulls
    if (has_json(command.type) && nests_too_deep(command.payload())) {
      throw Error({.what = "the command's JSON is nested too deep",
                   .expected = fmt::format("at most {} levels", deepest_json)});
    }
    hand_on(client, std::string(payload));
  } catch (const Error& error) {
    server_->send(client, error_message(command_id(payload), error));
  }
}

void Viewer::drive(ClientId client, const Command& command) {
  if (!loop_.drive(read_drive(command, arm_.robot.coordinates.size()))) {
    throw Error({.where = "drive", .what = "a number is not finite"});
  }
  driver_ = client;
}

void Viewer::hand_on(ClientId client, std::string message) {
  {
    const std::lock_guard lock(state_);
    int& waiting = waiting_[client];
    if (waiting >= most_of_one) {
      throw Error({.what = "too many commands of this page wait for their answer"});
    }
    ++waiting;
  }
  Jobs& jobs = is_slow(read_command(message).type) ? *slow_ : *quick_;
  const bool taken =
      jobs.add([this, client, message = std::move(message), drives = loop_.drives()] {
        {
          const std::lock_guard lock(state_);
          const auto waiting = waiting_.find(client);
          if (waiting != waiting_.end()) --waiting->second;
        }
        answer(client, message, drives);
      });
  if (taken) return;
  {
    const std::lock_guard lock(state_);
    --waiting_[client];
  }
  throw Error({.what = "too many commands wait for their answer"});
}

void Viewer::answer(ClientId client, const std::string& message, std::uint64_t drives_before) {
  Command command = read_command(message);
  command.drives_before = drives_before;
  try {
    (this->*answer_for(command.type))(client, command);
  } catch (const Error& error) {
    server_->send(client, error_message(command.id, error));
  } catch (const std::bad_alloc&) {
    server_->send(client, error_message(command.id, "there is too little memory for that"));
  } catch (const std::exception& error) {
    server_->send(client, error_message(command.id, error.what()));
  }
}

Viewer::Answer Viewer::answer_for(CommandType type) const {
  switch (type) {
    case CommandType::slice:
      return &Viewer::answer_slice;
    case CommandType::shell:
      return &Viewer::answer_shell;
    case CommandType::mesh:
      return &Viewer::answer_mesh;
    case CommandType::pick:
      return &Viewer::answer_pick;
    case CommandType::feel:
      return &Viewer::answer_feel;
    case CommandType::open_recording:
      return &Viewer::answer_open_recording;
    case CommandType::follow:
      return &Viewer::answer_follow;
    case CommandType::build:
      return &Viewer::answer_build;
    case CommandType::save_scene:
      return &Viewer::answer_save_scene;
    case CommandType::open_scene:
      return &Viewer::answer_open_scene;
    case CommandType::save_field:
      return &Viewer::answer_save_field;
    case CommandType::rate:
      return &Viewer::answer_rate;
    case CommandType::list:
    case CommandType::drive:  // has been dealt with
      break;
  }
  return &Viewer::answer_list;
}

SharedBytes Viewer::too_many_messages(std::uint64_t dropped) {
  return error_message(
      0, fmt::format("messages come too fast: {} were dropped since this was last said", dropped));
}

SharedBytes Viewer::text_not_understood() {
  return error_message(0, "messages are binary; this one was text");
}

SharedBytes Viewer::newest_snapshot() {
  return loop_.take_snapshot() ? snapshot_message(loop_.snapshot()) : nullptr;
}

nlohmann::ordered_json Viewer::files() const {
  std::vector<std::string> names;
  for (const auto& [name, path] : recordings_) names.push_back(name);
  return folder_.list(names);
}

void Viewer::tell_files() { server_->broadcast(json_message(MessageType::files, 0, files())); }

void Viewer::tell_done(ClientId client, std::uint32_t id, const nlohmann::ordered_json& json) {
  server_->send(client, json_message(MessageType::done, id, json));
}

SharedBytes Viewer::hello_message() const {
  WorkplacePointer now;
  FeelWords words;
  {
    const std::lock_guard lock(state_);
    now = workplace_;
    words = words_;
  }
  std::vector<std::string> devices;
  for (const Device& device : known_devices()) devices.push_back(device.name);
  if (!own_device_.empty() && std::ranges::find(devices, own_device_) == devices.end()) {
    devices.push_back(own_device_);
  }
  const WebOptions limits;
  return json_message(MessageType::hello, 0,
                      {{"protocol", protocol_version},
                       {"version", VICINITY_VERSION},
                       {"generation", now->generation},
                       {"field", field_json(*now)},
                       {"robot", robot_json_},
                       {"feel", feel_json(words, now->field)},
                       {"scene", scene_json(now->document)},
                       {"files", files()},
                       {"devices", devices},
                       {"memories", {"none", "sustained", "fading", "short", "rising"}},
                       {"codings", {"linear", "nonlinear", "jnd", "paper"}},
                       {"limits",
                        {{"message_bytes", limits.message_bytes},
                         {"upload_bytes", limits.upload_bytes},
                         {"commands_per_s", limits.messages_per_s}}}});
}

SharedBytes Viewer::points_message() const {
  PointsMessage points;
  points.all = static_cast<std::uint32_t>(arm_.points.count());
  for (const ArmLoop::ShownPoint& shown : loop_.shown()) {
    points.links.push_back(static_cast<std::uint32_t>(shown.link));
    points.points.push_back(shown.point);
    points.areas.push_back(arm_.points.area[shown.point]);
    for (const auto* axis : {&arm_.points.x, &arm_.points.y, &arm_.points.z}) {
      points.p_LR.push_back((*axis)[shown.point]);
    }
  }
  return viewer::points_message(points);
}

}  // namespace vicinity::viewer
