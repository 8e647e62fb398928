// A tool whose shapes are the scene's own needs a transform, and no robot.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "node_fixture.h"

namespace robot_tissue::test_no_robot {
namespace {

class NoRobot : public NodeTest {};

TEST_F(NoRobot, ShapesOfTheSceneAreEnough) {
  ASSERT_TRUE(waitFor([this] { return state_ && state_->status == "OK"; }))
      << (state_ ? state_->message : "");
  EXPECT_LT(press(0.004).wrench.force.z, -0.1);
  EXPECT_EQ(said_.count("NO_ROBOT"), 0U);
}

// Nor is one missed before the node is started.
TEST_F(NoRobot, CheckSetupMissesNone) {
  const std::string file = (std::filesystem::path(::testing::TempDir()) / "no_robot.yaml").string();
  std::ofstream(file) << "tissue:\n"
                         "  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}\n"
                         "  spacing: 0.01\n"
                         "  material: {young_modulus: 10000.0}\n"
                         "  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]\n"
                         "tools:\n"
                         "  - {name: probe, link: probe, shapes: [{type: sphere, radius: 0.01}]}\n";
  const std::string command = std::string(CHECK_SETUP_PATH) + " " + file + " 2>&1; echo ended $?";
  FILE* output = popen(command.c_str(), "r");
  ASSERT_NE(output, nullptr);
  fcntl(fileno(output), F_SETFL, O_NONBLOCK);
  std::string said;
  EXPECT_TRUE(waitFor([&] {  // with the transforms that it looks for
    char buffer[1024];
    const ssize_t count = read(fileno(output), buffer, sizeof(buffer));
    if (count > 0) said.append(buffer, static_cast<std::size_t>(count));
    return said.find("ended ") != std::string::npos;
  })) << said;
  pclose(output);
  EXPECT_NE(said.find("ended 0"), std::string::npos) << said;
  EXPECT_EQ(said.find("robot_description"), std::string::npos) << said;
}

}  // namespace
}  // namespace robot_tissue::test_no_robot
