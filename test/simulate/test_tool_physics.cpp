// What the runner's tools meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "robot_tissue/pipeline/pipeline.h"
#include "tool_scenes.h"

namespace robot_tissue::test_tool_physics {
namespace {

TEST(ToolPhysics, ASphereThatIsPressedMeetsAForceThatGrowsAndLeavesNothing) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.001), sphereAt(0.005), 6) +
          moved("probe", sphereAt(-0.002), 4));
  EXPECT_TRUE(result.allOk());
  const std::vector<ToolRow> down = rowsOf(result, 0, "probe");
  ASSERT_EQ(down.size(), 6U);
  double last = 0.0;
  for (std::size_t i = 1; i < down.size(); ++i) {
    EXPECT_GT(down[i].force.z(), last) << "increment " << i + 1;
    EXPECT_LT(down[i].force.head<2>().norm(), 0.02 * down[i].force.z());
    EXPECT_LT(down[i].torque.norm(), 0.02 * 0.02 * down[i].force.z());
    EXPECT_LT(down[i].max_penetration, 0.05 * kSpacing);
    EXPECT_GE(down[i].contacts, 1);
    last = down[i].force.z();
  }
  EXPECT_GT(last, 0.5);
  const ToolRow out = rowsOf(result, 1, "probe").back();
  EXPECT_EQ(out.force, Vec3::Zero());
  EXPECT_EQ(out.contacts, 0);
  EXPECT_EQ(greatestDisplacement(result), 0.0);
}

TEST(ToolPhysics, AFlushBoxMeetsAForceAlongItsWay) {
  const RunResult result =
      run(block() + "tools: [{name: punch, shapes: [{type: box, size: [0.03, 0.03, 0.02]}]}]\n" +
          "steps:\n" + placed("punch", Vec3(0.05, 0.05, 0.061), Vec3(0.05, 0.05, 0.057), 4));
  const ToolRow pressed = result.tools.back();
  EXPECT_GT(pressed.force.z(), 0.5);
  EXPECT_LT(pressed.force.head<2>().norm(), 0.02 * pressed.force.z());
  EXPECT_LT(pressed.torque.norm(), 0.02 * 0.015 * pressed.force.z());
  EXPECT_LT(pressed.max_penetration, 0.05 * kSpacing);
  EXPECT_GE(pressed.contacts, 9);
}

// Pressed by 4 mm, then drawn along x by 6 mm, by 1.5 mm an increment.
RunResult drawnAside(double friction) {
  return run(block() + "tools: [{name: probe, friction: " + std::to_string(friction) +
             ", shapes: [{type: sphere, radius: 0.03}]}]\n" + "steps:\n" +
             placed("probe", Vec3(0.047, 0.05, 0.081), Vec3(0.047, 0.05, 0.076), 3) +
             moved("probe", Vec3(0.053, 0.05, 0.076), 4));
}

TEST(ToolPhysics, FrictionHoldsADraggedSphereBack) {
  const std::vector<ToolRow> rough = rowsOf(drawnAside(0.5), 1, "probe");
  const std::vector<ToolRow> smooth = rowsOf(drawnAside(0.0), 1, "probe");
  ASSERT_EQ(rough.size(), 4U);
  ASSERT_EQ(smooth.size(), 4U);
  EXPECT_LT(rough.front().force.x(), -0.1 * rough.front().force.z());
  EXPECT_LT(rough.back().force.x(), -0.35 * rough.back().force.z());
  EXPECT_GT(rough.back().force.x(), -0.7 * rough.back().force.z());
  // Not zero: the surface is of flat triangles, under a radius of three spacings.
  for (const ToolRow& row : smooth) EXPECT_LT(std::abs(row.force.x()), 0.1 * row.force.z());
}

// What an edge touches hangs on the shape, and the shape on what it touches: both come to rest
// together, also where more is asked of the balance than by default.
TEST(ToolPhysics, AnEdgeIsFollowedAtTightTolerances) {
  const double height = 0.04 + 0.01 * std::sqrt(2.0);  // m: its middle where it meets the block
  const Vec3 above(0.03, 0.04, height + 0.0005), pressed(0.03, 0.04, height - 0.008);
  for (const std::string tolerance : {"0.003", "0.001"}) {
    const RunResult result =
        run("tissue:\n"
            "  shape: {type: box, min: [0, 0, 0], max: [0.08, 0.08, 0.04]}\n"
            "  spacing: 0.005\n"
            "  material: {young_modulus: 10000.0, poisson_ratio: 0.45}\n"
            "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
            "solver: {tolerance: " +
            tolerance +
            "}\n"
            "tools: [{name: edge, friction: 0.3, shapes: [{type: box, size: [0.02, 0.02, 0.02],"
            " rpy: [0, 0.785398, 0]}]}]\n"
            "steps:\n" +
            placed("edge", above, pressed, 17) + moved("edge", pressed + Vec3(0.02, 0, 0), 40));
    EXPECT_TRUE(result.allOk()) << tolerance;
    EXPECT_EQ(result.remarks, std::vector<std::string>()) << tolerance;
  }
}

// Two balls as jaws, at a wall 30 mm thick, 1 mm in on each side, then lifted by 4 mm.
TEST(ToolPhysics, AGrasperLiftsWhatItHoldsAndLetsGo) {
  const std::string scene =
      "tissue:\n"
      "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.03, 0.05]}\n"
      "  spacing: 0.01\n"
      "  material: {young_modulus: 10000.0}\n"
      "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
      "tools:\n"
      "  - name: forceps\n"
      "    role: grasper\n"
      "    jaws: [{shapes: [{type: sphere, radius: 0.012}]},"
      " {shapes: [{type: sphere, radius: 0.012}]}]\n"
      "steps:\n"
      "  - move: {tool: forceps, from: {xyz: [0.05, 0.015, 0.042], opening: 0.056},"
      " to: {xyz: [0.05, 0.015, 0.042], opening: 0.052}, increments: 2}\n"
      "  - grasp: {tool: forceps}\n"
      "  - move: {tool: forceps, to: {xyz: [0.05, 0.015, 0.046], opening: 0.052}, increments: 2}\n";
  const RunResult lifted = run(scene);
  EXPECT_TRUE(lifted.allOk());
  const std::vector<ToolRow> rows = rowsOf(lifted, 2, "forceps");
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_LT(rows[0].force.z(), -0.1);
  EXPECT_LT(rows[1].force.z(), 1.5 * rows[0].force.z());
  EXPECT_NEAR(greatestDisplacement(lifted), 0.004, 0.001);
  const RunResult released =
      run(scene +
          "  - release: {tools: [forceps]}\n"
          "  - move: {tool: forceps, to: {xyz: [0.05, 0.015, 0.046], opening: 0.06}}\n");
  EXPECT_GT(rowsOf(released, 3, "forceps").back().force.z(), 0.5 * rows[1].force.z());
  EXPECT_EQ(released.tools.back().force, Vec3::Zero());
  EXPECT_EQ(greatestDisplacement(released), 0.0);
}

TEST(ToolPhysics, APushedToolStopsWhereItMeetsItsForce) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.01), sphereAt(-0.004), 1) +
          "  - push: {tool: probe, force: [0, 0, -0.5], increments: 2}\n" + "  - settle: {}\n" +
          "  - release: {tools: [probe]}\n" + "  - settle: {}\n");
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(result.remarks, std::vector<std::string>());
  const std::vector<ToolRow> pushed = rowsOf(result, 1, "probe");
  ASSERT_EQ(pushed.size(), 2U);
  EXPECT_NEAR(pushed[0].force.z(), 0.25, 0.0025);
  EXPECT_NEAR(pushed[1].force.z(), 0.5, 0.005);
  EXPECT_NEAR(rowsOf(result, 2, "probe").front().force.z(), 0.5, 0.005);
  // Released it stays there, no longer driven.
  EXPECT_NEAR(rowsOf(result, 4, "probe").front().force.z(), 0.5, 0.025);
}

TEST(ToolPhysics, TwoToolsMeetWhatEachWouldAlone) {
  const std::string tools =
      "tools: [{name: left, shapes: [{type: sphere, radius: 0.02}]},"
      " {name: right, shapes: [{type: sphere, radius: 0.02}]}]\n";
  const RunResult result = run(block() + tools + "steps:\n" +
                               placed("left", sphereAt(-0.001, 0.02), sphereAt(0.003, 0.02), 2) +
                               placed("right", sphereAt(-0.001, 0.08), sphereAt(0.003, 0.08), 2));
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(rowsOf(result, 0, "left").size(), 2U);
  EXPECT_EQ(rowsOf(result, 0, "right").size(), 0U);  // stands nowhere yet
  const Vec3 left = rowsOf(result, 1, "left").back().force;
  const Vec3 right = rowsOf(result, 1, "right").back().force;
  EXPECT_GT(left.z(), 0.2);
  EXPECT_NEAR(left.z(), right.z(), 0.03 * left.z());
  EXPECT_NEAR(left.z(), rowsOf(result, 0, "left").back().force.z(), 0.1 * left.z());
}

const std::string kLyingBlock =
    "tissue:\n"
    "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n"
    "  spacing: 0.01\n"
    "  material: {young_modulus: 10000.0}\n"
    "  gravity: [0, 0, -9.81]\n"
    "supports: [{name: table, type: plane, point: [0, 0, 0], normal: [0, 0, 1]}]\n";

TEST(ToolPhysics, ASupportBearsTheWeightOfABlockThatNothingElseHolds) {
  const Scene scene = sceneOf(kLyingBlock);
  Pipeline pipeline(scene.tissue, scene.solver, {}, scene.supports);
  EXPECT_EQ(pipeline.settle().status, SolveStatus::kOk);
  const ForceBalance balance = pipeline.forceBalance();
  const double weight = 1000.0 * 0.1 * 0.1 * 0.05 * 9.81;
  EXPECT_NEAR(balance.weight.z(), -weight, 1e-6 * weight);
  EXPECT_NEAR(balance.supports.z(), weight, 0.02 * weight);
  EXPECT_LT(balance.unbalanced().norm(), 0.02 * weight);
}

// Not told as a step of its own.
TEST(ToolPhysics, ABlockAboveATableLiesOnItBeforeTheFirstStepAndAfterAReset) {
  std::string lower = kLyingBlock;
  const std::string on_table = "point: [0, 0, 0]";
  lower.replace(lower.find(on_table), on_table.size(), "point: [0, 0, -0.03]");
  const std::string press = placed("probe", sphereAt(0.028), sphereAt(0.034), 2);
  const RunResult result = run(lower + kSphere + "steps:\n" + press + "  - reset: {}\n" + press);
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(result.increments.size(), 5U);
  EXPECT_GT(rowsOf(result, 0, "probe").back().force.z(), 0.3);
  EXPECT_EQ(rowsOf(result, 0, "probe").back().force, rowsOf(result, 2, "probe").back().force);
  for (std::size_t node = 0; node < result.rest.size(); ++node) {
    if (result.rest[node].z() > 1e-9) continue;
    EXPECT_NEAR(result.displacement[node].z(), -0.03, 0.05 * kSpacing);
  }
}

TEST(ToolPhysics, ABlockOnATableSinksLittleAndIsPressedThere) {
  const RunResult result = run(kLyingBlock + kSphere + "steps:\n  - settle: {}\n" +
                               placed("probe", sphereAt(-0.002), sphereAt(0.004), 3) +
                               moved("probe", sphereAt(-0.004), 2));
  EXPECT_TRUE(result.allOk());
  EXPECT_GT(rowsOf(result, 1, "probe").back().force.z(), 0.3);
  EXPECT_EQ(rowsOf(result, 2, "probe").back().force, Vec3::Zero());
  const double sag = 1000.0 * 9.81 * 0.05 * 0.05 / (2.0 * 10000.0);  // of a bar under its weight
  Vec3 mean = Vec3::Zero();
  for (std::size_t node = 0; node < result.rest.size(); ++node) {
    const Vec3& way = result.displacement[node];
    mean += way / static_cast<double>(result.rest.size());
    EXPECT_GT(way.z(), result.rest[node].z() < 1e-9 ? -0.05 * kSpacing : -1.5 * sag);
  }
  EXPECT_LT(mean.head<2>().norm(), 0.05 * kSpacing);
  EXPECT_LT(mean.z(), -0.2 * sag);
}

TEST(ToolPhysics, ARigidToolPressesTheSixSpringLattice) {
  const RunResult result = run(block("  model: six_spring\n") + kSphere + "steps:\n" +
                               placed("probe", sphereAt(-0.001), sphereAt(0.003), 4) +
                               moved("probe", sphereAt(-0.002), 2));
  const std::vector<ToolRow> down = rowsOf(result, 0, "probe");
  ASSERT_EQ(down.size(), 4U);
  EXPECT_GT(down.back().force.z(), 0.1);
  EXPECT_GT(down.back().force.z(), down[1].force.z());
  EXPECT_LT(down.back().max_penetration, 0.05 * kSpacing);
  EXPECT_LT(down.back().torque.norm(), 0.02 * down.back().force.norm());
  EXPECT_EQ(greatestDisplacement(result), 0.0);
}

// Also where its edges are on nodes, for which its sides are as near as its face: none is thrown
// aside.
TEST(ToolPhysics, ARigidBoxTakesWhatItPressesStraightDown) {
  for (const std::string width : {"0.036", "0.04", "0.044"}) {
    const RunResult result =
        run(block() + "tools: [{name: punch, patch: rigid, shapes: [{type: box, size: [" + width +
            ", " + width + ", 0.02]}]}]\nsteps:\n" +
            placed("punch", Vec3(0.05, 0.05, 0.062), Vec3(0.05, 0.05, 0.058), 2));
    EXPECT_TRUE(result.allOk()) << width;
    const ToolRow pressed = result.tools.back();
    EXPECT_GT(pressed.force.z(), 0.5) << width;
    EXPECT_LT(pressed.force.head<2>().norm(), 0.02 * pressed.force.z()) << width;
    for (const Vec3& way : result.displacement) {
      EXPECT_LT(way.head<2>().norm(), 0.1 * kSpacing) << width;
    }
  }
}

// The wrench of a sphere without friction goes through its center.
TEST(ToolPhysics, WrenchesAreAboutTheToolsOriginInTheTissuesFrame) {
  const RunResult result =
      run(block() +
          "tools: [{name: probe, friction: 0.0, shapes:"
          " [{type: sphere, radius: 0.02, xyz: [0.03, 0.0, 0.0]}]}]\n"
          "steps:\n"
          "  - move: {tool: probe, from: {xyz: [0.05, 0.02, 0.071], rpy: [0, 0, 1.5707963]},"
          " to: {xyz: [0.05, 0.02, 0.067], rpy: [0, 0, 1.5707963]}, increments: 2}\n");
  const ToolRow row = result.tools.back();
  EXPECT_GT(row.force.z(), 0.2);
  EXPECT_LT(row.force.head<2>().norm(), 0.02 * row.force.z());
  const Vec3 expected = Vec3(0.0, 0.03, 0.0).cross(row.force);
  EXPECT_LT((row.torque - expected).norm(), 0.02 * expected.norm());
}

TEST(ToolPhysics, TwoRunsGiveTheSameBits) {
  const RunResult first = drawnAside(0.3);
  const RunResult second = drawnAside(0.3);
  EXPECT_EQ(first.displacement, second.displacement);
  ASSERT_EQ(first.tools.size(), second.tools.size());
  for (std::size_t i = 0; i < first.tools.size(); ++i) {
    EXPECT_EQ(first.tools[i].force, second.tools[i].force);
    EXPECT_EQ(first.tools[i].torque, second.tools[i].torque);
    EXPECT_EQ(first.tools[i].max_penetration, second.tools[i].max_penetration);
  }
}

// Beside a tool tissue goes half a spacing at most in a solve: then it is solved for anew, also
// where the tool touches nothing any more.
TEST(ToolPhysics, ALoadBesideAToolThatHasLeftIsAsWithoutIt) {
  const std::string tissue =
      "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.056, 0.048, 0.048]}\n"
      "  spacing: 0.008\n  material: {young_modulus: 1.0e+4, poisson_ratio: 0.45}\n"
      "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
  const std::string tools =
      "tools:\n  - {name: probe, friction: 0.3, shapes: [{type: box, size: [0.028, 0.026, "
      "0.03]}]}\n";
  const std::string press =
      "  - move: {tool: probe, from: {xyz: [0.0308, 0.0238, 0.073]}, to: {xyz: [0.0308, 0.0238, "
      "0.0597]}}\n";
  const std::string load =
      "  - load: {patches: [{name: a, min: [0, 0.016, 0.048], max: [0.008, 0.032, 0.048], force: "
      "[-0.117, 0.233, -0.0014]}]}\n";
  const std::string leave = "  - move: {tool: probe, to: {xyz: [0.0308, 0.0238, 0.083]}}\n";
  for (const std::string method : {"layered", "newton"}) {
    const std::string solver = "solver: {method: " + method + "}\n";
    const RunResult with = run(tissue + solver + tools + "steps:\n" + press + load + leave);
    const RunResult without = run(tissue + solver + "steps:\n" + load);
    EXPECT_TRUE(with.allOk() && without.allOk()) << method;
    double off = 0.0, all = 0.0;
    for (std::size_t node = 0; node < with.displacement.size(); ++node) {
      off += (with.displacement[node] - without.displacement[node]).squaredNorm();
      all += without.displacement[node].squaredNorm();
    }
    EXPECT_LT(std::sqrt(off), 0.02 * std::sqrt(all)) << method;
  }
}

}  // namespace
}  // namespace robot_tissue::test_tool_physics
