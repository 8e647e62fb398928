// What check_setup has to say: one line each, with its remedy.
#pragma once

#include <string>
#include <vector>

namespace robot_tissue {

struct Finding {
  enum class Level { kNote, kWarning, kError };  // an error: the node could not run
  Level level = Level::kNote;
  std::string text;    // one line
  std::string remedy;  // what to do; empty: nothing
};
using Findings = std::vector<Finding>;

}  // namespace robot_tissue
