// Displacements between the nodes, spacings of the ladder, updates of a scene.
#include <gtest/gtest.h>

#include <cmath>
#include <variant>

#include "fidelity_fixtures.h"
#include "field.h"
#include "ladder.h"
#include "pacing.h"
#include "probe.h"

namespace robot_tissue::test_field {
namespace {

TEST(FieldAt, IsTheNodesOwnAtNodesAndTheirMeanBetween) {
  const Scene scene = sceneOf(blockText() + kPress);
  Tissue tissue(scene.tissue, scene.solver);
  tissue.load(std::get<LoadStep>(scene.steps.front()));
  const std::vector<Vec3> shown = tissue.shownDisplacement();
  const Lattice& lattice = tissue.lattice();
  const Field at_nodes = fieldAt(tissue, nodesOf(scene.tissue));
  ASSERT_EQ(at_nodes.displacement.size(), shown.size());
  double greatest = 0.0;
  for (std::size_t node = 0; node < shown.size(); ++node) {
    EXPECT_EQ(at_nodes.inside[node], 1);
    EXPECT_LT((at_nodes.displacement[node] - shown[node]).norm(), 1e-9);
    greatest = std::max(greatest, shown[node].norm());
  }
  EXPECT_GT(greatest, 1e-3);
  const int a = lattice.node(2, 3, 3), b = lattice.node(3, 3, 3);
  const Vec3 middle = 0.5 * (lattice.restPosition(a) + lattice.restPosition(b));
  const Field between = fieldAt(tissue, {middle, Vec3(0.03, 0.03, 0.05)});
  EXPECT_LT((between.displacement[0] - 0.5 * (shown[at(a)] + shown[at(b)])).norm(), 1e-9);
  EXPECT_GT(between.displacement[0].norm(), 1e-4);
  EXPECT_EQ(between.inside[1], 0);  // above the block
}

// A cut from top to bottom through x = 25 mm, one half drawn away.
TEST(FieldAt, GoesWithThePartOfACutCellThatThePointIsIn) {
  const Scene scene = sceneOf(
      blockText() + "steps:\n" +
      "  - cut: {corners: [[0.025, -1, -1], [0.025, 1, -1], [0.025, 1, 1], [0.025, -1, 1]]}\n" +
      "  - load: {patches: [{name: half, min: [0.03, 0, 0.01], max: [0.06, 0.06, 0.04],"
      " displacement: [0.004, 0, 0]}]}\n");
  Tissue tissue(scene.tissue, scene.solver);
  tissue.cut(std::get<CutStep>(scene.steps[0]).corners);
  tissue.load(std::get<LoadStep>(scene.steps[1]));
  const Field field = fieldAt(tissue, {Vec3(0.024, 0.03, 0.035), Vec3(0.026, 0.03, 0.035)});
  EXPECT_LT(field.displacement[0].norm(), 1e-4);
  EXPECT_NEAR(field.displacement[1].x(), 0.004, 1e-4);
}

TEST(Ladder, DoublesAndHalvesWhereTheBoxAllows) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  tissue.spacing = 0.005;
  const std::vector<double> spacings = ladderSpacings(tissue, 2, 2);
  ASSERT_EQ(spacings.size(), 5U);
  EXPECT_NEAR(spacings[0], 0.05 / 3, 1e-12);  // twice 10 mm does not fit
  EXPECT_EQ(spacings[1], 0.01);
  EXPECT_EQ(spacings[2], 0.005);
  EXPECT_EQ(spacings[3], 0.0025);
  EXPECT_EQ(spacings[4], 0.00125);
  EXPECT_EQ(nodesAt(tissue, 0.005), 21.0 * 21.0 * 11.0);
}

TEST(Ladder, HasNoCoarserLatticeBelowTwoCells) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.1, 0.1, 0.05);
  tissue.spacing = 0.025;
  EXPECT_EQ(ladderSpacings(tissue, 2, 1), (std::vector<double>{0.025, 0.0125}));
}

int incrementsOf(const PacedScene& paced, std::size_t step) {
  return std::get<LoadStep>(paced.scene.steps[step]).increments.value_or(-1);
}

TEST(Pacing, ALoadHasAnUpdateAMillimetreInPartsOfHalfASpacing) {
  const std::string steps =
      "steps:\n"
      "  - load: {patches: [{name: p, min: [0.02, 0.02, 0.04], max: [0.04, 0.04, 0.04],"
      " displacement: [0, 0, -0.004]}]}\n"
      "  - load: {patches: [{name: p, min: [0.02, 0.02, 0.04], max: [0.04, 0.04, 0.04],"
      " displacement: [0.003, 0, -0.004]}]}\n"
      "  - load: {increments: 2, patches: [{name: p, min: [0.02, 0.02, 0.04], max: [0.04, 0.04,"
      " 0.04], displacement: [0, 0, -0.004]}]}\n"
      "  - release: {patches: [p]}\n";
  Scene scene = sceneOf(blockText() + steps);
  const PacedScene coarse = paced(scene, 0.001);
  EXPECT_EQ(coarse.parts, (std::vector<int>{1, 1, 1, 0}));
  EXPECT_EQ(incrementsOf(coarse, 0), 4);
  EXPECT_EQ(incrementsOf(coarse, 1), 3);  // from where it stands
  EXPECT_EQ(incrementsOf(coarse, 2), 2);  // as the scene says
  EXPECT_EQ(updateCount(coarse), 9);
  scene.tissue.spacing = 0.001;
  const PacedScene fine = paced(scene, 0.001);
  EXPECT_EQ(fine.parts, (std::vector<int>{2, 2, 3, 0}));
  EXPECT_EQ(incrementsOf(fine, 0), 8);
  EXPECT_EQ(updateCount(fine), 9);
}

TEST(Probe, PressesTheFaceFarthestFromWhatIsFixed) {
  const Scene from_above = probed(sceneOf(blockText()));
  const PatchConfig top = std::get<LoadStep>(from_above.steps.at(0)).patches.at(0);
  EXPECT_NEAR((*top.displacement)[2].value_or(0.0), -0.004, 1e-12);
  EXPECT_NEAR(top.box.min().x(), 0.018, 1e-12);
  Scene sideways = sceneOf(blockText());
  sideways.tissue.fixed = {{Vec3(0.06, -1.0, -1.0), Vec3(0.06, 1.0, 1.0)}};
  const PatchConfig side = std::get<LoadStep>(probed(sideways).steps.at(0)).patches.at(0);
  EXPECT_NEAR((*side.displacement)[0].value_or(0.0), 0.006, 1e-12);
  EXPECT_LT(side.box.max().x(), 0.001);
}

TEST(Probe, HoldsTheOppositeFaceOfWhatFloats) {
  Scene floating = sceneOf(blockText());
  floating.tissue.fixed.clear();
  const Scene pressed = probed(floating);
  ASSERT_EQ(pressed.steps.size(), 2U);
  Tissue tissue(pressed.tissue, pressed.solver);
  for (const Step& step : pressed.steps) tissue.load(std::get<LoadStep>(step));
  EXPECT_LT(tissue.lastReport().patches.at(1).force.z(), -0.1);
  EXPECT_LT(tissue.state().displacement[0].norm(), 1e-12);
}

}  // namespace
}  // namespace robot_tissue::test_field
