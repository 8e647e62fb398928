#include "stability_rungs.h"

#include <cmath>
#include <cstdio>

#include "core/mesh_fixtures.h"
#include "reference_cases.h"

namespace robot_tissue {
namespace {

constexpr double kYoung = 1e4;  // Pa
constexpr double kPoisson = 0.45;
constexpr double kSpacing = 0.005;         // m
constexpr double kFinestByNewton = 0.004;  // m; below, it needs too much memory
constexpr double kSmall = 0.0005;          // m: the reference's increments
constexpr double kSmallTurn = M_PI / 36.0;
constexpr double kGravity = 9.81;  // m/s^2
const Vec3 kBlock(0.10, 0.10, 0.05);

TissueConfig blockOf(double spacing = kSpacing, double poisson_ratio = kPoisson) {
  TissueConfig tissue;
  tissue.shape.max() = kBlock;
  tissue.spacing = spacing;
  tissue.material.young_modulus = kYoung;
  tissue.material.poisson_ratio = poisson_ratio;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return tissue;
}

// 20 x 20 mm at this height.
Box patchAt(double z) { return {Vec3(0.04, 0.04, z), Vec3(0.06, 0.06, z)}; }

int smallIncrements(double way) { return static_cast<int>(std::ceil(way / kSmall - 1e-9)); }

std::string numbered(const std::string& group, double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", number);
  return group + "_" + text;
}

// A patch in the middle of the top, moved at once.
Rung moved(const std::string& name, const std::string& group, const TissueConfig& tissue,
           const Vec3& way) {
  Rung rung;
  rung.name = name;
  rung.group = group;
  rung.tissue = tissue;
  rung.patches = {patchAt(kBlock.z())};
  rung.go = [way](Specimen& specimen, double share) { specimen.move(0, share * way); };
  rung.measure = [](const Specimen& specimen) { return specimen.force(0); };
  rung.unit = "N";
  rung.reference_increments = smallIncrements(way.norm());
  return rung;
}

void addPresses(std::vector<Rung>& rungs) {
  for (const double mm : {5.0, 10.0, 20.0, 30.0, 40.0}) {
    rungs.push_back(moved(numbered("press", mm), "press", blockOf(), Vec3(0.0, 0.0, -1e-3 * mm)));
  }
  for (const double mm : {5.0, 10.0, 20.0, 30.0}) {
    rungs.push_back(moved(numbered("drag", mm), "drag", blockOf(), Vec3(1e-3 * mm, 0.0, 0.0)));
  }
}

Rung twisted(const std::string& name, double angle, int increments) {
  Rung rung = moved(name, "twist", blockOf(), Vec3::Zero());
  rung.go = [angle](Specimen& specimen, double share) {
    specimen.turn(0, share * angle * Vec3::UnitZ());
  };
  rung.increments = increments;
  rung.measure = [](const Specimen& specimen) { return specimen.torque(0); };
  rung.unit = "N m";
  rung.reference_increments = static_cast<int>(std::lround(angle / kSmallTurn));
  return rung;
}

// A patch pushed by more than the tissue is thick.
void addThroughs(std::vector<Rung>& rungs) {
  const Vec3 way(0.0, 0.0, -0.06);
  TissueConfig held_by_sides = blockOf();
  held_by_sides.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)},
                         {Vec3(kBlock.x() - 1e-6, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)},
                         {Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1e-6, 1.0)},
                         {Vec3(-1.0, kBlock.y() - 1e-6, -1.0), Vec3(1.0, 1.0, 1.0)}};
  rungs.push_back(moved("through_sheet", "through", held_by_sides, way));
  Rung floor = moved("through_floor", "through", blockOf(), way);
  floor.has_no_shape = true;
  floor.reference_increments = 0;
  rungs.push_back(floor);
}

// What is stiffer hangs in the middle of what is soft.
void addRatios(std::vector<Rung>& rungs) {
  for (const double ratio : {1.0, 10.0, 100.0, 1000.0, 10000.0}) {
    TissueConfig tissue = blockOf();
    Region region;
    region.name = "stiff";
    region.box = {Vec3(0.03, 0.03, 0.015), Vec3(0.07, 0.07, 0.04)};
    region.material = tissue.material;
    region.material.young_modulus *= ratio;
    tissue.regions.push_back(region);
    rungs.push_back(moved(numbered("ratio", ratio), "stiffness", tissue, Vec3(0.0, 0.0, -0.005)));
  }
}

void addRatiosOfPoisson(std::vector<Rung>& rungs) {
  for (const double ratio : {0.25, 0.35, 0.45, 0.48, 0.49}) {
    rungs.push_back(moved(numbered("poisson", ratio), "poisson", blockOf(kSpacing, ratio),
                          Vec3(0.0, 0.0, -0.005)));
  }
}

void addSpacings(std::vector<Rung>& rungs) {
  std::optional<double> force;
  for (const ReferenceCase& reference : readReferenceCases(ROBOT_TISSUE_SOURCE_DIR)) {
    const bool same = std::abs(reference.poisson_ratio - kPoisson) < 1e-9;
    if (reference.name == "press_d5" && same) force = reference.force;
  }
  for (const double mm : {10.0, 5.0, 2.5, 1.25}) {
    Rung rung =
        moved(numbered("spacing", mm), "spacing", blockOf(1e-3 * mm), Vec3(0.0, 0.0, -0.005));
    if (1e-3 * mm < kFinestByNewton) {
      rung.reference_increments = 0;
      rung.known = force;
    }
    rungs.push_back(rung);
  }
}

std::vector<Vec3> level(double x0, double y0, double x1, double y1, double z) {
  return {Vec3(x0, y0, z), Vec3(x1, y0, z), Vec3(x1, y1, z), Vec3(x0, y1, z)};
}

// A bar of one cell by one, 100 mm long, at a lower edge of a block that hangs from its top: cut
// off but for one spring at its end.
Rung sliver(const std::string& name) {
  Rung rung;
  rung.name = name;
  rung.group = "sliver";
  rung.tissue = blockOf();
  rung.tissue.fixed = {{Vec3(-1.0, -1.0, kBlock.z() - 1e-6), Vec3(1.0, 1.0, 1.0)}};
  const double half = 1.5 * kSpacing;
  rung.cuts = {{Vec3(-0.01, half, -0.01), Vec3(0.11, half, -0.01), Vec3(0.11, half, half),
                Vec3(-0.01, half, half)},
               level(kSpacing / 2.0, -0.01, 0.11, half, half),
               level(-0.01, kSpacing / 2.0, kSpacing / 2.0, half, half)};
  return rung;
}

void addSlivers(std::vector<Rung>& rungs) {
  const Box end = {Vec3(kBlock.x(), 0.0, 0.0), Vec3(kBlock.x(), kSpacing, kSpacing)};
  Rung pulled = sliver("sliver_pulled");
  const Vec3 way(0.0, 0.0, -0.02);
  pulled.patches = {end};
  pulled.go = [way](Specimen& specimen, double share) { specimen.move(0, share * way); };
  pulled.measure = [](const Specimen& specimen) { return specimen.force(0); };
  pulled.unit = "N";
  pulled.reference_increments = smallIncrements(way.norm());
  rungs.push_back(pulled);
  Rung hanging = sliver("sliver_hangs");
  hanging.go = [](Specimen& specimen, double share) {
    specimen.setGravity(Vec3(0.0, 0.0, -share * kGravity));
  };
  hanging.measure = [](const Specimen& specimen) {  // how far its end has sunk
    const int node = specimen.lattice().node(specimen.lattice().size()[0] - 1, 0, 0);
    return -specimen.state().displacement[at(node)].z();
  };
  hanging.unit = "m";
  hanging.reference_increments = 100;
  rungs.push_back(hanging);
}

// The upper part of the block, cut off.
void addFreePieces(std::vector<Rung>& rungs) {
  const std::vector<Vec3> whole = level(-0.01, -0.01, 0.11, 0.11, 0.0275);
  Rung moved_off = moved("free_moved", "free", blockOf(), Vec3(0.01, 0.0, 0.005));
  moved_off.cuts = {whole};
  moved_off.measure = [](const Specimen& specimen) {  // of a far corner: it goes along
    const int node = specimen.lattice().node(0, 0, specimen.lattice().size()[2] - 1);
    return specimen.state().displacement[at(node)].norm();
  };
  moved_off.unit = "m";
  moved_off.reference_increments = 0;
  moved_off.known = Vec3(0.01, 0.0, 0.005).norm();
  rungs.push_back(moved_off);
  Rung squeezed = moved("free_squeezed", "free", blockOf(), Vec3(0.0, 0.0, -0.005));
  squeezed.cuts = {whole};
  squeezed.patches.push_back(patchAt(0.03));
  rungs.push_back(squeezed);
  Rung sprung = moved("free_sprung", "free", blockOf(), Vec3(0.0, 0.0, -0.005));
  sprung.afterwards = [whole](Specimen& specimen) {
    specimen.cut(whole);
    specimen.solve();
  };
  sprung.reference_increments = 0;
  sprung.known = 0.0;
  sprung.bound = 0.02;  // N; 1.8 before the cut
  rungs.push_back(sprung);
}

// Shapes by a mesh, whose cells at the surface are filled in part: held below `floor`, the nodes
// over `top` within 12 mm of the z axis pressed down.
Rung pressedMesh(const std::string& name, const TriangleMesh& mesh, double floor, double top,
                 double way) {
  TissueConfig tissue = blockOf();
  tissue.mesh = std::make_shared<const TriangleMesh>(mesh);
  tissue.fixed = {{Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, floor)}};
  Rung rung = moved(name, "mesh", tissue, Vec3(0.0, 0.0, -way));
  rung.patches = {{Vec3(-0.012, -0.012, top), Vec3(0.012, 0.012, 1.0)}};
  return rung;
}

void addMeshes(std::vector<Rung>& rungs) {
  const TriangleMesh ball = sphereMesh(0.03, 4);
  for (const double mm : {5.0, 10.0, 20.0}) {
    rungs.push_back(pressedMesh(numbered("mesh_ball", mm), ball, -0.015, 0.024, 1e-3 * mm));
  }
  for (const double mm : {2.0, 4.0, 8.0}) {  // of the wall
    const TriangleMesh shell = joined(ball, insideOut(sphereMesh(0.03 - 1e-3 * mm, 4)));
    rungs.push_back(pressedMesh(numbered("mesh_shell", mm), shell, -0.015, 0.024, 0.005));
  }
  // Turned by 30 degrees about an axis that is none of the grid's.
  Pose aslant = Pose::Identity();
  aslant.linear() =
      Eigen::AngleAxisd(M_PI / 6.0, Vec3(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  const TriangleMesh slab =
      robot_tissue::moved(boxMesh(Vec3(-0.04, -0.03, -0.015), Vec3(0.04, 0.03, 0.015)), aslant);
  rungs.push_back(pressedMesh("mesh_aslant", slab, -0.012, 0.01, 0.005));
  // Its sides reach into the outer cells by a hundredth.
  const Vec3 half = 0.5 * kSpacing * Vec3(10.02, 10.02, 8.02);
  rungs.push_back(pressedMesh("mesh_grazed", boxMesh(-half, half), -0.018, 0.019, 0.005));
  for (const double ratio : {10.0, 1000.0}) {
    Rung rung = pressedMesh(numbered("mesh_tumor", ratio), ball, -0.015, 0.024, 0.005);
    Region region;
    region.mesh = std::make_shared<const TriangleMesh>(
        robot_tissue::moved(sphereMesh(0.011, 3), Vec3(0.003, 0.002, 0.006)));
    region.material = rung.tissue.material;
    region.material.young_modulus *= ratio;
    rung.tissue.regions.push_back(region);
    rungs.push_back(rung);
  }
}

}  // namespace

std::vector<Rung> makeRungs() {
  std::vector<Rung> rungs;
  addPresses(rungs);
  rungs.push_back(twisted("twist_90", M_PI / 2.0, 1));
  rungs.push_back(twisted("twist_180", M_PI, 18));
  rungs.push_back(twisted("twist_180_by_45", M_PI, 4));
  addThroughs(rungs);
  addRatios(rungs);
  addRatiosOfPoisson(rungs);
  addSpacings(rungs);
  addSlivers(rungs);
  addFreePieces(rungs);
  addMeshes(rungs);
  return rungs;
}

}  // namespace robot_tissue
