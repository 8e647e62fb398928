// The straight line of one update:
//   robot pose -> contacts -> loading patches -> solve (-> publish, in the ros layer)
// Contacts at a pose look at the shape of the step before. A motion longer than the method follows
// well is walked in substeps.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/core/tool_patches.h"

namespace robot_tissue {

// What one tool met, after the solve.
struct ToolReport {
  Vec3 force_on_tool = Vec3::Zero();   // of the tissue on the tool, tool frame (N)
  Vec3 torque_on_tool = Vec3::Zero();  // about the tool's origin, tool frame (N m)
  std::vector<int> nodes;              // of its patch
  Vec3 point = Vec3::Zero();           // centroid of those, tissue frame (m)
  Vec3 normal = Vec3::Zero();          // from the tool into the tissue, tissue frame
  double max_penetration = 0.0;        // deepest point of the surface inside the tool (m)
};

struct StepReport {
  bool changed = false;  // false: nothing moved, nothing was solved
  bool too_fast = false;  // the tools jumped further than can be followed; contact began anew
  int substeps = 0;
  double contact_ms = 0.0;
  double solve_ms = 0.0;
  SolveReport solve;              // the last one
  std::vector<ToolReport> tools;  // in the order of the tools
};

class Pipeline {
 public:
  // Throws InputError.
  Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
           const std::vector<ToolGeometry>& tools);

  // Puts other tools in the place of the present ones; what these held is let go.
  void setTools(const std::vector<ToolGeometry>& tools);
  // One line each, e.g. a mesh of which only the convex hull is used.
  const std::vector<std::string>& toolWarnings() const { return finder_.warnings(); }

  // Follows the tools to their new pose. Poses with a non-finite number throw InputError.
  const StepReport& step(const RobotPose& pose);
  // Rest shape; the tools are met anew at the next step.
  void reset();
  // To be called after the tissue changed by other means (cut, load): the reports are brought up to
  // date at the next step even if the tools stand still.
  void touch() { touched_ = true; }

  Tissue& tissue() { return tissue_; }
  const Tissue& tissue() const { return tissue_; }
  const StepReport& report() const { return report_; }

 private:
  void advance(const RobotPose& pose);
  ContactSet contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement);
  void solve();
  void pushToolsOut(const RobotPose& pose);
  std::vector<RobotPose> substepsTo(const RobotPose& pose);
  void describeTools(const RobotPose& pose, const ContactSet& contacts);

  Tissue tissue_;
  ContactFinder finder_;
  ToolPatches patches_;
  std::optional<RobotPose> last_pose_;
  bool touched_ = true;
  std::vector<Vec3> vertices_;
  StepReport report_;
};

}  // namespace robot_tissue
