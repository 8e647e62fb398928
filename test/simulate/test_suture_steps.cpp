// Steps that suture, and the file that tells of it.
#include <gtest/gtest.h>

#include <algorithm>

#include "result_text.h"
#include "simulate_program.h"
#include "tool_scenes.h"

namespace robot_tissue::test_suture_steps {
namespace {

const std::string kCut =
    "  - cut: {corners: [[0.055, -1, 0.02], [0.055, 1, 0.02], [0.055, 1, 1], [0.055, -1, 1]]}\n";
const std::string kSuture =
    "  - suture: {from: [0.045, 0.05, 0.05], to: [0.065, 0.05, 0.05], rest_length: 0.018, "
    "break_force: 0.25}\n";
const std::string kDrawApart =
    "  - load: {increments: 2, patches: [{name: p, min: [0.1, 0, 0.05], max: [0.1, 0.1, 0.05], "
    "displacement: [0.03, 0, 0]}]}\n";

RunResult resultOf(const std::string& steps) { return run(block() + "steps:\n" + steps); }

TEST(SutureSteps, AreToldAfterEachIncrement) {
  const RunResult result = resultOf(kCut + kSuture + "  - settle: {}\n" + kDrawApart);
  ASSERT_EQ(result.sutures.size(), 4U);
  EXPECT_EQ(result.sutures[0].step, 1);
  EXPECT_EQ(result.sutures[0].suture.name, "s1");
  EXPECT_GT(result.sutures[0].suture.tension, 0.01);
  EXPECT_FALSE(result.sutures[0].suture.broken);
  EXPECT_NEAR(result.sutures[1].suture.tension, result.sutures[0].suture.tension, 1e-3);
  EXPECT_TRUE(result.sutures[3].suture.broken);
  EXPECT_EQ(result.sutures[3].suture.tension, 0.0);
  const std::string csv = suturesCsv(result);
  EXPECT_EQ(csv.rfind("step,increment,suture,tension,length,broken\n1,1,s1,", 0), 0U) << csv;
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  const auto is_told = [](const std::string& line) {
    return line.find("suture 's1' breaks") != std::string::npos;
  };
  EXPECT_EQ(std::count_if(result.remarks.begin(), result.remarks.end(), is_told), 1);
}

TEST(SutureSteps, WithoutANameTakeTheFirstThatIsFree) {
  std::string named = kSuture;
  named.replace(named.find("from"), 4, "name: s1, from");
  const RunResult result = resultOf(named + kSuture + "  - reset: {}\n" + kSuture);
  ASSERT_EQ(result.sutures.size(), 4U);
  EXPECT_EQ(result.sutures[2].suture.name, "s2");
  EXPECT_EQ(result.sutures[3].suture.name, "s1");
}

TEST(SutureSteps, GoWithAReset) {
  const RunResult result = resultOf(kSuture + "  - reset: {}\n" + kSuture);
  ASSERT_EQ(result.sutures.size(), 2U);
  EXPECT_EQ(result.sutures[1].step, 2);
  EXPECT_EQ(result.sutures[1].suture.tension, result.sutures[0].suture.tension);
}

TEST(SutureSteps, ToNowhereAreRefusedWithTheStep) {
  try {
    resultOf("  - suture: {from: [0.045, 0.05, 0.025], to: [0.065, 0.05, 0.05]}\n");
    ADD_FAILURE() << "not refused";
  } catch (const InputError& error) {
    const std::string line = error.what();
    EXPECT_NE(line.find("steps[0].suture: suture 's1': from = (0.045, 0.05, 0.025) m is nowhere"),
              std::string::npos)
        << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

TEST_F(Simulate, TellsOfSuturesWhereTheSceneHasSome) {
  write("sutured.yaml",
        kScene + "  - suture: {from: [0.01, 0.02, 0.02], to: [0.03, 0.02, 0.02]}\n");
  ASSERT_EQ(program("sutured.yaml --out sutured").code, 0);
  std::vector<std::string> files = kFiles;
  files.emplace_back("sutures.csv");
  std::sort(files.begin(), files.end());
  EXPECT_EQ(entries("sutured"), files);
  ASSERT_EQ(program("block.yaml --out plain").code, 0);
  EXPECT_EQ(entries("plain"), kFiles);
}

// The tissue leaves the box on its way up, and is found anew from rest, where the box is in it: the
// thread has drawn it away from there.
TEST(SutureSteps, AToolThatLeavesIsNotInTheWayBackFromRest) {
  const RunResult result = run(R"(
tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.08, 0.05, 0.04]}
  spacing: 0.01
  material: {young_modulus: 25669.8075433855, poisson_ratio: 0.4}
solver: {tolerance: 0.01}
tools:
  - name: p
    shapes: [{type: box, size: [0.014, 0.018570964422234094, 0.021]}]
    friction: 0.0
steps:
  - load: {increments: 1, patches: [{name: hold, min: [-1, -1, -0.0001], max: [1, 1, 0.0001],
                                     displacement: [0, 0, 0]}]}
  - load: {increments: 1, patches: [{name: pull, min: [0.009, 0.009000000000000001, 0.04],
                                     max: [0.02, 0.021, 0.04], force: [-0.2, -0.1377, 0.8]}]}
  - suture: {from: [0.04, 0.03, 0.04], to: [0.06, 0.029778377014992766, 0.04], stiffness: 5100.0}
  - move: {tool: p, from: {xyz: [0.05, 0.03, 0.06]},
           to: {xyz: [0.05391557327078068, 0.03072679571437163, 0.04065037915779324]}}
  - move: {tool: p, to: {xyz: [0.05391557327078068, 0.03072679571437163, 0.09131903631631588]}}
)");
  EXPECT_TRUE(result.allOk());
}

}  // namespace
}  // namespace robot_tissue::test_suture_steps
