// Steps that save the tissue's state and load it.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "result_text.h"
#include "simulate.h"
#include "tool_scenes.h"

namespace robot_tissue::test_state_steps {
namespace {

namespace fs = std::filesystem;

const std::string kLoad =
    "  - load: {increments: 2, patches: [{name: p, min: [0.02, 0.02, 0.05], max: [0.04, 0.04, "
    "0.05], displacement: [0, 0, -0.005]}]}\n";
const std::string kCut =
    "  - cut: {corners: [[0.055, -1, 0.02], [0.055, 1, 0.02], [0.055, 1, 1], [0.055, -1, 1]]}\n";
const std::string kSave = "  - save: {file: a.tissue}\n";
const std::string kBack = "  - load_state: {file: a.tissue}\n";

std::string scene(const std::string& steps) { return block() + "steps:\n" + steps; }

std::string refusalOf(const std::string& steps) {
  try {
    run(scene(steps));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(StateSteps, WhatWasSavedComesBackBitForBit) {
  const RunResult saved = run(scene(kLoad + kCut));
  const RunResult back = run(scene(kLoad + kCut + kSave + "  - reset: {}\n" + kBack));
  EXPECT_EQ(nodesCsv(back), nodesCsv(saved));
  EXPECT_EQ(surfaceStl(back), surfaceStl(saved));
  EXPECT_EQ(back.patches.back().answer.force, saved.patches.back().answer.force);
  EXPECT_TRUE(back.allOk());
}

TEST(StateSteps, TheReaderKnowsWhatStandsInASavedState) {
  const std::string release = "  - release: {patches: [p]}\n";
  EXPECT_EQ(refusalOf(kLoad + kSave + release + kBack + release), "");
  EXPECT_NE(refusalOf(kLoad + kSave + "  - reset: {}\n" + release).find("no patch stands"),
            std::string::npos);
  EXPECT_NE(refusalOf(kSave + kLoad + kBack + release).find("no patch stands"), std::string::npos);
}

const std::string kDrill = "  - remove: {sphere: {center: [0.05, 0.05, 0.05], radius: 0.016}}\n";

TEST(SurgerySteps, WhatIsTakenBackIsAsItWasBitForBit) {
  const RunResult before = run(scene(kLoad));
  const RunResult back = run(scene(kLoad + kCut + kDrill + "  - undo: {count: 2}\n"));
  EXPECT_EQ(nodesCsv(back), nodesCsv(before));
  EXPECT_EQ(surfaceStl(back), surfaceStl(before));
  EXPECT_TRUE(back.allOk());
}

const std::string kRemoveLoad =
    "  - remove: {sphere: {center: [0.03, 0.03, 0.05], radius: 0.03}}\n";
const std::string kRelease = "  - release: {patches: [p]}\n";

TEST(SurgerySteps, AReleaseOfALoadThatWentWithItsNodesIsRemarkedOn) {
  const RunResult run_on = run(scene(kLoad + kRemoveLoad + kRelease + "  - settle: {}\n"));
  EXPECT_EQ(run_on.increments.size(), 5U);
  EXPECT_EQ(std::count(run_on.remarks.begin(), run_on.remarks.end(),
                       "steps[2].release: load 'p' is not there to be released: it went with all "
                       "its nodes"),
            1);
  // One of this name that came since is released.
  const RunResult anew = run(scene(kLoad + kRemoveLoad + "  - undo: {}\n" + kLoad + kRelease));
  EXPECT_TRUE(anew.increments.back().report.patches.empty());
}

TEST(SurgerySteps, AnUndoneTearUnderItsLoadIsRemarkedOn) {
  const std::string tearing = R"(tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.04, 0.02]}
  spacing: 0.01
  material: {young_modulus: 10000.0, poisson_ratio: 0.3, tear_stretch: 1.25}
  fixed: [{min: [-1, -1, -1], max: [1.0e-6, 1, 1]}]
steps:
  - load: {increments: 10, patches: [{name: a, min: [0.06, 0, 0], max: [0.06, 0.04, 0.02], displacement: [0.03, 0, 0]}]}
  - undo: {}
  - settle: {}
)";
  const RunResult result = run(tearing);
  const auto is_told = [](const std::string& remark) {
    return remark.find("steps[1].undo: what tore is stretched") == 0;
  };
  EXPECT_EQ(std::count_if(result.remarks.begin(), result.remarks.end(), is_told), 1);
  ASSERT_GE(result.pieces.size(), 3U);
  const auto pieces_in = [&](int step) {
    return std::count_if(result.pieces.begin(), result.pieces.end(),
                         [&](const PieceRow& row) { return row.step == step; });
  };
  EXPECT_EQ(pieces_in(1), 1);
  EXPECT_EQ(pieces_in(2), 2);
}

TEST(SurgerySteps, PiecesAddUpToTheBlock) {
  const RunResult cut = run(
      scene("  - settle: {}\n  - cut: {corners: [[0.055, -1, -1], [0.055, 1, -1], [0.055, 1, 1], "
            "[0.055, -1, 1]]}\n"));
  ASSERT_EQ(cut.pieces.size(), 3U);
  EXPECT_NEAR(cut.pieces[1].piece.volume + cut.pieces[2].piece.volume, cut.pieces[0].piece.volume,
              1e-12);
  EXPECT_LT(cut.pieces[1].piece.center.x(), 0.055);
  EXPECT_GT(cut.pieces[2].piece.center.x(), 0.055);
  EXPECT_TRUE(cut.pieces[1].piece.fixed && cut.pieces[2].piece.fixed);
  EXPECT_EQ(piecesCsv(cut).substr(0, 44), "step,increment,piece,volume,fixed,cx,cy,cz\n0");
  EXPECT_TRUE(run(scene(kLoad)).pieces.empty());
}

TEST(SurgerySteps, RemovedNodesAreNotWritten) {
  const RunResult whole = run(scene("  - settle: {}\n")), drilled = run(scene(kDrill));
  EXPECT_LT(drilled.rest.size(), whole.rest.size());
  EXPECT_EQ(drilled.rest.size(), drilled.displacement.size());
  EXPECT_LT(drilled.pieces.back().piece.volume, 0.999 * 0.1 * 0.1 * 0.05);
}

TEST(SurgerySteps, MoreThanThereIsIsNotTakenBack) {
  const std::string line = refusalOf(kCut + "  - undo: {count: 2}\n");
  EXPECT_NE(line.find("steps[1].undo: count: 2 to take back; allowed: 1 to 1"), std::string::npos)
      << line;
}

TEST(StateSteps, BadNamesAndMissingFilesAreRefused) {
  EXPECT_NE(
      refusalOf("  - save: {file: ../a}\n").find("steps[0].save.file = ../a: must be a plain"),
      std::string::npos);
  EXPECT_NE(refusalOf("  - save: {}\n").find("steps[0].save.file"), std::string::npos);
  const std::string line = refusalOf("  - load_state: {file: never-saved}\n");
  EXPECT_NE(line.find("steps[0].load_state.file = 'never-saved'"), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

// A tool in the tissue is none of the state: the tissue is found anew with it.
TEST(StateSteps, AToolComesInAnew) {
  const std::string press = placed("probe", sphereAt(-0.005), sphereAt(0.005), 3);
  const RunResult pressed = run(block() + kSphere + "steps:\n" + press);
  const RunResult again = run(block() + kSphere + "steps:\n" + kSave + press + kBack);
  const Vec3 before = pressed.tools.back().force, after = again.tools.back().force;
  EXPECT_GT(before.z(), 0.05);
  EXPECT_NEAR(after.z(), before.z(), 0.1 * before.z());
  const RunResult inside = run(block() + kSphere + "steps:\n" + press + kSave + kBack);
  EXPECT_NEAR(inside.tools.back().force.z(), before.z(), 0.1 * before.z());
}

class StateFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "state_steps_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  int runInto(const std::string& out, const std::string& text) {
    std::ofstream(folder_ / "scene.yaml") << text;
    std::ostringstream said;
    err_.str("");
    return simulate({(folder_ / "scene.yaml").string(), "--out", (folder_ / out).string()}, said,
                    err_, false);
  }
  std::string text(const std::string& file) const {
    std::ifstream stream(folder_ / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  fs::path folder_;
  std::ostringstream err_;
};

TEST_F(StateFiles, ALaterRunGoesOnFromAFileInItsFolder) {
  ASSERT_EQ(runInto("out", scene(kLoad + kCut + kSave)), 0) << err_.str();
  const std::string saved = text("out/a.tissue"), nodes = text("out/nodes.csv");
  EXPECT_FALSE(saved.empty());
  ASSERT_EQ(runInto("out", scene(kBack + "  - save: {file: b.tissue}\n")), 0) << err_.str();
  EXPECT_EQ(text("out/nodes.csv"), nodes);
  EXPECT_EQ(text("out/b.tissue"), saved);
  EXPECT_EQ(text("out/a.tissue"), saved);
}

// It is not known before the run what stands in it.
TEST_F(StateFiles, ALoadOfAnEarlierRunIsReleasedAlsoWhereItWasSavedAgain) {
  ASSERT_EQ(runInto("out", scene(kLoad + kSave)), 0) << err_.str();
  const std::string again = "  - save: {file: b.tissue}\n  - load_state: {file: b.tissue}\n";
  EXPECT_EQ(runInto("out", scene(kBack + again + kRelease)), 0) << err_.str();
  // A state that this run saved first is known.
  EXPECT_EQ(runInto("out", scene(again + kRelease)), 2);
}

TEST_F(StateFiles, ASutureWithoutANameIsNoneOfAnEarlierRuns) {
  const std::string suture = "  - suture: {from: [0.045, 0.05, 0.05], to: [0.065, 0.05, 0.05]}\n";
  ASSERT_EQ(runInto("out", scene(suture + kSave)), 0) << err_.str();
  ASSERT_EQ(runInto("out", scene(kBack + suture)), 0) << err_.str();
  const std::string sutures = text("out/sutures.csv");
  EXPECT_NE(sutures.find(",s1,"), std::string::npos) << sutures;
  EXPECT_NE(sutures.find(",s2,"), std::string::npos) << sutures;
}

TEST_F(StateFiles, AStateOfAnotherLatticeIsRefusedAndNothingWritten) {
  ASSERT_EQ(runInto("out", scene(kSave)), 0) << err_.str();
  const std::string nodes = text("out/nodes.csv");
  std::string other = scene(kBack);
  other.replace(other.find("0.1, 0.1, 0.05"), 14, "0.1, 0.1, 0.04");
  EXPECT_EQ(runInto("out", other), 2);
  EXPECT_NE(err_.str().find("steps[0].load_state.file = 'a.tissue': is of another lattice"),
            std::string::npos)
      << err_.str();
  EXPECT_EQ(text("out/nodes.csv"), nodes);
}

TEST_F(StateFiles, WhatIsWrongNamesTheEntryAndWhatIsAllowed) {
  EXPECT_EQ(runInto("out", scene(kBack)), 2);
  EXPECT_NE(err_.str().find("steps[0].load_state.file = 'a.tissue': No such file or directory; "
                            "allowed: a saved state in the folder "),
            std::string::npos)
      << err_.str();
  EXPECT_EQ(runInto("out", scene(kCut + kSave + kBack + "  - undo: {}\n")), 2);
  EXPECT_NE(err_.str().find("since the tissue was made, reset or loaded"), std::string::npos)
      << err_.str();
}

// What a removal leaves of a cut's front, and of what a grasper held, is what is saved.
TEST(StateSteps, ARemovalBesideACutsFrontOrInAGraspIsReadBack) {
  const std::string strip =
      "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.012, 0.04]}\n"
      "  spacing: 0.004\n  material: {young_modulus: 1.0e+4}\n"
      "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
      "tools:\n"
      "  - {name: forceps, role: grasper, jaws: [{shapes: [{type: box, size: [0.008, 0.004, "
      "0.012]}]}, {shapes: [{type: box, size: [0.008, 0.004, 0.012]}]}], grasp: {close_gap: "
      "0.010}}\n"
      "  - {name: knife, role: blade, edge: [[-0.02, 0, 0], [0.02, 0, 0]], resistance: 50.0}\n"
      "steps:\n";
  const std::string beside_front =
      "  - move: {tool: knife, from: {xyz: [0.03, 0.006, 0.05], rpy: [0, 0, 1.3036]}, to: {xyz: "
      "[0.03, 0.006, 0.0243], rpy: [0, 0, 1.4736]}, increments: 1}\n"
      "  - remove: {sphere: {center: [0.03304, 0.006, 0.0307], radius: 0.0083}}\n";
  const std::string in_grasp =
      "  - move: {tool: forceps, from: {xyz: [0.03, 0.006, 0.06], opening: 0.022}, to: {xyz: "
      "[0.03, 0.006, 0.038], opening: 0.022}, increments: 1}\n"
      "  - move: {tool: forceps, to: {xyz: [0.03, 0.006, 0.038], opening: 0.012}, increments: 1}\n"
      "  - move: {tool: forceps, to: {xyz: [0.03, 0.006, 0.0372], opening: 0.012}, increments: 1}\n"
      "  - remove: {sphere: {center: [0.02510, 0.006, 0.0374], radius: 0.0062}}\n";
  for (const std::string& steps : {beside_front, in_grasp}) {
    EXPECT_NO_THROW(run(strip + steps + kSave + "  - reset: {}\n" + kBack)) << steps;
  }
}

}  // namespace
}  // namespace robot_tissue::test_state_steps
