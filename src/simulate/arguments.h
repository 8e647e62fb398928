// The runner's command line.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue {

struct Arguments {
  std::string scene;
  std::string out;
  SolverOverrides overrides;
  std::optional<double> max_seconds;  // of the wall's clock, of the whole run
  bool list_methods = false;
  bool list_models = false;
  bool quiet = false;
  bool help = false;

  bool onlyPrints() const { return help || list_methods || list_models; }
};

// Throws InputError, one line. Values of overrides are checked with the scene.
Arguments parseArguments(const std::vector<std::string>& arguments);

std::string helpText();

}  // namespace robot_tissue
