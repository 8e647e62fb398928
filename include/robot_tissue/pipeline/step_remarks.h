// What a step of the pipeline has to say of its tools and the tissue, in words: for the node's
// state and the runner's remarks.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"

namespace robot_tissue {

struct StepRemark {
  enum class Kind {
    kInside,
    kHooked,
    kJammed,
    kTornOff,
    kTooFast,
    kLost,
    kBeyondLaw,
    kAdrift,
    kJawsMeet,
    kHoldsNothing,
    kDrills
  };
  Kind kind = Kind::kInside;
  std::string text;  // a line that names the tools
};

// Of the last step, in the order of the kinds; none when there is nothing to say.
std::vector<StepRemark> remarksOn(const Pipeline& pipeline);

// Where the law `fung` would overflow; empty: nowhere.
std::string remarkOnLaw(const Tissue& tissue);

// Loads whose force acts on tissue that nothing holds; empty: there are none.
std::string remarkOnAdrift(const Tissue& tissue);

// "'probe'", "'probe' and 'hook'", "'a', 'b' and 'c'": these of the tools; "a tool" without any.
std::string namesOf(const std::vector<std::size_t>& numbers,
                    const std::vector<ToolGeometry>& tools);

}  // namespace robot_tissue
