// Increments that the tissue chooses for a load: as long as the method's step, whatever the
// stiffness, and as good as many more.
#include <gtest/gtest.h>

#include <cmath>

#include "robot_tissue/core/tissue.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_load_steps {
namespace {

constexpr double kSpacing = 0.01;       // m
constexpr double kStep = 0.5;           // of the spacing: what method layered follows
constexpr double kTolerance = 1e-3;     // of the displacement
constexpr double kOverTolerance = 2.0;  // two shapes, each within it

TissueConfig elasticOf(const Vec3& extent, double young, const Box& fixed) {
  TissueConfig config;
  config.shape.max() = extent;
  config.spacing = kSpacing;
  config.material.young_modulus = young;
  config.material.poisson_ratio = 0.4;
  config.fixed.push_back(fixed);
  return config;
}

// 80 x 80 x 40 mm on its bottom; the patch is in the middle of its top.
TissueConfig blockOn(double young) {
  return elasticOf(Vec3(0.08, 0.08, 0.04), young, {Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
}
const Box kPunch = {Vec3(0.03, 0.03, 0.04), Vec3(0.05, 0.05, 0.04)};

// A bar held at one end; the patch is its other end. Its nodes are a hundred times as stiff as it.
TissueConfig bar() {
  return elasticOf(Vec3(0.1, 0.02, 0.02), 1e4, {Vec3(-1.0, -1.0, -1.0), Vec3(1e-6, 1.0, 1.0)});
}
const Box kEnd = {Vec3(0.1, 0.0, 0.0), Vec3(0.1, 0.02, 0.02)};

struct Climb {
  explicit Climb(const TissueConfig& config, const PatchConfig& patch,
                 std::optional<int> increments = std::nullopt,
                 const std::string& method = "layered")
      : tissue(config, solverOf(method)) {
    Vec3 last = Vec3::Zero();
    tissue.load(loadOf({patch}, increments), [&](int increment, int of, const SolveReport& report) {
      EXPECT_EQ(increment, ++count);
      EXPECT_GE(of, increment);
      foreseen = of;
      const Vec3 place = tissue.answerOf(patch.name, report).displacement;
      longest = std::max(longest, (place - last).norm() / kSpacing);
      last = place;
    });
    way = last.norm();
  }
  static SolverConfig solverOf(const std::string& method) {
    SolverConfig solver;
    solver.method = method;
    solver.tolerance = kTolerance;
    return solver;
  }
  double offFrom(const Climb& other) const {
    double off = 0.0, all = 0.0;
    for (std::size_t node = 0; node < tissue.state().displacement.size(); ++node) {
      const Vec3& right = other.tissue.state().displacement[node];
      off += (tissue.state().displacement[node] - right).squaredNorm();
      all += right.squaredNorm();
    }
    return std::sqrt(off / all);
  }

  Tissue tissue;
  int count = 0, foreseen = 0;
  double longest = 0.0;  // way of the patch in one increment, in spacings
  double way = 0.0;      // m
};

// Young's modulus; the force goes with it.
class SoftOrStiff : public ::testing::TestWithParam<double> {};

TEST_P(SoftOrStiff, ForceIsBroughtOnInStepsThatTheMethodFollows) {
  const PatchConfig patch = forcedPatch("punch", kPunch, Vec3(0.0, 0.0, -6e-4 * GetParam()));
  const Climb chosen(blockOn(GetParam()), patch);
  EXPECT_EQ(chosen.foreseen, chosen.count);
  EXPECT_GT(chosen.way, 2.0 * kStep * kSpacing);
  EXPECT_LE(chosen.longest, 1.5 * kStep);
  EXPECT_LE(chosen.count, 3.0 * chosen.way / (kStep * kSpacing));
  const Climb fine(blockOn(GetParam()), patch, 10 * chosen.count);
  EXPECT_LT(chosen.offFrom(fine), kOverTolerance * kTolerance);
}

INSTANTIATE_TEST_SUITE_P(Pascal, SoftOrStiff, ::testing::Values(1e3, 1e4, 1e6));

TEST(LoadSteps, AreAsManyForASoftTissueAsForAStiffOne) {
  const auto countOf = [](double young) {
    return Climb(blockOn(young), forcedPatch("punch", kPunch, Vec3(0.0, 0.0, -6e-4 * young))).count;
  };
  EXPECT_EQ(countOf(1e3), countOf(1e6));
}

// What its nodes say of the bar's stiffness is far too much: the first increment is made anew.
TEST(LoadSteps, OfAForceFollowWhatTheTissueAnswers) {
  const PatchConfig patch = forcedPatch("end", kEnd, Vec3(0.0, 0.0, -0.05));
  const Climb at_once(bar(), patch, 1);
  EXPECT_GT(at_once.longest, 4.0 * kStep);
  const Climb chosen(bar(), patch);
  EXPECT_LE(chosen.longest, 2.0 * kStep + 1e-6);
  const Climb fine(bar(), patch, 100);
  EXPECT_LT(chosen.offFrom(fine), kOverTolerance * kTolerance);
}

TEST(LoadSteps, OfADisplacementAreEqual) {
  const Climb chosen(blockOn(1e4), displacedPatch("punch", kPunch, Vec3(0.0, 0.0, -0.012)));
  EXPECT_EQ(chosen.count, 3);
  EXPECT_NEAR(chosen.longest, 0.4, 1e-9);
}

// Of the paper's method a force goes on by the springs' stiffness, too.
TEST(LoadSteps, OfMethodPaperFollowTheStiffness) {
  const auto chosen = [](double stiffness) {
    TissueConfig config = blockOn(1e4);
    config.model = "six_spring";
    config.material.spring_stiffness = stiffness;
    return Climb(config, forcedPatch("punch", kPunch, Vec3(0.0, 0.0, -0.06 * stiffness)),
                 std::nullopt, "paper");
  };
  const Climb soft = chosen(30.0), stiff = chosen(3000.0);
  EXPECT_GT(soft.count, 1);
  EXPECT_EQ(soft.count, stiff.count);
}

}  // namespace
}  // namespace robot_tissue::test_load_steps
