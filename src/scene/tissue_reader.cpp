#include <algorithm>
#include <cmath>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

struct TissueReading {
  const std::string& scene_folder;
  const bool supported;
  Remarks& remarks;
  TissueConfig tissue;
  std::optional<Grid> grid;
};

const std::vector<MapType<TissueReading>>& shapeTypes() {
  static const std::vector<MapType<TissueReading>> types = {
      {"box",
       {{"min"}, {"max"}},
       [](const MapReader& map, TissueReading& reading) {
         reading.tissue.shape = map.box(ranges::pickedPlace(), FlatBox::kRefused);
       }},
      {"mesh",
       {{"resource"}, {"scale"}},
       [](const MapReader& map, TissueReading& reading) {
         reading.tissue.mesh =
             std::make_shared<const TriangleMesh>(readMeshShape(map, reading.scene_folder));
       }},
  };
  return types;
}

void readShape(const Entry& entry, TissueReading& reading) {
  readTyped(entry, {{"type"}}, shapeTypes(), reading);
}

// Refuses a tissue so far from the origin that its spacing would be lost in rounding.
void requireNear(const Entry& spacing_entry, const Box& box, double spacing) {
  const double farthest =
      std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  if (farthest <= ranges::kFarthestCell * spacing) return;
  spacing_entry.fail("the tissue reaches to " + numberText(farthest) +
                     " m from its frame's origin, must be at most " +
                     numberText(ranges::kFarthestCell) + " spacings");
}

std::string megabytes(double bytes) { return numberText(std::round(bytes / 1e6)) + " MB"; }

double readMeshSpacing(const Entry& entry, const TriangleMesh& mesh) {
  const double spacing = entry.number(ranges::spacing());
  requireSpacingWithin(entry, mesh);
  requireNear(entry, boundsOf(mesh.vertices), spacing);
  return spacing;
}

double readSpacing(const Entry& entry, const Box& shape) {
  const double spacing = entry.number(ranges::spacing());
  const Vec3 extent = shape.max() - shape.min();
  for (int axis = 0; axis < 3; ++axis) {
    const double ratio = extent[axis] / spacing;
    if (std::round(ratio) >= 1.0 && std::abs(ratio - std::round(ratio)) <= 1e-3) continue;
    std::string fits;
    for (const double s : nearestSpacings(extent, spacing)) {
      fits += (fits.empty() ? "; nearest that fit: " : " and ") + numberText(s);
    }
    entry.fail("must divide the shape's extent along " + std::string(1, "xyz"[axis]) + ", " +
               numberText(extent[axis]) + " m, into whole parts" + fits);
  }
  requireNear(entry, shape, spacing);
  return spacing;
}

struct MaterialReading {
  const std::string& model;
  Remarks& remarks;
  Material& material;  // what is not given stays
};

void readPoissonRatio(const Entry& entry, MaterialReading& reading) {
  Material& material = reading.material;
  material.poisson_ratio = entry.numberOr(material.poisson_ratio, ranges::poissonRatio());
  if (entry.given() && !traitsOfModel(reading.model).has_poisson_ratio) {
    reading.remarks.push_back(
        entry.line("ignored, model " + reading.model + " has no Poisson's ratio"));
  }
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
};

Material readMaterial(const Entry& entry, const std::string& model, Remarks& remarks) {
  const MapReader map(entry, namesOf(kMaterialKeys));
  const Entry stiffness = map["spring_stiffness"];
  if (stiffness.given() && !traitsOfModel(model).has_spring_stiffness) {
    stiffness.fail("must be left out, only model " +
                   modelsWith(&ModelTraits::has_spring_stiffness) +
                   " has it; give young_modulus in Pa");
  }
  if (stiffness.given() && map["young_modulus"].given()) {
    stiffness.fail("must not stand beside young_modulus, give one of the two");
  }
  Material material;
  MaterialReading reading{model, remarks, material};
  readKeys(map, kMaterialKeys, reading);
  if (!stiffness.given())
    material.young_modulus = map["young_modulus"].number(ranges::youngModulus());
  return material;
}

void requireContrast(const MapReader& region, const Material& around, const Material& material) {
  const double contrast = material.spring_stiffness
                              ? *material.spring_stiffness / *around.spring_stiffness
                              : material.young_modulus / around.young_modulus;
  if (std::max(contrast, 1.0 / contrast) <= ranges::kMostContrast) return;
  region[material.spring_stiffness ? "spring_stiffness" : "young_modulus"].fail(
      "must be within a factor of " + numberText(ranges::kMostContrast) + " of tissue.material's");
}

// Where the nodes stand, or with an offset of half a spacing the cells' centers.
std::string nodesText(const Grid& grid, double offset) {
  const Vec3 inset = Vec3::Constant(offset * grid.spacing());
  const Vec3 low = grid.shape().min() + inset;
  const Vec3 high = grid.shape().max() - inset;
  std::string text = "they stand every " + numberText(grid.spacing()) + " m at";
  for (int axis = 0; axis < 3; ++axis) {
    text += std::string(axis == 0 ? " " : ", ") + "xyz"[axis] + " " + numberText(low[axis]) +
            " to " + numberText(high[axis]);
  }
  return text;
}

const KeyTable<Region> kRegionKeys = {
    {"name",
     [](const Entry& entry, Region& region) {
       if (entry.given()) region.name = entry.word("a name");
     }},
    {"min"},
    {"max"},
};

Region readRegion(const Entry& entry, const TissueConfig& tissue, const Grid& grid,
                  Remarks& remarks) {
  const MapReader map(entry, namesOfAll(kRegionKeys, kMaterialKeys));
  Region region;
  readKeys(map, kRegionKeys, region);
  region.box = map.box(ranges::pickedPlace(), FlatBox::kAllowed);
  if (!grid.holdsCell(region.box)) {
    entry.fail("the box holds no cell's center, must hold at least one; " + nodesText(grid, 0.5));
  }
  const bool by_spring = tissue.material.spring_stiffness.has_value();
  const Entry foreign = map[by_spring ? "young_modulus" : "spring_stiffness"];
  if (foreign.given()) {
    foreign.fail(std::string("must be given as ") +
                 (by_spring ? "spring_stiffness (N/m)" : "young_modulus (Pa)") +
                 ", as in tissue.material");
  }
  if (std::none_of(kMaterialKeys.begin(), kMaterialKeys.end(),
                   [&map](const auto& key) { return map[key.name].given(); })) {
    entry.fail("must change the material by at least one of " + joined(namesOf(kMaterialKeys)));
  }
  region.material = tissue.material;
  MaterialReading reading{tissue.model, remarks, region.material};
  readKeys(map, kMaterialKeys, reading);
  region.own_modulus = map["young_modulus"].given();
  requireContrast(map, tissue.material, region.material);
  return region;
}

std::string readFrame(const Entry& entry, const std::string& otherwise) {
  if (!entry.given()) return otherwise;
  const std::string allowed = "a TF frame: no blanks, no leading /";
  const std::string frame = entry.word(allowed);
  const bool blank = std::any_of(frame.begin(), frame.end(), [](char c) {
    return static_cast<unsigned char>(c) <= 0x20 || c == 0x7f;
  });
  if (blank || frame.front() == '/') entry.fail("must be " + allowed);
  return frame;
}

void readSpacing(const Entry& entry, TissueReading& reading) {
  TissueConfig& tissue = reading.tissue;
  tissue.spacing =
      tissue.mesh ? readMeshSpacing(entry, *tissue.mesh) : readSpacing(entry, tissue.shape);
}

void readMaterial(const Entry& entry, TissueReading& reading) {
  TissueConfig& tissue = reading.tissue;
  tissue.material = readMaterial(entry, tissue.model, reading.remarks);
  if (!tissue.mesh || !tissue.material.spring_stiffness) return;
  reading.remarks.push_back(MapReader(entry, namesOf(kMaterialKeys))["spring_stiffness"].line(
      "every spring has it, also those of cells that the mesh fills only in part"));
}

void readRegions(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  for (const Entry& region : entry.list(0, "regions")) {
    reading.tissue.regions.push_back(
        readRegion(region, reading.tissue, *reading.grid, reading.remarks));
  }
}

void readFixed(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  for (const Entry& box : entry.list(0, "boxes with min and max")) {
    reading.tissue.fixed.push_back(readNodeBox(MapReader(box, {"min", "max"}), *reading.grid));
  }
}

void readGravity(const Entry& entry, TissueReading& reading) {
  TissueConfig& tissue = reading.tissue;
  if (entry.given()) tissue.gravity = readVector(entry, ranges::gravity(), ranges::kLeastGravity);
  const bool falls = tissue.fixed.empty() && !reading.supported && !tissue.time;
  if (tissue.gravity != Vec3::Zero() && falls) {
    entry.fail(
        "must be zero unless tissue.fixed holds nodes, supports bear it or tissue.time lets it "
        "fall, "
        "the tissue would fall");
  }
}

const KeyTable<TimeConfig> kTimeKeys = {
    {"mode",
     [](const Entry& entry, TimeConfig&) {
       if (entry.given()) entry.choice({"dynamic"}, {});
     }},
    {"damping_time",
     [](const Entry& entry, TimeConfig& time) {
       time.damping_time = entry.numberOr(time.damping_time, ranges::dampingTime());
     }},
};

void readTime(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  if (reading.tissue.model != "elastic") {
    entry.fail("must be left out, only model elastic moves in time");
  }
  TimeConfig time;
  readKeys(MapReader(entry, namesOf(kTimeKeys)), kTimeKeys, time);
  reading.tissue.time = time;
}

void readFreePieces(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  const bool drops = entry.choice({"stay", "drop"}, {}) == "drop";
  reading.tissue.free_pieces = drops ? FreePieces::kDrop : FreePieces::kStay;
}

// The tissue's keys: first those that make the grid, then those that are checked against it.
const KeyTable<TissueReading> kBodyKeys = {
    {"frame_id",
     [](const Entry& entry, TissueReading& reading) {
       reading.tissue.frame_id = readFrame(entry, reading.tissue.frame_id);
     }},
    {"shape", readShape},
    {"spacing", readSpacing},
    {"model",
     [](const Entry& entry, TissueReading& reading) {
       if (entry.given()) reading.tissue.model = entry.choice(modelNames(), {});
     }},
    {"material", readMaterial},
    {"time", readTime},
    {"free_pieces", readFreePieces},
};
const KeyTable<TissueReading> kGridKeys = {
    {"regions", readRegions},
    {"fixed", readFixed},
    {"gravity", readGravity},
};

}  // namespace

Box readNodeBox(const MapReader& map, const Grid& grid) {
  const Box box = map.box(ranges::pickedPlace(), FlatBox::kAllowed);
  if (!grid.nodesIn(box).empty()) return box;
  map.entry().fail("the box holds no node, must hold at least one; " + nodesText(grid, 0.0));
}

void requireMemory(const Entry& spacing, const TissueConfig& tissue, const std::string& method) {
  const double nodes = tissue.mesh
                           ? nodesWithin(*tissue.mesh, tissue.spacing)
                           : nodeCount(tissue.shape.max() - tissue.shape.min(), tissue.spacing);
  const double around = tissue.mesh ? memoryAround(*tissue.mesh, tissue.spacing) : 0.0;
  const double free = freeMemory();
  const double most = mostNodes(free - around, method);
  if (nodes <= most) return;
  spacing.fail("makes " + numberText(std::round(nodes)) + " nodes, which take " +
               megabytes(around + memoryOf(nodes, method)) + " with method " + method + " where " +
               megabytes(free) + " are free: " +
               (most > 0.0 ? "must give at most " + numberText(most) + " nodes"
                           : "must be larger, or the mesh smaller"));
}

TissueConfig readTissue(const Entry& entry, const std::string& scene_folder, bool supported,
                        Remarks& remarks) {
  const MapReader map(entry, namesOfAll(kBodyKeys, kGridKeys));
  TissueReading reading{scene_folder, supported, remarks, {}, {}};
  readKeys(map, kBodyKeys, reading);
  const TissueConfig& tissue = reading.tissue;
  requireMemory(map["spacing"], tissue, methodsFor(tissue.model).front());
  reading.grid = filledGrid(tissue).grid;
  readKeys(map, kGridKeys, reading);
  return reading.tissue;
}

}  // namespace robot_tissue
