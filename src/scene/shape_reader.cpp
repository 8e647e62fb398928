// Shapes, poses and directions of tools and supports.
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

namespace {

struct ShapeReading {
  const Surroundings& surroundings;
  ToolShape shape;
};

const Range& lengthRange(const ShapeReading& reading) {
  return reading.surroundings.lengths.length;
}

void readRadius(const Entry& entry, ShapeReading& reading) {
  reading.shape.radius = entry.number(lengthRange(reading));
}

// Keys that shapes of every type have.
const KeyTable<ShapeReading> kShapeKeys = {
    {"type"},
    {"xyz"},
    {"rpy"},
    {"padding",
     [](const Entry& entry, ShapeReading& reading) {
       reading.shape.padding =
           entry.numberOr(reading.shape.padding, reading.surroundings.lengths.gap);
     }},
};

template <ToolShape::Type type>
void setType(const MapReader&, ShapeReading& reading) {
  reading.shape.type = type;
}

void checkMesh(const MapReader& map, ShapeReading& reading) {
  ToolShape& shape = reading.shape;
  shape.type = ToolShape::Type::kMesh;
  requireToolMesh(map["resource"], shape.resource, shape.scale, reading.surroundings.lengths);
}

const std::vector<MapType<ShapeReading>> kShapeTypes = {
    {"sphere", {{"radius", readRadius}}, setType<ToolShape::Type::kSphere>},
    {"cylinder",
     {{"radius", readRadius},
      {"length",
       [](const Entry& entry, ShapeReading& reading) {
         reading.shape.length = entry.number(lengthRange(reading));
       }}},
     setType<ToolShape::Type::kCylinder>},
    {"box",
     {{"size",
       [](const Entry& entry, ShapeReading& reading) {
         reading.shape.size = entry.vec3(lengthRange(reading));
       }}},
     setType<ToolShape::Type::kBox>},
    {"mesh",
     {{"resource",
       [](const Entry& entry, ShapeReading& reading) {
         reading.shape.resource = readResource(entry, reading.surroundings.scene_folder);
       }},
      {"scale",
       [](const Entry& entry, ShapeReading& reading) { reading.shape.scale = readScale(entry); }}},
     checkMesh},
};

}  // namespace

ToolShape readToolShape(const Entry& entry, const Surroundings& surroundings) {
  ShapeReading reading{surroundings, {}};
  const MapReader map = readTyped(entry, kShapeKeys, kShapeTypes, reading);
  reading.shape.pose = readPose(map, surroundings.lengths.place);
  return reading.shape;
}

}  // namespace robot_tissue
