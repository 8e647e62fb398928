// Walls oblique to the grid: how they bend, and that they stretch and turn as they should.
#include <gtest/gtest.h>

#include "bent_strip.h"
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

void expectBendsAsABeam(double thickness, const Turn& turn) {
  Random random;
  for (int place = 0; place < 3; ++place) {
    const bent_strip::Strip strip = {thickness, 25.0, turn.degrees, turn.rolled};
    const bent_strip::Answer answer = bent_strip::bend(strip, "newton", random.offset(1.0));
    EXPECT_TRUE(answer.ok);
    EXPECT_NEAR(answer.ratio, 1.0, turn.error)
        << thickness << " " << turn.degrees << " " << turn.rolled;
  }
}

// The wall's bending along the grid's plane of its normal, across that, and along neither.
TEST(ObliqueWalls, BendAsBeams) {
  for (const Turn& turn : {Turn{0, 0, 0.01}, Turn{22, 0, 0.06}, Turn{45, 0, 0.07},
                           Turn{0, 22, 0.02}, Turn{0, 45, 0.02}, Turn{45, 35, 0.02}}) {
    expectBendsAsABeam(2.5, turn);
  }
}

// A spacing thick, so that no place of the grid has a whole layer of cells in it.
TEST(ObliqueWalls, OfASpacingBendAsBeams) {
  for (const Turn& turn : {Turn{0, 0, 0.06}, Turn{45, 0, 0.08}, Turn{0, 22, 0.14},
                           Turn{0, 45, 0.08}, Turn{45, 35, 0.13}}) {
    expectBendsAsABeam(1.0, turn);
  }
}

// Strain is taken where the wall is: that leaves its firmness along itself.
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

}  // namespace
}  // namespace robot_tissue::test_oblique_walls
