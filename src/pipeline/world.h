// The tissue and the tools beside it: what all parts of the pipeline see.
#pragma once

#include <optional>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "robot_tissue/coupling/sticking_contacts.h"
#include "robot_tissue/pipeline/step_report.h"
#include "tool_set.h"

namespace robot_tissue {

// A shortest load step that no shape followed.
struct DeadEnd {
  RobotPose from;
  RobotPose to;
};

struct World {
  World(const TissueConfig& tissue, const SolverConfig& solver);

  void setTools(const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports);

  Tissue tissue;
  ToolSet tools;
  ContactFinder finder;       // of tools and supports
  StickingContacts sticking;  // of tools with rigid patches, and graspers
  SlidingContacts sliding;    // of the other tools, and supports
  bool has_supports = false;
  RobotPose pose;   // of the load step under way, or the last that a shape followed
  RobotPose asked;  // where the tools are
  // Where they are for the tissue (Pipeline::pose); none before the first step.
  std::optional<RobotPose> last_pose;
  std::optional<DeadEnd> dead_end;  // none: the tissue has changed since
  bool unfinished = false;  // the last load step had no time for all that it would have done
  Deadline deadline;        // of the call under way
  StepReport report;
};

// What the patch of a tool or support exerts on the tissue; zero when it has none.
PatchAnswer answerOf(const World& world, std::size_t tool);
ForceBalance forceBalanceOf(const World& world);
// Of each tool that holds or pushes, and of each support that is near.
std::vector<LoadingPatch> patchesOfTools(const World& world);
// Supports are no tools: they alone disturb nothing.
bool anyToolIn(const std::vector<LoadingPatch>& patches, const World& world);

}  // namespace robot_tissue
