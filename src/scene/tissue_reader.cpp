#include <algorithm>
#include <cmath>

#include "material_reader.h"
#include "robot_tissue/core/composition.h"
#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"
#include "robot_tissue/scene/wall_remarks.h"

namespace robot_tissue {
namespace {

struct TissueReading {
  const std::string& scene_folder;
  const bool supported;
  Remarks& remarks;
  TissueConfig tissue;
  std::optional<FilledGrid> filled;
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
    {"shape"},
};

struct RegionShapeReading {
  const std::string& scene_folder;
  Region& region;
};

void readBox(const MapReader& map, RegionShapeReading& reading) {
  reading.region.box = map.box(ranges::pickedPlace(), FlatBox::kAllowed);
}

const std::vector<MapType<RegionShapeReading>> kRegionShapeTypes = {
    {"box", {{"min"}, {"max"}}, readBox},
    {"mesh",
     {{"resource"}, {"scale"}},
     [](const MapReader& map, RegionShapeReading& reading) {
       reading.region.mesh =
           std::make_shared<const TriangleMesh>(readMeshShape(map, reading.scene_folder));
     }},
};

std::string extentText(const Box& box) {
  std::string text;
  for (int axis = 0; axis < 3; ++axis) {
    text += std::string(axis == 0 ? "" : ", ") + "xyz"[axis] + " " + numberText(box.min()[axis]) +
            " to " + numberText(box.max()[axis]);
  }
  return text + " m";
}

// Refuses a mesh that has nothing of the tissue, or all.
void requireInTissue(const Entry& resource, const Region& region, const TissueReading& reading) {
  TissueConfig alone = reading.tissue;
  alone.regions = {region};
  bool has_some = false, leaves_some = false;
  for (const Composition& kind : compositionsOf(alone, *reading.filled).kinds) {
    for (const MaterialShare& part : kind) {
      (part.region == kOwnMaterial ? leaves_some : has_some) = true;
    }
  }
  if (has_some && leaves_some) return;
  resource.fail(std::string("the mesh encloses ") + (has_some ? "all" : "nothing") +
                " of the tissue, must enclose a part of it; it reaches from " +
                extentText(boundsOf(region.mesh->vertices)) + ", the tissue's nodes from " +
                extentText(reading.filled->grid.shape()));
}

// Keys min and max, or shape with the keys of tissue.shape.
void readPlace(const MapReader& map, const TissueReading& reading, Region& region) {
  RegionShapeReading place{reading.scene_folder, region};
  const Entry shape = map["shape"];
  if (!shape.given()) {
    readBox(map, place);
  } else {
    for (const char* key : {"min", "max"}) {
      if (map[key].given()) map[key].fail("must not stand beside shape, which says the same");
    }
    const MapReader of_shape = readTyped(shape, {{"type"}}, kRegionShapeTypes, place);
    if (region.mesh) requireInTissue(of_shape["resource"], region, reading);
  }
  if (region.mesh || reading.filled->grid.holdsCell(region.box)) return;
  map.entry().fail("the box holds no cell's center, must hold at least one; " +
                   nodesText(reading.filled->grid, 0.5));
}

Region readRegion(const Entry& entry, TissueReading& reading) {
  std::vector<std::string> keys = namesOf(kRegionKeys);
  const std::vector<std::string> of_material = materialKeys();
  keys.insert(keys.end(), of_material.begin(), of_material.end());
  const MapReader map(entry, keys);
  Region region;
  readKeys(map, kRegionKeys, region);
  readPlace(map, reading, region);
  readRegionMaterial(map, reading.tissue, reading.remarks, region);
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
  reading.remarks.push_back(MapReader(entry, materialKeys())["spring_stiffness"].line(
      "every spring has it, also those of cells that the mesh fills only in part"));
}

void readRegions(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  for (const Entry& region : entry.list(0, "regions")) {
    reading.tissue.regions.push_back(readRegion(region, reading));
  }
}

void readFixed(const Entry& entry, TissueReading& reading) {
  if (!entry.given()) return;
  const Grid& grid = reading.filled->grid;
  for (const Entry& box : entry.list(0, "boxes with min and max")) {
    reading.tissue.fixed.push_back(readNodeBox(MapReader(box, {"min", "max"}), grid));
    const NodeRange fixed = grid.nodesIn(reading.tissue.fixed.back()),
                    all = grid.nodesIn(grid.shape());
    if (fixed.first == all.first && fixed.last == all.last) {
      reading.remarks.push_back(box.line("holds all nodes: nothing of the tissue gives way"));
    }
  }
}

void readGravity(const Entry& entry, TissueReading& reading) {
  TissueConfig& tissue = reading.tissue;
  if (entry.given()) tissue.gravity = readVector(entry, ranges::gravity(), ranges::kLeastGravity);
  const bool falls = tissue.fixed.empty() && !reading.supported && !tissue.time;
  if (tissue.gravity != Vec3::Zero() && falls) {
    entry.fail(
        "must be zero unless tissue.fixed holds nodes, supports bear it or tissue.time lets it "
        "fall, the tissue would fall");
  }
}

const KeyTable<TimeConfig> kTimeKeys = {
    {"mode",
     [](const Entry& entry, TimeConfig&) {
       if (entry.given()) entry.choice({"dynamic"});
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
  const bool drops = entry.choice({"stay", "drop"}) == "drop";
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
       if (entry.given()) reading.tissue.model = entry.choice(modelNames());
     }},
    {"material", readMaterial},
    {"time", readTime},
    {"free_pieces", readFreePieces},
};
const KeyTable<TissueReading> kGridKeys = {
    {"regions", readRegions},
    {"fixed", readFixed},
    {"membranes",
     [](const Entry& entry, TissueReading& reading) {
       reading.tissue.membranes = readMembranes(entry, reading.tissue);
     }},
    {"gravity", readGravity},
};

// A mesh in millimeters is a thousand times as large.
std::string orSmaller(const TissueConfig& tissue) {
  constexpr double kLargest = 1.0;  // m; an organ is no larger. Chosen
  if (!tissue.mesh) return "";
  const double extent = boundsOf(tissue.mesh->vertices).sizes().maxCoeff();
  return ", or the mesh, " + numberText(extent) + " m across, smaller" +
         (extent > kLargest ? " (tissue.shape.scale: 0.001 if it is in millimeters)" : "");
}

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
  const double around = memoryAround(tissue, method);
  const double free = freeMemory();
  const double most = mostNodes(free - around, method);
  if (nodes <= most) return;
  const std::string takes =
      std::isfinite(around) ? " nodes, which take " + megabytes(around + memoryOf(nodes, method)) +
                                  (method.empty() ? "" : " with method " + method) + " where " +
                                  megabytes(free) + " are free: "
                            : " nodes, in a box of more cells than can be numbered: ";
  spacing.fail(
      "makes " + numberText(std::round(nodes)) + takes +
      (most > 0.0 ? "must give at most " + numberText(most) + " nodes" : "must be larger") +
      orSmaller(tissue));
}

TissueConfig readTissue(const Entry& entry, const std::string& scene_folder, bool supported,
                        Remarks& remarks) {
  const MapReader map(entry, namesOfAll(kBodyKeys, kGridKeys));
  TissueReading reading{scene_folder, supported, remarks, {}, {}};
  readKeys(map, kBodyKeys, reading);
  const TissueConfig& tissue = reading.tissue;
  requireMemory(map["spacing"], tissue, "");  // the method comes later
  for (const WallRemark& remark : wallRemarks(tissue)) {
    remarks.push_back(map["spacing"].line(remark.text + "; remedy: " + remark.remedy));
  }
  reading.filled = filledGrid(tissue);
  readKeys(map, kGridKeys, reading);
  return reading.tissue;
}

}  // namespace robot_tissue
