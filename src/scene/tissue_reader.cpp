#include <algorithm>
#include <cmath>

#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const std::vector<std::string> kMaterialKeys = {"young_modulus", "poisson_ratio", "density",
                                                "spring_stiffness"};

void readShape(const Entry& entry, const std::string& scene_folder, TissueConfig& tissue) {
  const MapReader any_type(entry, {"type", "min", "max", "resource", "scale"});
  if (any_type["type"].choice({"box", "mesh"}, {}) == "box") {
    tissue.shape =
        MapReader(entry, {"type", "min", "max"}).box(ranges::pickedPlace(), FlatBox::kRefused);
  } else {
    tissue.mesh = std::make_shared<const TriangleMesh>(readMeshShape(entry, scene_folder));
  }
}

// The tissue must not stand so far off that its spacing drowns in rounding.
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

// Entries of `map` replace those of `material`.
void readMaterialEntries(const MapReader& map, const std::string& model, Material& material,
                         Remarks& remarks) {
  const Entry poisson = map["poisson_ratio"];
  material.poisson_ratio = poisson.numberOr(material.poisson_ratio, ranges::poissonRatio());
  if (poisson.given() && model == "six_spring") {
    remarks.push_back(poisson.line("ignored, model six_spring has no Poisson's ratio"));
  }
  material.density = map["density"].numberOr(material.density, ranges::density());
  material.young_modulus =
      map["young_modulus"].numberOr(material.young_modulus, ranges::youngModulus());
  if (map["spring_stiffness"].given()) {
    material.spring_stiffness = map["spring_stiffness"].number(ranges::springStiffness());
  }
}

Material readMaterial(const Entry& entry, const std::string& model, Remarks& remarks) {
  const MapReader map(entry, kMaterialKeys);
  const Entry stiffness = map["spring_stiffness"];
  if (stiffness.given() && model != "six_spring") {
    stiffness.fail("must be left out, only model six_spring has it; give young_modulus in Pa");
  }
  if (stiffness.given() && map["young_modulus"].given()) {
    stiffness.fail("must not stand beside young_modulus, give one of the two");
  }
  Material material;
  readMaterialEntries(map, model, material, remarks);
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

Vec3 readGravity(const Entry& entry) {
  if (!entry.given()) return Vec3::Zero();
  return readVector(entry, ranges::gravity(), ranges::kLeastGravity);
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

Region readRegion(const Entry& entry, const TissueConfig& tissue, const Grid& grid,
                  Remarks& remarks) {
  std::vector<std::string> keys = {"name", "min", "max"};
  keys.insert(keys.end(), kMaterialKeys.begin(), kMaterialKeys.end());
  const MapReader map(entry, keys);
  Region region;
  if (map["name"].given()) region.name = map["name"].word("a name");
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
                   [&map](const std::string& key) { return map[key].given(); })) {
    entry.fail("must change the material by at least one of " + joined(kMaterialKeys));
  }
  region.material = tissue.material;
  readMaterialEntries(map, tissue.model, region.material, remarks);
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

void readBoxes(const MapReader& map, TissueConfig& tissue, Remarks& remarks) {
  const Grid grid = filledGrid(tissue).grid;
  if (map["regions"].given()) {
    for (const Entry& entry : map["regions"].list(0, "regions")) {
      tissue.regions.push_back(readRegion(entry, tissue, grid, remarks));
    }
  }
  if (map["fixed"].given()) {
    for (const Entry& entry : map["fixed"].list(0, "boxes with min and max")) {
      tissue.fixed.push_back(readNodeBox(MapReader(entry, {"min", "max"}), grid));
    }
  }
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
  const MapReader map(
      entry, {"frame_id", "shape", "spacing", "model", "material", "regions", "fixed", "gravity"});
  TissueConfig tissue;
  tissue.frame_id = readFrame(map["frame_id"], tissue.frame_id);
  readShape(map["shape"], scene_folder, tissue);
  tissue.spacing = tissue.mesh ? readMeshSpacing(map["spacing"], *tissue.mesh)
                               : readSpacing(map["spacing"], tissue.shape);
  if (map["model"].given()) tissue.model = map["model"].choice(modelNames(), {});
  tissue.material = readMaterial(map["material"], tissue.model, remarks);
  if (tissue.mesh && tissue.material.spring_stiffness) {
    remarks.push_back(MapReader(map["material"], kMaterialKeys)["spring_stiffness"].line(
        "every spring has it, also those of cells that the mesh fills only in part"));
  }
  requireMemory(map["spacing"], tissue, methodsFor(tissue.model).front());  // before the grid
  readBoxes(map, tissue, remarks);
  tissue.gravity = readGravity(map["gravity"]);
  if (tissue.gravity != Vec3::Zero() && tissue.fixed.empty() && !supported) {
    map["gravity"].fail(
        "must be zero unless tissue.fixed holds nodes or supports bear it, the tissue would fall");
  }
  return tissue;
}

}  // namespace robot_tissue
