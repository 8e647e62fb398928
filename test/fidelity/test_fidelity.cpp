// The program as a function: exit codes, what it says, the scene it writes.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "fidelity.h"
#include "fidelity_fixtures.h"
#include "write_scene.h"

namespace robot_tissue::test_fidelity {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

class Fidelity : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "fidelity_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    std::ofstream(folder_ / "press.yaml") << blockText("0.02") << kPress;
    std::ofstream(folder_ / "still.yaml") << blockText("0.02") << "steps:\n  - settle: {}\n";
    std::ofstream(folder_ / "springs.yaml")
        << "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [0.02, 0.02, 0.02]}\n"
           "  spacing: 0.01\n  model: six_spring\n  material: {young_modulus: 1.0e4}\n";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  static Outcome program(const std::vector<std::string>& words, bool terminal = false) {
    std::ostringstream out, err;
    const int code = fidelity(words, out, err, terminal);
    return {code, out.str(), err.str()};
  }
  static void expectRefused(const std::vector<std::string>& words, const std::string& fragment) {
    const Outcome outcome = program(words);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(fragment), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }

  fs::path folder_;
};

TEST_F(Fidelity, WritesTheSceneWithTheCheapestThatMeetsBoth) {
  const Outcome outcome = program({path("press.yaml"), "--error", "0.9", "--rate", "0.01",
                                   "--seconds", "3", "--write", path("out.yaml")});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("cheapest within 90 %"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("six_spring"), std::string::npos) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  const Scene written = loadScene(path("out.yaml"));
  EXPECT_EQ(written.solver.method, "layered");
  EXPECT_EQ(written.steps.size(), 1U);
  std::ifstream file(folder_ / "out.yaml");
  const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  EXPECT_EQ(text.rfind("# a block\n", 0), 0U) << text;
}

TEST_F(Fidelity, SaysWhatCanBeMetWhereNotBothCan) {
  const Outcome outcome = program({path("press.yaml"), "--error", "1e-6", "--rate", "1e9",
                                   "--seconds", "2", "--write", path("out.yaml")});
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  for (const char* fragment : {"none meets", "nearest:", "fastest within", "least error at"}) {
    EXPECT_NE(outcome.out.find(fragment), std::string::npos) << outcome.out;
  }
  EXPECT_FALSE(fs::exists(folder_ / "out.yaml"));
}

TEST_F(Fidelity, ShowsProgressOnATerminalAlone) {
  const std::vector<std::string> words = {path("press.yaml"), "--error", "0.5",
                                          "--rate",           "1",       "--seconds=2"};
  EXPECT_NE(program(words, true).err.find("[#"), std::string::npos);
  EXPECT_EQ(program(words, false).err, "");
}

TEST_F(Fidelity, BadInputIsRefusedInOneLine) {
  const std::string scene = path("press.yaml");
  expectRefused({}, "SCENE.yaml is missing");
  expectRefused({scene, "--error", "0.1"}, "--rate is missing");
  expectRefused({scene, "--error", "0", "--rate", "1"},
                "--error = 0: must be a number from 1e-09 to 1");
  expectRefused({scene, "--error", "0.1", "--rate", "fast"}, "--rate = fast: must be a number");
  expectRefused({scene, "--error", "0.1", "--rate", "1", "--second", "3"},
                "did you mean --seconds");
  expectRefused({scene, "--error", "0.1", "--rate", "1", "--method", "paper"}, "must be one of");
  expectRefused({scene, "--error", "0.1", "--rate", "1", "--write", path("no/out.yaml")},
                "must be a file that can be written");
  expectRefused({path("none.yaml"), "--error", "0.1", "--rate", "1"}, "No such file");
  expectRefused({path("springs.yaml"), "--error", "0.1", "--rate", "1"}, "must be elastic");
  expectRefused({path("still.yaml"), "--error", "0.1", "--rate", "1"}, "nothing moved");
}

const Rung kRung{"layered", 0.005, 0.03};

std::string rewritten(const std::string& text) { return withRung(text, kRung, "/a", "/a"); }

TEST(WithRung, ChangesThreeValuesAndNothingElse) {
  const std::string text =
      "# first\ntissue:\n  spacing: 0.01   # m\nsolver:\n  # mine\n  tolerance: 0.2  # loose\n"
      "  method: newton\n";
  EXPECT_EQ(rewritten(text),
            "# first\ntissue:\n  spacing: 0.005   # m\nsolver:\n  # mine\n  tolerance: 0.03  # "
            "loose\n  method: layered\n");
}

TEST(WithRung, AddsWhatIsMissing) {
  EXPECT_EQ(rewritten("tissue: {spacing: 1}  # a"),
            "tissue: {spacing: 0.005}  # a\nsolver: {method: layered, tolerance: 0.03}\n");
  EXPECT_EQ(rewritten("solver:\n  max_ms: 3  # b\ntissue: {spacing: 1}\n"),
            "solver:\n  method: layered\n  tolerance: 0.03\n  max_ms: 3  # b\n"
            "tissue: {spacing: 0.005}\n");
  EXPECT_EQ(rewritten("solver: {tolerance: 1}\ntissue: {spacing: 1}\n"),
            "solver: {method: layered, tolerance: 0.03}\ntissue: {spacing: 0.005}\n");
}

TEST(WithRung, KeepsKeysAndValuesWhereTheTextCannotBeKept) {
  for (const std::string text :
       {"{tissue: {spacing: 0.01, gravity: [0, 0, -9.81]}}",
        "solver:\ntissue: {spacing: 0.01, "
        "gravity: [0, 0, -9.81]}\n",
        "tissue: {spacing: &h 0.01, gravity: [0, 0, -9.81], other: *h}\n"}) {
    const YAML::Node root = YAML::Load(rewritten(text));
    EXPECT_EQ(root["tissue"]["spacing"].as<double>(), 0.005) << text;
    EXPECT_EQ(root["tissue"]["gravity"][2].as<double>(), -9.81);
    EXPECT_EQ(root["solver"]["method"].as<std::string>(), "layered");
    EXPECT_EQ(root["solver"]["tolerance"].as<double>(), 0.03);
    if (root["tissue"]["other"].IsDefined()) {
      EXPECT_EQ(root["tissue"]["other"].as<double>(), 0.01);
    }
  }
}

TEST(WithRung, MeshesAreFoundFromAnotherFolder) {
  const std::string text = "tissue: {spacing: 1, shape: {resource: meshes/a.stl}}\n";
  const YAML::Node root = YAML::Load(withRung(text, kRung, "/a/b", "/a/c"));
  EXPECT_EQ(root["tissue"]["shape"]["resource"].as<std::string>(), "../b/meshes/a.stl");
  const std::string region =
      "tissue: {spacing: 1, regions: [{shape: {type: mesh, resource: meshes/a.stl}}]}\n";
  const YAML::Node with_region = YAML::Load(withRung(region, kRung, "/a/b", "/a/c"));
  EXPECT_EQ(with_region["tissue"]["regions"][0]["shape"]["resource"].as<std::string>(),
            "../b/meshes/a.stl");
  const std::string package = "tissue: {spacing: 1, shape: {resource: 'package://p/a.stl'}}\n";
  EXPECT_NE(withRung(package, kRung, "/a/b", "/a/c").find("package://p/a.stl"), std::string::npos);
}

}  // namespace
}  // namespace robot_tissue::test_fidelity
