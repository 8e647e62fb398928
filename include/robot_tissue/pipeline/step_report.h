// What an update of the pipeline came to.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// What one tool met, after the solve. Its frame is that of its first link.
struct ToolReport {
  Vec3 force_on_tool = Vec3::Zero();   // of the tissue on the tool, tool frame (N)
  Vec3 torque_on_tool = Vec3::Zero();  // about the tool's origin, tool frame (N m)
  bool saturated = false;              // the wrench was longer than the tool's max_force
  double told_share = 1.0;             // of the wrench; less than 1 where it is saturated
  std::vector<int> nodes;              // of its patch: held, or under a touch that pushes
  int contacts = 0;                    // touches that push, and held nodes
  Vec3 point = Vec3::Zero();           // centroid of those, tissue frame (m)
  // Unit where `contacts` > 0, from the tool into the tissue, tissue frame: the mean by force over
  // the touches or, where these cancel out, that of the hardest. Jaws press from two sides: of a
  // grasper, of the first jaw that touches or holds.
  Vec3 normal = Vec3::Zero();
  double max_penetration = 0.0;  // deepest point of the tool inside the surface (m)
  bool grasps = false;
  // A grasper's jaws touch each other or are inside one another, and were not always: those that
  // are never apart have a hinge in common.
  bool jaws_overlap = false;
  std::optional<double> jaw_gap;  // of a grasper, where tissue is between its jaws or held (m)
  std::string holds_nothing;      // of a grasper whose jaws are closed, or press: why; else empty
  Vec3 offset = Vec3::Zero();     // of a tool that a force drives, from its pose, tissue frame (m)
  bool unanswered = false;        // nothing met its force on all of its way
};

// Lists of tools are of their numbers, each once.
struct StepReport {
  bool changed = false;   // false: the shape is as it was
  bool too_fast = false;  // the tools moved further than could be followed in time
  bool lost = false;      // no shape could follow the tools: the last good one stays
  bool hopeless = false;  // load steps take far too long again and again (limitPatience)
  bool late = false;      // it ran out of its time before the shape was in balance
  bool gave_up = false;   // late again and again where the tools stand: it ends
  // Where too_fast or lost: tools not yet at their pose. Those that are nowhere near the tissue on
  // their way always are.
  std::vector<std::size_t> behind;
  // Too far to be followed: let go, and came in anew. With rigid patches all tools did.
  std::vector<std::size_t> jumped;
  std::vector<std::size_t> were_inside;  // appeared inside the tissue and came in from outside
  std::vector<std::size_t> hooked;  // dragged tissue away that they stood through, and let go of it
  // No shape followed them, or those that they meet: let go, and came in anew from outside.
  std::vector<std::size_t> jammed;
  // Were behind in the tissue, and are clear of it where the robot has them: it let go of them.
  std::vector<std::size_t> left;
  std::vector<std::size_t> torn_off;    // graspers that lost what they held
  std::vector<std::size_t> torn_out;    // graspers that took out what they held
  int springs_cut = 0;                  // by blades
  double area_cut = 0.0;                // new surface of these cuts (m^2)
  double volume_removed = 0.0;          // by burrs, at rest (m^3)
  std::vector<std::string> lost_loads;  // named loads of which they left nothing
  std::vector<std::size_t>
      would_take_all;  // burrs that removed nothing, as it was all that is left
  int springs_torn = 0;
  int substeps = 0;  // load steps that the way took
  double contact_ms = 0.0;
  double solve_ms = 0.0;
  std::vector<ToolReport> tools;  // in the order of the tools
};

// Sums of the forces on the tissue (N, tissue frame).
struct ForceBalance {
  Vec3 tools = Vec3::Zero();
  Vec3 supports = Vec3::Zero();
  Vec3 loads = Vec3::Zero();  // named patches
  Vec3 fixed = Vec3::Zero();  // nodes
  Vec3 weight = Vec3::Zero();
  Vec3 unbalanced() const { return tools + supports + loads + fixed + weight; }
};

}  // namespace robot_tissue
