// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "browser.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "vicinity/geometry/error.h"

namespace vicinity::viewer {
namespace {

constexpr int longest_answer_ms = 300'000;

Error trouble(const std::string& what, const std::string& found = {}) {
  return Error({.where = "the browser", .what = what, .found = found});
}

std::filesystem::path new_profile() {
  std::string name = (std::filesystem::temp_directory_path() / "vicinity_browser_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr)
    throw trouble("no folder for its profile", std::strerror(errno));
  return name;
}

}  // namespace

Browser::Browser(const std::filesystem::path& program) : profile_(new_profile()) {
  int down[2], up[2];
  if (pipe2(down, O_CLOEXEC) != 0 || pipe2(up, O_CLOEXEC) != 0) {
    throw trouble("no pipe to it", std::strerror(errno));
  }
  to_ = down[1];
  from_ = up[0];
  std::vector<std::string> words = {
      program.string(), "--headless=new", "--remote-debugging-pipe",
      "--user-data-dir=" + profile_.string(), "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync", "--hide-scrollbars", "--mute-audio",
      // Draws by the processor where there is no graphics card.
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
      "--disable-gpu-rasterization", "about:blank"};
  // Its sandbox cannot be set up by root, as in a container; the page it opens is our own.
  if (geteuid() == 0) words.insert(words.begin() + 1, "--no-sandbox");
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  // It reads from 3 and writes to 4. Neither pipe end may be overwritten before it is moved.
  const int in = fcntl(down[0], F_DUPFD, 10), out = fcntl(up[1], F_DUPFD, 10);
  posix_spawn_file_actions_adddup2(&actions, in, 3);
  posix_spawn_file_actions_adddup2(&actions, out, 4);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  const int failed = posix_spawn(&process_, argv[0], &actions, &attributes, argv.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  for (const int end : {in, out, down[0], up[1]}) ::close(end);
  if (failed != 0) {
    process_ = -1;
    throw trouble("cannot be started", std::strerror(failed));
  }
}

Browser::~Browser() {
  if (to_ >= 0) ::close(to_);
  if (from_ >= 0) ::close(from_);
  if (process_ > 0) {
    ::kill(-process_, SIGKILL);  // with all its children
    while (waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  std::error_code ignored;
  std::filesystem::remove_all(profile_, ignored);
}

void Browser::open(const std::string& address, int width, int height) {
  const auto target = call("Target.createTarget", {{"url", "about:blank"}});
  const auto attached =
      call("Target.attachToTarget", {{"targetId", target.at("targetId")}, {"flatten", true}});
  session_ = attached.at("sessionId").get<std::string>();
  call("Runtime.enable", nlohmann::json::object());
  call("Page.enable", nlohmann::json::object());
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  call("Page.navigate", {{"url", address}});
}

nlohmann::json Browser::call(const std::string& method, const nlohmann::json& parameters) {
  nlohmann::json command{{"id", ++calls_}, {"method", method}, {"params", parameters}};
  if (!session_.empty()) command["sessionId"] = session_;
  std::string text = command.dump();
  text += '\0';
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = ::write(to_, text.data() + sent, text.size() - sent);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw trouble("has ended");
    sent += static_cast<std::size_t>(count);
  }
  while (true) {
    const nlohmann::json message = read_message();
    if (!message.contains("id")) {
      hear(message);
    } else if (message["id"] == calls_) {
      if (message.contains("error")) throw trouble("refused " + method, message["error"].dump());
      return message.value("result", nlohmann::json::object());
    }
  }
}

nlohmann::json Browser::evaluate(const std::string& expression) {
  const auto result =
      call("Runtime.evaluate", {{"expression", expression}, {"returnByValue", true}});
  return result.at("result").value("value", nlohmann::json());
}

// Messages end with a zero byte.
nlohmann::json Browser::read_message() {
  const auto until =
      std::chrono::steady_clock::now() + std::chrono::milliseconds(longest_answer_ms);
  while (true) {
    if (const std::size_t end = read_.find('\0'); end != std::string::npos) {
      auto message = nlohmann::json::parse(read_.substr(0, end), nullptr, false);
      read_.erase(0, end + 1);
      if (message.is_object()) return message;
      continue;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        until - std::chrono::steady_clock::now());
    pollfd ready{.fd = from_, .events = POLLIN, .revents = 0};
    const int count = ::poll(&ready, 1, static_cast<int>(std::max<std::int64_t>(0, left.count())));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw trouble("does not answer");
    char buffer[65'536];
    const ssize_t got = ::read(from_, buffer, sizeof buffer);
    if (got <= 0) throw trouble("has ended");
    read_.append(buffer, static_cast<std::size_t>(got));
  }
}

void Browser::hear(const nlohmann::json& event) {
  const std::string method = event.value("method", "");
  const auto parameters = event.value("params", nlohmann::json::object());
  if (method == "Runtime.consoleAPICalled") {
    std::string line = parameters.value("type", "log") + ":";
    for (const auto& argument : parameters.value("args", nlohmann::json::array())) {
      const auto& value = argument.contains("value") ? argument["value"] : argument;
      line += ' ' + (value.is_string() ? value.get<std::string>() : value.dump());
    }
    console_.push_back(line);
  } else if (method == "Runtime.exceptionThrown") {
    const auto details = parameters.value("exceptionDetails", nlohmann::json::object());
    console_.push_back(
        "exception: " + details.value("text", "") + " " +
        details.value("exception", nlohmann::json::object()).value("description", ""));
  }
}

}  // namespace vicinity::viewer
