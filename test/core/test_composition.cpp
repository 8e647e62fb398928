// Which materials cells hold where regions are given by boxes and by meshes.
#include <gtest/gtest.h>

#include <cmath>

#include "config/material.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue::test_composition {
namespace {

constexpr double kH = 0.005;

TissueConfig cube() {
  TissueConfig config;
  config.shape.max() = kH * Vec3(8, 7, 6);
  config.spacing = kH;
  config.material.young_modulus = 1e4;
  return config;
}

Region hard(const TissueConfig& config, const TriangleMesh& mesh) {
  Region region;
  region.material = config.material;
  region.material.young_modulus = 1e5;
  region.material.density = 3000.0;
  region.mesh = std::make_shared<const TriangleMesh>(mesh);
  return region;
}

Region hardBox(const TissueConfig& config, const Box& box) {
  Region region = hard(config, {});
  region.mesh = nullptr;
  region.box = box;
  return region;
}

TriangleMesh ball(double radius, const Vec3& middle) {
  return moved(sphereMesh(kH * radius, 3), kH * middle);
}

double shareOf(const Composition& composition, int region) {
  double share = 0.0;
  for (const MaterialShare& part : composition) share += part.region == region ? part.share : 0.0;
  return share;
}

// Of the tissue, in m^3.
double volumeOf(const TissueConfig& config, int region) {
  const Lattice lattice(config);
  double volume = 0.0;
  for (const Cell& cell : lattice.cells()) {
    const Composition& here = lattice.compositions()[lattice.compositionOf(cell)];
    double all = 0.0;
    for (const MaterialShare& part : here) all += part.share;
    EXPECT_NEAR(all, 1.0, 1e-12);
    volume += cell.share() * shareOf(here, region) * kH * kH * kH;
  }
  return volume;
}

LoadStep pressed(double depth) {
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {kH * Vec3(3, 3, 6), kH * Vec3(5, 5, 6)};
  patch.displacement = {0.0, 0.0, -depth};
  LoadStep step;
  step.patches = {patch};
  return step;
}

TEST(Composition, OfABoxAsAMeshIsItsOverlapWithEachCell) {
  TissueConfig config = cube();
  const Vec3 low(1.3, 2.2, 1.9), high(4.6, 5.25, 3.1);
  config.regions = {hard(config, boxMesh(kH * low, kH * high))};
  const Lattice lattice(config);
  for (const Cell& cell : lattice.cells()) {
    const Vec3 from = lattice.cellCenter(cell) / kH - Vec3::Constant(0.5);
    double expected = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double overlap =
          std::min(high[axis], from[axis] + 1.0) - std::max(low[axis], from[axis]);
      expected *= std::max(0.0, overlap);
    }
    EXPECT_NEAR(shareOf(lattice.compositions()[lattice.compositionOf(cell)], 0), expected, 1e-9);
  }
}

TEST(Composition, HasTheMeshsVolumeWhereverItStands) {
  Random random;
  for (int place = 0; place < 10; ++place) {
    TissueConfig config = cube();
    const TriangleMesh mesh = ball(2.1, Vec3(4, 3.5, 3) + random.offset(0.5));
    config.regions = {hard(config, mesh)};
    EXPECT_NEAR(volumeOf(config, 0) / volumeOf(mesh), 1.0, 1e-9);
  }
}

// Half a ball on each face of the block.
TEST(Composition, OfAMeshThatReachesBeyondTheTissueIsWhatIsInIt) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      TissueConfig config = cube();
      Vec3 middle(4, 3.5, 3);
      middle[axis] = upper ? config.shape.max()[axis] / kH : 0.0;
      const TriangleMesh mesh = ball(2.1, middle);
      config.regions = {hard(config, mesh)};
      EXPECT_NEAR(volumeOf(config, 0) / volumeOf(mesh), 0.5, 1e-9) << axis << upper;
    }
  }
}

TEST(Composition, TheLaterOfTwoRegionsHasWhatBothEnclose) {
  TissueConfig config = cube();
  const TriangleMesh first = ball(1.8, {3.3, 3.4, 3.2}), second = ball(1.6, {4.9, 3.7, 3.0});
  config.regions = {hard(config, first)};
  const double alone = volumeOf(config, 0);
  config.regions = {hard(config, first), hard(config, second)};
  EXPECT_NEAR(volumeOf(config, 1) / volumeOf(second), 1.0, 2e-3);
  const double first_left = volumeOf(config, 0);
  std::swap(config.regions[0], config.regions[1]);
  const double common = volumeOf(second) - volumeOf(config, 0);
  EXPECT_GT(common, 0.1 * alone);
  EXPECT_NEAR((first_left + common) / alone, 1.0, 4e-3);
}

// The same in a corner of cells whose centers it holds.
TEST(Composition, ABoxOverAMeshTakesWholeCells) {
  TissueConfig config = cube();
  config.regions = {hard(config, ball(2.1, {4, 3.5, 3})),
                    hardBox(config, {Vec3::Zero(), kH * Vec3(4, 7, 6)})};
  EXPECT_NEAR(volumeOf(config, 1), 0.5 * config.shape.volume(), 1e-15);
  EXPECT_NEAR(volumeOf(config, 0) / volumeOf(ball(2.1, {4, 3.5, 3})), 0.5, 1e-9);
}

TEST(Composition, OfTissueByAMeshIsOfWhatFillsTheCell) {
  TissueConfig config = cube();
  config.mesh = std::make_shared<const TriangleMesh>(ball(3.2, {0.1, 0.2, 0.3}));
  // Shares the organ's surface: the half of it with x > 0.1 h.
  config.regions = {hard(config, boxMesh(kH * Vec3(0.1, -9, -9), kH * Vec3(9, 9, 9)))};
  EXPECT_NEAR(volumeOf(config, 0) / volumeOf(*config.mesh), 0.5, 2e-3);
  // Within it, along its surface.
  const TriangleMesh inner = ball(3.0, {0.1, 0.2, 0.3});
  config.regions = {hard(config, inner)};
  EXPECT_NEAR(volumeOf(config, 0) / volumeOf(inner), 1.0, 2e-3);
}

// Bit by bit.
TEST(Composition, ABoxThatFitsTheGridIsTheSameAsAMesh) {
  TissueConfig config = cube();
  config.fixed = {{Vec3(0, 0, 0), Vec3(1, 1, 0)}};
  const Box box = {kH * Vec3(2, 2, 3), kH * Vec3(5, 4, 5)};
  TissueConfig by_mesh = config;
  config.regions = {hardBox(config, box)};
  by_mesh.regions = {hard(config, boxMesh(box.min(), box.max()))};
  const LoadStep step = pressed(0.3 * kH);
  Tissue first(config, SolverConfig()), second(by_mesh, SolverConfig());
  first.load(step);
  second.load(step);
  EXPECT_EQ(first.state().displacement, second.state().displacement);
  TissueConfig soft = config;
  soft.regions.clear();
  Tissue third(soft, SolverConfig());
  third.load(step);
  EXPECT_GT(first.lastReport().patches[0].force.norm(),
            1.05 * third.lastReport().patches[0].force.norm());
}

TEST(Composition, MethodsAgreeOnCellsOfTwoMaterials) {
  TissueConfig config = cube();
  config.fixed = {{Vec3(0, 0, 0), Vec3(1, 1, 0)}};
  config.regions = {hard(config, ball(1.7, {4.2, 3.3, 3.6}))};
  const LoadStep step = pressed(0.2 * kH);
  const auto force = [&](const std::string& method, double tolerance) {
    SolverConfig solver;
    solver.method = method;
    solver.tolerance = tolerance;
    Tissue tissue(config, solver);
    tissue.load(step);
    EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk) << method;
    return tissue.lastReport().patches[0].force.z();
  };
  const double exact = force("newton", 1e-3);
  EXPECT_NEAR(force("layered", 1e-4) / exact, 1.0, 1e-3);
  for (const char* method : {"vbd", "xpbd", "explicit"}) {
    EXPECT_NEAR(force(method, 0.01) / exact, 1.0, 0.03) << method;
  }
}

TEST(Composition, MassIsThatOfItsMaterials) {
  TissueConfig config = cube();
  const TriangleMesh mesh = ball(1.7, {4.2, 3.3, 3.6});
  config.regions = {hard(config, mesh)};
  const Lattice lattice(config);
  double mass = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) mass += lattice.mass(node);
  const double expected = 1000.0 * config.shape.volume() + 2000.0 * volumeOf(mesh);
  EXPECT_NEAR(mass / expected, 1.0, 1e-9);
}

// Hill's bounds: between layers in a row and side by side; of balls in the first.
TEST(MixedModuli, AreThoseOfBallsInTheFirst) {
  Material soft, stiff;
  soft.young_modulus = 1e4;
  stiff.young_modulus = 1e5;
  const Moduli a = moduliOf(soft), b = moduliOf(stiff);
  EXPECT_EQ(mixed({{a, 1.0}}).shear, a.shear);
  for (const double share : {1e-6, 0.2, 0.5, 0.9, 1.0 - 1e-6}) {
    const Moduli both = mixed({{a, 1.0 - share}, {b, share}});
    EXPECT_GT(both.shear, 1.0 / ((1.0 - share) / a.shear + share / b.shear));
    EXPECT_LT(both.shear, (1.0 - share) * a.shear + share * b.shear);
    EXPECT_GT(both.bulk, 1.0 / ((1.0 - share) / a.bulk + share / b.bulk));
    EXPECT_LT(both.bulk, (1.0 - share) * a.bulk + share * b.bulk);
    EXPECT_LT(both.shear, mixed({{b, share}, {a, 1.0 - share}}).shear);
  }
  // Few balls add what Eshelby's (1957) do in shear: c (G1 - G0) / (1 + beta (G1/G0 - 1)).
  const double nu = poissonRatio(a), few = 1e-6;
  const double beta = 2.0 * (4.0 - 5.0 * nu) / (15.0 * (1.0 - nu));
  const double added = (mixed({{a, 1.0 - few}, {b, few}}).shear - a.shear) / few;
  EXPECT_NEAR(added / ((b.shear - a.shear) / (1.0 + beta * (b.shear / a.shear - 1.0))), 1.0, 1e-5);
}

}  // namespace
}  // namespace robot_tissue::test_composition
