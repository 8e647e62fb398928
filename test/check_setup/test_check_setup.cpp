// check_setup: what it finds, its remedies and its exit codes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "../core/mesh_fixtures.h"
#include "../scene/mesh_files.h"
#include "check_setup.h"
#include "trial_press.h"

namespace robot_tissue {
namespace {

const std::string kHead = "tissue:\n  shape: ";
const std::string kBlock = "{type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}";
const std::string kRest =
    "\n  material: {young_modulus: 10000.0}\n"
    "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n";
const std::string kTool = "tools: [{link: tip, shapes: [{type: sphere, radius: 0.01}]}]\n";

std::string urdfOf(const std::string& geometry) {
  const std::string collision =
      geometry.empty() ? "" : "<collision><geometry>" + geometry + "</geometry></collision>";
  return "<robot name='r'><link name='base'/><link name='tip'>" + collision +
         "</link><joint name='j' type='fixed'><parent link='base'/><child link='tip'/></joint>"
         "</robot>";
}

class CheckSetup : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ("check_setup_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
               ::testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  // A box of these measures as a mesh, turned about y.
  void writeMesh(const std::string& name, double x, double y, double z, double angle = 0.0) const {
    std::ostringstream text;
    for (const int corner : {0, 1, 2, 3, 4, 5, 6, 7}) {
      const double along = x * (corner & 1), up = z * ((corner >> 2) & 1);
      text << "v " << std::cos(angle) * along + std::sin(angle) * up << ' '
           << y * ((corner >> 1) & 1) << ' ' << std::cos(angle) * up - std::sin(angle) * along
           << '\n';
    }
    text << "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\n"
            "f 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
    write(name, text.str());
  }

  int check(const std::string& scene, const std::string& urdf = urdfOf("<sphere radius='0.01'/>")) {
    std::ostringstream out, err;
    const auto look = [&](const NodeParameters&) {
      Robot robot;
      robot.urdf = urdf;
      return robot;
    };
    const int code = checkSetup({write("scene.yaml", scene)}, look, out, err);
    out_ = out.str();
    err_ = err.str();
    return code;
  }

  bool says(const std::string& words) const { return out_.find(words) != std::string::npos; }

  std::filesystem::path folder_;
  std::string out_, err_;
};

TEST_F(CheckSetup, GoodSceneIsFineAndTellsWhatAPressTakes) {
  EXPECT_EQ(check(kHead + kBlock + "\n  spacing: 0.01" + kRest + kTool), kFine) << out_ << err_;
  EXPECT_EQ(out_.find("note: tool 'tip', its link 'tip' with the far end first, pressed 1 mm into "
                      "726 nodes takes "),
            0U)
      << out_;
  EXPECT_EQ(std::count(out_.begin(), out_.end(), '\n'), 1);
  EXPECT_EQ(check(kHead + kBlock + "\n  spacing: 0.01" + kRest), kFine) << out_ << err_;
  EXPECT_EQ(out_.find("note: a sphere of 20 mm radius pressed 1 mm into 726 nodes takes "), 0U)
      << out_;
}

TEST_F(CheckSetup, EachToolWithShapesIsPressedAlsoThoseOfTheRobot) {
  writeMesh("tip.obj", 0.02, 0.02, 0.05);
  const std::string robot =
      urdfOf("<mesh filename='file://" + (folder_ / "tip.obj").string() + "'/>");
  const std::string scene =
      kHead + kBlock + "\n  spacing: 0.01" + kRest + "tools:\n  - {name: hand, link: tip}\n" +
      "  - {name: ball, link: base, shapes: [{type: sphere, radius: 0.01, xyz: [0, 0, 0.1]}]}\n";
  EXPECT_EQ(check(scene, robot), kFine) << out_ << err_;
  EXPECT_TRUE(says("tool 'hand', its link 'tip'") && says("tool 'ball', its link 'base'")) << out_;
  EXPECT_FALSE(says("a sphere")) << out_;
  EXPECT_FALSE(says(" 0 N") || says(" -")) << out_;
}

TEST_F(CheckSetup, MeshOfAThousandMetersLooksLikeMillimeters) {
  writeMesh("organ.obj", 1000.0, 1000.0, 500.0);
  const std::string shape = "{type: mesh, resource: organ.obj}";
  EXPECT_EQ(check(kHead + shape + "\n  spacing: 50.0" + kRest), kHasWarnings) << err_;
  EXPECT_TRUE(
      says("1000 m across, which looks like millimeters; remedy: tissue.shape.scale: 0.001"))
      << out_;
  // Also where the scene is refused for it: 2e16 nodes.
  EXPECT_EQ(check(kHead + shape + "\n  spacing: 0.005" + kRest), kCannotRun);
  EXPECT_TRUE(says("looks like millimeters")) << out_;
  EXPECT_NE(err_.find("spacing"), std::string::npos);
}

TEST_F(CheckSetup, ThinWallsAreMeasured) {
  writeMesh("sheet.obj", 0.06, 0.06, 0.005);
  const std::string rest =
      "\n  material: {young_modulus: 10000.0}\n"
      "  fixed: [{min: [-1, -1, -1], max: [1, 1, 5.0e-4]}]\n";
  const std::string shape = "{type: mesh, resource: sheet.obj}";
  EXPECT_EQ(check(kHead + shape + "\n  spacing: 0.005" + rest), kHasWarnings) << err_;
  EXPECT_TRUE(says("no thicker than a spacing, the thinnest 5 mm")) << out_;
  EXPECT_TRUE(says("remedy: tissue.spacing: 0.0025 or less")) << out_;
  EXPECT_NE(check(kHead + shape + "\n  spacing: 0.0025" + rest), kCannotRun) << out_ << err_;
  EXPECT_FALSE(says("walls")) << out_;
  EXPECT_EQ(check(kHead + "{type: box, min: [0, 0, 0], max: [0.05, 0.05, 0.005]}" +
                  "\n  spacing: 0.005" + kRest),
            kHasWarnings);
  EXPECT_TRUE(says("thinnest 5 mm")) << out_;
}

TEST_F(CheckSetup, ThinObliqueWallsAreMeasured) {
  writeMesh("sheet.obj", 0.06, 0.06, 0.0025, 0.25 * M_PI);
  const std::string shape = "{type: mesh, resource: sheet.obj}",
                    rest =
                        "\n  material: {young_modulus: 10000.0}\n"
                        "  fixed: [{min: [-1, -1, -1], max: [1, 1, -0.03]}]\n";
  EXPECT_EQ(check(kHead + shape + "\n  spacing: 0.005" + rest), kHasWarnings) << err_;
  EXPECT_TRUE(says("bend 71 to 128 % as far")) << out_;
  EXPECT_TRUE(says("tissue.spacing: 0.00125")) << out_;
  EXPECT_NE(check(kHead + shape + "\n  spacing: 0.002" + rest), kCannotRun) << out_ << err_;
  EXPECT_FALSE(says("no thicker than a spacing")) << out_;
  EXPECT_TRUE(says("oblique to the grid and no thicker than three spacings")) << out_;
}

TEST_F(CheckSetup, ToolsAreLookedForInTheRobot) {
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + "tools: [{link: tip}]\n";
  EXPECT_EQ(check(scene), kFine) << out_ << err_;
  EXPECT_EQ(check(scene, urdfOf("")), kHasWarnings);
  EXPECT_TRUE(says("no collision geometry")) << out_;
  EXPECT_EQ(check(scene, urdfOf("<box size='8 8 8'/>")), kHasWarnings);
  EXPECT_TRUE(says("a mesh in millimeters has scale 0.001")) << out_;
  EXPECT_EQ(check(scene, "<robot name='r'><link name='base'/></robot>"), kCannotRun);
  EXPECT_TRUE(says("error: ") && says("'tip'")) << out_;
  EXPECT_TRUE(says("remedy: a link that the robot has")) << out_;
}

TEST_F(CheckSetup, ALinkThatCannotBeReadIsMendedInTheUrdf) {
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + "tools: [{link: tip}]\n";
  EXPECT_EQ(check(scene, urdfOf("<box size='nan 1 1'/>")), kCannotRun);
  EXPECT_TRUE(says("error: robot_description: link 'tip'") && says("remedy: mend the URDF"))
      << out_;
  EXPECT_FALSE(says("a link that the robot has")) << out_;
}

TEST_F(CheckSetup, MeshesOfTheRobotHaveRemediesOfTheirOwn) {
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + "tools: [{link: tip}]\n";
  const auto mesh = [this](const std::string& name) {
    return urdfOf("<mesh filename='file://" + (folder_ / name).string() + "'/>");
  };
  EXPECT_EQ(check(scene, mesh("none.obj")), kCannotRun);
  EXPECT_TRUE(says("remedy: mend that shape") && says("`shapes`")) << out_;
  const TriangleMesh box = boxMesh(Vec3(0.0, 0.0, 0.0), Vec3(0.01, 0.01, 0.01));
  write("tip.dae", daeText(box, "Z_UP", 1.0));
  EXPECT_EQ(check(scene, mesh("tip.dae")), kFine) << out_;
  write("tip.dae", daeText(box, "Y_UP", 0.001));
  EXPECT_EQ(check(scene, mesh("tip.dae")), kHasWarnings);
  EXPECT_TRUE(says("unit 0.001 m and the up axis Y_UP")) << out_;
}

TEST_F(CheckSetup, ToolWithoutALinkAndTissueThatNothingHoldsAreTold) {
  const std::string floating =
      kHead + kBlock + "\n  spacing: 0.01\n  material: {young_modulus: 10000.0}\n";
  EXPECT_EQ(check(floating), kHasWarnings);
  EXPECT_TRUE(says("nothing holds the tissue")) << out_;
  EXPECT_EQ(check(kHead + kBlock + "\n  spacing: 0.01" + kRest +
                      "tools: [{name: probe, shapes: [{type: sphere, radius: 0.01}]}]\n",
                  ""),
            kHasWarnings);
  EXPECT_TRUE(says("'probe' names no link")) << out_;
}

TEST_F(CheckSetup, JawsAreLinksEnough) {
  const std::string geometry =
      "<collision><geometry><box size='0.02 0.004 0.02'/></geometry></collision>";
  const std::string robot = "<robot name='r'><link name='left'>" + geometry +
                            "</link><link name='right'>" + geometry +
                            "</link><joint name='j' type='fixed'><parent link='left'/>"
                            "<child link='right'/></joint></robot>";
  const std::string tools = "tools: [{name: hand, role: grasper, jaws: [left, right]}]\n";
  EXPECT_EQ(check(kHead + kBlock + "\n  spacing: 0.01" + kRest + tools, robot), kFine)
      << out_ << err_;
}

// The node refuses what the runner can do without.
TEST_F(CheckSetup, ScissorsOfTheRobotNeedJaws) {
  const std::string edges =
      "edges: [[[0, 0, 0], [0.02, 0, 0]], [[0, 0, 0], [0.02, 0, 0]]], opening_axis: [0, 0, 1]}]\n";
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + "tools: [";
  EXPECT_EQ(check(scene + "{name: shears, role: scissors, link: tip, " + edges), kCannotRun);
  EXPECT_TRUE(says("error: tools: 'shears' has no jaws")) << out_ << err_;
  EXPECT_TRUE(says("remedy: jaws: ")) << out_;
  EXPECT_EQ(check(scene + "{name: shears, role: scissors, " + edges, ""), kHasWarnings);
  EXPECT_TRUE(says("'shears' names no link")) << out_ << err_;
  check(scene + "{name: shears, role: scissors, jaws: [base, tip], " + edges);
  EXPECT_FALSE(says("has no jaws")) << out_ << err_;
}

TEST_F(CheckSetup, TheRobotsDescriptionIsLookedForWhereTheSceneSays) {
  const std::string scene = write("scene.yaml", kHead + kBlock + "\n  spacing: 0.01" + kRest +
                                                    "robot_description_param: arm\n");
  std::string asked;
  const auto look = [&](const NodeParameters& parameters) {
    asked = parameters.robot_description_param;
    return Robot();
  };
  std::ostringstream out, err;
  checkSetup({scene}, look, out, err);
  EXPECT_EQ(asked, "arm") << err.str();
}

TEST_F(CheckSetup, ANameThatNoParameterHasIsRefused) {
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + kTool;
  for (const char* name : {"a b", "a//b", "\u00e9", "-7.5", "7", "true", "~x", "a/"}) {
    EXPECT_EQ(check(scene + "robot_description_param: " + name + "\n"), kCannotRun) << name;
    EXPECT_NE(err_.find(std::string("robot_description_param = ")), std::string::npos) << err_;
  }
  for (const char* name : {"arm", "/left/robot_description", "left/arm", "'true'"}) {
    EXPECT_EQ(check(scene + "robot_description_param: " + name + "\n"), kFine) << err_;
  }
}

TEST_F(CheckSetup, TheNodesOwnKeysAreTakenAndChecked) {
  const std::string scene = kHead + kBlock + "\n  spacing: 0.01" + kRest + kTool;
  EXPECT_EQ(check(scene + "rate: 50\nwrench_rate: 200\ncolor: strain\n"), kFine) << out_ << err_;
  EXPECT_EQ(check(scene + "rate: 0\n"), kCannotRun) << out_;
  EXPECT_NE(err_.find("rate = 0: must be a number from 0.01"), std::string::npos) << err_;
  EXPECT_EQ(check(scene + "steps: [{settle: {}}]\n"), kFine) << out_ << err_;
}

TEST_F(CheckSetup, BadInputIsOneLineAndExitCodeTwo) {
  EXPECT_EQ(check("tissue: {spacing: 0.01}"), kCannotRun);
  EXPECT_EQ(std::count(err_.begin(), err_.end(), '\n'), 1) << err_;
  std::ostringstream out, err;
  const auto nobody = [](const NodeParameters&) { return Robot(); };
  EXPECT_EQ(checkSetup({}, nobody, out, err), kCannotRun);
  EXPECT_EQ(checkSetup({"a.yaml", "b.yaml"}, nobody, out, err), kCannotRun);
  EXPECT_EQ(checkSetup({"a.yaml", "--urdf"}, nobody, out, err), kCannotRun);
  EXPECT_EQ(checkSetup({"--help"}, nobody, out, err), kFine);
}

TEST_F(CheckSetup, NothingIsSaidOfTheUnitsOfABoxThatIsRefused) {
  EXPECT_EQ(
      check(kHead + "{type: box, min: [0.1, 0.1, 0.1], max: [0, 0, 0]}\n  spacing: 0.01" + kRest),
      kCannotRun);
  EXPECT_EQ(out_, "");
  EXPECT_NE(err_.find("max[0] = 0: must be > min[0] = 0.1"), std::string::npos) << err_;
}

TEST_F(CheckSetup, EachToolIsCheckedByItself) {
  const std::string scene =
      kHead + kBlock + "\n  spacing: 0.01" + kRest +
      "tools: [{name: a, link: none}, {name: b, link: neither}, {link: tip},\n"
      "        {name: c, shapes: [{type: sphere, radius: 0.01}]}]\n";
  EXPECT_EQ(check(scene, urdfOf("<box size='8 8 8'/>")), kCannotRun) << err_;
  EXPECT_TRUE(says("error: tools[0].link: 'none' of tool 'a'")) << out_;
  EXPECT_TRUE(says("error: tools[1].link: 'neither' of tool 'b'")) << out_;
  EXPECT_TRUE(says("a mesh in millimeters has scale 0.001")) << out_;
  // It needs no link of the robot, and is not missed there.
  EXPECT_TRUE(says("warning: tools: 'c' names no link: only simulate runs it")) << out_;
  EXPECT_FALSE(says("of tool 'c' is no link")) << out_;
}

// Also where no tool is of one of its links.
TEST_F(CheckSetup, UrdfThatIsNoneIsRefusedByName) {
  const std::string scene = write("scene.yaml", kHead + kBlock + "\n  spacing: 0.01" + kRest);
  const auto nobody = [](const NodeParameters&) { return Robot(); };
  const std::string xacro =
      "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'><xacro:arm prefix='left'/></robot>";
  const std::vector<std::string> texts = {"", "no XML", "<robot name='r'>", xacro};
  for (const std::string& text : texts) {
    const std::vector<std::string> arguments = {scene, "--urdf", write("robot.urdf", text)};
    std::ostringstream out, err;
    EXPECT_EQ(checkSetup(arguments, nobody, out, err), kCannotRun) << text;
    const std::string told = err.str();
    EXPECT_NE(told.find(" = " + arguments.back()), std::string::npos) << told;
    EXPECT_EQ(told.find("`xacro FILE > robot.urdf`") != std::string::npos, text == xacro) << told;
    EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
  }
}

Scene blockScene(double young_modulus) {
  Scene scene;
  scene.tissue.shape = {Vec3::Zero(), Vec3(0.1, 0.1, 0.05)};
  scene.tissue.spacing = 0.005;
  scene.tissue.material.young_modulus = young_modulus;
  scene.tissue.fixed = {{Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)}};
  return scene;
}

// Of a stiffer tissue in proportion, and the way in is what it says: Hertz is a lower bound of a
// bonded layer of five centimeters.
TEST(TrialPress, ForceGoesWithTheStiffness) {
  const TrialPress soft = pressEach(blockScene(1e4), {}, 60.0).at(0);
  const TrialPress stiff = pressEach(blockScene(3e4), {}, 60.0).at(0);
  EXPECT_TRUE(soft.ended && soft.converged);
  EXPECT_EQ(soft.nodes, 21 * 21 * 11);
  EXPECT_GT(soft.update_ms, 0.0);
  EXPECT_NEAR(stiff.force_n / soft.force_n, 3.0, 0.05);
  const double hertz =
      4.0 / 3.0 * 1e4 / (1.0 - 0.45 * 0.45) * std::sqrt(0.01) * std::pow(1e-3, 1.5);
  EXPECT_GT(soft.force_n, 0.5 * hertz);
  EXPECT_LT(soft.force_n, 2.0 * hertz);
}

// The node would carry such an update on in the next ones.
TEST(TrialPress, AnUpdateIsTimedToItsEndWhateverTimeTheSceneGives) {
  Scene scene = blockScene(1e4);
  scene.solver.max_ms = 1e-3;
  EXPECT_TRUE(pressEach(scene, {}, 60.0).at(0).ended);
  const Findings findings = checkPress(scene, {}, 60.0);
  ASSERT_EQ(findings.size(), 2U);
  EXPECT_NE(findings[1].text.find("an update longer than 0.001 ms"), std::string::npos)
      << findings[1].text;
}

// The ball of the sphere that is pressed where no tool has shapes, at the end of a long link.
TEST(TrialPress, AToolIsPressedByItsFarEnd) {
  ToolShape ball;
  ball.radius = 0.01;
  ball.pose.translation() = Vec3(0.0, 0.1, 0.0);
  ToolGeometry tool;
  tool.name = "probe";
  tool.links = {{"frame", {}}, {"tip", {ball}}};
  const TrialPress sphere = pressEach(blockScene(1e4), {}, 60.0).at(0);
  const std::vector<TrialPress> tools = pressEach(blockScene(1e4), {tool, tool}, 60.0);
  ASSERT_EQ(tools.size(), 2U);
  for (const TrialPress& press : tools) {
    EXPECT_NEAR(press.force_n, sphere.force_n, 0.05 * sphere.force_n);
    EXPECT_NE(press.what.find("'probe', its link 'tip'"), std::string::npos) << press.what;
  }
}

}  // namespace
}  // namespace robot_tissue
