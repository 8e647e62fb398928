// The straight line of one update:
//   robot pose -> contacts -> loading patches -> solve (-> publish, in the ros layer)
// Contacts at a pose look at the shape of the step before.
//
// The tools' way is walked in load steps of a fixed length, the longest that the method follows
// well. What is left of the way, less than a step, is solved from the end of the last whole step,
// and anew at the next update: so the shape depends on the way, not on the rate of the updates.
// The shapes at the ends of the steps are kept while a tool touches: going back the way it came, it
// finds the shapes that it left. A tool that appears inside the tissue is walked in from outside.
#pragma once

#include <limits>
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
  bool changed = false;   // false: the shape is as it was
  bool too_fast = false;  // the tools moved further than could be followed in time
  int substeps = 0;       // solves that the way took
  double contact_ms = 0.0;
  double solve_ms = 0.0;
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
  // Time that a step may take (s), after which it leaves the rest of the way to the next one.
  void setBudget(double seconds) { budget_s_ = seconds; }
  // Rest shape; at the next step the tools come in from outside.
  void reset();
  // To be called after the tissue changed by other means (cut, load).
  void touch();

  Tissue& tissue() { return tissue_; }
  const Tissue& tissue() const { return tissue_; }
  const StepReport& report() const { return report_; }

 private:
  // Where a whole load step ended.
  struct Checkpoint {
    RobotPose pose;
    Tissue::Shape shape;
    ToolPatches::Seats seats;
  };

  RobotPose walk(const RobotPose& pose);
  void advance(const RobotPose& pose);
  void checkIn(const RobotPose& pose);
  void goBackTo(const RobotPose& pose);
  void startAnew(const RobotPose& pose);
  RobotPose outside(const RobotPose& pose);
  Vec3 wayOut(std::size_t tool, const Pose& tissue_T_tool);
  bool standsStill(const RobotPose& pose) const;
  double longestWay(const RobotPose& from, const RobotPose& to) const;
  ContactSet contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement);
  void carryOn();
  void solve();
  void pushToolsOut(const RobotPose& pose);
  void describeTools(const RobotPose& pose, const ContactSet& contacts);

  Tissue tissue_;
  ContactFinder finder_;
  ToolPatches patches_;
  std::optional<RobotPose> last_pose_;
  std::vector<Checkpoint> checkpoints_;
  double budget_s_ = std::numeric_limits<double>::infinity();
  bool touched_ = true;  // the reports are to be brought up to date
  std::vector<Vec3> vertices_;
  StepReport report_;
};

}  // namespace robot_tissue
