// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/mesh/stl_file.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "geometry/file_beside.h"
#include "geometry/whole_loops.h"
#include "mesh_error.h"
#include "vertex_weld.h"
#include "vicinity/geometry/error.h"

namespace vicinity {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is little-endian");

// Binary: 80 bytes of anything, the number of triangles, then for each triangle a normal and three
// corners as 12 floats and two bytes of anything. Normals are ignored: real files store zeros or
// nonsense there, and the winding says the same.
constexpr std::size_t header_size = 84;
constexpr std::size_t record_size = 50;
constexpr std::size_t corners_offset = 12;
// Reading this many records at a time never holds the whole file and keeps them in the cache.
constexpr std::size_t records_per_read = 1024, records_per_write = records_per_read;

std::size_t binary_size(std::uint32_t triangles) { return header_size + record_size * triangles; }

constexpr std::string_view blanks = " \t\r\n\v\f";

bool is_blank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }  // those of `blanks`

/// Compares with a lower-case word; ASCII letters only, whatever the locale.
bool equals_ignoring_case(std::string_view text, std::string_view lower_case) {
  return std::equal(text.begin(), text.end(), lower_case.begin(), lower_case.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

/// A binary file has zero bytes at its beginning, in the triangle count if nowhere else: only more
/// than 16 million triangles need all four bytes.
bool is_text(std::string_view beginning) { return beginning.find('\0') == beginning.npos; }

/// Whether the first word is "solid", which a binary header may start with too.
bool starts_with_solid(std::string_view beginning) {
  const std::size_t start = beginning.find_first_not_of(blanks);
  return start != beginning.npos && equals_ignoring_case(beginning.substr(start, 5), "solid");
}

TriangleMesh read_binary(std::ifstream& file, const std::filesystem::path& path,
                         std::uint32_t triangles) {
  VertexWeld weld(triangles);
  std::vector<char> records(record_size * std::min<std::size_t>(triangles, records_per_read));
  std::vector<std::array<Vec3, 3>> corners(records.size() / record_size);
  file.seekg(header_size);
  for (std::uint32_t done = 0; done < triangles;) {
    const std::size_t batch = std::min<std::size_t>(triangles - done, records_per_read);
    if (!file.read(records.data(), static_cast<std::streamsize>(batch * record_size))) {
      throw Error({.where = path.string(),
                   .what = "reading stopped before the end of the file",
                   .found = fmt::format("fewer than {} triangles", done + batch),
                   .expected = fmt::format("{}", triangles)});
    }
    for (std::size_t i = 0; i < batch; ++i) {
      std::array<float, 9> numbers;
      std::memcpy(numbers.data(), &records[i * record_size + corners_offset], sizeof numbers);
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 corner(numbers[3 * k], numbers[3 * k + 1], numbers[3 * k + 2]);
        if (!is_sane(corner)) {
          throw_insane(path, fmt::format("triangle {} of {}", done + i + 1, triangles), corner);
        }
        corners[i][k] = corner;
      }
    }
    weld.add(std::span(corners).first(batch));
    done += static_cast<std::uint32_t>(batch);
  }
  return std::move(weld).take();
}

/// A walk through the words of an ASCII STL file, or a part of one. Lines matter only after "solid"
/// and "endsolid", where the rest of the line is a name.
class AsciiStl {
 public:
  AsciiStl(std::string_view text, const std::filesystem::path& path) : text_(text), path_(path) {}

  /// Calls add(corners) for each triangle of a whole file.
  void read(auto&& add) {
    if (read_part(false, add)) refuse({}, facet_or_end);
  }

  /// The same for a part that begins and ends where a facet may begin.
  /// @param within  whether it begins within a solid
  /// @return        whether it ends within one
  bool read_part(bool within, auto&& add) {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (within && equals_ignoring_case(word, "facet")) {
        add(facet());
      } else {
        expect(word, within ? "endsolid" : "solid", within ? facet_or_end : "");
        skip_line();
        within = !within;
      }
    }
    return within;
  }

 private:
  static constexpr std::string_view facet_or_end = "\"facet\" or \"endsolid\"";

  std::array<Vec3, 3> facet() {
    expect(next(), "normal");
    for (int i = 0; i < 3; ++i) {
      // Exporters write "nan" or worse as the normal of a sliver; only its place matters.
      const std::string_view word = next();
      if (word.empty() || equals_ignoring_case(word, "outer")) refuse(word, "three numbers");
    }
    expect(next(), "outer");
    expect(next(), "loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect(next(), "vertex");
      for (double& coordinate : corner) coordinate = number(next());
      if (!is_sane(corner)) throw_insane(path_, line_here(), corner);
    }
    expect(next(), "endloop");
    expect(next(), "endfacet");
    return corners;
  }

  /// The next word, or nothing at the end of the file.
  std::string_view next() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
    begin_ = at_;
    while (at_ < text_.size() && !is_blank(text_[at_])) ++at_;
    return text_.substr(begin_, at_ - begin_);
  }

  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n' && text_[at_] != '\r') ++at_;
  }

  double number(std::string_view word) {
    const std::string_view digits = word.substr(word.size() > 1 && word[0] == '+' ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || end != digits.data() + digits.size()) refuse(word, "a number");
    if (error == std::errc::result_out_of_range) {
      // Too small for a double is zero; too large is absurd, and is refused as such.
      const bool tiny = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos;
      return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return value;
  }

  void expect(std::string_view word, std::string_view keyword, std::string_view expected = {}) {
    if (equals_ignoring_case(word, keyword)) return;
    refuse(word, expected.empty() ? fmt::format("\"{}\"", keyword) : std::string(expected));
  }

  [[noreturn]] void refuse(std::string_view word, std::string_view expected) {
    constexpr std::size_t most_shown = 40;
    const bool at_end = word.empty();
    throw Error({.where = path_.string() + ", " + line_here(),
                 .what = at_end ? "the file is cut short" : "not a sentence of an ASCII STL file",
                 .found = at_end ? "the end of the file"
                                 : fmt::format("\"{}\"", printable(word.substr(0, most_shown))),
                 .expected = std::string(expected),
                 .hint = "exporting the mesh again"});
  }

  static std::string printable(std::string_view word) {
    std::string text(word);
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c < ' ' || c > '~'; }, '?');
    return text;
  }

  /// Counted only when somebody asks, which is once, in an error.
  std::string line_here() const {
    const auto end = text_.begin() + static_cast<std::ptrdiff_t>(begin_);
    return fmt::format("line {}", 1 + std::count(text_.begin(), end, '\n'));
  }

  std::string_view text_;
  const std::filesystem::path& path_;
  std::size_t at_ = 0;     // where the next word is looked for
  std::size_t begin_ = 0;  // where the last one began
};

// A facet of one-digit numbers with the fewest blanks takes about 90 bytes, a common one 250:
// enough to start from, and never more than the file itself justifies.
constexpr std::size_t bytes_per_facet = 250;

// Parts of this size are parsed by all threads: large beside a facet, small enough to stay in a
// cache. A file of a few parts is read by one thread.
constexpr std::size_t part_size = 1 << 18;
constexpr std::size_t few_parts = 4;

// A file in which no line of so many parts begins with "facet" is not worth another look.
constexpr std::size_t most_parts_in_one = 16;

/// Where the last line that begins with "facet" begins, or 0. It is no part of a name, since names
/// end with their line.
std::size_t last_facet(std::string_view text) {
  for (std::size_t end = text.npos; end != 0;) {
    const std::size_t newline = text.rfind('\n', end - 1);
    if (newline == text.npos) break;
    const std::size_t word = text.find_first_not_of(" \t\r\v\f", newline + 1);
    if (word != text.npos && equals_ignoring_case(text.substr(word, 5), "facet")) return newline;
    end = newline;
  }
  return 0;
}

/// Reads a sound file by all threads: parts are read one after another, parsed side by side and
/// welded in the order of the file. Throws where anything is wrong, without the right place.
TriangleMesh read_ascii_parts(std::ifstream& file, const std::filesystem::path& path,
                              std::size_t size) {
  struct Part {
    std::string text;
    bool first = false, last = false;
    std::vector<std::array<Vec3, 3>> corners;
  };
  // A pipeline that an exception ends forgets what was on its way through it, so the parts are
  // ours. They are done with in the order they were read in: the oldest one is free whenever one is
  // read.
  std::vector<Part> parts(4 * static_cast<std::size_t>(tbb::this_task_arena::max_concurrency()));
  VertexWeld weld(size / bytes_per_facet);
  std::size_t parts_read = 0;
  std::string rest;  // behind the last part
  const auto read = [&](tbb::flow_control& flow) -> Part* {
    if (parts_read > 0 && rest.empty()) {
      flow.stop();
      return nullptr;
    }
    Part& part = parts[parts_read % parts.size()];
    part.text = std::move(rest);
    part.first = parts_read++ == 0;
    part.last = false;
    std::size_t cut = 0;
    while (cut == 0 && !part.last) {
      if (part.text.size() > most_parts_in_one * part_size) {
        throw Error({.where = path.string(), .what = "no line begins with a facet"});
      }
      const std::size_t had = part.text.size();
      part.text.resize(had + part_size);
      file.read(&part.text[had], part_size);
      part.text.resize(had + static_cast<std::size_t>(file.gcount()));
      part.last = !file;
      if (!part.last) cut = last_facet(part.text);
    }
    rest = part.last ? std::string() : part.text.substr(cut);
    if (!part.last) part.text.resize(cut);
    return &part;
  };
  const auto parse = [&](Part* part) {
    part->corners.clear();
    part->corners.reserve(part->text.size() / bytes_per_facet);
    const bool within =
        AsciiStl(part->text, path).read_part(!part->first, [&](const auto& corners) {
          part->corners.push_back(corners);
        });
    if (within == part->last) throw Error({.where = path.string(), .what = "a solid does not end"});
    part->text = {};
    return part;
  };
  whole::parallel_pipeline(
      parts.size(),
      tbb::make_filter<void, Part*>(tbb::filter_mode::serial_in_order, read) &
          tbb::make_filter<Part*, Part*>(tbb::filter_mode::parallel, parse) &
          tbb::make_filter<Part*, void>(tbb::filter_mode::serial_in_order,
                                        [&](const Part* part) { weld.add(part->corners); }));
  return std::move(weld).take();
}

TriangleMesh read_ascii(std::ifstream& file, const std::filesystem::path& path, std::size_t size) {
  file.clear();
  file.seekg(0);
  if (size > few_parts * part_size) {
    try {
      return read_ascii_parts(file, path, size);
    } catch (const Error&) {
      // Once more from the beginning, to say what is wrong and in which line.
      file.clear();
      file.seekg(0);
    }
  }
  std::string text(size, '\0');
  file.read(text.data(), static_cast<std::streamsize>(size));
  text.resize(static_cast<std::size_t>(file.gcount()));
  VertexWeld weld(text.size() / bytes_per_facet);
  AsciiStl(text, path).read([&](const std::array<Vec3, 3>& corners) { weld.add({&corners, 1}); });
  return std::move(weld).take();
}

[[noreturn]] void throw_wrong_size(const std::filesystem::path& path, std::uint32_t triangles,
                                   std::size_t size) {
  throw Error({.where = path.string(),
               .what = size < binary_size(triangles)
                           ? "the file is cut short or its triangle count is wrong"
                           : "there are bytes behind the last triangle, or the count is wrong",
               .found = fmt::format("a count of {} triangles in {} bytes", triangles, size),
               .expected = fmt::format("{} bytes for that count", binary_size(triangles)),
               .hint = "copying or exporting the mesh again"});
}

}  // namespace

TriangleMesh read_stl(const std::filesystem::path& path) {
  const std::size_t size = readable_size(path);
  std::ifstream file(path, std::ios::binary);
  std::array<char, 512> beginning{};
  file.read(beginning.data(), static_cast<std::streamsize>(std::min(size, beginning.size())));
  const std::string_view seen(beginning.data(), static_cast<std::size_t>(file.gcount()));

  std::uint32_t triangles = 0;
  if (seen.size() >= header_size) {
    std::memcpy(&triangles, &beginning[header_size - sizeof triangles], sizeof triangles);
  }
  TriangleMesh mesh;
  if (seen.size() >= header_size && size == binary_size(triangles)) {
    mesh = read_binary(file, path, triangles);
  } else if (is_text(seen) && starts_with_solid(seen)) {
    mesh = read_ascii(file, path, size);
  } else if (seen.size() >= header_size && !is_text(seen)) {
    throw_wrong_size(path, triangles, size);
  } else {
    throw Error({.where = path.string(),
                 .what = "not an STL file, or cut short within its header",
                 .found = fmt::format("{} bytes", size),
                 .expected = "a binary header of 84 bytes or a text that starts with \"solid\"",
                 .hint = "copying or exporting the mesh again"});
  }
  if (mesh.triangles.empty()) throw_no_triangle(path);
  return mesh;
}

std::size_t count_zero_normals(const std::filesystem::path& path) {
  const std::size_t size = readable_size(path);
  std::ifstream file(path, std::ios::binary);
  std::array<char, header_size> header{};
  file.read(header.data(), header.size());
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, &header[header_size - sizeof triangles], sizeof triangles);
  std::size_t count = 0;
  if (file && size == binary_size(triangles)) {
    std::array<char, record_size> record;
    std::array<float, 3> normal;
    while (file.read(record.data(), record.size())) {
      std::memcpy(normal.data(), record.data(), sizeof normal);
      count += normal == std::array<float, 3>{} ? 1 : 0;
    }
    return count;
  }
  file.clear();
  file.seekg(0);
  for (std::string word; file >> word;) {
    if (!equals_ignoring_case(word, "normal")) continue;
    double x = 1, y = 1, z = 1;
    if (file >> x >> y >> z) {
      count += x == 0 && y == 0 && z == 0 ? 1 : 0;
    } else {
      file.clear();  // "nan", or no STL file at all
    }
  }
  return count;
}

void write_stl(const TriangleMesh& mesh, const std::filesystem::path& path) {
  if (mesh.triangles.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw Error({.where = path.string(),
                 .what = "more triangles than an STL file can count",
                 .found = fmt::format("{}", mesh.triangles.size()),
                 .expected = "at most 4294967295"});
  }
  for (const Vec3& vertex : mesh.vertices) {
    if (!is_sane(vertex)) throw_insane(path, "a vertex to be written", vertex);
  }
  // Must not start with "solid", which simple readers take for ASCII.
  std::array<char, header_size> header{"binary STL written by Vicinity"};
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  std::memcpy(&header[header_size - sizeof count], &count, sizeof count);

  FileBeside file(path);
  file.write(std::as_bytes(std::span(header)));
  std::vector<std::byte> records;
  records.reserve(record_size * std::min(mesh.triangles.size(), records_per_write));
  for (std::size_t n = 0; n < mesh.triangles.size(); ++n) {
    const auto& [a, b, c] = mesh.triangles[n];
    // The normal is that of the rounded corners, so that a file read and written again is the same.
    const Eigen::Vector3f p = mesh.vertices[a].cast<float>(), q = mesh.vertices[b].cast<float>(),
                          r = mesh.vertices[c].cast<float>();
    const Vec3 edge = (q - p).cast<double>(), other = (r - p).cast<double>();
    Eigen::Matrix<float, 3, 4> numbers;
    numbers << edge.cross(other).normalized().cast<float>(), p, q, r;
    records.resize(records.size() + record_size);
    std::memcpy(&records[records.size() - record_size], numbers.data(), 12 * sizeof(float));
    if (records.size() < record_size * records_per_write) continue;
    file.write(records);
    records.clear();
  }
  file.write(records);
  file.move_into_place();
}

}  // namespace vicinity
