// What a step of the pipeline has to say of its tools, in words: for the node's state and the
// runner's remarks.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

struct StepRemark {
  enum class Kind { kInside, kTornOff, kTooFast, kLost, kJawsMeet, kHoldsNothing, kDrills };
  Kind kind = Kind::kInside;
  std::string text;  // a line that names the tools
};

// Of the last step, in the order of the kinds; none when there is nothing to say.
std::vector<StepRemark> remarksOn(const Pipeline& pipeline);

// "'probe'", "'probe' and 'hook'", "'a', 'b' and 'c'": these of the tools; "a tool" without any.
std::string namesOf(const std::vector<std::size_t>& numbers,
                    const std::vector<ToolGeometry>& tools);

}  // namespace robot_tissue
