// Good scenes arrive with every field; defaults and remarks; files.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "../core/mesh_fixtures.h"
#include "mesh_files.h"
#include "robot_tissue/core/grid.h"
#include "robot_tissue/scene/value_text.h"
#include "scene_texts.h"

namespace robot_tissue::test_good_scene {
namespace {

namespace fs = std::filesystem;

class SceneFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "scene_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }
  static std::string fileRefusal(const std::string& path) {
    try {
      loadScene(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  fs::path folder_;
};

TEST(GoodScene, TissueHasEveryField) {
  const TissueConfig tissue = parseText(kRunnerScene, SceneUser::kRunner).tissue;
  EXPECT_EQ(tissue.frame_id, "organ");
  EXPECT_EQ(tissue.shape.min(), Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(tissue.shape.max(), Vec3(0.1, 0.1, 0.05));
  EXPECT_EQ(tissue.spacing, 0.01);
  EXPECT_EQ(tissue.model, "six_spring");
  EXPECT_EQ(tissue.material.young_modulus, 10000.0);
  EXPECT_EQ(tissue.material.density, 900.0);
  EXPECT_EQ(tissue.material.poisson_ratio, 0.45);
  EXPECT_FALSE(tissue.material.spring_stiffness.has_value());
  ASSERT_EQ(tissue.fixed.size(), 1U);
  EXPECT_EQ(tissue.fixed[0].min(), Vec3(-1.0, -1.0, -1e-6));
  EXPECT_EQ(tissue.fixed[0].max(), Vec3(1.0, 1.0, 1e-6));
  EXPECT_EQ(tissue.gravity, Vec3(0.0, 0.0, -9.81));
}

TEST(GoodScene, RegionsTakeTheirOwnEntriesAndInheritTheRest) {
  const TissueConfig tissue = parseText(kRunnerScene, SceneUser::kRunner).tissue;
  ASSERT_EQ(tissue.regions.size(), 2U);
  EXPECT_EQ(tissue.regions[0].name, "tumour");
  EXPECT_EQ(tissue.regions[0].box.min(), Vec3(0.03, 0.03, 0.01));
  EXPECT_EQ(tissue.regions[0].box.max(), Vec3(0.07, 0.07, 0.03));
  EXPECT_EQ(tissue.regions[0].material.young_modulus, 1e5);
  EXPECT_EQ(tissue.regions[0].material.density, 900.0);
  EXPECT_EQ(tissue.regions[1].name, "");
  EXPECT_EQ(tissue.regions[1].material.young_modulus, 10000.0);
  EXPECT_EQ(tissue.regions[1].material.density, 1100.0);
}

TEST(GoodScene, SpringStiffnessTakesThePlaceOfTheModulus) {
  std::string text =
      replaced(kRunnerScene, "{young_modulus: 10000.0, density: 900.0}", "{spring_stiffness: 50}");
  text = replaced(text, "young_modulus: 1.0e+5", "spring_stiffness: 80");
  const TissueConfig tissue = parseText(text, SceneUser::kRunner).tissue;
  EXPECT_EQ(tissue.material.spring_stiffness.value_or(0.0), 50.0);
  EXPECT_EQ(tissue.regions[0].material.spring_stiffness.value_or(0.0), 80.0);
  EXPECT_EQ(tissue.regions[1].material.spring_stiffness.value_or(0.0), 50.0);
}

TEST(GoodScene, SolverHasEveryField) {
  const Scene scene = parseText(
      replaced(kRunnerScene, "max_ms: 8", "max_ms: 8, max_iterations: 24"), SceneUser::kRunner);
  EXPECT_EQ(scene.solver.method, "paper");
  EXPECT_EQ(scene.solver.tolerance, 0.02);
  EXPECT_EQ(scene.solver.max_ms, 8.0);
  EXPECT_EQ(scene.solver.max_iterations.value_or(0), 24);
  EXPECT_EQ(scene.solver.threads, 1);
  EXPECT_TRUE(scene.remarks.empty()) << scene.remarks.front();
}

TEST(GoodScene, StepsHaveEveryField) {
  const std::vector<Step> steps = parseText(kRunnerScene, SceneUser::kRunner).steps;
  ASSERT_EQ(steps.size(), 5U);
  EXPECT_TRUE(std::holds_alternative<SettleStep>(steps[0]));
  const auto& load = std::get<LoadStep>(steps[1]);
  EXPECT_EQ(load.increments.value_or(0), 5);
  ASSERT_EQ(load.patches.size(), 2U);
  const PatchConfig& punch = load.patches[0];
  EXPECT_EQ(punch.name, "punch");
  EXPECT_EQ(punch.box.min(), Vec3(0.04, 0.04, 0.05));
  EXPECT_EQ(punch.box.max(), Vec3(0.06, 0.06, 0.05));
  ASSERT_TRUE(punch.displacement.has_value());
  EXPECT_FALSE(punch.force.has_value());
  EXPECT_FALSE((*punch.displacement)[0].has_value());
  EXPECT_EQ((*punch.displacement)[1].value_or(9.0), 0.0);
  EXPECT_EQ((*punch.displacement)[2].value_or(9.0), -0.005);
  const PatchConfig& pull = load.patches[1];
  EXPECT_FALSE(pull.displacement.has_value());
  EXPECT_EQ(pull.force.value_or(Vec3::Zero()), Vec3(0.0, 0.5, 1.0));
  const auto& cut = std::get<CutStep>(steps[2]);
  ASSERT_EQ(cut.corners.size(), 3U);
  EXPECT_EQ(cut.corners[2], Vec3(0.055, 0.08, 0.051));
  EXPECT_EQ(std::get<ReleaseStep>(steps[3]).patches, std::vector<std::string>({"punch"}));
  EXPECT_TRUE(std::holds_alternative<ResetStep>(steps[4]));
}

TEST(GoodScene, APatchMayBeLoadedAgainAndAfterReleaseElsewhere) {
  const std::string again =
      "- load: {patches: [{name: pull, min: [0, 0, 0.05], max: [0.01, 0.01, 0.05], force: [0, 0, "
      "2]}, {name: punch, min: [0.1, 0.1, 0.05], max: [0.1, 0.1, 0.05], force: [0, 0, 2]}]}";
  const Scene scene = parseText(replaced(kRunnerScene, "- reset: {}", again), SceneUser::kRunner);
  const auto& load = std::get<LoadStep>(scene.steps[4]);
  EXPECT_FALSE(load.increments.has_value());
  EXPECT_EQ(load.patches.size(), 2U);
}

TEST(GoodScene, OnlyTheTissueIsNeeded) {
  const std::string text = kNodeScene.substr(0, kNodeScene.find("tools:"));
  const Scene scene = parseText(text, SceneUser::kRunner);
  EXPECT_EQ(scene.tissue.frame_id, "tissue");
  EXPECT_EQ(scene.tissue.model, "elastic");
  EXPECT_EQ(scene.tissue.material.density, 1000.0);
  EXPECT_EQ(scene.tissue.gravity, Vec3(0.0, 0.0, 0.0));
  EXPECT_EQ(scene.solver.method, "layered");
  EXPECT_EQ(scene.solver.tolerance, 0.01);
  EXPECT_EQ(scene.solver.max_ms, 0.0);
  EXPECT_FALSE(scene.solver.max_iterations.has_value());
  EXPECT_EQ(scene.solver.threads, 1);
  EXPECT_TRUE(scene.tools.empty());
  EXPECT_TRUE(scene.steps.empty());
}

TEST(GoodScene, WhatIsIgnoredIsSaid) {
  std::string text = replaced(kRunnerScene, "density: 900.0", "poisson_ratio: 0.3");
  text = replaced(text, "density: 1100", "poisson_ratio: 0.4");
  text = replaced(text, "threads: 1", "threads: 4");
  const Scene scene = parseText(text, SceneUser::kRunner);
  ASSERT_EQ(scene.remarks.size(), 3U);
  EXPECT_NE(scene.remarks[0].find("tissue.material.poisson_ratio = 0.3: ignored"),
            std::string::npos);
  EXPECT_NE(scene.remarks[1].find("tissue.regions[1].poisson_ratio = 0.4"), std::string::npos);
  EXPECT_NE(scene.remarks[2].find("solver.threads = 4: ignored"), std::string::npos);
  EXPECT_EQ(scene.solver.threads, 4);
}

TEST(GoodScene, TheNodeIgnoresStepsAndSaysSoInOneLine) {
  const Scene scene = parseText(kNodeScene + "steps: [{settle: {}}]\n", SceneUser::kNode);
  EXPECT_TRUE(scene.steps.empty());
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_NE(scene.remarks[0].find("steps = [{settle: {}}]: ignored"), std::string::npos);
  EXPECT_EQ(scene.remarks[0].find('\n'), std::string::npos);
  EXPECT_TRUE(parseText(kNodeScene + "steps: []\n", SceneUser::kNode).remarks.empty());
  YAML::Node as_many_as_the_runner_takes = YAML::Load(kNodeScene);
  for (int step = 0; step < 10001; ++step) as_many_as_the_runner_takes["steps"].push_back("settle");
  SceneSource source;
  source.user = SceneUser::kNode;
  EXPECT_NO_THROW(parseScene(as_many_as_the_runner_takes, source));
}

TEST(GoodScene, OtherKeysAreLeftToTheirReader) {
  const std::string text = kNodeScene + "robot_description_param: /robot\n";
  EXPECT_NE(refusal(text, SceneUser::kNode), "");
  SceneSource source;
  source.name = "/tissue";
  source.user = SceneUser::kNode;
  source.other_keys = {"robot_description_param"};
  EXPECT_NO_THROW(parseScene(YAML::Load(text), source));
}

TEST(GoodScene, AListThatContainsItselfIsRefused) {
  const std::string message = refusal("tissue: &a [*a]", SceneUser::kRunner);
  EXPECT_NE(message.find("tissue = [["), std::string::npos) << message;
  EXPECT_LT(message.size(), 300U);
}

// A parameter server's values have no line: the message names the node alone.
TEST(GoodScene, NodesOfAProgramHaveNoLine) {
  YAML::Node root;
  root["tissue"]["spacing"] = -1.0;
  SceneSource source;
  source.name = "/tissue_node";
  try {
    parseScene(root, source);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).rfind("/tissue_node: tissue.shape is missing", 0), 0U)
        << error.what();
  }
}

TEST(GoodScene, ProposedSpacingsAreAccepted) {
  for (const double spacing : {0.0041, 0.0099, 0.013, 0.024, 0.3}) {
    const std::vector<double> proposed = nearestSpacings({0.1, 0.06, 0.02}, spacing);
    ASSERT_FALSE(proposed.empty());
    for (const double nearest : proposed) {
      EXPECT_TRUE(spacingFits({0.1, 0.06, 0.02}, std::stod(numberText(nearest)))) << nearest;
    }
  }
  EXPECT_FALSE(spacingFits({0.1, 0.06, 0.02}, 0.0041));
}

TEST(GoodScene, BoxesAreClosedWithAThousandthOfTheSpacing) {
  const Grid grid({Vec3::Zero(), Vec3(0.1, 0.1, 0.1)}, 0.01);
  const auto nodes = [&grid](double low, double high) {
    const NodeRange range = grid.nodesIn({Vec3(low, 0.0, 0.0), Vec3(high, 0.0, 0.0)});
    return range.empty() ? 0 : range.last[0] - range.first[0] + 1;
  };
  EXPECT_EQ(nodes(0.0, 0.1), 11);
  EXPECT_EQ(nodes(0.03, 0.03), 1);
  EXPECT_EQ(nodes(0.030009, 0.030009), 1);
  EXPECT_EQ(nodes(0.030011, 0.030011), 0);
  EXPECT_EQ(nodes(-1e14, 1e14), 11);
  EXPECT_EQ(nodes(0.2, 0.3), 0);
  EXPECT_EQ(nodes(-0.3, -0.2), 0);
}

TEST_F(SceneFolder, AFileGivesTheSameScene) {
  const Scene scene = loadScene(write("block.yaml", kRunnerScene));
  EXPECT_EQ(scene.tissue.frame_id, "organ");
  EXPECT_EQ(scene.steps.size(), 5U);
}

TEST_F(SceneFolder, OverridesTakeThePlaceOfTheScenesEntriesAndPassTheSameChecks) {
  const std::string path = write("block.yaml", kRunnerScene);
  SolverOverrides overrides;
  overrides.tolerance = "0.5";
  overrides.threads = "3";
  overrides.method = "paper";
  const Scene scene = loadScene(path, overrides);
  EXPECT_EQ(scene.solver.tolerance, 0.5);
  EXPECT_EQ(scene.solver.threads, 3);
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_EQ(scene.remarks[0].rfind("--threads = 3: ignored", 0), 0U) << scene.remarks[0];
  overrides.tolerance = "1.5";
  EXPECT_THROW(loadScene(path, overrides), InputError);
}

TEST_F(SceneFolder, ElasticTakesNewtonWhichIgnoresTheTolerance) {
  const std::string path = write("block.yaml", replaced(kRunnerScene, "six_spring", "elastic"));
  SolverOverrides overrides;
  overrides.method = "newton";
  overrides.tolerance = "0.5";
  const Scene scene = loadScene(path, overrides);
  EXPECT_EQ(scene.tissue.model, "elastic");
  EXPECT_EQ(scene.solver.method, "newton");
  ASSERT_EQ(scene.remarks.size(), 1U);
  EXPECT_EQ(scene.remarks[0], "--tolerance = 0.5: ignored, method newton solves exactly");
}

TEST_F(SceneFolder, EveryModelHasAMethodOfItsOwnUnlessTold) {
  const std::string elastic = replaced(kRunnerScene, "six_spring", "elastic");
  EXPECT_THROW(loadScene(write("block.yaml", elastic)), InputError);
  for (const auto& [text, method] : {std::pair(elastic, "layered"), {kRunnerScene, "paper"}}) {
    const std::string untold = replaced(text, "method: paper, tolerance: 0.02, max_ms", "max_ms");
    const Scene scene = loadScene(write("block.yaml", untold));
    EXPECT_EQ(scene.solver.method, method);
    EXPECT_TRUE(scene.remarks.empty());
  }
}

TEST_F(SceneFolder, MeshesAreFoundFromTheScenesFolder) {
  write("tip.stl", stlText(boxMesh(Vec3::Zero(), Vec3::Ones())));
  SceneSource source;
  source.name = "block.yaml";
  source.user = SceneUser::kNode;
  source.folder = folder_.string();
  const std::string text =
      replaced(kNodeScene, "package://robot_tissue/tip.stl, scale: 0.001", "tip.stl");
  const Scene scene = parseScene(YAML::Load(text), source);
  EXPECT_EQ(scene.tools[0].links[0].shapes[3].resource, "file://" + (folder_ / "tip.stl").string());
  EXPECT_EQ(scene.tools[0].links[0].shapes[3].scale, Vec3(1.0, 1.0, 1.0));
}

TEST_F(SceneFolder, FilesThatAreNoSceneAreRefusedInOneLine) {
  const std::string missing = (folder_ / "none.yaml").string();
  EXPECT_EQ(fileRefusal(missing).rfind(missing + ": No such file", 0), 0U) << fileRefusal(missing);
  EXPECT_NE(fileRefusal(folder_.string()).find("is a folder"), std::string::npos);
  const std::string broken = write("broken.yaml", "tissue:\n  spacing: [1, 2\nsolver: {}\n");
  EXPECT_EQ(fileRefusal(broken).rfind(broken + ":3: not YAML", 0), 0U) << fileRefusal(broken);
  const std::string empty = write("empty.yaml", "");
  EXPECT_NE(fileRefusal(empty).find("(nothing)"), std::string::npos) << fileRefusal(empty);
  const std::string two = write("two.yaml", kRunnerScene + "---\n" + kRunnerScene);
  EXPECT_NE(fileRefusal(two).find("2 YAML documents"), std::string::npos) << fileRefusal(two);
  for (const std::string& path : {missing, folder_.string(), broken, empty, two}) {
    EXPECT_EQ(fileRefusal(path).find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace robot_tissue::test_good_scene
