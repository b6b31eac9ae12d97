// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "guarded_import.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <assimp/DefaultIOSystem.h>
#include <algorithm>
#include <array>
#include <assimp/Importer.hpp>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "mesh_error.h"
#include "vertex_weld.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

using Clock = std::chrono::steady_clock;

/// What the child says first. A faulting reader can write anything, so the parent checks it all.
struct Announcement {
  static constexpr std::uint64_t right_mark = 0x5649434d45534831u;
  std::uint64_t mark = right_mark;
  std::uint64_t triangles = 0;  // that follow, as nine doubles each
  std::uint64_t complaint = 0;  // bytes of text that follow instead
};
using Corners = std::array<Vec3, 3>;
static_assert(sizeof(Corners) == 9 * sizeof(double));
constexpr std::size_t batch_size = 512;
constexpr std::size_t longest_complaint = 300;

// A child that is split off while another thread holds a lock of the allocator waits for it for
// ever. The C library guards against that. Under sanitizers readers were seen that never got to
// work, in a process of many threads only: there, another moment is tried.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int most_readers = 3;
#else
constexpr int most_readers = 1;
#endif

struct Limits {
  rlim_t cpu_seconds;
  rlim_t bytes;             // of address space, beyond what this process has already
  std::uint64_t triangles;  // a small file may place one mesh many times, but not without end

  explicit Limits(std::size_t file_size)
      : cpu_seconds(2 + (file_size >> 20)),
        bytes((std::size_t{512} << 20) + 64 * file_size),
        triangles(1'000'000 + 8 * file_size) {}

  /// On a busy machine seconds of CPU take longer; this is for a child that sleeps for ever.
  std::chrono::seconds wall_time() const { return std::chrono::seconds(10 * cpu_seconds); }
};

rlim_t address_space_now() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

// ---- In the child ------------------------------------------------------------------------------

void set_limit(decltype(RLIMIT_CPU) resource, rlim_t value) {
  const rlimit limit{value, value};
  setrlimit(resource, &limit);
}

/// Cuts the child off from what the host process has set up: its signal handlers, its streams and
/// its open files, of which only the pipe stays.
/// @return the pipe's new descriptor
int confine(int pipe, const Limits& limits, rlim_t address_space) {
  for (int signal_number = 1; signal_number < NSIG; ++signal_number) {
    std::signal(signal_number, SIG_DFL);
  }
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  constexpr int kept = STDERR_FILENO + 1;
  // The pipe may sit on a standard stream's number, where the host had closed that stream.
  pipe = fcntl(pipe, F_DUPFD, kept);
  const int nowhere = open("/dev/null", O_RDWR);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
  dup2(pipe, kept);
  // Another thread's child may hold our pipe, and we its; a copy left open would hide the end.
  close_range(kept + 1, ~0u, 0);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.cpu_seconds);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  // Sanitizers map terabytes of shadow, which this limit counts.
  set_limit(RLIMIT_AS, address_space + limits.bytes);
#else
  static_cast<void>(address_space);
#endif
  return kept;
}

void send(int pipe, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t sent = write(pipe, at, size);
    if (sent < 0 && errno == EINTR) continue;
    if (sent <= 0) _exit(1);
    at += sent;
    size -= static_cast<std::size_t>(sent);
  }
}

[[noreturn]] void complain(int pipe, std::string text) {
  text.resize(std::min(text.size(), longest_complaint));
  const Announcement announcement{.complaint = text.size()};
  send(pipe, &announcement, sizeof announcement);
  send(pipe, text.data(), text.size());
  _exit(0);
}

Eigen::Matrix4d matrix(const aiMatrix4x4& m) {
  Eigen::Matrix4d result;
  result << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, m.d1, m.d2,
      m.d3, m.d4;
  return result;
}

/// Calls visit(mesh, X) for every mesh below the node, as often as nodes place it.
void for_each_placed_mesh(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& X,
                          const auto& visit) {
  for (unsigned i = 0; i < node.mNumMeshes; ++i) visit(*scene.mMeshes[node.mMeshes[i]], X);
  for (unsigned i = 0; i < node.mNumChildren; ++i) {
    const aiNode& child = *node.mChildren[i];
    for_each_placed_mesh(scene, child, X * matrix(child.mTransformation), visit);
  }
}

/// Calls visit(corners) for every triangle, where the file's nodes place it.
void for_each_triangle(const aiScene& scene, bool keep_root_transform, const auto& visit) {
  const aiNode& root = *scene.mRootNode;
  const Eigen::Matrix4d X_root =
      keep_root_transform ? matrix(root.mTransformation) : Eigen::Matrix4d::Identity();
  for_each_placed_mesh(scene, root, X_root, [&](const aiMesh& mesh, const Eigen::Matrix4d& X) {
    // A mirror turns triangles inside out; walking them the other way turns them back.
    const bool mirrored = X.topLeftCorner<3, 3>().determinant() < 0;
    for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
      const aiFace& face = mesh.mFaces[i];
      if (face.mNumIndices != 3) continue;
      Corners corners;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned index = face.mIndices[mirrored ? 2 - k : k];
        if (index >= mesh.mNumVertices) throw std::out_of_range("a face names a vertex too many");
        const aiVector3D& p = mesh.mVertices[index];
        corners[k] = (X * Eigen::Vector4d(p.x, p.y, p.z, 1)).head<3>();
      }
      visit(corners);
    }
  });
}

/// The mesh's own folder and what lies below it: other files that a mesh names (buffers of a glTF,
/// materials of an OBJ) are looked for nowhere else. A mesh that came from somewhere does not say
/// what is read here.
class OwnFolder final : public Assimp::DefaultIOSystem {
 public:
  explicit OwnFolder(const std::filesystem::path& mesh)
      : folder_(std::filesystem::absolute(mesh).lexically_normal().parent_path()) {}

  bool Exists(const char* file) const override {
    return holds(file) && DefaultIOSystem::Exists(file);
  }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    return holds(file) && std::string_view(mode).starts_with('r')
               ? DefaultIOSystem::Open(file, mode)
               : nullptr;
  }

 private:
  bool holds(const char* file) const {
    const auto within =
        std::filesystem::absolute(file).lexically_normal().lexically_relative(folder_);
    return !within.empty() && *within.begin() != "..";
  }

  std::filesystem::path folder_;
};

[[noreturn]] void import_and_send(int pipe, const std::filesystem::path& path,
                                  std::string_view extension, const Limits& limits) {
  try {
    Assimp::Importer importer;
    importer.SetIOHandler(new OwnFolder(path));  // the importer's from now on
    const aiScene* scene = importer.ReadFile(path.string(), aiProcess_Triangulate);
    if (scene == nullptr || scene->mRootNode == nullptr) complain(pipe, importer.GetErrorString());
    // The root of a DAE or FBX scene has no transform in the file. What assimp puts there is the
    // unit and a turn of the up axis to y; we want the numbers as the file has them.
    const bool keep_root_transform = extension != ".dae" && extension != ".fbx";
    Announcement announcement;
    for_each_triangle(*scene, keep_root_transform,
                      [&](const Corners&) { ++announcement.triangles; });
    if (announcement.triangles > limits.triangles) {
      complain(pipe, fmt::format("{} triangles, more than a file of its size should hold",
                                 announcement.triangles));
    }
    send(pipe, &announcement, sizeof announcement);
    std::vector<Corners> batch;
    batch.reserve(batch_size);
    const auto flush = [&] {
      send(pipe, batch.data(), batch.size() * sizeof(Corners));
      batch.clear();
    };
    for_each_triangle(*scene, keep_root_transform, [&](const Corners& corners) {
      batch.push_back(corners);
      if (batch.size() == batch_size) flush();
    });
    flush();
  } catch (const std::exception& error) {
    complain(pipe, error.what());
  }
  // Neither destructors nor exit handlers: they belong to the process this is a copy of.
  _exit(0);
}

// ---- In this process ---------------------------------------------------------------------------

/// The child and our end of its pipe; both are gone when this goes out of scope.
class Reader {
 public:
  Reader(const std::filesystem::path& path, std::string_view extension, const Limits& limits)
      : deadline_(Clock::now() + limits.wall_time()) {
    const rlim_t address_space = address_space_now();
    std::array<int, 2> ends;
    if (pipe2(ends.data(), O_CLOEXEC) != 0) throw_no_process(path);
    pipe_ = ends[0];
    child_ = fork();
    if (child_ == 0) {
      import_and_send(confine(ends[1], limits, address_space), path, extension, limits);
    }
    close(ends[1]);
    if (child_ < 0) {
      close(pipe_);
      throw_no_process(path);
    }
  }

  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;

  ~Reader() {
    close(pipe_);
    if (child_ > 0) {
      kill(child_, SIGKILL);
      reap(0);
    }
  }

  /// Receives exactly `size` bytes; false at the end of the stream or past the deadline.
  bool receive(void* data, std::size_t size) {
    char* at = static_cast<char*>(data);
    while (size > 0) {
      const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline_ - Clock::now());
      if (left.count() <= 0) return false;
      pollfd ready{pipe_, POLLIN, 0};
      const int polled =
          poll(&ready, 1, static_cast<int>(std::min<std::int64_t>(left.count(), 1000)));
      if (polled == 0 || (polled < 0 && errno == EINTR)) continue;
      const ssize_t got = polled < 0 ? -1 : read(pipe_, at, size);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) return false;
      at += got;
      size -= static_cast<std::size_t>(got);
    }
    return true;
  }

  /// How the child ended, for a sentence about a mesh that did not arrive.
  std::string ending(const Limits& limits) {
    while (child_ > 0 && Clock::now() < deadline_ && !reap(WNOHANG)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const bool killed = WIFSIGNALED(status_);
    if (child_ > 0 || (killed && (WTERMSIG(status_) == SIGXCPU || WTERMSIG(status_) == SIGKILL))) {
      return fmt::format("a reader still at work after {} s of computing", limits.cpu_seconds);
    }
    if (killed) {
      return fmt::format("bytes that brought the reader down ({})", strsignal(WTERMSIG(status_)));
    }
    return "an answer that makes no sense";
  }

 private:
  /// Whether the child is gone. A host that ignores SIGCHLD has it reaped by the kernel.
  bool reap(int options) {
    pid_t done = 0;
    do {
      done = waitpid(child_, &status_, options);
    } while (done < 0 && errno == EINTR);
    if (done == 0) return false;
    child_ = -1;
    return true;
  }

  [[noreturn]] static void throw_no_process(const std::filesystem::path& path) {
    throw Error({.where = path.string(),
                 .what = "no process could be started to read it in",
                 .found = std::strerror(errno),
                 .hint = "closing other programs, or converting the mesh to STL"});
  }

  Clock::time_point deadline_;
  int pipe_ = -1;
  pid_t child_ = -1;
  int status_ = 0;
};

/// One line of plain text, whatever the reader said.
std::string sentence(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, ' ');
  while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
  return text.empty() ? "no reason given" : text;
}

}  // namespace

TriangleMesh guarded_import(const std::filesystem::path& path, std::string_view extension,
                            std::size_t size) {
  const Limits limits(size);
  const auto refuse = [&](std::string found) {
    throw Error({.where = path.string(),
                 .what = "the file is damaged or cut short, and cannot be read",
                 .found = std::move(found),
                 .expected = fmt::format("a {} file", extension.substr(1)),
                 .hint = "exporting the mesh again, or as STL"});
  };
  auto reader = std::make_unique<Reader>(path, extension, limits);
  Announcement announcement;
  bool is_heard = reader->receive(&announcement, sizeof announcement);
  for (int readers = 1; !is_heard && readers < most_readers; ++readers) {
    reader = std::make_unique<Reader>(path, extension, limits);
    is_heard = reader->receive(&announcement, sizeof announcement);
  }
  if (!is_heard) refuse(reader->ending(limits));
  if (announcement.mark != Announcement::right_mark || announcement.triangles > limits.triangles ||
      announcement.complaint > longest_complaint) {
    refuse("an answer that makes no sense");
  }
  if (announcement.complaint > 0) {
    std::string complaint(announcement.complaint, ' ');
    if (!reader->receive(complaint.data(), complaint.size())) refuse(reader->ending(limits));
    if (complaint.find("bad_alloc") != complaint.npos) {
      refuse(fmt::format("a need for more than {} MB of memory", limits.bytes >> 20));
    }
    refuse(sentence(std::move(complaint)));
  }

  // The announced number is only believed as far as the size of the file makes it likely.
  VertexWeld weld(std::min<std::size_t>(announcement.triangles, size / 8 + 1024));
  std::vector<Corners> batch(batch_size);
  for (std::uint64_t done = 0; done < announcement.triangles;) {
    const auto count = std::min<std::uint64_t>(batch_size, announcement.triangles - done);
    if (!reader->receive(batch.data(), count * sizeof(Corners))) refuse(reader->ending(limits));
    for (std::uint64_t i = 0; i < count; ++i) {
      for (const Vec3& corner : batch[i]) {
        if (is_sane(corner)) continue;
        throw_insane(path, fmt::format("triangle {} of {}", done + i + 1, announcement.triangles),
                     corner);
      }
    }
    weld.add(std::span(batch).first(count));
    done += count;
  }
  return std::move(weld).take();
}

}  // namespace vicinity
