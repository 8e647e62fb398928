// Shapes, poses and directions of tools and supports.
#include <map>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

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

Vec3 readNonZero(const Entry& entry, const std::string& unit) {
  const Vec3 value = entry.vec3(Range::any(unit));
  if (value.norm() >= kSmallestPositive) return value;
  entry.fail("must not be zero, its length at least " + numberText(kSmallestPositive));
}

ToolShape readToolShape(const Entry& entry, const std::string& scene_folder) {
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
  shape.pose = readPose(map);
  shape.padding = map["padding"].numberOr(shape.padding, Range::atLeastZero("m"));
  if (type == "box") {
    shape.type = ToolShape::Type::kBox;
    shape.size = map["size"].vec3(Range::positive("m"));
  } else if (type == "mesh") {
    shape.type = ToolShape::Type::kMesh;
    shape.resource = readResource(map["resource"], scene_folder);
    shape.scale = readScale(map["scale"]);
    requireToolMesh(map["resource"], shape.resource, shape.scale);
  } else {
    shape.type = type == "sphere" ? ToolShape::Type::kSphere : ToolShape::Type::kCylinder;
    shape.radius = map["radius"].number(Range::positive("m"));
    if (type == "cylinder") shape.length = map["length"].number(Range::positive("m"));
  }
  return shape;
}

}  // namespace robot_tissue
