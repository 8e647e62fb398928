// Model `elastic` against formulas and against finite elements (test/data/reference).
#include <gtest/gtest.h>

#include <cmath>

#include "analytic_checks.h"
#include "reference_cases.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue::test_accuracy {
namespace {

class AnyRatio : public ::testing::TestWithParam<double> {};

TEST_P(AnyRatio, FreeBarHasTheModulusAndTheRatioAlongEveryAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const PulledBar bar = pulledBar(axis, GetParam());
    EXPECT_LT(std::abs(bar.young_modulus_error), 0.01) << axis;
    EXPECT_LT(std::abs(bar.poisson_ratio_error), 0.02) << axis;
  }
}

TEST_P(AnyRatio, DiagonalsOfTheLatticeAreLikeItsAxes) {
  for (const Vec3& direction : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(1, 1, 1), Vec3(1, -2, 3)}) {
    const PulledBar bar = uniaxialStress(direction, GetParam());
    EXPECT_LT(std::abs(bar.young_modulus_error), 1e-3) << direction.transpose();
    EXPECT_LT(std::abs(bar.poisson_ratio_error), 1e-3) << direction.transpose();
  }
}

TEST_P(AnyRatio, NoTurnMeetsAForce) {
  for (const double angle : {0.1, 1.0, 3.14159, 5.0}) {
    EXPECT_LT(forceAfterTurn(angle, GetParam()), 1e-10) << angle;
  }
}

TEST_P(AnyRatio, LinearFieldOnTheBorderComesBackInside) {
  EXPECT_LT(patchTestError(GetParam()), 1e-6);
}

// The elastica is slender and inextensible, the bar is a tenth as thick as long.
TEST_P(AnyRatio, BarHangsByItsWeightLikeAnElastica) {
  const HangingBar bar = hangingBar(4, GetParam());
  EXPECT_GT(bar.elastica, 0.5);
  EXPECT_GT(bar.deflection, 0.5);
  EXPECT_NEAR(bar.deflection, bar.elastica, 0.03 * bar.elastica);
}

INSTANTIATE_TEST_SUITE_P(PoissonRatio, AnyRatio, ::testing::Values(0.25, 0.45, 0.49));

TEST(Accuracy, NearlyIncompressibleTissueKeepsItsVolume) {
  EXPECT_GT(volumeRatioUnderPress(false, 0.01, 0.49), 0.98);
  EXPECT_GT(volumeRatioUnderPress(true, 0.01, 0.49), 0.98);
}

// At a spacing of 5 mm. The reference of press_d10 is itself off by up to 3.5 % (its README).
TEST(Accuracy, ForceAndShapeAreThoseOfFiniteElements) {
  for (const ReferenceCase& reference : readReferenceCases(ROBOT_TISSUE_SOURCE_DIR)) {
    SCOPED_TRACE(reference.name + ", " + std::to_string(reference.poisson_ratio));
    const bool deep = reference.name == "press_d10", drag = reference.name == "drag_d5";
    const ReferenceError error = errorAgainst(reference, "layered", 0.005);
    EXPECT_LT(std::abs(error.force), deep || drag ? 0.05 : 0.03);
    EXPECT_LT(error.field, deep ? 0.06 : 0.04);
    if (reference.name != "press_d1") continue;
    const ReferenceError exact = errorAgainst(reference, "newton", 0.005);
    EXPECT_NEAR(error.force, exact.force, 3e-3);
    EXPECT_NEAR(error.field, exact.field, 1e-3);
  }
}

TEST(Accuracy, GrowsAsTheLatticeGetsFiner) {
  for (const ReferenceCase& reference : readReferenceCases(ROBOT_TISSUE_SOURCE_DIR)) {
    if (reference.name != "press_d1" && reference.name != "shear") continue;
    SCOPED_TRACE(reference.name + ", " + std::to_string(reference.poisson_ratio));
    const double coarse = errorAgainst(reference, "layered", 0.005).field;
    EXPECT_LT(errorAgainst(reference, "layered", 0.0025).field, 0.5 * coarse);
  }
}

}  // namespace
}  // namespace robot_tissue::test_accuracy
