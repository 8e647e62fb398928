// How the node is, in the words of TissueState.msg.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/pipeline/step_remarks.h"

namespace robot_tissue {

struct NodeStatus {
  std::string status = "OK";
  std::string message;
};

// After an update at a good pose, with the remarks on it (remarksOn). The first word that applies;
// the message has all.
NodeStatus statusOf(const Pipeline& pipeline, const std::vector<StepRemark>& remarks);

// What the answer of a service ends with, whose last solve this is: nothing where it is in balance,
// else "; " and the status.
std::string endOfAnswer(const SolveReport& solve, const Pipeline& pipeline);

}  // namespace robot_tissue
