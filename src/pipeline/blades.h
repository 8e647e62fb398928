// Tools with an edge: what they cut on their way, and what that takes of force.
//
// The way of an edge is gone in strides (strides.h). At the end of each, what the edge swept on it
// is cut in the shape as it is then, and the tissue comes to balance. What is left of the way, less
// than a stride, is cut with the next one.
//
// A spring that goes is new surface at once, of a spacing's length; the edge pays for it while it
// goes on by one spacing: force = resistance * area / spacing, against its motion. Over that way
// its work is resistance * area.
#pragma once

#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "strides.h"
#include "world.h"

namespace robot_tissue {

// What is left to be paid of one cut.
struct CutDebt {
  double force = 0.0;  // N
  double way = 0.0;    // m
};

// Of one tool; nothing of it is used for tools without an edge.
struct BladeState {
  Strides strides;                // of the first link
  std::vector<Pose> path;         // since the end of the last stride
  Vec3 point = Vec3::Zero();      // where it cut last, tool frame (m)
  Vec3 direction = Vec3::Zero();  // of the point's motion, unit, tissue frame
  std::vector<CutDebt> debts;

  const Pose& stands() const { return strides.stands.front(); }  // tissue_T_tool
};

class Blades {
 public:
  explicit Blades(World& world) : world_(world) {}

  // They stand nowhere.
  void forget() { states_.assign(world_.tools.size(), BladeState()); }
  const std::vector<BladeState>& states() const { return states_; }
  void restore(const std::vector<BladeState>& states) { states_ = states; }

  // They go to their place in the pose, from where they were last. A tool that comes from nowhere,
  // or jumped, cuts nothing on its way. False: there was no time for all of the way; the pose has
  // where they came to.
  bool goTo(RobotPose& pose);

  // Puts the wrench of cutting in the report of a tool with an edge.
  void describe(std::size_t tool, ToolReport& report) const;

 private:
  bool goTo(std::size_t tool, RobotPose& pose);
  void comeIn(std::size_t tool, BladeState& state) const;
  void moveTo(const Pose& pose, BladeState& state) const;
  void cutAlongPath(std::size_t tool, BladeState& state);
  std::vector<CutTriangle> sweptBy(std::size_t tool, const std::vector<Pose>& path) const;

  World& world_;
  std::vector<BladeState> states_;
};

}  // namespace robot_tissue
