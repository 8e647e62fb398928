// Steps of the runner that tools take: rows, increments, remarks and refusals.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "result_text.h"
#include "simulate.h"
#include "tool_scenes.h"

namespace robot_tissue::test_tool_steps {
namespace {

std::string refusalOf(const std::string& scene) {
  try {
    run(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

bool hasRemark(const RunResult& result, const std::string& start, const std::string& fragment) {
  return std::any_of(result.remarks.begin(), result.remarks.end(), [&](const std::string& remark) {
    return remark.rfind(start, 0) == 0 && remark.find(fragment) != std::string::npos;
  });
}

TEST(ToolSteps, AToolHasARowAnIncrementFromWhereItIsPlacedUntilTheReset) {
  const RunResult result =
      run(block() + kSphere + "steps:\n  - settle: {}\n" +
          placed("probe", sphereAt(-0.03), sphereAt(-0.01), 3) + "  - settle: {}\n" +
          "  - load: {increments: 2, patches: [{name: pull, min: [0, 0, 0.05], max: [0, 0, 0.05],"
          " displacement: [0, 0, 0.001]}]}\n" +
          "  - release: {patches: [pull], tools: [probe]}\n  - reset: {}\n  - settle: {}\n");
  std::vector<std::array<int, 2>> rows;
  for (const ToolRow& row : result.tools) rows.push_back({row.step, row.increment});
  const std::vector<std::array<int, 2>> expected = {{1, 1}, {1, 2}, {1, 3}, {2, 1},
                                                    {3, 1}, {3, 2}, {4, 1}};
  EXPECT_EQ(rows, expected);
  EXPECT_EQ(result.increments.size(), 10U);
  ASSERT_EQ(result.patches.size(), 2U);  // named ones only
  EXPECT_EQ(result.patches[0].patch, "pull");
}

TEST(ToolSteps, PatchesHoldNoRowsOfTools) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.001), sphereAt(0.002), 2));
  EXPECT_GT(result.tools.back().force.z(), 0.1);
  EXPECT_TRUE(result.patches.empty());
}

TEST(ToolSteps, WithoutIncrementsAMoveHasOneALoadStep) {
  const RunResult result = run(block() + kSphere +
                               "steps:\n  - move: {tool: probe, from: {xyz: [0.05, 0.05, 0.2]},"
                               " to: {xyz: [0.05, 0.05, 0.19]}}\n");
  EXPECT_EQ(result.increments.size(), 5U);  // of a fifth of the spacing
}

// A tool that slips, its edges in folds: a way of 20 mm in load steps of 2 mm.
RunResult draggedIn(int increments, const std::string& shape) {
  return run(block() + "tools:\n  - {name: probe, friction: 0.3, shapes: [" + shape +
             "]}\nsteps:\n" + placed("probe", {0.041, 0.0483, 0.09}, {0.041, 0.0483, 0.06}, 2) +
             moved("probe", {0.061, 0.0483, 0.06}, increments) +
             moved("probe", {0.061, 0.0533, 0.06}, 2));
}

class SlippingTools : public testing::TestWithParam<std::string> {};

TEST_P(SlippingTools, EndAlikeInAnyNumberOfIncrements) {
  const RunResult one = draggedIn(1, GetParam());
  for (const int increments : {3, 10, 14, 40}) {
    const RunResult more = draggedIn(increments, GetParam());
    EXPECT_EQ(rowsOf(more, 1, "probe").back().force, rowsOf(one, 1, "probe").back().force);
    EXPECT_EQ(more.displacement, one.displacement) << increments << " increments";
    EXPECT_TRUE(more.allOk());
  }
  EXPECT_GT(std::abs(one.tools.back().force.x()), 0.1);
}

// A tube of 24 sides, closed by a ring at each end, from -20 to 20 mm along z.
std::string writeTube() {
  const std::string path = testing::TempDir() + "robot_tissue_tube.stl";
  std::ofstream stl(path);
  const auto put = [&](const Vec3& corner) {
    stl << "vertex " << corner.x() << ' ' << corner.y() << ' ' << corner.z() << '\n';
  };
  const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    stl << "facet normal 0 0 0\nouter loop\n";
    put(a), put(b), put(c);
    stl << "endloop\nendfacet\n";
  };
  const std::array<Eigen::Vector2d, 5> outline = {
      {{0.011, -0.02}, {0.011, 0.02}, {0.007, 0.02}, {0.007, -0.02}, {0.011, -0.02}}};
  stl << "solid tube\n";
  for (int side = 0; side < 24; ++side) {
    const auto at_side = [&](const Eigen::Vector2d& place, int k) -> Vec3 {
      const double angle = M_PI * (k % 24) / 12.0;
      return {place.x() * std::cos(angle), place.x() * std::sin(angle), place.y()};
    };
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
      const Vec3 a = at_side(outline[i], side), b = at_side(outline[i], side + 1);
      const Vec3 c = at_side(outline[i + 1], side + 1), d = at_side(outline[i + 1], side);
      facet(a, b, c), facet(a, c, d);
    }
  }
  stl << "endsolid tube\n";
  return path;
}

INSTANTIATE_TEST_SUITE_P(Shapes, SlippingTools,
                         testing::Values("{type: box, size: [0.02, 0.02, 0.04]}",
                                         "{type: mesh, resource: 'file://" + writeTube() + "'}"));

TEST(ToolSteps, AFarWayInOneIncrementIsWalkedAll) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-3.0), sphereAt(0.003), 1));
  EXPECT_TRUE(result.allOk());
  EXPECT_EQ(result.increments.size(), 1U);
  EXPECT_TRUE(result.remarks.empty());
  EXPECT_GT(result.tools.back().force.z(), 0.2);
}

TEST(ToolSteps, AWayOfTooManyLoadStepsIsRefused) {
  const std::string message = refusalOf(block() + kSphere + "steps:\n" +
                                        placed("probe", sphereAt(-900.0), sphereAt(0.0), 1));
  EXPECT_EQ(message.rfind("steps[0].move: ", 0), 0U) << message;
  EXPECT_NE(message.find("450000 load steps of 0.002 m"), std::string::npos) << message;
  EXPECT_NE(message.find("at most 100000"), std::string::npos) << message;
}

TEST(ToolSteps, AToolThatAppearsInsideIsWalkedInWithARemark) {
  const RunResult inside =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(0.003), sphereAt(0.003), 1));
  EXPECT_TRUE(hasRemark(inside, "steps[0].move: 'probe' ", "walked in from outside"));
  EXPECT_EQ(inside.remarks.size(), 1U);
  const RunResult outside =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.001), sphereAt(0.003), 1));
  EXPECT_TRUE(outside.remarks.empty());
  EXPECT_NEAR(inside.tools.back().force.z(), outside.tools.back().force.z(),
              0.05 * outside.tools.back().force.z());
}

TEST(ToolSteps, ALaterPlaceToAppearAtIsNotWalkedTo) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.001), sphereAt(0.003), 2) +
          placed("probe", {0.2, 0.05, 0.02}, {0.2, 0.05, 0.02}, 1));
  EXPECT_EQ(result.tools.back().force, Vec3::Zero());
  EXPECT_EQ(greatestDisplacement(result), 0.0);
  EXPECT_TRUE(result.allOk());
}

TEST(ToolSteps, PlacingAToolLeavesTheOthersAsTheyAre) {
  const std::string tools =
      "tools: [{name: first, friction: 0.5, shapes: [{type: sphere, radius: 0.02}]},"
      " {name: second, shapes: [{type: sphere, radius: 0.02}]}]\n";
  const RunResult result =
      run(block() + tools + "steps:\n" + placed("first", sphereAt(-0.001), sphereAt(0.003), 2) +
          moved("first", sphereAt(0.003, 0.053), 2) +
          placed("second", {0.05, 0.05, 0.3}, {0.05, 0.05, 0.29}, 1));
  const Vec3 before = rowsOf(result, 1, "first").back().force;
  const Vec3 after = rowsOf(result, 2, "first").back().force;
  EXPECT_LT(before.x(), -0.1 * before.z());
  EXPECT_LT(after.x(), 0.4 * before.x());  // it still drags, which one placed anew would not
  EXPECT_NEAR(after.z(), before.z(), 0.03 * before.z());
}

TEST(ToolSteps, AMoveEndsAPushWhereItHasLed) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.01), sphereAt(-0.005), 1) +
          "  - push: {tool: probe, force: [0, 0, -0.3]}\n" + moved("probe", sphereAt(-0.02), 1) +
          moved("probe", sphereAt(-0.02), 1));
  EXPECT_TRUE(hasRemark(result, "steps[2].move: ", "ends its push"));
  EXPECT_EQ(result.remarks.size(), 1U);
  EXPECT_EQ(rowsOf(result, 3, "probe").front().force, Vec3::Zero());
}

TEST(ToolSteps, APushThatMeetsNothingIsToldAndNotOk) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.01), sphereAt(-0.005), 1) +
          "  - push: {tool: probe, force: [0, 0, 0.3]}\n");
  EXPECT_EQ(result.increments.back().report.status, SolveStatus::kUnconverged);
  EXPECT_TRUE(hasRemark(result, "steps[1].push: tool 'probe' met 0 N", "not the force of 0.3 N"));
}

TEST(ToolSteps, APushIsToldOnceAStepAsItsLastRowHasIt) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.01), sphereAt(-0.005), 1) +
          "  - push: {tool: probe, force: [0, 0, 0.3], increments: 3}\n  - settle: {}\n");
  ASSERT_EQ(result.remarks.size(), 2U);
  EXPECT_TRUE(hasRemark(result, "steps[1].push: tool 'probe' met 0 N", "not the force of 0.3 N"));
  EXPECT_TRUE(hasRemark(result, "steps[2].settle: tool 'probe' met 0 N", "the force of 0.3 N"));
  for (const std::size_t row : {1U, 2U, 3U, 4U}) {
    EXPECT_EQ(result.increments[row].report.status, SolveStatus::kUnconverged) << row;
  }
}

TEST(ToolSteps, AReleaseOfNothingIsTold) {
  const RunResult result =
      run(block() + kSphere + "steps:\n" + placed("probe", sphereAt(-0.004), sphereAt(-0.002), 1) +
          "  - release: {tools: [probe]}\n");
  EXPECT_TRUE(hasRemark(result, "steps[1].release: tool 'probe' ", "holds nothing"));
}

TEST(ToolSteps, AGraspOfNothingIsRefused) {
  const std::string message = refusalOf(
      block() +
      "tools: [{name: forceps, role: grasper, jaws: [{shapes: [{type: sphere, radius: 0.002}]},"
      " {shapes: [{type: sphere, radius: 0.002}]}]}]\n"
      "steps:\n"
      "  - move: {tool: forceps, from: {xyz: [0.05, 0.05, 0.2], opening: 0.01},"
      " to: {xyz: [0.05, 0.05, 0.19], opening: 0.01}, increments: 1}\n"
      "  - grasp: {tool: forceps}\n");
  EXPECT_EQ(message.rfind("steps[1].grasp: tool 'forceps': ", 0), 0U) << message;
}

// The spheres' middles are the opening apart.
TEST(ToolSteps, JawsThatMeetAreNamedOnceAStep) {
  const std::string forceps =
      "tools: [{name: forceps, role: grasper, jaws: [{shapes: [{type: sphere, radius: 0.002}]},"
      " {shapes: [{type: sphere, radius: 0.002}]}]}]\nsteps:\n";
  const auto closed_to = [&](const std::string& opening) {
    return run(block() + forceps + "  - move: {tool: forceps, from: {xyz: [0.05, 0.05, 0.2]," +
               " opening: 0.01}, to: {xyz: [0.05, 0.05, 0.2], opening: " + opening +
               "}, increments: 4}\n");
  };
  const auto overlaps = [](const RunResult& result) {
    return std::count_if(result.remarks.begin(), result.remarks.end(), [](const std::string& said) {
      return said.rfind("steps[0].move: ", 0) == 0 &&
             said.find("the jaws of 'forceps'") != std::string::npos;
    });
  };
  EXPECT_EQ(overlaps(closed_to("0.0045")), 0);
  EXPECT_EQ(overlaps(closed_to("0.0")), 1);
}

// Where jaws that no shape followed have let go and come to their place, one does.
TEST(ToolSteps, ToolsThatNoShapeFollowsAreNamedForAsLongAsThatIsSo) {
  const std::string jaw = "{shapes: [{type: box, size: [0.02, 0.002, 0.02]}]}";
  const auto jaws = [](const char* height, const char* opening) {
    return std::string("{xyz: [0.05, 0.05, ") + height + "], opening: " + opening + "}";
  };
  const RunResult result = run(
      block() + "tools: [{name: forceps, role: grasper, jaws: [" + jaw + ", " + jaw +
      "], grasp: {close_gap: 0.02, max_force: 0.8}}]\nsteps:\n  - move: {tool: forceps, from: " +
      jaws("0.07", "0.03") + ", to: " + jaws("0.052", "0.03") +
      ", increments: 1}\n  - move: {tool: forceps, to: " + jaws("0.052", "0.012") +
      ", increments: 1}\n  - move: {tool: forceps, to: " + jaws("0.07", "0.012") +
      ", increments: 9}\n");
  EXPECT_TRUE(hasRemark(result, "steps[1].move", "no shape follows 'forceps'"));
  EXPECT_FALSE(hasRemark(result, "", "no shape follows a tool"));
  EXPECT_EQ(result.increments.back().report.status, SolveStatus::kOk);
}

TEST(ToolSteps, ToolsThatNoStepPlacesPlayNoPart) {
  const RunResult result = run(block() + "tools: [{link: tool_tip}]\nsteps:\n  - settle: {}\n");
  EXPECT_TRUE(result.tools.empty());
  EXPECT_TRUE(result.remarks.empty());
}

TEST(ToolSteps, ToolsCsvHasItsHeaderAndOneLineARow) {
  RunResult result;
  const std::string header = "step,increment,tool,fx,fy,fz,tx,ty,tz,contacts,max_penetration\n";
  EXPECT_EQ(toolsCsv(result), header);
  result.tools.push_back({2, 7, "probe", {1, 2, 3}, {4, 5, 6}, 8, 0.1});
  EXPECT_EQ(toolsCsv(result), header + "2,7,probe,1,2,3,4,5,6,8,0.10000000000000001\n");
  result.tools.back().torque.x() = std::nan("");
  EXPECT_THROW(toolsCsv(result), std::runtime_error);
}

TEST(ToolSteps, TheScenesProbePressesDragsAndLeaves) {
  const RunResult result =
      runScene(loadScene(ROBOT_TISSUE_SOURCE_DIR "/config/probe_scene.yaml", {}));
  EXPECT_TRUE(result.allOk());
  EXPECT_TRUE(result.remarks.empty());
  EXPECT_GT(rowsOf(result, 0, "probe").back().force.z(), 0.5);
  const Vec3 dragged = rowsOf(result, 1, "probe").back().force;
  EXPECT_LT(dragged.x(), -0.25 * dragged.z());
  EXPECT_EQ(rowsOf(result, 2, "probe").back().force, Vec3::Zero());
  EXPECT_EQ(greatestDisplacement(result), 0.0);
}

// Two fifths of a turn in coarse tissue squeeze cells inside out.
TEST(ToolSteps, ARigidPlateThatTurnsInCoarseTissueThrowsNoneOfItAway) {
  const RunResult result = run(R"(tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.08, 0.08, 0.04]}
  spacing: 0.02
  material: {young_modulus: 10000.0, poisson_ratio: 0.3}
  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]
solver: {tolerance: 0.05}
tools: [{name: plate, patch: rigid, shapes: [{type: box, size: [0.03, 0.03, 0.004]}]}]
steps:
  - move:
      tool: plate
      from: {xyz: [0.0254, 0.013, 0.0961], rpy: [-0.0733, 2.94175, -2.54172]}
      to: {xyz: [0.088, 0.0149, 0.01], rpy: [2.92041, -1.74761, -2.3065]}
      increments: 3
)");
  EXPECT_FALSE(result.allOk());
  EXPECT_LT(greatestDisplacement(result), 0.2);
  for (const IncrementRow& row : result.increments) {
    EXPECT_TRUE(std::isfinite(row.report.residual)) << row.increment;
  }
  for (const ToolRow& row : result.tools) EXPECT_TRUE(row.force.allFinite()) << row.increment;
}

TEST(ToolSteps, RemarksGoToStderrUnlessQuiet) {
  namespace fs = std::filesystem;
  std::string pattern = (fs::temp_directory_path() / "tool_steps_XXXXXX").string();
  ASSERT_NE(mkdtemp(pattern.data()), nullptr);
  const std::string file = pattern + "/scene.yaml";
  std::ofstream(file) << block() << kSphere << "steps:\n"
                      << placed("probe", sphereAt(0.002), sphereAt(0.002), 1);
  const auto errorsOf = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {file, "--out", pattern + "/out"});
    std::ostringstream out, err;
    EXPECT_EQ(simulate(arguments, out, err, false), kExitOk);
    return err.str();
  };
  EXPECT_EQ(errorsOf({}).rfind("simulate: steps[0].move: ", 0), 0U);
  EXPECT_EQ(errorsOf({"--quiet"}), "");
  fs::remove_all(pattern);
}

// With few iterations a load step, the tool is not followed to where it leaves the tissue.
TEST(ToolSteps, SettleBringsAToolThatIsBehindToItsPlace) {
  const std::string scene =
      "tissue:\n"
      "  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.06, 0.03]}\n"
      "  spacing: 0.005\n"
      "  material: {young_modulus: 20000}\n"
      "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
      "solver: {tolerance: 0.001, max_iterations: 6}\n"
      "tools: [{name: probe, shapes: [{type: sphere, radius: 0.01}]}]\n"
      "steps:\n" +
      placed("probe", Vec3(0.031, 0.029, 0.045), Vec3(0.031, 0.029, 0.034), 1) +
      moved("probe", Vec3(0.022, 0.023, 0.034), 1) + moved("probe", Vec3(0.031, 0.029, 0.045), 1) +
      "  - settle: {}\n";
  const RunResult result = run(scene);
  ASSERT_EQ(result.increments[2].report.status, SolveStatus::kLate) << "nothing is behind";
  EXPECT_EQ(result.increments.back().report.status, SolveStatus::kOk);
  const ToolRow settled = rowsOf(result, 3, "probe").back();
  EXPECT_EQ(settled.contacts, 0);
  EXPECT_EQ(settled.force, Vec3(Vec3::Zero()));
  for (const Vec3& displacement : result.displacement) EXPECT_LT(displacement.norm(), 1e-5);
}

// So near that its contacts are looked for, but do not push: nothing is solved for as the cuts are
// taken back.
TEST(ToolSteps, ASphereThatHoversTouchesTissueThatWasMended) {
  const std::string before =
      "tissue:\n"
      "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n"
      "  spacing: 0.005\n"
      "  material: {young_modulus: 10000}\n"
      "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
      "tools: [{name: probe, shapes: [{type: sphere, radius: 0.01}]}]\n"
      "steps:\n"
      "  - move: {tool: probe, from: {xyz: [0.05, 0.05, 0.075]}, to: {xyz: [0.05, 0.05, 0.0601]}, "
      "increments: 3}\n";
  const std::string cuts =
      "  - cut: {corners: [[0.055, -0.01, 0.01], [0.055, 0.11, 0.01], [0.055, 0.11, 0.06], "
      "[0.055, -0.01, 0.06]]}\n"
      "  - cut: {corners: [[-0.01, 0.045, 0.01], [0.11, 0.045, 0.01], [0.11, 0.045, 0.06], "
      "[-0.01, 0.045, 0.06]]}\n"
      "  - undo: {count: 2}\n";
  const std::string after =
      "  - move: {tool: probe, to: {xyz: [0.05, 0.05, 0.0598]}, increments: 3}\n";
  const RunResult mended = run(before + cuts + after), whole = run(before + after);
  EXPECT_TRUE(mended.allOk());
  const double force = rowsOf(whole, 1, "probe").back().force.z();
  EXPECT_GT(force, 0.001);
  EXPECT_NEAR(rowsOf(mended, 4, "probe").back().force.z(), force, 0.01 * force);
}

}  // namespace
}  // namespace robot_tissue::test_tool_steps
