// The name of a suture that is given none.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

// The first of s1, s2, ... that no suture of the tissue has.
inline std::string freeSutureName(const Tissue& tissue) {
  const std::vector<SutureReport> sutures = tissue.sutures();
  const auto is_taken = [&](const std::string& name) {
    return std::any_of(sutures.begin(), sutures.end(),
                       [&](const SutureReport& suture) { return suture.name == name; });
  };
  int number = 1;
  while (is_taken("s" + std::to_string(number))) ++number;
  return "s" + std::to_string(number);
}

}  // namespace robot_tissue
