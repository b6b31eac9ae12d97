// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

#include "vicinity/robot/urdf_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "robot/robots.h"
#include "vicinity/geometry/error.h"
#include "vicinity/mesh/primitive.h"
#include "vicinity/mesh/stl_file.h"

namespace vicinity {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::string remarks_of(const RobotLoad& load) {
  std::string all;
  for (const std::string& remark : load.remarks) all += remark + "\n";
  return all;
}

// A folder of its own for each test, removed at its end.
class UrdfFile : public testing::Test {
 protected:
  UrdfFile() {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / ("vicinity_urdf_" + std::string(test->name()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  ~UrdfFile() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  fs::path write(const std::string& name, const std::string& text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }

  RobotLoad load(const std::string& inside, const UrdfOptions& options = {}) {
    return read_urdf(write("arm.urdf", "<robot name='arm'>\n" + inside + "\n</robot>"), options);
  }

  // Two links and what is between them.
  RobotLoad load_joint(const std::string& type, const std::string& inside) {
    return load(two_links + "<joint name='elbow' type='" + type +
                "'><parent link='upper'/><child link='lower'/>" + inside + "</joint>");
  }

  // The sentence it is refused with.
  std::string refusal(const std::string& text) {
    try {
      read_urdf(write("bad.urdf", text));
    } catch (const Error& error) {
      return error.what();
    }
    return "not refused";
  }
  std::string refusal_inside(const std::string& inside) {
    return refusal("<robot name='arm'>\n" + inside + "\n</robot>");
  }

  const std::string two_links = "<link name='upper'/><link name='lower'/>\n";
  fs::path folder_;
};

TEST(Urdf, KinovaLoadsWithEveryOddityReported) {
  const auto file = robot_file(kinova);
  if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
  const RobotLoad load = read_urdf(file);
  SCOPED_TRACE(remarks_of(load));
  EXPECT_EQ(load.robot.name, "GEN3-7DOF-NOVISION_FOR_URDF_ARM_V12");
  EXPECT_EQ(load.robot.links.size(), 9u);
  EXPECT_EQ(load.robot.joints.size(), 8u);
  ASSERT_EQ(load.robot.coordinates.size(), 7u);
  for (int c = 0; c < 7; ++c) {
    const auto joint =
        static_cast<std::size_t>(load.robot.coordinates[static_cast<std::size_t>(c)]);
    EXPECT_EQ(load.robot.joints[joint].name, "joint_" + std::to_string(c + 1));
    EXPECT_EQ(load.robot.joints[joint].type,
              c % 2 == 0 ? JointType::continuous : JointType::revolute);
  }
  EXPECT_EQ(load.robot.joints[1].limits.upper, 2.24);
  EXPECT_EQ(load.robot.joints[1].limits.velocity, 1.3963);
  EXPECT_EQ(load.robot.joints[1].limits.effort, 39);
  EXPECT_TRUE(std::isinf(load.robot.joints[0].limits.upper));
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("end_effector"), HasSubstr("zero axis"))));
  EXPECT_THAT(load.remarks,
              Contains(AllOf(HasSubstr("no surface"), HasSubstr("end_effector_link"))));
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("no mass"), HasSubstr("end_effector_link"))));
  EXPECT_THAT(load.remarks, Contains(HasSubstr("shoulder_link.STL")));
  EXPECT_THAT(load.remarks, Each(Not(HasSubstr("left out"))));
  // The arm is about 0.9 m long, in links that fit in hand.
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_EQ(load.robot.links[i].geometries.size(), 1u);
    const double size = load.robot.links[i].geometries[0].mesh.bounds().sizes().maxCoeff();
    EXPECT_GT(size, 0.05);
    EXPECT_LT(size, 0.4);
  }
}

TEST(Urdf, FanucLoadsWithEveryOddityReported) {
  const auto file = robot_file(fanuc);
  if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
  const RobotLoad load = read_urdf(file);
  SCOPED_TRACE(remarks_of(load));
  EXPECT_EQ(load.robot.links.size(), 9u);
  EXPECT_EQ(load.robot.joints.size(), 8u);
  EXPECT_EQ(load.robot.coordinates.size(), 6u);
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("no inertia"), HasSubstr("9 of 9 links"))));
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("no surface"), HasSubstr("tool0, base"))));
  for (int joint = 1; joint <= 6; ++joint) {
    EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("'joint_" + std::to_string(joint) + "'"),
                                             HasSubstr("effort limit 0"))));
  }
  EXPECT_TRUE(std::isinf(load.robot.joints[0].limits.effort));
  for (const Link& link : load.robot.links) {
    for (const LinkGeometry& geometry : link.geometries) {
      EXPECT_EQ(geometry.role, LinkGeometry::Role::collision);
    }
  }
}

TEST(Urdf, PhantomOmniLoadsWithEveryOddityReported) {
  const auto file = robot_file(omni);
  if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
  const RobotLoad load = read_urdf(file);
  SCOPED_TRACE(remarks_of(load));
  EXPECT_EQ(load.robot.links.size(), 7u);
  EXPECT_EQ(load.robot.coordinates.size(), 6u);
  EXPECT_THAT(load.remarks,
              Contains(AllOf(HasSubstr("no collision geometry"),
                             HasSubstr("visual geometry is used"), HasSubstr("7 of 7 links"))));
  EXPECT_THAT(load.remarks, Contains(HasSubstr("no inertia")));
  EXPECT_THAT(load.remarks,
              Contains(AllOf(HasSubstr("'yaw' cannot be at zero"), HasSubstr("3.92 to 8.83"))));
  for (const char* mesh : {"base.stl: 2848", "torso.stl: 5676", "tip.stl: 7694"}) {
    EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr(mesh), HasSubstr("normals are zero"))));
  }
  for (const Link& link : load.robot.links) {
    ASSERT_EQ(link.geometries.size(), 1u);
    EXPECT_EQ(link.geometries[0].role, LinkGeometry::Role::visual);
  }
}

TEST(Urdf, ARobotWhoseMeshesAreGoneStillMoves) {
  const auto file = robot_file(kinova);
  if (file.empty()) GTEST_SKIP() << "set VICINITY_DATA to the folder of real data";
  const fs::path alone = fs::path(testing::TempDir()) / "vicinity_alone.urdf";
  fs::copy_file(file, alone, fs::copy_options::overwrite_existing);
  const RobotLoad load = read_urdf(alone);
  EXPECT_EQ(load.robot.coordinates.size(), 7u);
  EXPECT_THAT(load.remarks,
              Contains(AllOf(HasSubstr("base_link.STL' is not there"), HasSubstr("left out"))));
  EXPECT_THAT(load.remarks, Contains(HasSubstr("9 of 9 links have no surface")));

  // The option leads to them again: the folder that holds the package, and the package itself.
  const fs::path package =
      file.parent_path().parent_path().parent_path().parent_path().parent_path();
  ASSERT_EQ(package.filename(), "kortex_description");
  for (const fs::path& given : {package, package / "", package.parent_path()}) {
    const RobotLoad found = read_urdf(alone, {.package_folders = {given}});
    EXPECT_THAT(found.remarks, Each(Not(HasSubstr("is not there")))) << given;
    EXPECT_EQ(found.robot.links[1].geometries.size(), 1u);
  }
  fs::remove(alone);
}

TEST_F(UrdfFile, LinksComeInOnePassOrderAndCoordinatesInTheFilesOrder) {
  const auto joint = [](const char* name, const char* type, const char* parent, const char* child) {
    return std::string("<joint name='") + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/><limit lower='-1' upper='1' effort='1' velocity='1'/>" +
           "</joint>\n";
  };
  const RobotLoad load = this->load(
      "<link name='tip'/><link name='arm'/><link name='base'/><link name='camera'/>" +
      joint("wrist", "revolute", "arm", "tip") + joint("mount", "fixed", "base", "camera") +
      joint("slide", "prismatic", "base", "arm"));
  const auto& robot = load.robot;
  EXPECT_EQ(robot.links[0].name, "base");
  EXPECT_EQ(robot.links[1].name, "camera");
  EXPECT_EQ(robot.links[2].name, "arm");
  EXPECT_EQ(robot.links[3].name, "tip");
  EXPECT_THAT(robot.coordinates, ElementsAre(2, 1)) << "wrist first, then slide";
  EXPECT_EQ(robot.joints[2].coordinate, 0);
  EXPECT_EQ(robot.joints[1].coordinate, 1);
  EXPECT_EQ(robot.joints[2].parent, 2);
  EXPECT_EQ(robot.find_joint("slide"), 1);
  EXPECT_EQ(robot.find_link("nothing"), std::nullopt);
}

TEST_F(UrdfFile, MimicsFollowThroughChains) {
  const auto joint = [](const std::string& name, const std::string& follows, double by,
                        double from) {
    return "<link name='" + name + "_link'/><joint name='" + name +
           "' type='continuous'><parent link='base'/><child link='" + name + "_link'/>" +
           (follows.empty() ? ""
                            : "<mimic joint='" + follows + "' multiplier='" + std::to_string(by) +
                                  "' offset='" + std::to_string(from) + "'/>") +
           "</joint>\n";
  };
  const RobotLoad load = this->load("<link name='base'/>" + joint("third", "second", 3, 0.5) +
                                    joint("second", "first", 2, 0.25) + joint("first", "", 0, 0) +
                                    joint("lost", "nobody", 5, 5) + joint("hen", "egg", 2, 1) +
                                    joint("egg", "hen", 3, 1));
  SCOPED_TRACE(remarks_of(load));
  const auto at = [&](const char* name) {
    return load.robot.joints[static_cast<std::size_t>(*load.robot.find_joint(name))];
  };
  EXPECT_EQ(load.robot.coordinates.size(), 3u) << "first, lost and hen";
  EXPECT_EQ(at("first").coordinate, 0);
  EXPECT_EQ(at("third").coordinate, 0);
  EXPECT_DOUBLE_EQ(at("third").multiplier, 6);
  EXPECT_DOUBLE_EQ(at("third").offset, 3 * 0.25 + 0.5);
  EXPECT_EQ(at("lost").coordinate, 1);
  EXPECT_EQ(at("lost").multiplier, 1);
  EXPECT_EQ(at("hen").coordinate, 2);
  EXPECT_EQ(at("egg").coordinate, 2);
  EXPECT_EQ(at("egg").multiplier, 3);
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("'lost'"), HasSubstr("'nobody'"))));
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("'hen'"), HasSubstr("itself"))));
}

TEST_F(UrdfFile, OddJointsAreSurvivedAndRemarked) {
  const std::string good = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
  const std::string with_limits = "<axis xyz='0 0 1'/>" + good;
  EXPECT_THAT(remarks_of(load_joint("revolute", with_limits)), Not(HasSubstr("elbow")));

  RobotLoad load = load_joint("revolute", "<axis xyz='0 3 4'/>" + good);
  EXPECT_THAT(load.remarks, Contains(HasSubstr("has length 5; normalised")));
  EXPECT_LT((load.robot.joints[0].axis_J - Vec3(0, 0.6, 0.8)).norm(), 1e-15);

  load = load_joint("revolute", "<axis xyz='1e-300 0 0'/>" + good);
  EXPECT_EQ(load.robot.joints[0].axis_J, Vec3(1, 0, 0));

  load = load_joint("revolute", "<axis xyz='0 0 0'/>" + good);
  EXPECT_THAT(load.remarks, Contains(HasSubstr("zero axis, so that it cannot move")));
  EXPECT_THAT(load.robot.coordinates, IsEmpty());

  load = load_joint("revolute", "");
  EXPECT_THAT(load.remarks, Contains(HasSubstr("'elbow' has no limits")));
  EXPECT_EQ(load.robot.joints[0].axis_J, Vec3(1, 0, 0)) << "the format's default";
  EXPECT_EQ(load.robot.joints[0].limits.lower, -std::numeric_limits<double>::infinity());
  EXPECT_THAT(remarks_of(load_joint("continuous", "")), Not(HasSubstr("elbow")));

  load = load_joint("prismatic", "<limit lower='2' upper='-1' effort='1' velocity='1'/>");
  EXPECT_THAT(load.remarks, Contains(HasSubstr("limits reversed, 2 to -1; swapped")));
  EXPECT_EQ(load.robot.joints[0].limits.lower, -1);
  EXPECT_EQ(load.robot.joints[0].limits.upper, 2);

  EXPECT_THAT(load_joint("revolute", "<limit effort='1' velocity='1'/>").remarks,
              Contains(HasSubstr("no position limits")));
  for (const char* type : {"floating", "planar", "spherical"}) {
    load = load_joint(type, "");
    EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr(type), HasSubstr("taken as fixed"))));
    EXPECT_EQ(load.robot.joints[0].type, JointType::fixed);
  }
}

TEST_F(UrdfFile, ShapesBecomeClosedMeshesWhereTheFileSays) {
  const auto shape = [](const std::string& text) {
    return "<link name='" + text.substr(1, text.find(' ') - 1) +
           "'><collision><origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/><geometry>" + text +
           "</geometry></collision></link>";
  };
  const auto loaded = [&](const std::string& text) {
    const RobotLoad load = this->load(shape(text));
    EXPECT_EQ(load.robot.links[0].geometries.size(), 1u) << remarks_of(load);
    return load.robot.links[0].geometries.at(0).mesh.bounds();
  };
  const auto expect = [](const Box& box, const Vec3& size) {
    EXPECT_LT((box.sizes() - size).norm(), 1e-3);
    EXPECT_LT((box.center() - Vec3(1, 2, 3)).norm(), 1e-3);
  };
  expect(loaded("<box size='0.1 0.2 0.3'/>"), {0.2, 0.1, 0.3});
  expect(loaded("<sphere radius='0.1'/>"), {0.2, 0.2, 0.2});
  expect(loaded("<cylinder radius='0.1' length='0.5'/>"), {0.2, 0.2, 0.5});
  expect(loaded("<capsule radius='0.1' length='0.5'/>"), {0.2, 0.2, 0.7});
}

TEST_F(UrdfFile, MeshesAreFoundByEveryKindOfAddressAndScaled) {
  fs::create_directories(folder_ / "arm_description/meshes");
  write_stl(primitive::box({1, 2, 3}), folder_ / "arm_description/meshes/box.stl");
  const auto size = [&](const std::string& address, const std::string& more = "") {
    const RobotLoad load =
        read_urdf(write("arm_description/urdf/arm.urdf",
                        "<robot name='arm'><link name='l'><visual><geometry><mesh filename='" +
                            address + "' " + more + "/></geometry></visual></link></robot>"));
    EXPECT_EQ(load.robot.links[0].geometries.size(), 1u) << remarks_of(load);
    return load.robot.links[0].geometries.empty()
               ? Vec3(0, 0, 0)
               : Vec3(load.robot.links[0].geometries[0].mesh.bounds().sizes());
  };
  const Vec3 whole(1, 2, 3);
  EXPECT_EQ(size("package://arm_description/meshes/box.stl"), whole);
  EXPECT_EQ(size("model://arm_description/meshes/box.stl"), whole);
  EXPECT_EQ(size("../meshes/box.stl"), whole);
  EXPECT_EQ(size("file://../meshes/box.stl"), whole);
  EXPECT_EQ(size("file://" + (folder_ / "arm_description/meshes/box.stl").string()), whole);
  EXPECT_EQ(size((folder_ / "arm_description/meshes/box.stl").string()), whole);
  EXPECT_EQ(size("../meshes/box.stl", "scale='2 2 -2'"), Vec3(2, 4, 6));
}

TEST_F(UrdfFile, AMirroredMeshStillFacesOutward) {
  write_stl(primitive::box({1, 1, 1}), folder_ / "box.stl");
  const RobotLoad load = this->load(
      "<link name='l'><visual><geometry><mesh filename='box.stl' scale='1 1 -1'/></geometry>"
      "</visual></link>");
  const TriangleMesh& mesh = load.robot.links[0].geometries.at(0).mesh;
  double volume = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices[a].dot(mesh.vertices[b].cross(mesh.vertices[c])) / 6;
  }
  EXPECT_NEAR(volume, 1, 1e-12);
}

TEST_F(UrdfFile, OddGeometryIsSurvivedAndRemarked) {
  TriangleMesh open = primitive::box({0.1, 0.1, 0.1});
  open.triangles.pop_back();
  write_stl(open, folder_ / "open.stl");
  write_stl(primitive::box({300, 200, 100}), folder_ / "in_millimetres.stl");
  write("garbage.stl", "not a mesh");
  const auto remarks = [&](const std::string& geometry) {
    return this->load("<link name='forearm'><collision>" + geometry + "</collision></link>")
        .remarks;
  };
  const auto mesh = [&](const std::string& file) {
    return remarks("<geometry><mesh filename='" + file + "'/></geometry>");
  };
  EXPECT_THAT(mesh("open.stl"), Contains(AllOf(HasSubstr("open.stl"), HasSubstr("open edges"))));
  EXPECT_THAT(mesh("in_millimetres.stl"),
              Contains(AllOf(HasSubstr("300 m long"), HasSubstr("in metres"))));
  EXPECT_THAT(
      remarks("<geometry><mesh filename='in_millimetres.stl' scale='1e308 1 1'/></geometry>"),
      Contains(AllOf(HasSubstr("forearm"), HasSubstr("left out"))));
  for (const char* dead : {"nowhere.stl", "", ".", "package://", "package://nowhere/x.stl",
                           "http://example.org/x.stl", "garbage.stl", "../../../..//", "file://"}) {
    EXPECT_THAT(mesh(dead), Contains(AllOf(HasSubstr("forearm"), HasSubstr("left out")))) << dead;
  }
  for (const char* shape :
       {"", "<geometry/>", "<geometry><teapot/></geometry>", "<geometry><mesh/></geometry>",
        "<geometry><mesh filename='open.stl' scale='0 1 1'/></geometry>",
        "<geometry><box size='1 2'/></geometry>", "<geometry><box size='1 2 nan'/></geometry>",
        "<geometry><sphere radius='-1'/></geometry>", "<geometry><cylinder/></geometry>",
        "<geometry><capsule radius='0' length='0'/></geometry>",
        "<origin xyz='here'/><geometry><sphere radius='1'/></geometry>"}) {
    EXPECT_THAT(remarks(shape), Contains(AllOf(HasSubstr("forearm"), HasSubstr("left out"))))
        << shape;
  }
}

TEST_F(UrdfFile, TheOtherGeometryStandsInForOneThatIsGone) {
  const std::string link =
      "<link name='l'><collision><geometry><mesh filename='gone.stl'/></geometry></collision>"
      "<visual><geometry><sphere radius='0.1'/></geometry></visual></link>";
  const RobotLoad load = this->load(link);
  ASSERT_EQ(load.robot.links[0].geometries.size(), 1u);
  EXPECT_EQ(load.robot.links[0].geometries[0].role, LinkGeometry::Role::visual);
  EXPECT_THAT(load.remarks, Contains(HasSubstr("visual geometry is used: l")));
}

TEST_F(UrdfFile, AColladaUnitIsAppliedAndSaid) {
  write("box.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="millimeter" meter="0.001"/><up_axis>Z_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 100 0 0 0 200 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>)");
  const RobotLoad load = this->load(
      "<link name='l'><visual><geometry><mesh filename='box.dae'/></geometry></visual></link>");
  SCOPED_TRACE(remarks_of(load));
  ASSERT_EQ(load.robot.links[0].geometries.size(), 1u);
  EXPECT_LT((load.robot.links[0].geometries[0].mesh.bounds().sizes() - Vec3(0.1, 0.2, 0)).norm(),
            1e-6);
  EXPECT_THAT(load.remarks, Contains(AllOf(HasSubstr("box.dae"), HasSubstr("unit of 0.001 m"))));
}

TEST_F(UrdfFile, WhatIsNoRobotIsRefusedWithOneSentenceAndALine) {
  EXPECT_THAT(refusal(""), HasSubstr("not well-formed XML"));
  EXPECT_THAT(refusal("hello"), HasSubstr("not well-formed XML"));
  EXPECT_THAT(refusal("<sdf><model/></sdf>"), AllOf(HasSubstr("not a URDF"), HasSubstr("<sdf>")));
  EXPECT_THAT(refusal("<robot name='r'>\n<link name='a'>\n</robot>"),
              AllOf(HasSubstr("bad.urdf:3"), HasSubstr("Start-end tags mismatch")));
  EXPECT_THAT(refusal("<robot name='r'/>\n<robot name='s'/>"),
              AllOf(HasSubstr("bad.urdf:2"), HasSubstr("second root element")));
  EXPECT_THAT(refusal_inside(""), HasSubstr("there is no link"));
  EXPECT_THAT(refusal_inside("<xacro:property name='x' value='1'/>"), HasSubstr("xacro"));
  EXPECT_THAT(refusal_inside("<link/>"), HasSubstr("<link> has no name"));
  EXPECT_THAT(refusal_inside("<link name='a'/>\n<link name='a'/>"),
              AllOf(HasSubstr("bad.urdf:3"), HasSubstr("second link named 'a'")));
  EXPECT_THAT(refusal_inside(two_links), HasSubstr("two roots"));

  const auto joint = [](const std::string& name, const std::string& parent,
                        const std::string& child, const std::string& inside = "") {
    return "<joint name='" + name + "' type='fixed'><parent link='" + parent + "'/><child link='" +
           child + "'/>" + inside + "</joint>\n";
  };
  EXPECT_THAT(
      refusal_inside(two_links + joint("j", "upper", "lower") + joint("j", "lower", "upper")),
      HasSubstr("second joint named 'j'"));
  EXPECT_THAT(
      refusal_inside(two_links + joint("j", "upper", "lower") + joint("k", "lower", "upper")),
      HasSubstr("loop"));
  EXPECT_THAT(refusal_inside("<link name='root'/>" + two_links + joint("j", "upper", "lower") +
                             joint("k", "lower", "upper")),
              HasSubstr("loop"));
  EXPECT_THAT(refusal_inside("<link name='a'/>" + joint("j", "a", "a")), HasSubstr("loop"));
  EXPECT_THAT(
      refusal_inside(two_links + joint("j", "upper", "lower") + joint("k", "upper", "lower")),
      HasSubstr("hangs on two joints, 'j' and 'k'"));
  EXPECT_THAT(refusal_inside(two_links + joint("j", "upper", "hand")),
              HasSubstr("names link 'hand' as its child"));
  EXPECT_THAT(refusal_inside(two_links + "<joint name='j' type='fixed'/>"), HasSubstr("no parent"));
  for (const char* bad : {"1 2", "1 2 3 4", "a b c", "1 2 inf", "1 2 nan", "1,2,3", ""}) {
    EXPECT_THAT(refusal_inside(two_links + joint("j", "upper", "lower",
                                                 "<origin xyz='" + std::string(bad) + "'/>")),
                HasSubstr("xyz cannot be read"));
  }
  EXPECT_THROW(read_urdf(folder_ / "nowhere.urdf"), Error);
  EXPECT_THROW(read_urdf(folder_), Error);
}

TEST_F(UrdfFile, XmlIsReadAsItIsMeant) {
  const RobotLoad load = read_urdf(write(
      "odd.urdf",
      "\xef\xbb\xbf<?xml version='1.0'?>\r\n<!DOCTYPE robot [<!ENTITY a \"b\">]>\r\n"
      "<!-- <link name='not this'/> --><robot name=\"&lt;a&amp;b&gt; &#65;&#x20ac;\" >"
      "text <![CDATA[<link name='nor this'/>]]>"
      "<link\n\tname = 'a' /><material name='m'><color rgba='1 2 3 4'/></material></robot>\n"));
  EXPECT_EQ(load.robot.name, "<a&b> A\xe2\x82\xac");
  ASSERT_EQ(load.robot.links.size(), 1u);
  EXPECT_EQ(load.robot.links[0].name, "a");
}

TEST_F(UrdfFile, BombsAndGarbageAreRefusedAndNotFelt) {
  std::string deep, closed;
  for (int i = 0; i < 1000000; ++i) {
    deep += "<a>";
    closed += "</a>";
  }
  EXPECT_THAT(refusal(deep), HasSubstr("not well-formed XML"));
  EXPECT_THAT(refusal(deep + closed), HasSubstr("nested deeper"));
  std::string laughs = "<!DOCTYPE r [<!ENTITY a \"ha\">";
  for (char c = 'b'; c < 'z'; ++c) {
    laughs += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) laughs += std::string("&") + static_cast<char>(c - 1) + ";";
    laughs += "\">";
  }
  EXPECT_EQ(read_urdf(write("laughs.urdf", laughs + "]><robot name='&y;'><link name='a'/></robot>"))
                .robot.name,
            "&y;");
  EXPECT_THAT(refusal(std::string("\x7f"
                                  "ELF\0\0\0\0",
                                  8)),
              HasSubstr("not well-formed XML"));
}

TEST_F(UrdfFile, DamagedFilesAreReadOrRefusedAndNeverCrash) {
  std::string whole =
      "<?xml version='1.0'?><robot name='arm'><link name='a'><collision><origin rpy='0 0 1'/>"
      "<geometry><box size='1 1 1'/></geometry></collision><inertial><mass value='1'/></inertial>"
      "</link><link name='b'/><link name='c'/>"
      "<joint name='j' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>"
      "<limit lower='-1' upper='1' effort='1' velocity='1'/></joint>"
      "<joint name='k' type='prismatic'><parent link='b'/><child link='c'/>"
      "<mimic joint='j' multiplier='2'/></joint></robot>";
  ASSERT_NO_THROW(read_urdf(write("whole.urdf", whole)));
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::string damaged = whole;
    const int changes = 1 + static_cast<int>(random() % 4);
    for (int i = 0; i < changes; ++i) {
      const std::size_t at = random() % damaged.size();
      switch (random() % 4) {
        case 0:
          damaged[at] = static_cast<char>(random());
          break;
        case 1:
          damaged.erase(at, 1 + random() % 20);
          break;
        case 2:
          damaged.insert(at, damaged.substr(random() % damaged.size(), random() % 60));
          break;
        default:
          damaged[at] = "<>/='&0-9e"[random() % 10];
      }
      if (damaged.empty()) damaged.push_back('<');
    }
    try {
      const RobotLoad load = read_urdf(write("damaged.urdf", damaged));
      EXPECT_NO_THROW(check(load.robot));
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("damaged.urdf"));
    }
  }
}

}  // namespace
}  // namespace vicinity
