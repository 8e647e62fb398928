// Walls oblique to the grid: how they bend, and which moduli their cells have for it.
#include <gtest/gtest.h>

#include <numeric>

#include "bent_strip.h"
#include "lattice/oblique_walls.h"
#include "material/elastic_model.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue::test_oblique_walls {
namespace {

struct Turn {
  double degrees, rolled, error;
};

TissueConfig tissueOf(const TriangleMesh& mesh) {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(mesh);
  config.spacing = 0.005;
  return config;
}

TriangleMesh turnedBox(const Vec3& size) {
  return moved(boxMesh(Vec3::Zero(), 0.005 * size),
               Pose(Eigen::AngleAxisd(0.7, Vec3(0.1, 1.0, 0.3).normalized())));
}

// The wall's bending along the grid's plane of its normal, across that, and along neither.
TEST(ObliqueWalls, BendAsBeams) {
  for (const Turn& turn : {Turn{22, 0, 0.03}, Turn{45, 0, 0.07}, Turn{0, 22, 0.02},
                           Turn{0, 45, 0.05}, Turn{45, 35, 0.09}}) {
    Random random;
    for (int place = 0; place < 3; ++place) {
      const bent_strip::Strip strip = {2.5, 25.0, turn.degrees, turn.rolled};
      const bent_strip::Answer answer = bent_strip::bend(strip, "newton", random.offset(1.0));
      EXPECT_TRUE(answer.ok);
      EXPECT_NEAR(answer.ratio, 1.0, turn.error) << turn.degrees << " " << turn.rolled;
    }
  }
}

// Moved moduli leave the firmness along the wall.
TEST(ObliqueWalls, StretchAsBars) {
  Random random;
  for (const double thickness : {1.5, 2.5}) {
    for (const double degrees : {22.0, 35.0, 45.0}) {
      const bent_strip::Strip strip = {thickness, 24.0, degrees};
      const bent_strip::Answer answer = bent_strip::stretch(strip, "newton", random.offset(1.0));
      EXPECT_TRUE(answer.ok);
      EXPECT_NEAR(answer.ratio, 1.0, 0.02) << thickness << " " << degrees;
    }
  }
}

TEST(ObliqueWalls, KeepTheSumOfTheirModuli) {
  const TissueConfig config = tissueOf(turnedBox({12.0, 7.3, 2.4}));
  const FilledGrid tissue = filledGrid(config);
  const std::vector<double> factors = moduliFactors(tissue, compositionsOf(config, tissue));
  double volume = 0.0, moduli = 0.0;
  std::size_t next = 0;
  for (const double filled : tissue.filled) {
    if (!(filled > 0.0)) continue;
    volume += filled;
    moduli += filled * factors.at(next);
    EXPECT_GE(factors[next], 1.0 / 3.0 - 1e-12);
    EXPECT_LE(factors[next++], 2.0 + 1e-12);
  }
  EXPECT_EQ(next, factors.size());
  EXPECT_NEAR(moduli, volume, 1e-10 * volume);
}

// What is deep inside, and all of a box along the axes, keeps its bits.
TEST(ObliqueWalls, LeaveTheRestAlone) {
  const TissueConfig upright = tissueOf(boxMesh(Vec3::Zero(), 0.005 * Vec3(6.4, 3.2, 2.5)));
  const FilledGrid tissue = filledGrid(upright);
  EXPECT_TRUE(moduliFactors(tissue, compositionsOf(upright, tissue)).empty());
  for (const auto& [cell, fill] : tissue.partial) EXPECT_EQ(fill.strain_places, Vec3::Ones());
  const Lattice thick(tissueOf(turnedBox({14.0, 14.0, 14.0})));
  const Vec3 middle = 0.5 * (thick.bounds().min() + thick.bounds().max());
  int inside = 0;
  for (const Cell& cell : thick.cells()) {
    if ((thick.cellCenter(cell) - middle).norm() > 0.02) continue;
    EXPECT_EQ(cell.moduli_factor, 1.0);
    ++inside;
  }
  EXPECT_GT(inside, 200);
}

TEST(ObliqueWalls, TurnedAsARigidBodyHaveNoForce) {
  TissueConfig config = tissueOf(turnedBox({10.0, 6.3, 2.4}));
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.3;
  config.gravity.setZero();
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  LatticeState state = lattice.restState();
  const Eigen::AngleAxisd turn(1.1, Vec3(1, -2, 0.5).normalized());
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    state.displacement[at(node)] = turn * rest - rest;
  }
  const double unit = 1e4 * 0.005 * 0.005;  // E h^2
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    EXPECT_LT(model.nodeForce(state, node).norm(), 1e-10 * unit);
  }
}

// No moduli go from one material to another.
TEST(ObliqueWalls, MoveModuliWithinAMaterial) {
  TissueConfig config = tissueOf(turnedBox({12.0, 7.3, 2.4}));
  const FilledGrid tissue = filledGrid(config);
  Region region;
  region.box = {Vec3(-1, -1, -1), Vec3(0.03, 1, 1)};
  region.material = config.material;
  region.material.young_modulus = 1e6;
  config.regions.push_back(region);
  const CellCompositions compositions = compositionsOf(config, tissue);
  const std::vector<double> factors = moduliFactors(tissue, compositions);
  std::array<double, 2> volume{}, moduli{};
  std::size_t next = 0;
  for (const double filled : tissue.filled) {
    if (!(filled > 0.0)) continue;
    const std::size_t kind = compositions.of_cell[next];
    volume.at(kind) += filled;
    moduli.at(kind) += filled * factors[next++];
  }
  for (std::size_t kind = 0; kind < 2; ++kind) {
    EXPECT_GT(volume[kind], 10.0);
    EXPECT_NEAR(moduli[kind], volume[kind], 1e-10 * volume[kind]);
  }
}

}  // namespace
}  // namespace robot_tissue::test_oblique_walls
