// Options of the programs that have Bullet solve a scene.
#pragma once

#include <cmath>
#include <cstdlib>
#include <string>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/command_line.h"

namespace robot_tissue {

// > 0. Throws InputError.
inline double numberOf(const CommandLine& line, const std::string& option, double otherwise) {
  const auto text = line.value(option);
  if (!text) return otherwise;
  char* end = nullptr;
  const double number = std::strtod(text->c_str(), &end);
  if (end == text->c_str() || *end != '\0' || !(number > 0.0) || !std::isfinite(number)) {
    throw InputError(option + ": is " + *text + ", must be a number > 0");
  }
  return number;
}

inline int wholeNumberOf(const CommandLine& line, const std::string& option, int otherwise) {
  return static_cast<int>(std::ceil(numberOf(line, option, otherwise)));
}

}  // namespace robot_tissue
