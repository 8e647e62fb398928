// Wrong parameters and robot descriptions: the node ends with exit code 2 and one line that names
// the key. Each case starts a node of its own.
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "robot_tissue/ros/node_parameters.h"

namespace robot_tissue::test_bad_parameters {
namespace {

struct Ended {
  int exit_code = -1;
  std::string output;
};

struct Case {
  const char* name;
  const char* key;  // private parameter to set
  XmlRpc::XmlRpcValue value;
  const char* names;  // what the message must hold
};

class BadArgument : public ::testing::Test {
 protected:
  static Ended runNode(const std::string& name, const std::string& argument = "") {
    const std::string command =
        std::string("timeout 20 ") + NODE_PATH + " " + argument + " __name:=" + name + " 2>&1";
    Ended ended;
    FILE* pipe = popen(command.c_str(), "r");
    char buffer[512];
    while (fgets(buffer, sizeof(buffer), pipe) != nullptr) ended.output += buffer;
    ended.exit_code = WEXITSTATUS(pclose(pipe));
    return ended;
  }
};

class BadParameter : public BadArgument, public ::testing::WithParamInterface<Case> {};

TEST_P(BadParameter, EndsTheNodeWithALineThatNamesIt) {
  const std::string name = std::string("bad_") + GetParam().name;
  XmlRpc::XmlRpcValue scene;
  ASSERT_TRUE(ros::param::get("/good_scene", scene));
  ros::param::set("/" + name, scene);
  ros::param::set("/" + name + "/" + GetParam().key, GetParam().value);
  const Ended ended = runNode(name);
  EXPECT_EQ(ended.exit_code, 2) << ended.output;
  EXPECT_NE(ended.output.find(GetParam().names), std::string::npos) << ended.output;
}

// As one writes it who knows `simulate`.
TEST_F(BadArgument, EndsTheNodeWithALineThatSaysHowASceneIsGiven) {
  const Ended ended = runNode("with_an_argument", "scene.yaml");
  EXPECT_EQ(ended.exit_code, 2) << ended.output;
  EXPECT_NE(ended.output.find("'scene.yaml': an argument; allowed: none but"), std::string::npos)
      << ended.output;
}

INSTANTIATE_TEST_SUITE_P(
    Node, BadParameter,
    ::testing::Values(Case{"spacing", "tissue/spacing", -0.005, "tissue.spacing = -0.005"},
                      Case{"ratio", "tissue/spacing", 0.03, "tissue.spacing = 0.03"},
                      Case{"model", "tissue/model", "jelly", "tissue.model = jelly"},
                      Case{"method", "solver/method", "jacobi", "solver.method = jacobi"},
                      Case{"unknown_key", "tissue/sapcing", 0.005, "tissue.sapcing"},
                      Case{"own_unknown_key", "ratee", 100, "ratee"},
                      Case{"quoted", "tissue/spacing", "0.005", "tissue.spacing = \"0.005\""},
                      Case{"truth", "tissue/spacing", true, "tissue.spacing = true"},
                      Case{"own_quoted", "rate", "50", "rate = \"50\""},
                      Case{"own_truth", "tf_timeout", true, "tf_timeout = true"},
                      Case{"rate", "rate", 0, "rate = 0"},
                      Case{"wrench_rate", "wrench_rate", 1001, "wrench_rate = 1001"},
                      Case{"seldom_wrenches", "wrench_rate", 1e-10,
                           "wrench_rate = 1e-10: must be 0, for one an update, or 0.01 Hz"},
                      Case{"greatest", "tissue/spacing", std::numeric_limits<double>::max(),
                           "tissue.spacing = 1.797693134862315"},
                      Case{"least", "tissue/spacing", std::numeric_limits<double>::denorm_min(),
                           "tissue.spacing = 4.940656458412"},
                      Case{"negative_wrench_rate", "wrench_rate", -1, "wrench_rate = -1"},
                      Case{"scene_file", "scene_file", "scene.yaml", "scene_file = scene.yaml"},
                      Case{"color", "color", "rainbow", "color = rainbow"},
                      Case{"timeout", "tf_timeout", -1, "tf_timeout = -1"},
                      Case{"diagnostics", "diagnostic_period", -1, "diagnostic_period = -1"},
                      Case{"description", "robot_description_param", "/broken_description", "URDF"},
                      Case{"no_text", "robot_description_param", "/number_description",
                           "'/number_description' (~robot_description_param) is no text"},
                      Case{"other_robot", "robot_description_param", "/other_description",
                           "probe"}),
    [](const ::testing::TestParamInfo<Case>& one) { return std::string(one.param.name); });

// rosparam makes words of numbers that YAML 1.2, and so the runner, has.
TEST(GoodParameter, NumbersThatRosparamMakesWordsOfAreTaken) {
  XmlRpc::XmlRpcValue scene;
  ASSERT_TRUE(ros::param::get("/good_scene", scene));
  scene["tissue"]["shape"]["min"][0] = "-.05";
  scene["tissue"]["shape"]["max"][0] = "+.5e-1";
  scene["tissue"]["material"]["young_modulus"] = "1e4";
  ros::param::set("/good_numbers", scene);
  const NodeParameters parameters = readNodeParameters(ros::NodeHandle("/good_numbers"));
  EXPECT_EQ(parameters.scene.tissue.shape.min().x(), -0.05);
  EXPECT_EQ(parameters.scene.tissue.shape.max().x(), 0.05);
  EXPECT_EQ(parameters.scene.tissue.material.young_modulus, 1e4);
}

// The good scene with one parameter more, as that node reads it.
NodeParameters readAs(const std::string& node, const std::string& key, const std::string& value) {
  XmlRpc::XmlRpcValue scene;
  EXPECT_TRUE(ros::param::get("/good_scene", scene));
  if (!key.empty()) scene[key] = value;
  ros::param::set(node, scene);
  return readNodeParameters(ros::NodeHandle(node));
}

TEST(GoodParameter, EachNodeKeepsStatesInAFolderOfItsOwn) {
  std::set<std::string> folders;
  for (const char* node : {"/left/organ", "/left_organ", "/organ", "/left/organ/organ"}) {
    const std::filesystem::path folder = readAs(node, "", "").state_dir;
    EXPECT_TRUE(folder.is_absolute());
    EXPECT_EQ(folder.parent_path().filename(), "robot_tissue");
    folders.insert(folder);
  }
  EXPECT_EQ(folders.size(), 4U);
  EXPECT_EQ(readAs("/organ", "state_dir", "/tmp/kept here").state_dir, "/tmp/kept here");
}

TEST(GoodParameter, AFrameThatIsPlacedForNothingIsToldInALine) {
  EXPECT_TRUE(readAs("/organ", "", "").scene.remarks.empty());
  EXPECT_TRUE(readAs("/organ", "placed_frame", "tissue").scene.remarks.empty());
  for (const char* frame : {"bed", ""}) {
    const std::vector<std::string> remarks = readAs("/organ", "placed_frame", frame).scene.remarks;
    ASSERT_EQ(remarks.size(), 1U) << frame;
    for (const std::string& names : {std::string("`place`"), std::string("'tissue'"),
                                     std::string("tissue.frame_id"), std::string(frame)}) {
      EXPECT_NE(remarks[0].find(names), std::string::npos) << remarks[0];
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_bad_parameters
