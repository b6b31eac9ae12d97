// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace vicinity::cli_test {

const char* const small_scene = R"(voxel_size: 0.01
defaults: {m: 2, q: 3, coding: [30, 20, 10]}
objects:
  - name: block
    primitive: {box: {size: [0.2, 0.1, 0.1]}}
  - name: ball
    primitive: {sphere: {radius: 0.05}}
    pose: {xyz: [0.22, 0, 0]}
)";

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "vicinity_cli_XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
  path_ = name;
}

Folder::~Folder() { std::filesystem::remove_all(path_); }

std::filesystem::path Folder::write(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name, std::ios::binary) << text;
  return path_ / name;
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_)) {
    names.push_back(entry.path().filename().string());
  }
  std::ranges::sort(names);
  return names;
}

namespace {

pid_t spawn(const std::filesystem::path& folder, const std::vector<std::string>& arguments,
            const std::string& in, const std::string& out, const std::string& err) {
  std::vector<std::string> words = {VICINITY_PROGRAM};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, in.c_str(), O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addopen(&actions, 2, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t process = -1;
  const int failed = posix_spawn(&process, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed != 0) throw std::runtime_error("the program could not be started");
  return process;
}

}  // namespace

Answer Folder::run(const std::vector<std::string>& arguments,
                   const std::string& standard_input) const {
  const Folder streams;
  const std::string in = streams.write("in", standard_input).string();
  const std::string out = (streams / "out").string(), err = (streams / "err").string();
  const int code = wait_for(spawn(path_, arguments, in, out, err));
  return {code, text_of(out), text_of(err)};
}

pid_t Folder::start(const std::vector<std::string>& arguments) const {
  return spawn(path_, arguments, "/dev/null", "/dev/null", "/dev/null");
}

int wait_for(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace vicinity::cli_test
