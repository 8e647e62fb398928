// Reads the supports: the planes and shapes that stand still and that the tissue rests on.
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

ToolShape readPlane(const MapReader& map, const Range& place) {
  ToolShape plane;
  plane.type = ToolShape::Type::kPlane;
  const Vec3 normal =
      readNonZero(map["normal"], ranges::direction(), ranges::kLeastDirection).normalized();
  plane.pose.translation() = map["point"].vec3(place);
  plane.pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal).toRotationMatrix();
  return plane;
}

ToolShape readBox(const MapReader& map, const LengthRanges& lengths) {
  const Box box = map.box(lengths.place, FlatBox::kRefused);
  if ((box.max() - box.min()).minCoeff() < lengths.length.lowest) {
    map.entry().fail("the box is thinner than " + numberText(lengths.length.lowest) +
                     " m, must be as thick at least");
  }
  ToolShape shape;
  shape.type = ToolShape::Type::kBox;
  shape.size = box.max() - box.min();
  shape.pose.translation() = 0.5 * (box.min() + box.max());
  return shape;
}

struct SupportReading {
  const LengthRanges& lengths;
  SupportConfig support;
};

// Keys that supports of every type have.
const KeyTable<SupportReading> kSupportKeys = {
    {"name",
     [](const Entry& entry, SupportReading& reading) {
       if (entry.given()) reading.support.name = readGraphName(entry);
     }},
    {"type"},
    {"friction",
     [](const Entry& entry, SupportReading& reading) {
       reading.support.friction = entry.numberOr(reading.support.friction, ranges::friction());
     }},
};

const std::vector<MapType<SupportReading>> kSupportTypes = {
    {"plane",
     {{"point"}, {"normal"}},
     [](const MapReader& map, SupportReading& reading) {
       reading.support.shape = readPlane(map, reading.lengths.place);
     }},
    {"box",
     {{"min"}, {"max"}},
     [](const MapReader& map, SupportReading& reading) {
       reading.support.shape = readBox(map, reading.lengths);
     }},
};

SupportConfig readSupport(const Entry& entry, const std::string& default_name,
                          const LengthRanges& lengths) {
  SupportReading reading{lengths, {}};
  reading.support.name = default_name;
  readTyped(entry, kSupportKeys, kSupportTypes, reading);
  return reading.support;
}

}  // namespace

std::vector<SupportConfig> readSupports(const Entry& entry, const TissueConfig& tissue) {
  const std::vector<Entry> entries = entry.list(0, "supports");
  if (!entries.empty() && hardPatchesOnly(tissue.model)) {
    entry.fail("with tissue.model " + tissue.model +
               " must be [] or left out, its method moves hard patches only");
  }
  std::vector<SupportConfig> supports;
  for (const Entry& support_entry : entries) {
    const std::string default_name = "support_" + std::to_string(supports.size() + 1);
    const SupportConfig support = readSupport(support_entry, default_name, lengthsOf(tissue));
    for (const SupportConfig& other : supports) {
      if (other.name != support.name) continue;
      support_entry.fail("the name " + support.name + " is an earlier support's, must be unique");
    }
    supports.push_back(support);
  }
  return supports;
}

}  // namespace robot_tissue
