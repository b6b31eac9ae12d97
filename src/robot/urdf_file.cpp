// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/urdf_file.h"

#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "urdf_geometry.h"
#include "vicinity/geometry/error.h"
#include "xml_element.h"

namespace vicinity {
namespace {

constexpr std::size_t largest_file = std::size_t{1} << 26;  // 64 MiB; real ones have some 10 kB

std::string read_text(const std::filesystem::path& path) {
  const auto refuse = [&](std::string what) {
    throw Error({.where = path.string(), .what = std::move(what)});
  };
  std::error_code error;
  const auto size = std::filesystem::file_size(path, error);  // fails for a folder, too
  if (error) refuse("the file cannot be opened");
  if (size > largest_file) refuse("this is too large for a URDF file");
  std::string text(size, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(size));
  if (!file) refuse("the file cannot be read");
  return text;
}

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

// A joint as the file has it: links and joints by name, in the file's order.
struct FileJoint {
  Joint joint;
  int line = 0;
  std::string parent, child;
  std::string follows;  // the joint it mimics; empty for none
};

class UrdfReader {
 public:
  UrdfReader(const std::filesystem::path& path, const UrdfOptions& options)
      : path_(path), options_(options), geometry_(path_, options_, load_.remarks) {}

  RobotLoad read(std::string_view text) {
    const XmlElement root = parse_xml(text, path_.string());
    read_root(root);
    for (const XmlElement& element : root.children) {
      if (element.name == "link") read_link(element);
    }
    for (const XmlElement& element : root.children) {
      if (element.name == "joint") read_joint(element);
    }
    if (links_.empty()) refuse(root.line, "there is no link");
    remark_links();
    resolve_mimics();
    number_coordinates();
    grow_tree();
    check(load_.robot);
    return std::move(load_);
  }

 private:
  std::string at(int line) const { return fmt::format("{}:{}", path_.string(), line); }
  [[noreturn]] void refuse(int line, std::string what, std::string hint = {}) const {
    throw Error({.where = at(line), .what = std::move(what), .hint = std::move(hint)});
  }
  void remark(int line, const std::string& sentence) {
    load_.remarks.push_back(fmt::format("line {}: {}", line, sentence));
  }

  const std::string& required(const XmlElement& element, const char* attribute) const {
    const std::string* value = element.attribute(attribute);
    if (!value || value->empty()) {
      refuse(element.line, fmt::format("<{}> has no {}", element.name, attribute));
    }
    return *value;
  }

  void read_root(const XmlElement& root) {
    if (root.name != "robot") {
      throw Error({.where = at(root.line),
                   .what = "this is not a URDF file",
                   .found = fmt::format("<{}>", root.name),
                   .expected = "<robot>"});
    }
    for (const XmlElement& element : root.children) {
      if (element.name.starts_with("xacro:")) {
        refuse(element.line, "this is a xacro file and not yet a URDF file",
               fmt::format("xacro {} > robot.urdf", path_.filename().string()));
      }
    }
    const std::string* name = root.attribute("name");
    load_.robot.name = name && !name->empty() ? *name : path_.stem().string();
    if (!name || name->empty()) {
      remark(root.line, fmt::format("the robot has no name; called '{}'", load_.robot.name));
    }
  }

  void read_link(const XmlElement& element) {
    Link link;
    link.name = required(element, "name");
    if (link_of_.contains(link.name)) {
      refuse(element.line, fmt::format("a second link named '{}'", link.name));
    }
    using Role = LinkGeometry::Role;
    const auto read_parts = [&](Role role) {
      const std::string_view tag = role == Role::visual ? "visual" : "collision";
      for (const XmlElement& part : element.children) {
        if (part.name != tag) continue;
        if (auto mesh = geometry_.read(part, link.name)) {
          link.geometries.push_back({role, std::move(*mesh)});
        }
      }
    };
    read_parts(options_.geometry);
    if (link.geometries.empty()) {
      read_parts(options_.geometry == Role::visual ? Role::collision : Role::visual);
      (link.geometries.empty() ? bare_ : substituted_).push_back(link.name);
    }
    const XmlElement* inertial = element.child("inertial");
    const XmlElement* mass = inertial ? inertial->child("mass") : nullptr;
    if (!mass) {
      without_inertia_.push_back(link.name);
    } else if (const std::string* value = mass->attribute("value");
               !value || std::strtod(value->c_str(), nullptr) <= 0) {
      without_mass_.push_back(link.name);
    }
    if (inertial && mass) link.inertia = inertia_of(*inertial, *mass);
    link_of_.emplace(link.name, links_.size());
    links_.push_back(std::move(link));
  }

  // Only a simulation needs it, which says what is missing: a reader that is after the drag does
  // not refuse an arm because of it.
  static std::optional<LinkInertia> inertia_of(const XmlElement& inertial, const XmlElement& mass) {
    const XmlElement* tensor = inertial.child("inertia");
    if (!tensor) return std::nullopt;
    const auto numbers = [](const XmlElement* element, const char* attribute, auto& values) {
      values.setZero();
      const std::string* text = element ? element->attribute(attribute) : nullptr;
      if (!text) return;
      const char* at = text->c_str();
      for (Eigen::Index n = 0; n < values.size(); ++n) {
        char* end = nullptr;
        values[n] = std::strtod(at, &end);
        if (end == at) values[n] = std::numeric_limits<double>::quiet_NaN();
        at = end;
      }
    };
    const auto number = [&](const XmlElement& element, const char* attribute) {
      Eigen::Matrix<double, 1, 1> value;
      numbers(&element, attribute, value);
      return value[0];
    };
    LinkInertia inertia;
    Vec3 xyz, rpy;
    numbers(inertial.child("origin"), "xyz", xyz);
    numbers(inertial.child("origin"), "rpy", rpy);
    inertia.mass = number(mass, "value");
    inertia.X_LC = pose_from_rpy(xyz, rpy);
    const double xy = number(*tensor, "ixy"), xz = number(*tensor, "ixz"),
                 yz = number(*tensor, "iyz");
    inertia.about_centre << number(*tensor, "ixx"), xy, xz, xy, number(*tensor, "iyy"), yz, xz, yz,
        number(*tensor, "izz");
    const bool usable = inertia.mass > 0 && std::isfinite(inertia.mass) &&
                        inertia.X_LC.matrix().allFinite() && inertia.about_centre.allFinite();
    return usable ? std::optional(inertia) : std::nullopt;
  }

  void remark_links() {
    const bool visual = options_.geometry == LinkGeometry::Role::visual;
    const auto about = [&](const std::vector<std::string>& names, std::string_view what) {
      if (names.empty()) return;
      load_.remarks.push_back(
          fmt::format("{} of {} links {}: {}", names.size(), links_.size(), what, listed(names)));
    };
    about(substituted_, visual ? "have no visual geometry, so that collision geometry is used"
                               : "have no collision geometry, so that visual geometry is used");
    about(bare_, "have no surface, so that nothing is felt there");
    about(without_inertia_, "state no inertia, which drag does not need");
    about(without_mass_, "state no mass above zero, which drag does not need");
  }

  void read_joint(const XmlElement& element) {
    FileJoint file;
    file.line = element.line;
    file.joint.name = required(element, "name");
    const std::string where = fmt::format("{}: joint '{}'", at(element.line), file.joint.name);
    if (!joint_of_.emplace(file.joint.name, joints_.size()).second) {
      refuse(element.line, fmt::format("a second joint named '{}'", file.joint.name));
    }
    const auto link_named = [&](const char* end) {
      const XmlElement* child = element.child(end);
      if (!child) {
        refuse(element.line, fmt::format("joint '{}' has no {}", file.joint.name, end));
      }
      const std::string& name = required(*child, "link");
      if (!link_of_.contains(name)) {
        refuse(child->line,
               fmt::format("joint '{}' names link '{}' as its {}, which does not exist",
                           file.joint.name, name, end));
      }
      return name;
    };
    file.parent = link_named("parent");
    file.child = link_named("child");
    file.joint.X_PJ = read_origin(element, where);
    read_type(element, file);
    read_axis(element, file, where);
    read_limits(element, file, where);
    if (const XmlElement* mimic = element.child("mimic");
        mimic && file.joint.type != JointType::fixed) {
      file.follows = required(*mimic, "joint");
      file.joint.multiplier = read_number(*mimic, "multiplier", 1, where + ", mimic");
      file.joint.offset = read_number(*mimic, "offset", 0, where + ", mimic");
    }
    joints_.push_back(std::move(file));
  }

  void read_type(const XmlElement& element, FileJoint& file) {
    static const std::map<std::string_view, JointType> types = {
        {"fixed", JointType::fixed},
        {"revolute", JointType::revolute},
        {"continuous", JointType::continuous},
        {"prismatic", JointType::prismatic}};
    const std::string& type = required(element, "type");
    if (const auto known = types.find(type); known != types.end()) {
      file.joint.type = known->second;
    } else {
      remark(element.line, fmt::format("joint '{}' is of type '{}', which is taken as fixed",
                                       file.joint.name, type));
    }
  }

  void read_axis(const XmlElement& element, FileJoint& file, const std::string& where) {
    Joint& joint = file.joint;
    const XmlElement* axis = element.child("axis");
    if (!axis) return;  // x, as the format has it
    const Vec3 stated = read_triple(*axis, "xyz", Vec3::UnitX(), where + ", axis");
    const double length = stated.stableNorm();
    if (length == 0) {
      remark(axis->line,
             joint.type == JointType::fixed
                 ? fmt::format("joint '{}' has a zero axis, which a fixed joint does not need",
                               joint.name)
                 : fmt::format("joint '{}' has a zero axis, so that it cannot move: taken as fixed",
                               joint.name));
      joint.type = JointType::fixed;
      return;
    }
    // Four digits, as in "0.7071", are how a unit vector is written.
    if (std::abs(length - 1) > 1e-3) {
      remark(axis->line,
             fmt::format("the axis of joint '{}' has length {:g}; normalised", joint.name, length));
    }
    joint.axis_J = (stated / stated.cwiseAbs().maxCoeff()).normalized();
  }

  void read_limits(const XmlElement& element, FileJoint& file, const std::string& where) {
    Joint& joint = file.joint;
    if (joint.type == JointType::fixed) return;
    const XmlElement* limit = element.child("limit");
    const bool bounded = joint.type != JointType::continuous;
    if (!limit) {
      if (bounded) remark(element.line, fmt::format("joint '{}' has no limits", joint.name));
      return;
    }
    const auto rate = [&](const char* attribute, double& to) {
      const double stated = read_number(*limit, attribute, to, where + ", limit");
      if (stated > 0) {
        to = stated;
      } else {
        remark(limit->line, fmt::format("joint '{}' has {} limit {:g}, which is taken as none",
                                        joint.name, attribute, stated));
      }
    };
    rate("velocity", joint.limits.velocity);
    rate("effort", joint.limits.effort);
    if (!bounded) return;
    if (!limit->attribute("lower") && !limit->attribute("upper")) {
      remark(limit->line, fmt::format("joint '{}' has no position limits", joint.name));
      return;
    }
    double lower = read_number(*limit, "lower", 0, where + ", limit");
    double upper = read_number(*limit, "upper", 0, where + ", limit");
    if (lower > upper) {
      remark(limit->line, fmt::format("joint '{}' has its limits reversed, {:g} to {:g}; swapped",
                                      joint.name, lower, upper));
      std::swap(lower, upper);
    }
    if (lower > 0 || upper < 0) {
      remark(limit->line, fmt::format("joint '{}' cannot be at zero: its limits are {:g} to {:g}",
                                      joint.name, lower, upper));
    }
    if (lower == upper) {
      remark(limit->line,
             fmt::format("joint '{}' cannot move: both its limits are {:g}", joint.name, lower));
    }
    joint.limits.lower = lower;
    joint.limits.upper = upper;
  }

  // Makes every mimic joint follow one that moves by itself.
  void resolve_mimics() {
    const auto release = [&](FileJoint& file, std::string_view why) {
      remark(file.line,
             fmt::format("joint '{}' mimics {}; it moves by itself", file.joint.name, why));
      file.follows.clear();
      file.joint.multiplier = 1;
      file.joint.offset = 0;
    };
    for (FileJoint& file : joints_) {
      if (!file.follows.empty() && !joint_of_.contains(file.follows)) {
        release(file, fmt::format("joint '{}', which does not exist", file.follows));
      }
    }
    for (FileJoint& file : joints_) {
      const FileJoint* leader = &file;
      for (std::size_t step = 0; step < joints_.size() && !leader->follows.empty(); ++step) {
        leader = &joints_[joint_of_.at(leader->follows)];
      }
      if (!leader->follows.empty()) release(file, "itself, by way of those that it follows");
    }
    // A chain shortens from its front: q = m1 (m2 q2 + o2) + o1.
    for (FileJoint& file : joints_) {
      while (!file.follows.empty()) {
        const FileJoint& leader = joints_[joint_of_.at(file.follows)];
        if (leader.follows.empty()) break;
        file.joint.offset += file.joint.multiplier * leader.joint.offset;
        file.joint.multiplier *= leader.joint.multiplier;
        file.follows = leader.follows;
      }
    }
  }

  void number_coordinates() {
    for (FileJoint& file : joints_) {
      if (!file.follows.empty() || file.joint.type == JointType::fixed) continue;
      file.joint.coordinate = static_cast<int>(coordinate_names_.size());
      coordinate_names_.push_back(file.joint.name);
    }
    for (FileJoint& file : joints_) {
      if (file.follows.empty()) continue;
      const Joint& leader = joints_[joint_of_.at(file.follows)].joint;
      file.joint.coordinate = leader.coordinate;
      if (leader.coordinate < 0) {
        remark(file.line, fmt::format("joint '{}' mimics the fixed joint '{}'; it stays at {:g}",
                                      file.joint.name, leader.name, file.joint.offset));
      }
    }
  }

  // Links and joints from the root on, each branch to its end before the next, in the file's order.
  void grow_tree() {
    std::vector<std::vector<std::size_t>> joints_on(links_.size());
    std::vector<const FileJoint*> joint_above(links_.size(), nullptr);
    for (std::size_t i = 0; i < joints_.size(); ++i) {
      const FileJoint& file = joints_[i];
      const FileJoint*& above = joint_above[link_of_.at(file.child)];
      if (above) {
        refuse(file.line, fmt::format("link '{}' hangs on two joints, '{}' and '{}'", file.child,
                                      above->joint.name, file.joint.name));
      }
      above = &file;
      joints_on[link_of_.at(file.parent)].push_back(i);
    }
    const std::size_t root = find_root(joint_above);

    RobotModel& robot = load_.robot;
    std::vector<int> number(links_.size(), -1);  // of a link in the tree
    number[root] = 0;
    robot.links.push_back(std::move(links_[root]));
    std::vector<std::size_t> next(joints_on[root].rbegin(), joints_on[root].rend());
    while (!next.empty()) {
      FileJoint& file = joints_[next.back()];
      next.pop_back();
      const std::size_t child = link_of_.at(file.child);
      file.joint.parent = number[link_of_.at(file.parent)];
      number[child] = static_cast<int>(robot.links.size());
      robot.links.push_back(std::move(links_[child]));
      robot.joints.push_back(std::move(file.joint));
      next.insert(next.end(), joints_on[child].rbegin(), joints_on[child].rend());
    }
    for (std::size_t link = 0; link < links_.size(); ++link) {
      if (number[link] < 0) {
        refuse(joint_above[link]->line,
               fmt::format("the joints make a loop at '{}'", joint_above[link]->joint.name));
      }
    }
    for (const std::string& name : coordinate_names_) {
      robot.coordinates.push_back(*robot.find_joint(name));
    }
  }

  std::size_t find_root(const std::vector<const FileJoint*>& joint_above) const {
    std::optional<std::size_t> root;
    for (std::size_t link = 0; link < links_.size(); ++link) {
      if (joint_above[link]) continue;
      if (root) {
        throw Error({.where = path_.string(),
                     .what = fmt::format("there are two roots: no joint carries link '{}' or '{}'",
                                         links_[*root].name, links_[link].name)});
      }
      root = link;
    }
    if (!root) {
      refuse(joint_above[0]->line, "the joints make a loop: every link hangs on another");
    }
    return *root;
  }

  const std::filesystem::path& path_;
  const UrdfOptions& options_;
  RobotLoad load_;
  UrdfGeometry geometry_;
  std::vector<Link> links_;  // in the file's order, as the joints
  std::vector<FileJoint> joints_;
  std::map<std::string, std::size_t, std::less<>> link_of_, joint_of_;
  std::vector<std::string> coordinate_names_;
  std::vector<std::string> substituted_, bare_, without_inertia_, without_mass_;
};

}  // namespace

RobotLoad read_urdf(const std::filesystem::path& path, const UrdfOptions& options) {
  return UrdfReader(path, options).read(read_text(path));
}

RobotLoad parse_urdf(std::string_view text, const std::filesystem::path& where,
                     const UrdfOptions& options) {
  return UrdfReader(where, options).read(text);
}

}  // namespace vicinity
