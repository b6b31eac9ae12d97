// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

// The commands of pages, one function each.

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>

#include "fresh_file.h"
#include "hello.h"
#include "pick.h"
#include "show/simplified.h"
#include "show/slice_codes.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/placement.h"
#include "vicinity/viscosity/build_field.h"
#include "vicinity/viscosity/field_file.h"
#include "viewer.h"

namespace vicinity::viewer {
namespace {

constexpr int usual_slice_side = 1024, largest_slice_side = 4096;
// A shell that a page asked for without a step, and the finest that it may ask for.
constexpr double usual_faces = 400'000, most_faces = 6'000'000;
constexpr std::size_t most_triangles = 100'000;
constexpr std::size_t most_recordings = 32;
constexpr double fastest_playing = 20;
constexpr auto progress_period = std::chrono::milliseconds(50);

template <class T>
T needed(const std::optional<T>& number) {
  if (!number) throw Error({.what = "the message is too short for its command"});
  return *number;
}

const std::string& name_in(const nlohmann::json& json) {
  if (!json.contains("name") || !json["name"].is_string()) {
    throw Error({.what = "the command has no name", .expected = "\"name\": \"...\""});
  }
  return json["name"].get_ref<const std::string&>();
}

double number_in(const nlohmann::json& json, const char* key, double otherwise) {
  if (!json.contains(key)) return otherwise;
  if (!json[key].is_number() || !std::isfinite(json[key].get<double>())) {
    throw Error({.where = key, .what = "not a finite number"});
  }
  return json[key].get<double>();
}

bool truth_in(const nlohmann::json& json, const char* key, bool otherwise) {
  if (!json.contains(key)) return otherwise;
  if (!json[key].is_boolean()) throw Error({.where = key, .what = "not true or false"});
  return json[key].get<bool>();
}

// Keys stay in the order of the page.
nlohmann::ordered_json scene_in(const Command& command) {
  auto json = nlohmann::ordered_json::parse(command.payload(), nullptr, false);
  if (!json.is_object() || !json.contains("scene") || !json["scene"].is_object()) {
    throw Error({.what = "the command has no scene", .expected = "\"scene\": {...}"});
  }
  return json["scene"];
}

nlohmann::ordered_json report_json(const BuildReport& report) {
  return {{"report",
           {{"seconds", report.seconds.total},
            {"boundary", report.boundary},
            {"inner", report.inner},
            {"neighbour", report.neighbour},
            {"remarks", report.remarks}}}};
}

}  // namespace

void Viewer::answer_slice(ClientId client, const Command& command) {
  const int axis = needed(command.number<std::uint8_t>(8));
  const int side = needed(command.number<std::uint16_t>(10));
  const double where = needed(command.number<double>(16));
  if (axis > 2) throw Error({.where = "slice", .what = "there is no such axis"});
  const WorkplacePointer now = workplace();
  const int most = side == 0 ? usual_slice_side : std::min(side, largest_slice_side);
  const SliceCodes slice = slice_codes(now->field, axis, where, most);
  server_->send(
      client, slice_message(command.id, now->generation, axis, slice, now->field.records().size()));
}

void Viewer::answer_shell(ClientId client, const Command& command) {
  const std::uint16_t rank = needed(command.number<std::uint16_t>(8));
  const int asked = needed(command.number<std::uint16_t>(10));
  const WorkplacePointer now = workplace();
  if (shown_generation_ != now->generation) shells_.clear();
  shown_generation_ = now->generation;
  const int finest = step_for(now->field, most_faces), usual = step_for(now->field, usual_faces);
  constexpr int coarsest = 1 << 15;  // its number has 16 bits
  const int wanted =
      std::min(static_cast<int>(std::bit_ceil(static_cast<unsigned>(asked))), coarsest);
  const int step = asked == 0 ? usual : std::max(finest, wanted);
  auto& shells = shells_[step];
  if (shells == nullptr) {
    shells = std::make_shared<const Shells>(shells_of(now->field, step));
    // The usual one, and the one that was asked for last.
    std::erase_if(shells_,
                  [&](const auto& each) { return each.first != step && each.first != usual; });
  }
  const auto& found = shells_.at(step);
  if (rank >= found->by_rank.size()) {
    throw Error({.where = "shell",
                 .what = "there is no such rank",
                 .found = std::to_string(rank),
                 .expected = fmt::format("0 to {}", found->by_rank.size() - 1)});
  }
  for (const SharedBytes& part : shell_messages(command.id, now->generation, *found, rank)) {
    server_->send(client, part);
  }
}

TriangleMesh Viewer::object_mesh(const Workplace& now, std::size_t object) const {
  if (now.scene == nullptr) return {};
  const std::string& name = now.field.objects()[object].name;
  const auto found = std::ranges::find_if(
      now.scene->objects, [&](const SceneObject& each) { return each.name == name; });
  if (found == now.scene->objects.end()) return {};
  const auto* const file = std::get_if<MeshFile>(&found->shape);
  if (file == nullptr) {
    return place(std::get<TriangleMesh>(found->shape), found->scale, found->X_WO);
  }
  return place(read_mesh(file->path), found->scale * metres_per(*file->units), found->X_WO);
}

void Viewer::answer_mesh(ClientId client, const Command& command) {
  const auto of = static_cast<MeshOf>(needed(command.number<std::uint8_t>(8)));
  const std::uint16_t index = needed(command.number<std::uint16_t>(10));
  const WorkplacePointer now = workplace();
  const std::size_t count =
      of == MeshOf::object ? now->field.objects().size() : arm_.link_meshes.size();
  if (of > MeshOf::link || index >= count) {
    throw Error({.where = "mesh",
                 .what = "there is no such object or link",
                 .found = std::to_string(index)});
  }
  const TriangleMesh whole =
      of == MeshOf::object ? object_mesh(*now, index) : arm_.link_meshes[index];
  const TriangleMesh shown = simplified(whole, most_triangles);
  const MeshDetail detail = shown.triangles.empty() ? MeshDetail::none
                            : shown.triangles.size() < whole.triangles.size()
                                ? MeshDetail::simplified
                                : MeshDetail::whole;
  server_->send(client, mesh_message(command.id, now->generation, of, detail, index, shown));
}

void Viewer::answer_pick(ClientId client, const Command& command) {
  const Vec3 p_W(needed(command.number<double>(8)), needed(command.number<double>(16)),
                 needed(command.number<double>(24)));
  if (!p_W.allFinite()) throw Error({.where = "pick", .what = "the point is not finite"});
  server_->send(client,
                json_message(MessageType::pick, command.id, pick_json(workplace()->field, p_W)));
}

void Viewer::answer_feel(ClientId client, const Command& command) {
  const nlohmann::json json = read_json(command);
  const std::lock_guard change(changing_);
  const WorkplacePointer now = workplace();
  const FeelWords words = feel_words(words_, json, own_device_);
  Workplace next = *now;
  next.field = now->field.with_codings(codings_from(json, now->field, now->original));
  if (words == words_) {
    loop_.recode(next.field);
  } else {
    loop_.feel(next.field, next.generation, feel_options(arm_.like, words));
  }
  const auto feel = feel_json(words, next.field);
  {
    const std::lock_guard lock(state_);
    workplace_ = std::make_shared<const Workplace>(std::move(next));
    words_ = words;
  }
  tell_done(client, command.id, nlohmann::ordered_json::object());
  server_->broadcast(json_message(MessageType::feel, 0, feel));
}

void Viewer::answer_open_recording(ClientId client, const Command& command) {
  const std::string name = name_in(read_json(command));
  std::filesystem::path path;
  for (const auto& [known, at] : recordings_) {
    if (known == name) path = at;
  }
  if (path.empty()) path = folder_.recording(name);
  const auto recorded = std::make_shared<const Recorded>(read_recorded(path, name, arm_.robot));
  std::uint32_t number = 0;
  {
    const std::lock_guard lock(state_);
    // Numbers go on; what was opened long ago is closed.
    opened_recordings_.push_back(recorded);
    number = static_cast<std::uint32_t>(opened_recordings_.size());
    if (opened_recordings_.size() > most_recordings) {
      opened_recordings_[opened_recordings_.size() - most_recordings - 1].reset();
    }
  }
  server_->send(client, recorded_message(command.id, *recorded, number, arm_.robot, arm_.X_WB));
}

void Viewer::answer_follow(ClientId client, const Command& command) {
  const nlohmann::json json = read_json(command);
  if (!json.contains("recording") || json["recording"].is_null()) {
    loop_.follow(nullptr, command.drives_before);
    return tell_done(client, command.id, nlohmann::ordered_json::object());
  }
  std::shared_ptr<const Recorded> recorded;
  const double number = number_in(json, "recording", 0);
  {
    const std::lock_guard lock(state_);
    if (number >= 1 && number <= static_cast<double>(opened_recordings_.size())) {
      recorded = opened_recordings_[static_cast<std::size_t>(number) - 1];
    }
  }
  if (recorded == nullptr) {
    throw Error(
        {.where = "follow", .what = "no such recording is open", .hint = "opening it first"});
  }
  if (!recorded->motion) {
    throw Error({.where = recorded->name,
                 .what = "holds no joint positions, so that no arm can follow it",
                 .expected = "a column q_JOINT or JOINT for every joint",
                 .hint = "vicinity replay -o, which writes them"});
  }
  auto following = std::make_unique<Following>(
      Following{.trajectory = cli::JointTrajectory(*recorded->motion),
                .time_s = std::clamp(number_in(json, "time", 0), 0.0, recorded->t.back()),
                .speed = std::clamp(number_in(json, "speed", 1), -fastest_playing, fastest_playing),
                .loop = truth_in(json, "loop", false),
                .playing = truth_in(json, "playing", true)});
  loop_.follow(std::move(following), command.drives_before);
  tell_done(client, command.id, nlohmann::ordered_json::object());
}

void Viewer::answer_build(ClientId client, const Command& command) {
  SceneDocument document{.name = {}, .scene = scene_in(command), .robot = nullptr};
  const nlohmann::json json = read_json(command);
  if (json.contains("name")) document.name = name_in(json);
  if (building_.exchange(true)) {
    throw Error({.where = "build", .what = "a field is being built", .hint = "waiting for it"});
  }
  if (builder_.joinable()) builder_.join();
  auto work = [this, client, id = command.id, document = std::move(document)] {
    const auto fails = [&](SharedBytes why) {
      building_.store(false);
      server_->send(client, std::move(why));
    };
    try {
      build(client, id, document);
    } catch (const Error& error) {
      fails(error_message(id, error));
    } catch (const std::bad_alloc&) {
      fails(error_message(id,
                          "there is too little memory for that field; a larger voxel_size or "
                          "smaller bounds help"));
    } catch (const std::exception& error) {
      fails(error_message(id, error.what()));
    }
  };
  try {
    builder_ = std::thread(std::move(work));
  } catch (...) {  // no thread is to be had
    building_.store(false);
    throw;
  }
}

void Viewer::build(ClientId client, std::uint32_t id, const SceneDocument& document) {
  std::set<std::string> allowed;
  {
    const std::lock_guard lock(state_);
    allowed = allowed_meshes_;
  }
  auto scene = std::make_shared<const Scene>(scene_of(document.scene, folder_.path(), allowed));
  auto last_said = std::chrono::steady_clock::now() - progress_period;
  BuildOptions options;
  options.progress = [&](std::string_view stage, double done) {
    if (stopping_.load()) throw Error({.what = "the server is stopping"});
    const auto now = std::chrono::steady_clock::now();
    if (now < last_said + progress_period) return;
    last_said = now;
    server_->broadcast(
        json_message(MessageType::progress, 0, {{"stage", std::string(stage)}, {"done", done}}));
  };
  BuildResult built = build_field(*scene, options);
  const std::lock_guard change(changing_);
  Workplace next = *workplace();
  ++next.generation;
  next.original = next.field = built.field;
  next.document.scene = document.scene;
  next.document.name = document.name;
  next.name = document.name.empty() ? "the scene" : document.name;
  next.scene = scene;
  loop_.feel(next.field, next.generation, feel_options(arm_.like, words_));
  {
    const std::lock_guard lock(state_);
    workplace_ = std::make_shared<const Workplace>(std::move(next));
  }
  building_.store(false);  // before the page hears of it, which may ask for the next one at once
  tell_done(client, id, report_json(built.report));
  server_->broadcast(hello_message());
  server_->broadcast(points_message());
}

void Viewer::answer_save_scene(ClientId client, const Command& command) {
  const std::string name = name_in(read_json(command));
  const std::filesystem::path path = folder_.scene(name);
  SceneDocument document;
  document.scene = scene_in(command);
  std::set<std::string> allowed;
  {
    const std::lock_guard lock(state_);
    allowed = allowed_meshes_;
    document.robot = workplace_->document.robot;
  }
  (void)scene_of(document.scene, folder_.path(),
                 allowed);  // refuses what could not be opened again
  document.scene.erase("robot");
  (void)folder_.scratch();  // the folder is there now
  cli::FreshFile file(path);
  file.write("# Saved by vicinity serve.\n");
  file.write(yaml_of(document));
  file.commit();
  tell_done(client, command.id, {{"name", name}});
  tell_files();
}

void Viewer::answer_open_scene(ClientId client, const Command& command) {
  const std::string name = name_in(read_json(command));
  const SceneDocument document = read_document(folder_.scene(name), folder_.path());
  const std::set<std::string> paths = mesh_paths(document.scene);
  {
    const std::lock_guard lock(state_);
    allowed_meshes_.insert(paths.begin(), paths.end());
  }
  server_->send(client, json_message(MessageType::scene, command.id, scene_json(document)));
}

void Viewer::answer_save_field(ClientId client, const Command& command) {
  const std::string name = name_in(read_json(command));
  const std::filesystem::path path = folder_.field(name);
  (void)folder_.scratch();  // the folder is there now
  const WorkplacePointer now = workplace();
  save_field(now->field, path);
  tell_done(client, command.id, {{"name", name}, {"bytes", now->field.image().size()}});
  tell_files();
}

void Viewer::answer_list(ClientId client, const Command& command) {
  server_->send(client, json_message(MessageType::files, command.id, files()));
}

void Viewer::answer_rate(ClientId client, const Command& command) {
  server_->set_rate(client, needed(command.number<std::uint16_t>(8)));
  tell_done(client, command.id, nlohmann::ordered_json::object());
}

}  // namespace vicinity::viewer
