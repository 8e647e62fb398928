// Steps of the runner that remove tissue, and that take surgery back.
#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

constexpr int kMostUndone = 1000000;

struct SphereReading {
  const LengthRanges& lengths;
  Sphere sphere;
};

const KeyTable<SphereReading> kSphereKeys = {
    {"center",
     [](const Entry& entry, SphereReading& reading) {
       reading.sphere.center = entry.vec3(reading.lengths.place);
     }},
    {"radius",
     [](const Entry& entry, SphereReading& reading) {
       reading.sphere.radius = entry.number(reading.lengths.length);
     }},
};

Sphere readSphere(const Entry& entry, const LengthRanges& lengths) {
  SphereReading reading{lengths, {}};
  readKeys(MapReader(entry, namesOf(kSphereKeys)), kSphereKeys, reading);
  return reading.sphere;
}

Box readSpaceBox(const Entry& entry) {
  return MapReader(entry, {"min", "max"}).box(ranges::pickedPlace(), FlatBox::kRefused);
}

}  // namespace

RemoveStep readRemove(const Entry& entry, const LengthRanges& lengths) {
  const MapReader map(entry, {"box", "sphere"});
  if (map["box"].given() == map["sphere"].given()) {
    entry.fail(std::string(map["box"].given() ? "has both" : "has neither of") +
               " box and sphere, must have exactly one");
  }
  if (map["box"].given()) return {PlacedBox{readSpaceBox(map["box"])}};
  return {readSphere(map["sphere"], lengths)};
}

UndoStep readUndo(const Entry& entry) {
  return {MapReader(entry, {"count"})["count"].integerOr(1, 1, kMostUndone)};
}

}  // namespace robot_tissue
