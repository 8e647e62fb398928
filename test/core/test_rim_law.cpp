#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "../rim_strip.h"
#include "loads/rim_law.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue::test_rim_law {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<const char*, 3> kMotion{"across", "along", "normal"};

std::array<RimMode, 3> modesOf(const RimLaw& law) { return {law.across, law.along, law.normal}; }

TEST(RimLaw, ANodeRightAtTheEdgeHasTheModesStiffness) {
  for (const RimMode& mode : modesOf(rimLaw(0.4))) {
    EXPECT_DOUBLE_EQ(rimStiffness(mode, 0.0), mode.stiffness);
  }
}

TEST(RimLaw, NodesDeepInsideAreRigidAndNodesFarOutsideFree) {
  for (const RimMode& mode : modesOf(rimLaw(0.4))) {
    EXPECT_EQ(rimStiffness(mode, mode.shift), kInfinity);
    EXPECT_EQ(rimStiffness(mode, 5.0), kInfinity);
    EXPECT_EQ(rimStiffness(mode, mode.shift - 1.0), 0.0);
    EXPECT_EQ(rimStiffness(mode, -5.0), 0.0);
  }
}

TEST(RimLaw, BetweenFreeAndRigidTheStiffnessRisesWithoutAJump) {
  for (const RimMode& mode : modesOf(rimLaw(0.4))) {
    const double end = mode.shift;
    EXPECT_LT(rimStiffness(mode, end - 1.0 + 1e-9), 1e-6);
    EXPECT_GT(rimStiffness(mode, end - 1e-9), 1e6);
    double last = 0.0;
    for (double depth = end - 0.9999; depth < end - 0.001; depth += 1e-4) {
      const double stiffness = rimStiffness(mode, depth);
      EXPECT_GT(stiffness, last);
      // The law's slope is a / (end - depth)^2, its value nearly a / (end - depth), a near 1.
      EXPECT_LT((stiffness - last) * (end - depth), 3e-4 * (stiffness + 1.0));
      last = stiffness;
    }
  }
}

TEST(RimLaw, ComplianceIsInShearModuliTimesSpacing) {
  const RimCompliance found = rimCompliance({20.0, 0.45}, -0.3);
  const RimLaw law = rimLaw(0.45);
  EXPECT_DOUBLE_EQ(found.across, 1.0 / (20.0 * rimStiffness(law.across, -0.3)));
  EXPECT_DOUBLE_EQ(found.along, 1.0 / (20.0 * rimStiffness(law.along, -0.3)));
  EXPECT_DOUBLE_EQ(found.normal, 1.0 / (20.0 * rimStiffness(law.normal, -0.3)));
}

// However full the cells around a node are, they are of one material.
TEST(RimLaw, ModuliAreOfTheMaterial) {
  TissueConfig config;
  config.mesh =
      std::make_shared<const TriangleMesh>(boxMesh(Vec3::Zero(), Vec3(0.023, 0.023, 0.018)));
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.4;
  const Tissue tissue(config, SolverConfig());
  const double shear = 1e4 / (2.0 * 1.4);
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    const auto moduli = tissue.rimModuli(node);
    ASSERT_TRUE(moduli) << node;
    EXPECT_NEAR(moduli->stiffness, shear * 0.005, 1e-9 * shear) << node;
    EXPECT_NEAR(moduli->poisson_ratio, 0.4, 1e-9) << node;
  }
}

TEST(RimLaw, HitsTheTableAndGoesStraightBetween) {
  EXPECT_DOUBLE_EQ(rimLaw(0.25).normal.stiffness, 6.18);
  EXPECT_DOUBLE_EQ(rimLaw(0.45).normal.stiffness, 9.22);
  EXPECT_DOUBLE_EQ(rimLaw(0.45).across.shift, 0.271);
  EXPECT_DOUBLE_EQ(rimLaw(0.49).across.stiffness, 5.48);
  const RimLaw low = rimLaw(0.45), middle = rimLaw(0.46), high = rimLaw(0.47);
  EXPECT_NEAR(middle.normal.stiffness, 0.5 * (low.normal.stiffness + high.normal.stiffness), 1e-12);
  EXPECT_NEAR(middle.across.shift, 0.5 * (low.across.shift + high.across.shift), 1e-12);
}

TEST(RimLaw, BeyondTheTableItStaysAsAtTheEnd) {
  EXPECT_EQ(rimLaw(0.1).normal.stiffness, rimLaw(0.25).normal.stiffness);
  EXPECT_EQ(rimLaw(0.4999).across.shift, rimLaw(0.49).across.shift);
}

// Strips of 16 and 32 cells: those of the table are taller, and what is left is that difference.
class RimStrip : public testing::TestWithParam<double> {
 protected:
  static constexpr int kCells = 16;
  static constexpr int kBonded = 6;
  static constexpr int kBeside = 4;

  Vec3 shiftOf(const RimSprings& springs, double depth) const {
    const Eigen::Matrix3d seeming = seemingDepth(coarse_, fine_, springs);
    return seeming.diagonal().array() - depth;
  }

  Strip coarse_{kCells, GetParam(), kBonded, kBeside};
  Strip fine_{2 * kCells, GetParam(), kBonded, kBeside};
};

TEST_P(RimStrip, JoinedRigidlyThePlateSeemsWider) {
  const Vec3 shift = shiftOf(rigidRim(), 0.0);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(shift[axis], 0.14) << kMotion[at(axis)];
    EXPECT_LT(shift[axis], 0.28) << kMotion[at(axis)];
  }
}

TEST_P(RimStrip, WithTheLawsSpringsItSeemsAsWideAsItIs) {
  const RimLaw law = rimLaw(GetParam());
  for (const double depth : {-0.7, -0.5, -0.3, -0.1, 0.0, 0.1, 0.2}) {
    const Vec3 shift = shiftOf(springsAt(law, depth), depth);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_LT(std::abs(shift[axis]), 0.02) << kMotion[at(axis)] << " at " << depth;
    }
  }
}

TEST_P(RimStrip, TwoMotionsAtOnceAreNotCoupledByTheLawsSprings) {
  const RimSprings springs = springsAt(rimLaw(GetParam()), 0.0);
  EXPECT_LT(std::abs(seemingDepth(coarse_, fine_, springs)(0, 2)), 0.02);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatio, RimStrip, testing::Values(0.25, 0.45));

}  // namespace
}  // namespace robot_tissue::test_rim_law
