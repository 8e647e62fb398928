// Reads the membranes on a tissue's surface.
#include <algorithm>

#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

struct MembraneReading {
  const TissueConfig& tissue;
  MembraneConfig membrane;
};

void readThickness(const Entry& entry, MembraneReading& reading) {
  const double thickness = entry.number(ranges::membraneThickness());
  if (thickness > reading.tissue.spacing) {
    entry.fail("must be at most the spacing, " + numberText(reading.tissue.spacing) +
               " m: cells show what is thicker");
  }
  reading.membrane.thickness = thickness;
}

void readModulus(const Entry& entry, MembraneReading& reading) {
  reading.membrane.young_modulus = entry.number(ranges::youngModulus());
  const TissueConfig& tissue = reading.tissue;
  const double most = ranges::mostMembraneModulus(tissue.material.young_modulus, tissue.spacing,
                                                  reading.membrane.thickness);
  if (reading.membrane.young_modulus > most) {
    entry.fail("must be at most " + numberText(most) + " Pa: with its thickness a membrane is at " +
               "most " + numberText(ranges::kMostMembraneContrast) +
               " times as stiff as a layer of cells");
  }
}

void readSide(const Entry& entry, MembraneReading& reading) {
  using Side = MembraneConfig::Side;
  if (!entry.given()) return;
  const std::string side = entry.choice({"all", "outer", "inner"});
  reading.membrane.side = side == "outer"   ? Side::kOuter
                          : side == "inner" ? Side::kInner
                                            : Side::kAll;
}

void readBoxes(const Entry& entry, MembraneReading& reading) {
  if (!entry.given()) return;
  for (const Entry& box : entry.list(1, "boxes with min and max")) {
    reading.membrane.boxes.push_back(
        MapReader(box, {"min", "max"}).box(ranges::pickedPlace(), FlatBox::kAllowed));
  }
}

const KeyTable<MembraneReading> kMembraneKeys = {
    {"name",
     [](const Entry& entry, MembraneReading& reading) {
       if (entry.given()) reading.membrane.name = entry.word("a name");
     }},
    {"thickness", readThickness},
    {"young_modulus", readModulus},
    {"poisson_ratio",
     [](const Entry& entry, MembraneReading& reading) {
       double& ratio = reading.membrane.poisson_ratio;
       ratio = entry.numberOr(ratio, ranges::membranePoissonRatio());
     }},
    {"side", readSide},
    {"boxes", readBoxes},
    {"pressure",
     [](const Entry& entry, MembraneReading& reading) {
       double& pressure = reading.membrane.pressure;
       pressure = entry.numberOr(pressure, ranges::pressure());
     }},
};

}  // namespace

std::vector<MembraneConfig> readMembranes(const Entry& entry, const TissueConfig& tissue) {
  std::vector<MembraneConfig> membranes;
  if (!entry.given()) return membranes;
  const std::vector<Entry> entries = entry.list(0, "membranes");
  if (entries.empty()) return membranes;
  if (!traitsOfModel(tissue.model).has_membranes) {
    entry.fail("must be left out, only model " + modelsWith(&ModelTraits::has_membranes) +
               " has membranes");
  }
  if (tissue.time) entry.fail("must be left out with tissue.time: membranes have no inertia");
  for (const Entry& one : entries) {
    MembraneReading reading{tissue, {}};
    readKeys(MapReader(one, namesOf(kMembraneKeys)), kMembraneKeys, reading);
    membranes.push_back(reading.membrane);
  }
  return membranes;
}

}  // namespace robot_tissue
