// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The viewer: answers every page, with the arm ticking beside it.
///
///   web server's thread   takes messages; answers nothing that takes time
///     drive ------------> arm loop (1 kHz, its own thread) --> newest snapshot, to all pages
///     quick commands ---> one thread: slices, picks, feel, scenes
///     slow commands ----> one thread: shells, meshes, recordings, uploads
///     build ------------> a thread of its own, one at a time
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <unordered_map>
#include <utility>
#include <vector>

#include "feel_words.h"
#include "folder.h"
#include "jobs.h"
#include "live/arm_loop.h"
#include "protocol.h"
#include "recorded.h"
#include "show/shells.h"
#include "web/site.h"
#include "web/web_server.h"
#include "workplace.h"

namespace vicinity::viewer {

/// The arm that is shown, and how it feels at first.
struct ViewerArm {
  RobotModel robot;
  BodyPoints points;
  Pose X_WB = Pose::Identity();
  double rate = 1000;         ///< [Hz]
  TeleoperationOptions like;  ///< what has no word
  FeelWords words;
  AxisVector q;  ///< where it starts
  std::vector<TriangleMesh>
      link_meshes;     ///< for display, in the links' frames; by link, may be empty
  bool probe = false;  ///< no robot was given
  std::vector<std::string> remarks;
};

class Viewer final : public Site {
 public:
  /// Starts the arm's loop. Errors: throws Error for words that do not fit.
  /// @param recordings  beside those in the folder
  Viewer(ViewerArm arm, Workplace workplace, const std::filesystem::path& folder,
         const std::vector<std::filesystem::path>& recordings);
  ~Viewer() override;

  /// By whom it answers; before that server runs, and for as long as it does.
  void answer_by(WebServer& server) noexcept { server_ = &server; }

  /// Ends all work that is under way. After the server has stopped, and before it goes.
  void stop();

  const ArmLoop& loop() const noexcept { return loop_; }

  std::optional<HttpResponse> page_file(std::string_view path) override;
  void file_wanted(ClientId connection, const std::string& name) override;
  std::variant<std::filesystem::path, HttpResponse> upload_begins(const std::string& name) override;
  void upload_came(ClientId connection, const std::string& name,
                   const std::filesystem::path& file) override;
  void opened(ClientId client) override;
  void closed(ClientId client) override;
  void message(ClientId client, std::string_view payload) override;
  SharedBytes too_many_messages(std::uint64_t dropped) override;
  SharedBytes text_not_understood() override;
  SharedBytes newest_snapshot() override;

 private:
  using WorkplacePointer = std::shared_ptr<const Workplace>;
  using Answer = void (Viewer::*)(ClientId, const Command&);

  void drive(ClientId client, const Command& command);
  void hand_on(ClientId client, std::string message);
  void answer(ClientId client, const std::string& message, std::uint64_t drives_before);
  Answer answer_for(CommandType type) const;

  void answer_slice(ClientId client, const Command& command);
  void answer_shell(ClientId client, const Command& command);
  void answer_mesh(ClientId client, const Command& command);
  void answer_pick(ClientId client, const Command& command);
  void answer_feel(ClientId client, const Command& command);
  void answer_open_recording(ClientId client, const Command& command);
  void answer_follow(ClientId client, const Command& command);
  void answer_build(ClientId client, const Command& command);
  void answer_save_scene(ClientId client, const Command& command);
  void answer_open_scene(ClientId client, const Command& command);
  void answer_save_field(ClientId client, const Command& command);
  void answer_list(ClientId client, const Command& command);
  void answer_rate(ClientId client, const Command& command);

  void build(ClientId client, std::uint32_t id, const SceneDocument& document);
  HttpResponse store_upload(const std::string& name, const std::filesystem::path& file);
  TriangleMesh object_mesh(const Workplace& workplace, std::size_t object) const;

  WorkplacePointer workplace() const;
  void show(Workplace workplace);
  void tell_done(ClientId client, std::uint32_t id, const nlohmann::ordered_json& json);
  void tell_files();
  nlohmann::ordered_json files() const;
  SharedBytes hello_message() const;
  SharedBytes points_message() const;

  ViewerArm arm_;
  Folder folder_;
  std::vector<std::pair<std::string, std::filesystem::path>> recordings_;
  nlohmann::ordered_json robot_json_;
  std::string own_device_;
  ArmLoop loop_;
  WebServer* server_ = nullptr;
  std::atomic<bool> stopping_{false};

  mutable std::mutex state_;  ///< guards what follows; held for a copy, never for work
  WorkplacePointer workplace_;
  FeelWords words_;
  std::set<std::string> allowed_meshes_;
  std::vector<std::shared_ptr<const Recorded>> opened_recordings_;
  std::unordered_map<ClientId, int> waiting_;  ///< commands of each client

  std::mutex
      changing_;  ///< held while the field or the feel is changed: one change after the other
  ClientId driver_ = 0;  ///< the web server's thread alone: the page that drove last

  // The slow thread's own.
  std::uint32_t shown_generation_ = 0;
  std::map<int, std::shared_ptr<const Shells>> shells_;

  std::atomic<bool> building_{false};
  std::thread builder_;
  std::optional<Jobs> quick_, slow_;  // absent once it has stopped
};

}  // namespace vicinity::viewer
