// The runner's step that joins two points of the surface by a thread.
#include "robot_tissue/scene/patch_name.h"
#include "robot_tissue/scene/readers.h"

namespace robot_tissue {
namespace {

struct SutureReading {
  const LengthRanges& lengths;
  SutureConfig suture;
};

void readName(const Entry& entry, SutureReading& reading) {
  if (!entry.given()) return;
  reading.suture.name = entry.word("a name");
  const std::string fault = patchNameFault(reading.suture.name);
  if (!fault.empty()) entry.fail(fault);
}

const KeyTable<SutureReading> kSutureKeys = {
    {"name", readName},
    {"from",
     [](const Entry& entry, SutureReading& reading) {
       reading.suture.from = entry.vec3(reading.lengths.place);
     }},
    {"to", [](const Entry& entry,
              SutureReading& reading) { reading.suture.to = entry.vec3(reading.lengths.place); }},
    {"rest_length",
     [](const Entry& entry, SutureReading& reading) {
       double& length = reading.suture.rest_length;
       length = entry.numberOr(length, reading.lengths.thread);
     }},
    {"stiffness",
     [](const Entry& entry, SutureReading& reading) {
       double& stiffness = reading.suture.stiffness;
       stiffness = entry.numberOr(stiffness, ranges::sutureStiffness());
     }},
    {"break_force",
     [](const Entry& entry, SutureReading& reading) {
       double& force = reading.suture.break_force;
       force = entry.numberOr(force, ranges::sutureStrength());
     }},
    {"bite",
     [](const Entry& entry, SutureReading& reading) {
       double& bite = reading.suture.bite;
       bite = entry.numberOr(bite, reading.lengths.thread);
     }},
};

}  // namespace

SutureStep readSuture(const Entry& entry, const std::string& model, const LengthRanges& lengths) {
  const MapReader map(entry, namesOf(kSutureKeys));
  if (hardPatchesOnly(model)) {
    entry.fail("must be left out with tissue.model " + model +
               ", whose methods find no equilibrium; a thread needs model elastic with method " +
               joined(methodsFor("elastic"), " or "));
  }
  SutureReading reading{lengths, {}};
  readKeys(map, kSutureKeys, reading);
  return {reading.suture};
}

}  // namespace robot_tissue
