// check_setup SCENE.yaml [--urdf FILE]: what would keep a scene, and the robot beside it, from
// running well; a line each with its remedy.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "finding.h"
#include "robot_tissue/ros/node_parameters.h"

namespace robot_tissue {

constexpr int kFine = 0;
constexpr int kHasWarnings = 1;
constexpr int kCannotRun = 2;

// What is known of the robot that runs.
struct Robot {
  std::optional<std::string> urdf;
  Findings findings;  // of its description and transforms
};
using LookAtRobot = std::function<Robot(const NodeParameters& parameters)>;

// `look` is asked where --urdf does not tell the description. Returns the exit code.
int checkSetup(const std::vector<std::string>& words, const LookAtRobot& look, std::ostream& out,
               std::ostream& err);

}  // namespace robot_tissue
