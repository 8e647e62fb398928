#include <algorithm>
#include <cctype>
#include <map>

#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

// A tool's name becomes part of a topic.
bool isGraphName(const std::string& name) {
  const auto letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  return !name.empty() && letter(name.front()) &&
         std::all_of(name.begin(), name.end(),
                     [&letter](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

// Roll, pitch, yaw about the fixed axes x, y, z, as in URDF.
Pose readPose(const MapReader& map) {
  const Vec3 rpy = map["rpy"].vec3Or(Vec3::Zero(), Range::any("rad"));
  Pose pose = Pose::Identity();
  pose.translation() = map["xyz"].vec3Or(Vec3::Zero(), Range::any("m"));
  pose.linear() =
      (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
          .toRotationMatrix();
  return pose;
}

std::string readToolName(const MapReader& map, const std::string& link) {
  const std::string allowed = "letters, digits and _, starting with a letter";
  const Entry entry = map["name"];
  if (entry.given()) {
    const std::string name = entry.word(allowed);
    if (!isGraphName(name)) entry.fail("must be " + allowed);
    return name;
  }
  if (!isGraphName(link)) {
    map["link"].fail("needs a name beside it, as the tool's name must be " + allowed);
  }
  return link;
}

ToolConfig readTool(const Entry& entry, const std::string& scene_folder) {
  const MapReader map(entry, {"name", "link", "role", "padding", "friction", "shapes"});
  if (map["friction"].given()) {
    map["friction"].fail(
        "sliding contact is not available yet, a patch sticks to its tool; the key must be left "
        "out");
  }
  if (map["role"].given()) map["role"].choice({"push"}, {"blade", "grasper"});
  ToolConfig tool;
  tool.link = map["link"].word("the name of a link of the URDF");
  tool.name = readToolName(map, tool.link);
  tool.padding = map["padding"].numberOr(tool.padding, Range::atLeastZero("m"));
  if (map["shapes"].given()) {
    for (const Entry& shape : map["shapes"].list(0, "shapes")) {
      tool.shapes.push_back(readToolShape(shape, scene_folder));
    }
  }
  return tool;
}

}  // namespace

ToolShape readToolShape(const Entry& entry, const std::string& scene_folder) {
  const MapReader any_type(entry,
                           {"type", "radius", "length", "size", "resource", "scale", "xyz", "rpy"});
  const std::string type = any_type["type"].choice({"sphere", "cylinder", "box", "mesh"}, {});
  static const std::map<std::string, std::vector<std::string>> kKeys = {
      {"sphere", {"type", "radius", "xyz", "rpy"}},
      {"cylinder", {"type", "radius", "length", "xyz", "rpy"}},
      {"box", {"type", "size", "xyz", "rpy"}},
      {"mesh", {"type", "resource", "scale", "xyz", "rpy"}}};
  const MapReader map(entry, kKeys.at(type));
  ToolShape shape;
  shape.pose = readPose(map);
  if (type == "box") {
    shape.type = ToolShape::Type::kBox;
    shape.size = map["size"].vec3(Range::positive("m"));
  } else if (type == "mesh") {
    shape.type = ToolShape::Type::kMesh;
    shape.resource = readResource(map["resource"], scene_folder);
    shape.scale = readScale(map["scale"]);
  } else {
    shape.type = type == "sphere" ? ToolShape::Type::kSphere : ToolShape::Type::kCylinder;
    shape.radius = map["radius"].number(Range::positive("m"));
    if (type == "cylinder") shape.length = map["length"].number(Range::positive("m"));
  }
  return shape;
}

std::vector<ToolConfig> readTools(const Entry& entry, const std::string& scene_folder) {
  std::vector<ToolConfig> tools;
  for (const Entry& tool_entry : entry.list(0, "tools")) {
    const ToolConfig tool = readTool(tool_entry, scene_folder);
    for (const ToolConfig& other : tools) {
      if (other.name != tool.name) continue;
      tool_entry.fail("the name " + tool.name + " is an earlier tool's, must be unique");
    }
    tools.push_back(tool);
  }
  return tools;
}

}  // namespace robot_tissue
