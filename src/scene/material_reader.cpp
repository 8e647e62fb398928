#include "material_reader.h"

#include <algorithm>

#include "material_presets.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/key_table.h"
#include "robot_tissue/scene/ranges.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

struct MaterialReading {
  const std::string& model;
  Remarks& remarks;
  Material& material;  // what is not given stays
};

// What a preset sets, and none of which may stand beside one.
const std::vector<std::string> kOfPreset = {"young_modulus", "poisson_ratio", "density",
                                            "law",           "stiffening",    "spring_stiffness"};

void readPreset(const Entry& entry, MaterialReading& reading) {
  if (!entry.given()) return;
  std::vector<std::string> names;
  for (const MaterialPreset& preset : materialPresets()) names.push_back(preset.name);
  const std::string name = entry.choice(names);
  for (const MaterialPreset& preset : materialPresets()) {
    if (preset.name != name) continue;
    Material& material = reading.material;
    const Material before = material;
    material = preset.material;
    material.tear_stretch = before.tear_stretch;
    material.tear_length = before.tear_length;
    reading.remarks.push_back(entry.line(describe(preset)));
  }
}

void readPoissonRatio(const Entry& entry, MaterialReading& reading) {
  Material& material = reading.material;
  material.poisson_ratio = entry.numberOr(material.poisson_ratio, ranges::poissonRatio());
  if (entry.given() && !traitsOfModel(reading.model).has_poisson_ratio) {
    reading.remarks.push_back(
        entry.line("ignored, model " + reading.model + " has no Poisson's ratio"));
  }
}

void readLaw(const Entry& entry, MaterialReading& reading) {
  if (!entry.given()) return;
  const bool stiffens = entry.choice({"neo_hookean", "fung"}) == "fung";
  reading.material.law = stiffens ? Material::Law::kFung : Material::Law::kNeoHookean;
  if (stiffens && !traitsOfModel(reading.model).has_law) {
    reading.remarks.push_back(entry.line("ignored, model " + reading.model + " is linear springs"));
  }
}

void readStiffening(const Entry& entry, MaterialReading& reading) {
  if (!entry.given()) return;
  if (reading.material.law != Material::Law::kFung) entry.fail("must stand beside law: fung");
  reading.material.stiffening = entry.number(ranges::stiffening());
}

double readTearStretch(const Entry& entry) {
  const double stretch = entry.number(ranges::tearStretch());
  if (stretch == 0.0 || stretch >= ranges::kLeastTearStretch) return stretch;
  entry.fail("must be 0, for never, or " + numberText(ranges::kLeastTearStretch) + " at least");
}

const KeyTable<MaterialReading> kMaterialKeys = {
    {"young_modulus",
     [](const Entry& entry, MaterialReading& reading) {
       double& modulus = reading.material.young_modulus;
       modulus = entry.numberOr(modulus, ranges::youngModulus());
     }},
    {"poisson_ratio", readPoissonRatio},
    {"density",
     [](const Entry& entry, MaterialReading& reading) {
       double& density = reading.material.density;
       density = entry.numberOr(density, ranges::density());
     }},
    {"law", readLaw},
    {"stiffening", readStiffening},
    {"tear_stretch",
     [](const Entry& entry, MaterialReading& reading) {
       if (entry.given()) reading.material.tear_stretch = readTearStretch(entry);
     }},
    {"tear_length",
     [](const Entry& entry, MaterialReading& reading) {
       if (entry.given()) reading.material.tear_length = entry.number(ranges::spacing());
     }},
    {"spring_stiffness",
     [](const Entry& entry, MaterialReading& reading) {
       if (!entry.given()) return;
       reading.material.spring_stiffness = entry.number(ranges::springStiffness());
     }},
    {"preset", readPreset},
};

void requireAlone(const MapReader& map) {
  if (!map["preset"].given()) return;
  for (const std::string& name : kOfPreset) {
    if (map[name].given()) map["preset"].fail("must not stand beside " + name + ", which it sets");
  }
}

void requireContrast(const MapReader& region, const Material& around, const Material& material) {
  const double of_tissue =
      material.spring_stiffness ? *around.spring_stiffness : around.young_modulus;
  const double contrast =
      (material.spring_stiffness ? *material.spring_stiffness : material.young_modulus) / of_tissue;
  if (std::max(contrast, 1.0 / contrast) <= ranges::kMostContrast) return;
  const Entry preset = region["preset"];
  const Entry by_number = region[material.spring_stiffness ? "spring_stiffness" : "young_modulus"];
  (preset.given() ? preset : by_number)
      .fail("must be within a factor of " + numberText(ranges::kMostContrast) +
            " of tissue.material's, " + numberText(of_tissue));
}

}  // namespace

std::vector<std::string> materialKeys() { return namesOf(kMaterialKeys); }

Material readMaterial(const Entry& entry, const std::string& model, Remarks& remarks) {
  const MapReader map(entry, materialKeys());
  const Entry stiffness = map["spring_stiffness"];
  if (stiffness.given() && !traitsOfModel(model).has_spring_stiffness) {
    stiffness.fail("must be left out, only model " +
                   modelsWith(&ModelTraits::has_spring_stiffness) +
                   " has it; give young_modulus in Pa");
  }
  if (stiffness.given() && map["young_modulus"].given()) {
    stiffness.fail("must not stand beside young_modulus, give one of the two");
  }
  requireAlone(map);
  Material material;
  MaterialReading reading{model, remarks, material};
  readKeys(map, kMaterialKeys, reading);
  if (!stiffness.given() && !map["preset"].given()) {
    material.young_modulus = map["young_modulus"].number(ranges::youngModulus());
  }
  return material;
}

void readRegionMaterial(const MapReader& map, const TissueConfig& tissue, Remarks& remarks,
                        Region& region) {
  const bool by_spring = tissue.material.spring_stiffness.has_value();
  const Entry preset = map["preset"];
  const Entry foreign =
      by_spring && preset.given() ? preset : map[by_spring ? "young_modulus" : "spring_stiffness"];
  if (foreign.given()) {
    foreign.fail(std::string("must be given as ") +
                 (by_spring ? "spring_stiffness (N/m)" : "young_modulus (Pa)") +
                 ", as in tissue.material");
  }
  if (std::none_of(kMaterialKeys.begin(), kMaterialKeys.end(),
                   [&map](const auto& key) { return map[key.name].given(); })) {
    map.entry().fail("must change the material by at least one of " + joined(materialKeys()));
  }
  requireAlone(map);
  region.material = tissue.material;
  MaterialReading reading{tissue.model, remarks, region.material};
  readKeys(map, kMaterialKeys, reading);
  region.own_modulus = map["young_modulus"].given() || preset.given();
  requireContrast(map, tissue.material, region.material);
}

}  // namespace robot_tissue
