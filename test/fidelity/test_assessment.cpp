// Estimates against errors that are known, and the choice among rungs.
#include <gtest/gtest.h>

#include <cmath>

#include "assessment.h"
#include "reference_cases.h"
#include "resolution_sweep.h"

namespace robot_tissue::test_assessment {
namespace {

const std::vector<Vec3> kLimit = {Vec3(0.001, 0.0, -0.004), Vec3(0.0, 0.002, -0.001)};
const std::vector<Vec3> kSlope = {Vec3(0.0, 0.001, 0.002), Vec3(0.003, 0.0, -0.001)};

double norm(const std::vector<Vec3>& field) {
  return std::sqrt(field[0].squaredNorm() + field[1].squaredNorm());
}

// Displacements limit + slope (h / cm)^1.5, force 2 N (1 + (h / cm)), ten updates of `ms`.
Trial trialAt(double spacing, double tolerance, double ms) {
  Trial trial;
  trial.rung = {"layered", spacing, tolerance};
  const double cm = spacing / 0.01;
  Field field{{}, {1, 1}};
  for (std::size_t i = 0; i < 2; ++i) {
    field.displacement.push_back(kLimit[i] + std::pow(cm, 1.5) * kSlope[i]);
  }
  trial.fields = {field};
  trial.forces = {Vec3(0.0, 0.0, -2.0 * (1.0 + cm))};
  trial.update_ms.assign(10, ms);
  trial.update_ms.front() = 100.0 * ms;
  return trial;
}

TEST(Assessment, FindsErrorsThatFallAsAPowerOfTheSpacing) {
  const Assessment found = assessed({trialAt(0.04, 0.001, 1.0), trialAt(0.02, 0.001, 2.0),
                                     trialAt(0.01, 0.001, 4.0), trialAt(0.005, 0.001, 8.0)});
  EXPECT_EQ(found.lattices, 3);
  EXPECT_EQ(found.points, 2U);
  EXPECT_NEAR(found.field.order, 1.5, 1e-3);
  EXPECT_NEAR(found.force.order, 1.0, 1e-3);
  for (const Assessed& row : found.rows) {
    const double cm = row.rung.spacing / 0.01;
    EXPECT_NEAR(row.field_error, std::pow(cm, 1.5) * norm(kSlope) / norm(kLimit), 1e-3);
    EXPECT_NEAR(row.force_error, cm, 1e-3);
    EXPECT_EQ(row.solver_error, 0.0);
  }
  EXPECT_EQ(found.rows[1].median_ms, 2.0);  // the first update does not count
  EXPECT_EQ(found.rows[1].greatest_ms, 200.0);
}

TEST(Assessment, ALooseToleranceAddsToTheErrorAndNotToTheLimit) {
  Trial loose = trialAt(0.005, 0.1, 3.0);
  loose.forces[0].z() -= 0.5;
  const Assessment found = assessed(
      {trialAt(0.02, 0.001, 2.0), trialAt(0.01, 0.001, 4.0), loose, trialAt(0.005, 0.001, 8.0)});
  EXPECT_NEAR(found.rows[2].solver_error, 0.25, 1e-3);
  EXPECT_NEAR(found.rows[2].force_error, 0.75, 1e-3);
  EXPECT_NEAR(found.rows[3].force_error, 0.5, 1e-3);
}

TEST(Assessment, RungsThatFailedAreNoPartOfTheLimitAndAreNeverChosen) {
  Trial failed = trialAt(0.0025, 0.001, 0.1);
  failed.worst = SolveStatus::kInverted;
  failed.forces[0].z() = 1e3;
  Trial untried;
  untried.rung = {"layered", 0.00125, 0.001};
  untried.gap = "not tried";
  const Assessment found = assessed({trialAt(0.02, 0.001, 2.0), trialAt(0.01, 0.001, 4.0),
                                     trialAt(0.005, 0.001, 8.0), failed, untried});
  EXPECT_NEAR(found.rows[2].force_error, 0.5, 1e-3);
  const Choice choice = choose(found.rows, 0.9, 1.0);
  EXPECT_EQ(choice.best, std::optional<std::size_t>(2));
}

TEST(Assessment, ASceneThatMovesNothingIsRefused) {
  Trial still = trialAt(0.01, 0.001, 1.0);
  still.fields[0].displacement.assign(2, Vec3::Zero());
  Trial finer = still;
  finer.rung.spacing = 0.005;
  EXPECT_THROW(assessed({still, finer}), InputError);
}

Assessed rowOf(double error, double ms) {
  Assessed row;
  row.field_error = error;
  row.median_ms = ms;
  return row;
}

TEST(Choice, IsTheCheapestThatMeetsBoth) {
  const std::vector<Assessed> rows = {rowOf(0.2, 1.0), rowOf(0.04, 5.0), rowOf(0.03, 4.0),
                                      rowOf(0.01, 20.0)};
  EXPECT_EQ(choose(rows, 0.05, 100.0).best, std::optional<std::size_t>(2));
  EXPECT_EQ(choose(rows, 0.5, 100.0).best, std::optional<std::size_t>(0));
}

TEST(Choice, SaysWhatCanBeMetWhereNotBothCan) {
  const std::vector<Assessed> rows = {rowOf(0.2, 1.0), rowOf(0.04, 5.0), rowOf(0.01, 20.0)};
  const Choice choice = choose(rows, 0.03, 400.0);  // asks for 2.5 ms
  EXPECT_FALSE(choice.best);
  EXPECT_EQ(choice.nearest, std::optional<std::size_t>(1));  // twice too slow, 1.3 times too far
  EXPECT_EQ(choice.fastest, std::optional<std::size_t>(2));
  EXPECT_EQ(choice.most_accurate, std::optional<std::size_t>(0));
  EXPECT_FALSE(choose(rows, 0.001, 1.0).fastest);
}

// The scene of a case of the finite elements, and what its 5 mm lattice misses of them.
TEST(Assessment, TheEstimateIsNearTheErrorAgainstFiniteElements) {
  for (const ReferenceCase& reference : readReferenceCases(ROBOT_TISSUE_SOURCE_DIR)) {
    if (reference.name != "press_d1" || reference.poisson_ratio != 0.25) continue;
    Scene scene;
    scene.tissue = referenceTissue(reference, 0.005);
    scene.steps = {referenceLoad(reference)};
    scene.solver.tolerance = 0.001;
    SweepOptions options;
    options.coarser = options.finer = 1;
    const Assessment found = assessed(resolutionSweep(scene, options, {}));
    ASSERT_EQ(found.lattices, 3);
    for (const Assessed& row : found.rows) {
      if (row.rung.spacing != 0.005 || row.rung.tolerance != 0.001) continue;
      const double truth = std::abs(errorAgainst(reference, "layered", 0.005).field);
      EXPECT_LT(row.field_error, 1.5 * truth);
      EXPECT_GT(row.field_error, truth / 1.5);
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_assessment
