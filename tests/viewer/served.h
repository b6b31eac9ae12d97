// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// The small scene and the small arm, served on a port of the loopback address.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "viewer.h"
#include "web/web_server.h"
#include "web_client.h"

namespace vicinity::viewer_test {

/// A folder that goes with the test.
class ScratchFolder {
 public:
  ScratchFolder();
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const noexcept { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

/// A box of 0.2 x 0.1 x 0.1 m and a ball beside it, as a scene file.
extern const char* const scene_text;

class Served {
 public:
  explicit Served(const viewer::WebOptions& options = {});
  ~Served();

  std::uint16_t port() const noexcept { return server_->port(); }
  viewer::WebServer& server() noexcept { return *server_; }
  viewer::Viewer& site() noexcept { return *viewer_; }
  const ViscosityField& field() const noexcept { return field_; }
  const RobotModel& robot() const noexcept { return robot_; }
  const ScratchFolder& folder() const noexcept { return folder_; }

 private:
  ScratchFolder folder_;
  ViscosityField field_;
  RobotModel robot_;
  std::unique_ptr<viewer::Viewer> viewer_;
  std::unique_ptr<viewer::WebServer> server_;
  std::thread serving_;
};

nlohmann::json json_of(const PageClient::Message& message);

/// Resident memory of this process [bytes].
std::uint64_t resident_bytes();

}  // namespace vicinity::viewer_test
