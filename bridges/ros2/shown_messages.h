// SPDX-FileCopyrightText: The Vicinity authors
// SPDX-License-Identifier: Apache-2.0

/// ROS 2's messages that are there to be looked at, in RViz or Foxglove: markers and point clouds.
#pragma once

#include "ros2/messages.h"

namespace vicinity::ros2 {

struct CompressedImage {
  static constexpr std::string_view type = "sensor_msgs/msg/CompressedImage";
  Header header;
  std::string format;
  std::vector<std::uint8_t> data;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("format", self.format);
    visit("data", self.data);
  }
};

struct UVCoordinate {
  static constexpr std::string_view type = "visualization_msgs/msg/UVCoordinate";
  float u = 0, v = 0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("u", self.u);
    visit("v", self.v);
  }
};

struct MeshFile {
  static constexpr std::string_view type = "visualization_msgs/msg/MeshFile";
  std::string filename;
  std::vector<std::uint8_t> data;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("filename", self.filename);
    visit("data", self.data);
  }
};

/// One thing to draw. What we never draw (textures, meshes) is there because its bytes are.
struct Marker {
  static constexpr std::string_view type = "visualization_msgs/msg/Marker";
  static constexpr std::int32_t arrow = 0, sphere_list = 7, text_view_facing = 9;
  static constexpr std::int32_t add = 0, remove = 2;
  Header header;
  std::string ns;
  std::int32_t id = 0, kind = arrow, action = add;
  Pose pose;
  Vector3 scale;
  ColorRGBA color;
  Duration lifetime;
  bool frame_locked = false;
  std::vector<Point> points;
  std::vector<ColorRGBA> colors;
  std::string texture_resource;
  CompressedImage texture;
  std::vector<UVCoordinate> uv_coordinates;
  std::string text, mesh_resource;
  MeshFile mesh_file;
  bool mesh_use_embedded_materials = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("ns", self.ns);
    visit("id", self.id);
    visit("type", self.kind);
    visit("action", self.action);
    visit("pose", self.pose);
    visit("scale", self.scale);
    visit("color", self.color);
    visit("lifetime", self.lifetime);
    visit("frame_locked", self.frame_locked);
    visit("points", self.points);
    visit("colors", self.colors);
    visit("texture_resource", self.texture_resource);
    visit("texture", self.texture);
    visit("uv_coordinates", self.uv_coordinates);
    visit("text", self.text);
    visit("mesh_resource", self.mesh_resource);
    visit("mesh_file", self.mesh_file);
    visit("mesh_use_embedded_materials", self.mesh_use_embedded_materials);
  }
};

struct MarkerArray {
  static constexpr std::string_view type = "visualization_msgs/msg/MarkerArray";
  std::vector<Marker> markers;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("markers", self.markers);
  }
};

struct PointField {
  static constexpr std::string_view type = "sensor_msgs/msg/PointField";
  static constexpr std::uint8_t float32 = 7;
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = float32;
  std::uint32_t count = 1;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("name", self.name);
    visit("offset", self.offset);
    visit("datatype", self.datatype);
    visit("count", self.count);
  }
};

struct PointCloud2 {
  static constexpr std::string_view type = "sensor_msgs/msg/PointCloud2";
  Header header;
  std::uint32_t height = 1, width = 0;
  std::vector<PointField> columns;
  bool is_bigendian = false;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<std::uint8_t> data;
  bool is_dense = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("header", self.header);
    visit("height", self.height);
    visit("width", self.width);
    visit("fields", self.columns);
    visit("is_bigendian", self.is_bigendian);
    visit("point_step", self.point_step);
    visit("row_step", self.row_step);
    visit("data", self.data);
    visit("is_dense", self.is_dense);
  }
};

}  // namespace vicinity::ros2
