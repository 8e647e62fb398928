// Blades and tearing in scenes of the runner.
#include <gtest/gtest.h>

#include "tool_scenes.h"

namespace robot_tissue::test_blade {
namespace {

const std::string kKnife =
    "tools: [{name: knife, role: blade, edge: [[0, 0, -0.025], [0, 0, 0.01]], resistance: 200}]\n";

RunResult cutIn(int increments) {
  return run(block() + kKnife + "steps:\n" +
             placed("knife", Vec3(-0.02, 0.055, kTop), Vec3(0.12, 0.055, kTop), increments));
}

// 11 columns of nodes, 3 nodes deep; the new surface is half way between nodes at its lower end.
TEST(BladeInAScene, IsToldInItsWrenchAndInWords) {
  const RunResult result = cutIn(140);
  EXPECT_TRUE(result.allOk());
  ASSERT_EQ(result.remarks.size(), 1U);
  EXPECT_EQ(result.remarks.front(),
            "steps[0].move: tool 'knife' cut 33 springs, 0.0025 m^2 of new surface; pieces: 1");
  double work = 0.0;
  for (const ToolRow& row : rowsOf(result, 0, "knife")) work -= row.force.x() * 0.001;
  EXPECT_NEAR(work, 200.0 * 0.0025, 0.05 * 200.0 * 0.0025);
}

TEST(BladeInAScene, CutsTheSameInAnyIncrements) {
  const RunResult one = cutIn(1);
  for (const int increments : {10, 100}) {
    const RunResult more = cutIn(increments);
    EXPECT_EQ(more.remarks, one.remarks);
    EXPECT_EQ(more.triangles, one.triangles);
    EXPECT_EQ(more.displacement, one.displacement);
  }
}

// Edges that lie above each other meet all at once.
TEST(ScissorsInAScene, CutWhereTheyClose) {
  const RunResult result =
      run(block() +
          "tools: [{name: shears, role: scissors, opening_axis: [0, 0, 1],"
          " edges: [[[0, 0, 0], [0.04, 0, 0]], [[0, 0, 0], [0.04, 0, 0]]]}]\n"
          "steps:\n"
          "  - move: {tool: shears, from: {xyz: [-0.01, 0.055, 0.05], opening: 0.06},"
          " to: {xyz: [-0.01, 0.055, 0.05], opening: 0.0}, increments: 5}\n");
  EXPECT_TRUE(result.allOk());
  ASSERT_EQ(result.remarks.size(), 1U);
  EXPECT_NE(result.remarks.front().find("tool 'shears' cut "), std::string::npos)
      << result.remarks.front();
}

TEST(BladeInAScene, OfTheExampleCutsItsGroove) {
  const RunResult result = runScene(loadScene(ROBOT_TISSUE_SOURCE_DIR "/config/blade.yaml", {}));
  EXPECT_TRUE(result.allOk());
  const std::vector<ToolRow> rows = rowsOf(result, 0, "knife");
  for (std::size_t i = rows.size() / 3; i < 2 * rows.size() / 3; ++i) {
    EXPECT_NEAR(-rows[i].force.x(), 200.0 * 0.0225, 0.05 * 200.0 * 0.0225);  // in its even way
  }
}

TEST(TearInAScene, IsToldInWords) {
  const RunResult result =
      run("tissue:\n"
          "  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.02, 0.02]}\n"
          "  spacing: 0.01\n"
          "  material: {young_modulus: 10000, poisson_ratio: 0.3, tear_stretch: 1.3}\n"
          "  fixed: [{min: [0, 0, 0], max: [0, 1, 1]}]\n"
          "steps:\n"
          "  - load: {increments: 8, patches: [{name: grip, min: [0.06, 0, 0], max: [0.06, 1, 1],"
          " displacement: [0.03, 0, 0]}]}\n");
  ASSERT_EQ(result.remarks.size(), 1U);
  EXPECT_NE(result.remarks.front().find("springs tore; pieces: 2"), std::string::npos)
      << result.remarks.front();
  EXPECT_NEAR(result.patches.back().answer.force.norm(), 0.0, 1e-2);
}

TEST(TearInAScene, OfAGrasperHasRowsOfPieces) {
  const RunResult result =
      run("tissue:\n"
          "  shape: {type: box, min: [0, 0, 0], max: [0.03, 0.01, 0.03]}\n"
          "  spacing: 0.005\n"
          "  material: {young_modulus: 10000}\n"
          "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
          "tools:\n"
          "  - name: forceps\n"
          "    role: grasper\n"
          "    jaws:\n"
          "      - {shapes: [{type: box, size: [0.016, 0.004, 0.01], xyz: [0, 0.002, 0]}]}\n"
          "      - {shapes: [{type: box, size: [0.016, 0.004, 0.01], xyz: [0, -0.002, 0]}]}\n"
          "    grasp: {close_gap: 0.0085, open_gap: 0.0095, max_force: 0.2, on_max_force: tear}\n"
          "steps:\n"
          "  - move: {tool: forceps, from: {xyz: [0.015, 0.005, 0.025], opening: 0.014},"
          " to: {xyz: [0.015, 0.005, 0.025], opening: 0.008}, increments: 1}\n"
          "  - move: {tool: forceps, to: {xyz: [0.015, 0.005, 0.045], opening: 0.008},"
          " increments: 1}\n");
  ASSERT_EQ(result.pieces.size(), 3U);  // one, then two
  EXPECT_TRUE(result.pieces[1].piece.fixed);
  EXPECT_FALSE(result.pieces[2].piece.fixed);
}

}  // namespace
}  // namespace robot_tissue::test_blade
