// Scenes in which time goes by.
#include <gtest/gtest.h>

#include <cmath>

#include "result_text.h"
#include "tool_scenes.h"

namespace robot_tissue::test_time {
namespace {

const std::string kTime = "  time: {damping_time: 0.01}\n";

std::string refusalOf(const std::string& scene) {
  try {
    sceneOf(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string inTime(const std::string& tool, const Vec3& from, const Vec3& to, double duration,
                   int increments) {
  return "  - move: {tool: " + tool + ", from: {xyz: " + list(from) + "}, to: {xyz: " + list(to) +
         "}, duration: " + std::to_string(duration) +
         ", increments: " + std::to_string(increments) + "}\n";
}

std::string waiting(double duration, int increments) {
  return "  - wait: {duration: " + std::to_string(duration) +
         ", increments: " + std::to_string(increments) + "}\n";
}

TEST(TimeSteps, RowsTellTheTimeThatWentBy) {
  const RunResult result = run(block(kTime) + kSphere + "steps:\n" +
                               inTime("probe", sphereAt(-0.001), sphereAt(0.004), 0.1, 10) +
                               waiting(0.2, 4) + "  - settle: {}\n");
  ASSERT_EQ(result.increments.size(), 15U);
  EXPECT_NEAR(result.increments[0].time, 0.01, 1e-12);
  EXPECT_NEAR(result.increments[9].time, 0.1, 1e-12);
  EXPECT_NEAR(result.increments[10].time, 0.15, 1e-12);
  EXPECT_NEAR(result.increments[14].time, 0.3, 1e-12);
  EXPECT_TRUE(result.allOk());
  const std::string head = incrementsCsv(result).substr(0, incrementsCsv(result).find('\n'));
  EXPECT_EQ(head.substr(head.rfind("inverted_cells")), "inverted_cells,update_ms,time");
}

// Slow, or at rest again, the tissue is where it would be without time; fast, it pushes back
// harder, as its rate of strain counts. Of a ball as wide as the lattice tells: a narrow contact
// has another law without time.
TEST(TimeSteps, SlowMotionIsThatWithoutTime) {
  const std::string ball = "tools: [{name: probe, shapes: [{type: sphere, radius: 0.08}]}]\n";
  const auto ballAt = [](double depth) { return Vec3(sphereAt(depth) + Vec3(0.0, 0.0, 0.06)); };
  const RunResult still =
      run(block() + ball + "steps:\n" + placed("probe", ballAt(-0.001), ballAt(0.004), 5));
  const double force = still.tools.back().force.z();
  const auto pressed = [&](double duration) {
    return run(block(kTime) + ball + "steps:\n" +
               inTime("probe", ballAt(-0.001), ballAt(0.004), duration, 20) + waiting(1.0, 20));
  };
  const RunResult slow = pressed(5.0), fast = pressed(0.05);
  EXPECT_NEAR(rowsOf(slow, 0, "probe").back().force.z(), force, 0.03 * force);
  const auto onItsWay = [](const RunResult& result) {  // 0.25 mm before its end
    return rowsOf(result, 0, "probe").at(18).force.z();
  };
  EXPECT_GT(onItsWay(fast), 1.1 * onItsWay(slow));
  EXPECT_NEAR(rowsOf(fast, 1, "probe").back().force.z(), force, 0.02 * force);
  // The middle of the dent hangs between touches: on so coarse a lattice at either of two heights.
  EXPECT_NEAR(greatestDisplacement(fast), greatestDisplacement(still),
              0.05 * greatestDisplacement(still));
}

TEST(TimeSteps, WhatHasComeToRestCostsNothing) {
  const RunResult result = run(block(kTime) + kSphere + "steps:\n" +
                               inTime("probe", sphereAt(-0.001), sphereAt(0.004), 0.1, 10) +
                               waiting(5.0, 100) + waiting(5.0, 1));
  EXPECT_EQ(result.increments.back().update_ms, 0.0);
  const auto rows = rowsOf(result, 1, "probe");
  EXPECT_EQ(rows[98].force, rows[99].force);
}

TEST(TimeSteps, TissueSwingsBackWhenItsToolIsGone) {
  const RunResult result = run(block(kTime) + kSphere + "steps:\n" +
                               inTime("probe", sphereAt(-0.001), sphereAt(0.004), 0.5, 20) +
                               "  - move: {tool: probe, to: {xyz: " + list(sphereAt(-0.05)) +
                               "}, duration: 0.01}\n" + waiting(2.0, 20));
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(rowsOf(result, 2, "probe").back().force, Vec3(Vec3::Zero()));
  EXPECT_LT(greatestDisplacement(result), 1e-5);
}

// Of the lattice's nodes (m).
Vec3 centerOfMass(const Tissue& tissue) {
  Vec3 sum = Vec3::Zero();
  double mass = 0.0;
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    sum += tissue.lattice().mass(node) * tissue.nodePosition(node);
    mass += tissue.lattice().mass(node);
  }
  return sum / mass;
}

// A tool knocks against a block that floats: what it gave it stays, to rounding.
TEST(TimeSteps, AFloatingBlockThatWasHitKeepsItsMomentum) {
  std::string scene = block(kTime) + kSphere + "steps:\n" +
                      inTime("probe", sphereAt(-0.001), sphereAt(0.004), 0.02, 4) +
                      inTime("probe", sphereAt(0.004), sphereAt(-0.05), 0.02, 4);
  const std::string fixed = "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
  scene.erase(scene.find(fixed), fixed.size());
  for (int i = 0; i < 6; ++i) scene += waiting(0.02, 1);
  std::vector<Vec3> centers;
  runScene(sceneOf(scene), {}, [&](int step, const Tissue& tissue) {
    if (step >= 1) centers.push_back(centerOfMass(tissue));
  });
  ASSERT_EQ(centers.size(), 7U);
  const Vec3 way = centers[1] - centers[0];
  EXPECT_LT(way.z(), -1e-4);  // away from the tool
  for (std::size_t i = 2; i < centers.size(); ++i) {
    EXPECT_LT((centers[i] - centers[i - 1] - way).norm(), 1e-9 * way.norm()) << i;
  }
}

// Its steps are short, and their ways smaller than what single precision tells apart.
TEST(TimeSteps, ViscousTissueThatHardlyGivesWayIsPressedToATightTolerance) {
  const RunResult result =
      run("tissue:\n"
          "  shape: {type: box, min: [0, 0, 0], max: [0.01, 0.01, 0.01]}\n"
          "  spacing: 0.0025\n"
          "  material: {young_modulus: 20000.0, poisson_ratio: 0.49}\n"
          "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
          "  time: {damping_time: 0.02}\n"
          "solver: {tolerance: 0.003}\n"
          "tools: [{name: probe, friction: 0.3, shapes: [{type: sphere, radius: 0.0095}]}]\n"
          "steps:\n" +
          inTime("probe", Vec3(0.0056, 0.0068, 0.022), Vec3(0.0056, 0.0068, 0.0166), 0.5, 1));
  EXPECT_TRUE(result.allOk());
  EXPECT_GT(result.tools.back().force.z(), 0.1);
}

// What a cut leaves without a hold falls on a table and comes to rest there.
TEST(TimeSteps, APieceLandsOnASupportAndComesToRest) {
  const std::string scene =
      "tissue:\n"
      "  shape: {type: box, min: [0, 0, 0], max: [0.04, 0.04, 0.06]}\n"
      "  spacing: 0.01\n"
      "  material: {young_modulus: 10000.0}\n"
      "  fixed: [{min: [-1, -1, 0.06], max: [1, 1, 0.06]}]\n"
      "  gravity: [0, 0, -9.81]\n"
      "  time: {damping_time: 0.02}\n"
      "supports: [{name: table, type: plane, point: [0, 0, -0.01], normal: [0, 0, 1]}]\n"
      "steps:\n"
      "  - settle: {}\n"
      "  - cut: {corners: [[-1, -1, 0.025], [1, -1, 0.025], [1, 1, 0.025], [-1, 1, 0.025]]}\n" +
      waiting(2.0, 100) + waiting(1.0, 1);
  double lowest = 0.0, highest = 0.0;
  bool moves = true;
  const RunResult result = runScene(sceneOf(scene), {}, [&](int, const Tissue& tissue) {
    moves = tissue.isMoving();
    lowest = highest = tissue.nodePosition(0).z();
    for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
      if (tissue.pieceOfNodes()[static_cast<std::size_t>(node)] != tissue.pieceOfNodes().front()) {
        continue;
      }
      lowest = std::min(lowest, tissue.nodePosition(node).z());
      highest = std::max(highest, tissue.nodePosition(node).z());
    }
  });
  EXPECT_FALSE(moves);
  EXPECT_EQ(result.increments.back().update_ms, 0.0);
  EXPECT_NEAR(lowest, -0.01, 0.1 * kSpacing);
  EXPECT_NEAR(highest - lowest, 0.02, 0.1 * kSpacing);
}

TEST(TimeSteps, TheSameBitsEachTime) {
  const std::string scene = block(kTime) + kSphere + "steps:\n" +
                            inTime("probe", sphereAt(-0.001), sphereAt(0.004), 0.1, 10) +
                            waiting(0.05, 5);
  EXPECT_EQ(run(scene).displacement, run(scene).displacement);
}

TEST(TimeSteps, BadOnesAreRefusedInALine) {
  const auto expect = [](const std::string& scene, const std::string& fragment) {
    const std::string line = refusalOf(scene);
    EXPECT_NE(line.find(fragment), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
  };
  const std::string steps = kSphere + "steps:\n";
  expect(block() + steps + waiting(0.1, 1), "steps[0].wait");
  expect(block() + steps + inTime("probe", sphereAt(0), sphereAt(0), 0.1, 1),
         "unless the scene has tissue.time");
  expect(block(kTime) + steps + waiting(0.0, 1), "steps[0].wait.duration = 0");
  expect(block(kTime) + steps + waiting(-1.0, 1), "steps[0].wait.duration = -1");
  expect(block("  time: {damping_time: -0.1}\n") + steps, "tissue.time.damping_time = -0.1");
  expect(block("  time: {mode: fast}\n") + steps, "tissue.time.mode = fast");
  expect(block("  time: {}\n  model: six_spring\n") + steps, "only model elastic");
}

}  // namespace
}  // namespace robot_tissue::test_time
