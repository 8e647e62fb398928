// Shapes, poses and directions of tools and supports.
#include <map>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

Pose readPose(const MapReader& map, const Range& place) {
  const Vec3 rpy = map["rpy"].vec3Or(Vec3::Zero(), ranges::angle());
  Pose pose = Pose::Identity();
  pose.translation() = map["xyz"].vec3Or(Vec3::Zero(), place);
  pose.linear() =
      (Eigen::AngleAxisd(rpy.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vec3::UnitY()) *
       Eigen::AngleAxisd(rpy.x(), Vec3::UnitX()))
          .toRotationMatrix();
  return pose;
}

ToolShape readToolShape(const Entry& entry, const Surroundings& surroundings) {
  const MapReader any_type(
      entry, {"type", "radius", "length", "size", "resource", "scale", "padding", "xyz", "rpy"});
  const std::string type = any_type["type"].choice({"sphere", "cylinder", "box", "mesh"}, {});
  static const std::map<std::string, std::vector<std::string>> kKeys = {
      {"sphere", {"type", "radius", "padding", "xyz", "rpy"}},
      {"cylinder", {"type", "radius", "length", "padding", "xyz", "rpy"}},
      {"box", {"type", "size", "padding", "xyz", "rpy"}},
      {"mesh", {"type", "resource", "scale", "padding", "xyz", "rpy"}}};
  const MapReader map(entry, kKeys.at(type));
  ToolShape shape;
  const LengthRanges& lengths = surroundings.lengths;
  shape.pose = readPose(map, lengths.place);
  shape.padding = map["padding"].numberOr(shape.padding, lengths.gap);
  if (type == "box") {
    shape.type = ToolShape::Type::kBox;
    shape.size = map["size"].vec3(lengths.length);
  } else if (type == "mesh") {
    shape.type = ToolShape::Type::kMesh;
    shape.resource = readResource(map["resource"], surroundings.scene_folder);
    shape.scale = readScale(map["scale"]);
    requireToolMesh(map["resource"], shape.resource, shape.scale, lengths);
  } else {
    shape.type = type == "sphere" ? ToolShape::Type::kSphere : ToolShape::Type::kCylinder;
    shape.radius = map["radius"].number(lengths.length);
    if (type == "cylinder") shape.length = map["length"].number(lengths.length);
  }
  return shape;
}

}  // namespace robot_tissue
