// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "commands/check.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "arguments.h"
#include "readable.h"
#include "vicinity/mesh/inspection.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/placement.h"

namespace vicinity::cli {
namespace {

using Json = nlohmann::ordered_json;

Json as_json(const MeshInspection& found, const Vec3& size, const std::string& units) {
  Json problems = Json::array();
  for (const MeshProblem& problem : found.problems) {
    problems.push_back(
        {{"what", problem.what}, {"count", problem.count}, {"means", problem.means}});
  }
  return {{"verdict", to_string(found.verdict)},
          {"triangles", found.triangles},
          {"closed", found.closed},
          {"shells", found.shells},
          {"size", {size.x(), size.y(), size.z()}},
          {"units", units.empty() ? Json() : Json("m")},
          {"problems", problems}};
}

// A file that no mesh comes out of still gets an answer that a program can read.
Json unreadable(const Error& error) {
  MeshInspection nothing;
  nothing.verdict = MeshInspection::Verdict::unusable;
  nothing.closed = false;
  nothing.problems.push_back({"cannot be read", 1, error.what()});
  return as_json(nothing, Vec3::Zero(), "");
}

std::string in_words(const MeshInspection& found, const Vec3& size, const CheckOptions& options) {
  std::string text = fmt::format(
      "{}: {}\n\n  {} triangle{}, {}, {} shell{}\n", options.mesh.filename().string(),
      found.verdict == MeshInspection::Verdict::ok       ? "ok"
      : found.verdict == MeshInspection::Verdict::usable ? "usable, with remarks"
                                                         : "unusable",
      grouped(found.triangles), found.triangles == 1 ? "" : "s", found.closed ? "closed" : "open",
      grouped(found.shells), found.shells == 1 ? "" : "s");
  text += options.units.empty()
              ? fmt::format(
                    "  size  {}\n        (a unit in the file, if there is one, is not read: say "
                    "--units)\n",
                    size_in_units(found.bounds))
              : fmt::format("  size  {:.4g} x {:.4g} x {:.4g} m\n", size.x(), size.y(), size.z());
  if (!found.problems.empty()) text += '\n';
  for (const MeshProblem& problem : found.problems) {
    text += fmt::format("  {} {}\n      {}\n", grouped(problem.count), problem.what, problem.means);
  }
  return text;
}

}  // namespace

int check(const CheckOptions& options, std::ostream& out, std::ostream& err) {
  const double metres = options.units.empty() ? 1 : metres_per(unit_from("--units", options.units));
  MeshInspection found;
  try {
    found = inspect(read_mesh(options.mesh));
  } catch (const Error& error) {
    if (options.json) out << unreadable(error).dump(2) << '\n';
    throw;
  }
  const Vec3 size = found.bounds.isEmpty() ? Vec3(0, 0, 0) : Vec3(metres * found.bounds.sizes());
  if (options.json) {
    out << as_json(found, size, options.units).dump(2) << '\n';
  } else {
    out << in_words(found, size, options);
  }
  if (found.verdict != MeshInspection::Verdict::unusable) return 0;
  err << "vicinity: " << options.mesh.string() << ": no triangle has any extent\n";
  return 2;
}

}  // namespace vicinity::cli
