// Steps of every kind in every order: what is legal runs, the rest is refused in one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "result_text.h"
#include "tool_scenes.h"

namespace robot_tissue::test_step_orders {
namespace {

const std::string kTissue = R"(
tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.08, 0.08, 0.04]}
  spacing: 0.02
  material: {young_modulus: 10000.0}
  gravity: [0, 0, -1.0]
)";
const std::string kFixed = "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
const std::string kWall = "supports: [{type: box, min: [0.08, 0, 0], max: [0.1, 0.08, 0.05]}]\n";
const std::string kTable =
    "supports: [{name: table, type: plane, point: [0, 0, 0], normal: [0, 0, 1]}]\n";
const std::string kTools = R"(
tools:
  - {name: probe, shapes: [{type: sphere, radius: 0.02}]}
  - name: forceps
    role: grasper
    jaws: [{shapes: [{type: box, size: [0.01, 0.004, 0.02]}]},
           {shapes: [{type: box, size: [0.01, 0.004, 0.02]}]}]
    grasp: {close_gap: 0.012, opening_axis: [0, 1, 0]}
)";

const std::map<std::string, std::string> kSteps = {
    {"settle", "settle: {}"},
    {"displacement",
     "load: {increments: 2, patches: [{name: d, min: [0, 0, 0.04], max: [0.02, 0.02, 0.04], "
     "displacement: [0, 0, -0.004]}]}"},
    {"force",
     "load: {patches: [{name: f, min: [0.06, 0.06, 0.04], max: [0.08, 0.08, 0.04], "
     "force: [0, 0, -0.1]}]}"},
    {"cut",
     "cut: {corners: [[0.05, -0.01, 0.01], [0.05, 0.05, 0.01], [0.05, 0.05, 0.05], "
     "[0.05, -0.01, 0.05]]}"},
    {"release of patches", "release: {patches: [d]}"},
    {"reset", "reset: {}"},
};
const std::map<std::string, std::string> kToolSteps = {
    {"move",
     "move: {tool: probe, from: {xyz: [0.035, 0.04, 0.062]}, to: {xyz: [0.035, 0.04, 0.056]}, "
     "increments: 1}"},
    {"move of a grasper",
     "move: {tool: forceps, from: {xyz: [0.03, 0.04, 0.05], opening: 0.03}, "
     "to: {xyz: [0.03, 0.04, 0.046], opening: 0.014}, increments: 1}"},
    {"push", "push: {tool: probe, force: [0, 0, -0.2]}"},
    {"grasp", "grasp: {tool: forceps}"},
    {"release of a tool", "release: {tools: [probe]}"},
    {"release of a grasper", "release: {tools: [forceps]}"},
};

class StepOrders : public ::testing::Test {
 protected:
  // Every one first, second after every one, and after a reset.
  void tryAllOrders(const std::map<std::string, std::string>& steps, const std::string& scene) {
    for (const auto& first : steps) {
      const std::string begun = "steps:\n  - " + first.second + "\n";
      SCOPED_TRACE(first.first);
      tryOrder(scene + begun);
      for (const auto& second : steps) {
        SCOPED_TRACE("before " + second.first);
        const std::string then = "  - " + second.second + "\n";
        tryOrder(scene + begun + then);
        if (first.first != "reset") tryOrder(scene + begun + "  - reset: {}\n" + then);
      }
    }
  }

  void tryOrder(const std::string& scene) {
    try {
      const RunResult result = run(kTissue + scene);
      EXPECT_NO_THROW(nodesCsv(result) + incrementsCsv(result) + patchesCsv(result) +
                      toolsCsv(result));  // throw where a number is not finite
      ++ran_;
    } catch (const InputError& error) {
      const std::string line = error.what();
      EXPECT_NE(line.find("steps["), std::string::npos) << line;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
      ++refused_;
    }
  }

  int ran_ = 0;
  int refused_ = 0;
};

TEST_F(StepOrders, RunOrAreRefusedWithoutTools) {
  for (const std::string& bearing : {kFixed, kFixed + kWall, kTable}) tryAllOrders(kSteps, bearing);
  EXPECT_GT(ran_, 120);
  EXPECT_GT(refused_, 0);
}

TEST_F(StepOrders, RunOrAreRefusedWithTools) {
  std::map<std::string, std::string> all = kSteps;
  all.insert(kToolSteps.begin(), kToolSteps.end());
  for (const std::string& bearing : {kFixed, kFixed + kWall, kTable}) {
    tryAllOrders(all, bearing + kTools);
  }
  EXPECT_GT(ran_, 300);
  EXPECT_GT(refused_, 0);
}

TEST_F(StepOrders, RunOrAreRefusedWhereToolsTouch) {
  std::map<std::string, std::string> all = kSteps;
  all.insert(kToolSteps.begin(), kToolSteps.end());
  const std::string touched = kTable + kTools + "steps:\n  - " + kToolSteps.at("move") + "\n  - " +
                              kToolSteps.at("move of a grasper") + "\n";
  for (const auto& first : all) {
    for (const auto& second : all) {
      SCOPED_TRACE(first.first + " before " + second.first);
      tryOrder(touched + "  - " + first.second + "\n  - " + second.second + "\n");
    }
  }
  EXPECT_GT(ran_, 90);
  EXPECT_GT(refused_, 0);
}

// The first solve knows of the table, or the block would fall.
TEST(FirstLoad, IsBalancedOnASupport) {
  const RunResult result = run(kTissue + kTable + "steps:\n  - " + kSteps.at("force") + "\n");
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(result.increments.size(), 1U);
}

}  // namespace
}  // namespace robot_tissue::test_step_orders
