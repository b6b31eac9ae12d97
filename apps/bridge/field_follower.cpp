// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "field_follower.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "chunks.h"
#include "vicinity/geometry/error.h"
#include "vicinity/viscosity/field_file.h"
#include "vicinity/viscosity/field_image.h"

namespace vicinity::bridge {
namespace {

// Longer than a chunk takes that is lost once on a slow way and sent again by DDS itself.
constexpr std::chrono::milliseconds ask_again{1500};

[[noreturn]] void fail(const std::filesystem::path& path, const char* what) {
  throw Error({.where = path.string(), .what = what, .found = std::strerror(errno)});
}

bool is_whole(const FieldManifest& manifest) {
  if (manifest.chunks.empty() || manifest.chunks.size() != manifest.sizes.size()) return false;
  for (const std::uint32_t size : manifest.sizes) {
    if (size == 0 || size > largest_chunk) return false;
  }
  return true;
}

// Chunks that are here already, by checksum.
class AtHand {
 public:
  void add(std::span<const std::byte> file) {
    for (const Chunk& chunk : chunks_of(file)) {
      found_.emplace(chunk.checksum, file.subspan(chunk.offset, chunk.size));
    }
  }
  /// Empty: not here.
  std::span<const std::byte> find(std::uint64_t checksum, std::uint32_t size) const {
    const auto found = found_.find(checksum);
    return found == found_.end() || found->second.size() != size ? std::span<const std::byte>()
                                                                 : found->second;
  }

 private:
  std::unordered_map<std::uint64_t, std::span<const std::byte>> found_;
};

}  // namespace

MappedFile::MappedFile(const std::filesystem::path& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return;
  map(file);
  close(file);
}

void MappedFile::map(int file) {
  struct stat status {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_size <= 0) return;
  const auto size = static_cast<std::size_t>(status.st_size);
  void* const mapping = mmap(nullptr, size, PROT_READ, MAP_SHARED, file, 0);
  if (mapping != MAP_FAILED) bytes_ = {static_cast<const std::byte*>(mapping), size};
}

MappedFile::~MappedFile() {
  if (!bytes_.empty()) munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

FieldFollower::FieldFollower(dds::Participant& participant, const std::string& name,
                             std::filesystem::path copy, Say say)
    : copy_(std::move(copy)),
      part_(copy_.string() + ".part"),
      say_(std::move(say)),
      manifest_reader_(
          participant.reader<FieldManifest>(field_topic<FieldManifest>(name), manifest_quality)),
      chunk_reader_(participant.reader<FieldChunk>(field_topic<FieldChunk>(name), chunk_quality)),
      wanted_writer_(
          participant.writer<FieldWanted>(field_topic<FieldWanted>(name), chunk_quality)),
      waiter_(participant, {manifest_reader_, chunk_reader_}) {}

FieldFollower::~FieldFollower() {
  if (file_ >= 0) close(file_);
}

std::optional<ViscosityField> FieldFollower::open_copy() {
  if (!std::filesystem::exists(copy_)) return {};
  try {
    ViscosityField field = open_field(copy_);
    copy_checksum_ = checksum_of(field.image());
    return field;
  } catch (const Error& error) {
    say_(std::string(error.what()) + "; it is fetched anew");
    return {};
  }
}

std::optional<ViscosityField> FieldFollower::step(double seconds) {
  waiter_.wait(seconds);
  hear_manifest();
  hear_chunks();
  if (!fetching_) return {};
  if (missing_.empty()) return finish();
  ask();
  return {};
}

FieldStanding FieldFollower::standing() const {
  const bool shared = dds_get_matched_publications(manifest_reader_, nullptr, 0) > 0;
  if (fetching_) {
    return {ros2::DiagnosticStatus::warn,
            fmt::format("{}fetching: {} of {} chunks to come",
                        copy_checksum_ == 0 ? "no field, " : "the old field, ", missing_.size(),
                        wanted_)};
  }
  if (copy_checksum_ == 0) return {ros2::DiagnosticStatus::error, "no field"};
  if (!shared) return {ros2::DiagnosticStatus::warn, "our own copy: nobody shares it"};
  if (!confirmed_)
    return {ros2::DiagnosticStatus::warn, "our own copy: the shared one is no field"};
  return {ros2::DiagnosticStatus::ok, "as shared"};
}

void FieldFollower::hear_manifest() {
  std::optional<FieldManifest> newest;
  FieldManifest said;
  while (dds::take(manifest_reader_, bytes_)) {
    if (ros2::read_cdr(bytes_, said) && is_whole(said)) newest = said;
  }
  if (!newest) return;
  if (newest->checksum == copy_checksum_) {
    fetching_ = false;
    confirmed_ = true;
    return;
  }
  confirmed_ = false;
  if (unusable_.contains(newest->checksum)) return;
  if (fetching_ && newest->checksum == manifest_.checksum) return;  // its sender has come back
  manifest_ = std::move(*newest);
  begin();
}

// Lays out FIELD.part with all that is at hand.
void FieldFollower::begin() {
  const MappedFile copy(copy_), part(part_);
  AtHand at_hand;
  at_hand.add(copy.bytes());
  at_hand.add(part.bytes());
  if (file_ >= 0) close(file_);
  // What was begun before is still mapped; the new file takes its name.
  unlink(part_.c_str());
  file_ = open(part_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666);
  if (file_ < 0) fail(part_, "cannot be written");
  const auto size = std::accumulate(manifest_.sizes.begin(), manifest_.sizes.end(), off_t{0});
  if (ftruncate(file_, size) != 0) fail(part_, "cannot be written");
  missing_.clear();
  std::uint64_t offset = 0;
  for (std::size_t n = 0; n < manifest_.chunks.size(); ++n) {
    const std::uint64_t checksum = manifest_.chunks[n];
    std::span<const std::byte> here = at_hand.find(checksum, manifest_.sizes[n]);
    // Between holes chunks are not cut where they are whole: one may stand where it belongs.
    if (here.empty() && part.bytes().size() == static_cast<std::uint64_t>(size)) {
      const auto there = part.bytes().subspan(offset, manifest_.sizes[n]);
      if (checksum_of(there) == checksum) here = there;
    }
    if (here.empty()) {
      Missing& missing = missing_[checksum];
      missing.offsets.push_back(offset);
      missing.size = manifest_.sizes[n];
    } else {
      write(offset, here);
    }
    offset += manifest_.sizes[n];
  }
  wanted_ = missing_.size();
  fetching_ = true;
  say_(fmt::format(
      "{}fetching {} of the {} chunks of field {}",
      copy_checksum_ == 0 ? "" : copy_.string() + " holds another field than is shared: ", wanted_,
      manifest_.chunks.size(), hex(manifest_.checksum)));
}

void FieldFollower::hear_chunks() {
  FieldChunk chunk;
  while (dds::take(chunk_reader_, bytes_)) {
    if (!ros2::read_cdr(bytes_, chunk)) continue;
    const auto found = missing_.find(chunk.checksum);
    if (found == missing_.end()) continue;  // another's wish, or come twice
    const auto data = std::as_bytes(std::span(chunk.data));
    if (data.size() != found->second.size || checksum_of(data) != chunk.checksum) {
      ++traffic_.refused;
      found->second.asked.reset();
      continue;
    }
    for (const std::uint64_t offset : found->second.offsets) write(offset, data);
    ++traffic_.chunks;
    traffic_.bytes += data.size();
    missing_.erase(found);
  }
}

void FieldFollower::ask() {
  const Clock::time_point now = Clock::now();
  std::uint64_t under_way = 0;
  FieldWanted wanted;
  for (auto& [checksum, missing] : missing_) {
    if (missing.asked && now - *missing.asked < ask_again) under_way += missing.size;
  }
  for (auto& [checksum, missing] : missing_) {
    if (under_way >= window_bytes) break;
    if (missing.asked) {
      if (now - *missing.asked < ask_again) continue;
      ++traffic_.asked_again;
    }
    missing.asked = now;
    under_way += missing.size;
    wanted.chunks.push_back(checksum);
  }
  if (!wanted.chunks.empty()) (void)dds::send(wanted_writer_, wanted, bytes_);
}

std::optional<ViscosityField> FieldFollower::finish() {
  if (fsync(file_) != 0) {
    fetching_ = false;
    fail(part_, "cannot be written");
  }
  // Mapped through the descriptor that is open: it takes no other.
  const auto part = std::make_shared<const MappedFile>(file_);
  const std::span<const std::byte> bytes = part->bytes();
  if (bytes.empty()) return {};  // for want of memory, say: again at the next step
  fetching_ = false;
  close(std::exchange(file_, -1));
  try {
    if (checksum_of(bytes) != manifest_.checksum) {
      throw Error({.where = part_.string(), .what = "is not the field that was announced"});
    }
    ViscosityField field = ViscosityField::from_image(
        std::shared_ptr<const std::byte[]>(part, bytes.data()), bytes.size(), part_.string());
    std::filesystem::rename(part_, copy_);
    const int folder = open(std::filesystem::absolute(copy_).parent_path().c_str(),
                            O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder >= 0) {
      fsync(folder);  // the name, too, outlasts a power failure
      close(folder);
    }
    copy_checksum_ = manifest_.checksum;
    confirmed_ = true;
    ++traffic_.fields;
    say_(fmt::format("{} is field {}", copy_.string(), hex(copy_checksum_)));
    return field;
  } catch (const Error& error) {
    unusable_.insert(manifest_.checksum);
    unlink(part_.c_str());
    say_(std::string(error.what()) + "; what is shared is no field for us");
    return {};
  }
}

void FieldFollower::write(std::uint64_t offset, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(file_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) fail(part_, "cannot be written");
    offset += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

}  // namespace vicinity::bridge
