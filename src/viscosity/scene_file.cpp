// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/viscosity/scene_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "vicinity/geometry/error.h"
#include "vicinity/geometry/nearest_word.h"
#include "vicinity/mesh/mesh_file.h"
#include "vicinity/mesh/primitive.h"

namespace vicinity {
namespace {

template <class Value>
using Words = std::vector<std::pair<std::string, Value>>;

/// Walks through YAML without keeping any of it, and stops at a second document. yaml-cpp 0.7 finds
/// documents without end in some broken text (", a" is enough), and would fill the memory with
/// them.
class DocumentMeter : public YAML::EventHandler {
 public:
  explicit DocumentMeter(std::size_t text_size) : most_events_(4 * text_size + 16) {}

  int documents() const noexcept { return documents_; }

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (++documents_ > 1) throw YAML::ParserException(mark, "text behind the end of the scene");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override { count(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                const std::string&) override {
    count(mark);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {
    count(mark);
  }
  void OnMapEnd() override {}

 private:
  /// No letter stands for more than a few values.
  void count(const YAML::Mark& mark) {
    if (++events_ > most_events_) throw YAML::ParserException(mark, "more values than letters");
  }

  std::size_t most_events_;
  std::size_t events_ = 0;
  int documents_ = 0;
};

/// Reads one scene. Every error names the line it stems from.
class SceneReader {
 public:
  SceneReader(std::filesystem::path base_folder, std::string where)
      : base_folder_(std::move(base_folder)), where_(std::move(where)) {}

  Scene read(const std::string& text) {
    const YAML::Node root = only_document(text);
    const Mapping top =
        mapping(root, "the scene", {"voxel_size", "bounds", "defaults", "objects", "robot"});
    Scene scene;
    if (const auto* node = top.find("voxel_size")) scene.voxel_size = positive(*node);
    if (const auto* node = top.find("bounds")) scene.bounds = bounds(*node);
    Settings defaults;
    if (const auto* node = top.find("defaults")) {
      read_settings(mapping(*node, "defaults", setting_keys()), defaults);
    }
    for (const YAML::Node& node : list(top.need("objects"), "a list of objects")) {
      scene.objects.push_back(object(node, defaults));
    }
    if (const auto* node = top.find("robot")) scene.robot = robot(*node);
    return scene;
  }

  [[noreturn]] void refuse_text(const YAML::Exception& e) const {
    throw Error({.where = e.mark.is_null() ? where_ : at(e.mark),
                 .what = "this is not YAML that can be read",
                 .found = e.msg});
  }

 private:
  /// A YAML mapping whose keys are all known and stated once.
  struct Mapping {
    const SceneReader& reader;
    YAML::Node node;
    std::string what;
    std::map<std::string, YAML::Node> entries;

    const YAML::Node* find(const std::string& key) const {
      const auto entry = entries.find(key);
      return entry == entries.end() ? nullptr : &entry->second;
    }
    const YAML::Node& need(const std::string& key) const {
      const YAML::Node* entry = find(key);
      if (entry == nullptr) {
        reader.refuse(node, fmt::format("{} lacks the key '{}'", what, key), "", key + ": ...");
      }
      return *entry;
    }
  };

  /// What an object takes over from `defaults`. A named coding has as many values as the object
  /// has ranks, so that it is made last. Assigning to a YAML::Node would change the document;
  /// reset() lets it stand for another part of it.
  struct Settings {
    SceneObject object;
    YAML::Node coding{YAML::NodeType::Undefined};
  };

  std::string at(const YAML::Mark& mark) const {
    return fmt::format("{}:{}", where_, mark.line + 1);
  }
  std::string at(const YAML::Node& node) const { return at(node.Mark()); }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what,
                           const std::string& found = {}, const std::string& expected = {},
                           const std::string& hint = {}) const {
    throw Error(
        {.where = at(node), .what = what, .found = found, .expected = expected, .hint = hint});
  }

  /// Runs a step of another stage; an error of it that has no line gets this one.
  template <class Step>
  auto with_line(const YAML::Node& node, Step&& step) const {
    try {
      return step();
    } catch (const Error& e) {
      ErrorParts parts = e.parts();
      if (parts.where.starts_with(where_)) throw;
      parts.where = parts.where.empty() ? at(node) : at(node) + ", " + parts.where;
      throw Error(parts);
    }
  }

  static std::string shown(const YAML::Node& node) {
    constexpr std::size_t most = 40;
    if (node.IsSequence()) return "a list";
    if (node.IsMap()) return "keys and values";
    if (!node.IsScalar()) return "nothing";
    const std::string& text = node.Scalar();
    return text.size() <= most ? "'" + text + "'" : "'" + text.substr(0, most) + "...'";
  }

  YAML::Node only_document(const std::string& text) const {
    DocumentMeter meter(text.size());
    std::istringstream stream(text);
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(meter)) {
    }
    if (meter.documents() == 0) {
      throw Error({.where = where_, .what = "the scene is empty", .expected = "YAML text"});
    }
    return YAML::Load(text);
  }

  Mapping mapping(const YAML::Node& node, const std::string& what,
                  const std::vector<std::string>& known) const {
    if (!node.IsMap()) {
      refuse(node, fmt::format("{} should be keys and values", what), shown(node),
             fmt::format("keys among {}", fmt::join(known, ", ")));
    }
    Mapping result{*this, node, what, {}};
    for (const auto& entry : node) {
      const std::string key = entry.first.IsScalar() ? entry.first.Scalar() : "";
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        refuse(entry.first, fmt::format("unknown key in {}", what), shown(entry.first),
               fmt::format("one of {}", fmt::join(known, ", ")), nearest_word(key, known));
      }
      if (!result.entries.emplace(key, entry.second).second) {
        refuse(entry.first, fmt::format("the key '{}' is stated twice in {}", key, what));
      }
    }
    return result;
  }

  std::vector<YAML::Node> list(const YAML::Node& node, const std::string& expected) const {
    if (!node.IsSequence()) refuse(node, "not a list", shown(node), expected);
    return {node.begin(), node.end()};
  }

  std::string text(const YAML::Node& node, const std::string& expected) const {
    if (!node.IsScalar() || node.Scalar().empty()) {
      refuse(node, "not a text", shown(node), expected);
    }
    return node.Scalar();
  }

  double number(const YAML::Node& node) {
    // Aliases let a short text stand for any number of values.
    constexpr int most_numbers = 200000;
    if (++numbers_ > most_numbers) {
      refuse(node, "more numbers in here than any scene needs", "",
             fmt::format("at most {}", most_numbers), "a mesh file for shapes of many points");
    }
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
      refuse(node, "not a number", shown(node), "a finite number");
    }
    return value;
  }

  double positive(const YAML::Node& node) {
    const double value = number(node);
    if (value <= 0) refuse(node, "not a size", shown(node), "a number above zero");
    return value;
  }

  int whole_number(const YAML::Node& node) const {
    int value = 0;
    if (!node.IsScalar() || !YAML::convert<int>::decode(node, value)) {
      refuse(node, "not a whole number", shown(node), "digits");
    }
    return value;
  }

  template <std::size_t n>
  std::array<double, n> numbers(const YAML::Node& node) {
    const std::string expected = fmt::format("a list of {} numbers", n);
    const std::vector<YAML::Node> values = list(node, expected);
    if (values.size() != n) {
      refuse(node, "a list of the wrong length", fmt::format("{} values", values.size()), expected);
    }
    std::array<double, n> result;
    for (std::size_t i = 0; i < n; ++i) result[i] = number(values[i]);
    return result;
  }

  Vec3 vec3(const YAML::Node& node) { return Vec3(numbers<3>(node).data()); }

  template <std::size_t n>
  std::vector<std::array<double, n>> points(const YAML::Node& node) {
    constexpr std::size_t most_points = 1000;  // checking an outline takes the square of it
    const std::vector<YAML::Node> nodes = list(node, "a list of points");
    if (nodes.size() > most_points) {
      refuse(node, "too many points", fmt::format("{}", nodes.size()),
             fmt::format("at most {}", most_points), "a mesh file");
    }
    std::vector<std::array<double, n>> result;
    for (const YAML::Node& point : nodes) result.push_back(numbers<n>(point));
    return result;
  }

  template <class Value>
  Value one_of(const YAML::Node& node, const Words<Value>& words) const {
    std::vector<std::string> known;
    for (const auto& [word, value] : words) {
      if (node.IsScalar() && node.Scalar() == word) return value;
      known.push_back(word);
    }
    refuse(node, "not one of the words that may stand here", shown(node),
           fmt::format("{}", fmt::join(known, ", ")),
           node.IsScalar() ? nearest_word(node.Scalar(), known) : "");
  }

  Pose pose(const YAML::Node& node) {
    const Mapping entries = mapping(node, "the pose", {"xyz", "rpy", "quaternion"});
    const auto* xyz = entries.find("xyz");
    const auto* rpy = entries.find("rpy");
    const auto* quaternion = entries.find("quaternion");
    const Vec3 position = xyz != nullptr ? vec3(*xyz) : Vec3::Zero();
    if (quaternion == nullptr) {
      return pose_from_rpy(position, rpy != nullptr ? vec3(*rpy) : Vec3::Zero());
    }
    if (rpy != nullptr) refuse(node, "a pose has either rpy or a quaternion, not both");
    const Eigen::Vector4d xyzw(numbers<4>(*quaternion).data());
    const double length = xyzw.norm();
    if (!(length > 1e-6) || !std::isfinite(length)) {
      refuse(*quaternion, "not a rotation", fmt::format("a quaternion of length {:g}", length),
             "[x, y, z, w] of length one");
    }
    return pose_from_quaternion(position, xyzw / length);
  }

  std::optional<Box> bounds(const YAML::Node& node) {
    if (node.IsScalar() && node.Scalar() == "auto") return std::nullopt;
    const std::string expected = "auto, or two corners [[x, y, z], [x, y, z]] in metres";
    const std::vector<YAML::Node> corners = list(node, expected);
    if (corners.size() != 2) {
      refuse(node, "not a box", fmt::format("{} corners", corners.size()), expected);
    }
    const Box box(vec3(corners[0]), vec3(corners[1]));
    if ((box.sizes().array() <= 0).any()) {
      refuse(node, "not a box", "a first corner that is not below the second", expected);
    }
    return box;
  }

  static std::vector<std::string> setting_keys() {
    return {"m", "q", "shape", "coding", "skin", "boundary", "inner"};
  }

  void read_settings(const Mapping& entries, Settings& settings) {
    SceneObject& object = settings.object;
    if (const auto* node = entries.find("m")) object.m = whole_number(*node);
    if (const auto* node = entries.find("q")) object.q = whole_number(*node);
    if (const auto* node = entries.find("shape")) {
      Words<LayerShape> words;
      for (const auto shape : {LayerShape::cube, LayerShape::sphere, LayerShape::distance}) {
        words.emplace_back(to_string(shape), shape);
      }
      object.layers = one_of(*node, words);
    }
    if (const auto* node = entries.find("coding")) settings.coding.reset(*node);
    if (const auto* node = entries.find("skin")) object.coding.skin = number(*node);
    if (const auto* node = entries.find("boundary")) {
      object.boundary = one_of<BoundaryMethod>(
          *node, {{"exact", BoundaryMethod::exact}, {"probe", BoundaryMethod::probe}});
    }
    if (const auto* node = entries.find("inner")) {
      object.inner = one_of<InnerMethod>(*node, {{"winding", InnerMethod::winding},
                                                 {"raster", InnerMethod::raster},
                                                 {"none", InnerMethod::none}});
    }
  }

  std::vector<double> coding_values(const YAML::Node& node, int q) {
    if (node.IsScalar()) {
      return with_line(node, [&] { return named_coding(node.Scalar(), q).mu; });
    }
    std::vector<double> values;
    const auto nodes = list(node, "a list of viscosities, or linear, nonlinear, jnd, paper");
    for (const YAML::Node& value : nodes) values.push_back(number(value));
    return values;
  }

  SceneObject object(const YAML::Node& node, const Settings& defaults) {
    std::vector<std::string> known = {"name", "mesh", "units", "pose", "scale", "primitive"};
    for (const std::string& key : setting_keys()) known.push_back(key);
    const Mapping entries = mapping(node, "an object", known);

    Settings settings = defaults;
    read_settings(entries, settings);
    SceneObject object = settings.object;
    object.name = text(entries.need("name"), "a name");
    if (!names_.insert(object.name).second) {
      refuse(entries.need("name"), "two objects have this name", "'" + object.name + "'",
             "a name of its own for every object");
    }
    if (const auto* entry = entries.find("pose")) object.X_WO = pose(*entry);
    if (const auto* entry = entries.find("scale")) object.scale = positive(*entry);
    if (settings.coding.IsDefined()) {
      // A wild q would make a wild number of values; check_object() refuses it below.
      object.coding.mu = coding_values(settings.coding, std::clamp(object.q, 0, 32));
    }
    check_object(object, fmt::format("{}, object '{}'", at(node), object.name));

    const auto* mesh = entries.find("mesh");
    const auto* shape = entries.find("primitive");
    if ((mesh == nullptr) == (shape == nullptr)) {
      refuse(node, fmt::format("object '{}' needs one shape", object.name),
             mesh == nullptr ? "none" : "mesh and primitive", "mesh or primitive");
    }
    const auto* units = entries.find("units");
    if (mesh != nullptr) {
      object.shape = mesh_file(*mesh, units);
    } else {
      if (units != nullptr) refuse(*units, "a primitive is in metres and takes no units");
      object.shape = primitive_mesh(*shape);
    }
    return object;
  }

  MeshFile mesh_file(const YAML::Node& mesh, const YAML::Node* units) const {
    MeshFile file{base_folder_ / text(mesh, "the path of a mesh file"), std::nullopt};
    if (units == nullptr) {
      throw with_line(mesh, [&] { return missing_unit(read_mesh(file.path), at(mesh)); });
    }
    file.units = length_unit(text(*units, "mm, cm, m or in"));
    if (!file.units) refuse(*units, "not a unit", shown(*units), "mm, cm, m or in");
    return file;
  }

  TriangleMesh primitive_mesh(const YAML::Node& node) {
    struct Shape {
      std::string name;
      std::vector<std::string> parameters;
      std::function<TriangleMesh(const Mapping&)> make;
    };
    const auto size = [this](const Mapping& p, const char* key) { return positive(p.need(key)); };
    const std::vector<Shape> shapes = {
        {"box", {"size"}, [&](const auto& p) { return primitive::box(vec3(p.need("size"))); }},
        {"sphere", {"radius"}, [&](const auto& p) { return primitive::sphere(size(p, "radius")); }},
        {"cylinder",
         {"radius", "height"},
         [&](const auto& p) { return primitive::cylinder(size(p, "radius"), size(p, "height")); }},
        {"capsule",
         {"radius", "height"},
         [&](const auto& p) { return primitive::capsule(size(p, "radius"), size(p, "height")); }},
        {"cone",
         {"base_radius", "height"},
         [&](const auto& p) { return primitive::cone(size(p, "base_radius"), size(p, "height")); }},
        {"torus",
         {"radius", "tube_radius"},
         [&](const auto& p) {
           return primitive::torus(size(p, "radius"), size(p, "tube_radius"));
         }},
        {"tube",
         {"outer_radius", "inner_radius", "height"},
         [&](const auto& p) {
           return primitive::tube(size(p, "outer_radius"), size(p, "inner_radius"),
                                  size(p, "height"));
         }},
        {"extrusion",
         {"outline", "height"},
         [&](const auto& p) {
           return primitive::extrusion(points<2>(p.need("outline")), size(p, "height"));
         }},
        {"revolution",
         {"profile"},
         [&](const auto& p) { return primitive::revolution(points<2>(p.need("profile"))); }},
        {"pipe",
         {"path", "radius", "bend_radius"},
         [&](const auto& p) {
           return primitive::pipe(points<3>(p.need("path")), size(p, "radius"),
                                  size(p, "bend_radius"));
         }},
        {"v_block",
         {"size", "depth"},
         [&](const auto& p) { return primitive::v_block(vec3(p.need("size")), size(p, "depth")); }},
        {"complex_cylinder", {"radius", "height"}, [&](const auto& p) {
           return primitive::complex_cylinder(size(p, "radius"), size(p, "height"));
         }}};

    std::vector<std::string> known;
    for (const Shape& shape : shapes) known.push_back(shape.name);
    const Mapping entries = mapping(node, "the primitive", known);
    if (entries.entries.size() != 1) {
      refuse(node, "a primitive is one shape", fmt::format("{} shapes", entries.entries.size()),
             fmt::format("one of {}", fmt::join(known, ", ")));
    }
    const auto& [name, parameters] = *entries.entries.begin();
    const auto shape =
        std::find_if(shapes.begin(), shapes.end(), [&](const Shape& s) { return s.name == name; });
    const Mapping read = mapping(parameters, name, shape->parameters);
    return with_line(node, [&] { return shape->make(read); });
  }

  SceneRobot robot(const YAML::Node& node) {
    const Mapping entries =
        mapping(node, "the robot", {"urdf", "base", "points_per_m2", "exclude", "tool"});
    SceneRobot robot;
    robot.urdf = base_folder_ / text(entries.need("urdf"), "the path of a URDF file");
    if (const auto* entry = entries.find("base")) robot.X_WB = pose(*entry);
    if (const auto* entry = entries.find("points_per_m2")) robot.points_per_m2 = positive(*entry);
    if (const auto* entry = entries.find("exclude")) {
      for (const YAML::Node& link : list(*entry, "a list of links")) {
        robot.exclude.push_back(text(link, "the name of a link"));
      }
    }
    if (const auto* entry = entries.find("tool")) robot.tool = text(*entry, "the name of a frame");
    return robot;
  }

  std::filesystem::path base_folder_;
  std::string where_;
  std::set<std::string> names_;
  int numbers_ = 0;
};

}  // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& base_folder,
                  const std::string& where) {
  constexpr std::size_t most_bytes = 4 << 20;
  if (text.size() > most_bytes) {
    throw Error({.where = where,
                 .what = "too large for a scene",
                 .found = fmt::format("{} bytes", text.size()),
                 .expected = fmt::format("at most {}", most_bytes)});
  }
  SceneReader reader(base_folder, where);
  try {
    return reader.read(std::string(text));
  } catch (const YAML::Exception& e) {
    reader.refuse_text(e);
  }
}

Scene read_scene(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file || std::filesystem::is_directory(path)) {
    throw Error({.where = path.string(),
                 .what = "the scene file cannot be opened",
                 .expected = "a YAML file that may be read"});
  }
  constexpr std::size_t more_than_allowed = (4 << 20) + 1;
  std::string text(more_than_allowed, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  return parse_scene(text, path.parent_path(), path.string());
}

}  // namespace vicinity
