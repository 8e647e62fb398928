// The tissue and the tools beside it: what all parts of the pipeline see. In brackets: which of
// them change it, besides Pipeline, which may change all of it; cutters: Blades, Burrs, Scissors.
// WayLengths, TouchFinder, ToolRims, OverlapResolver, ShapeJudge and what makes reports have it
// const.
#pragma once

#include <optional>
#include <vector>

#include "blade_sides.h"
#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "robot_tissue/coupling/sticking_contacts.h"
#include "robot_tissue/pipeline/step_report.h"
#include "tool_set.h"

namespace robot_tissue {

// A load step of the shortest length that no shape followed, from one pose to the other.
struct DeadEnd {
  RobotPose from;
  RobotPose to;
};

// What steps change of it, but for the tissue: what a trial does is undone by taking a copy back
// (World::takeBack).
struct WorldState {
  // kFar: there is nothing to touch, so it asks for no short load steps. kInside: in tissue, in a
  // wound.
  enum class Edge { kTouches, kFar, kInside };

  // Of tools with rigid patches, and graspers. [LoadStepper, ToolContactUpdate, ToolMotion,
  // Grasping]
  StickingContacts sticking;
  // Of the other tools, and supports.
  // [LoadStepper, ToolContactUpdate, ToolMotion, Grasping, tearStretched, cutters]
  SlidingContacts sliding;
  // Of the load step under way, or the last that a shape followed. [LoadStepper, ToolMotion]
  RobotPose pose;
  RobotPose asked;  // where the robot has the tools, which may be farther [ToolMotion]
  // Where the tools are for the tissue, as Pipeline::pose tells; none before the first step.
  // [ToolMotion]
  std::optional<RobotPose> last_pose;
  // The stamp that the tissue has come to (s); none before the first. [LoadStepper, ToolMotion]
  std::optional<double> reached_s;
  // None: nothing failed since the tissue last changed. [ToolMotion, LoadStepper, cutters]
  std::optional<DeadEnd> dead_end;
  // The last load step had no time for all it would do. [LoadStepper, ToolMotion]
  bool unfinished = false;
  // [LoadStepper, ToolMotion, Grasping, tearStretched, cutters; times: whoever took them]
  StepReport report;
  bool depths_are_due = false;  // of the tools' reports [Pipeline]
  std::vector<Edge> edge_of;    // per link; of those that have one that may touch [Blades]
};

struct World : WorldState {
  World(const TissueConfig& tissue, const SolverConfig& solver);

  // Of the link's shapes and its edge: the farthest point from the
  // link's origin, and a box around them in the tissue's frame (m).
  double reach(std::size_t link) const;
  // Points with all of these between them, in the link's frame (m).
  std::vector<Vec3> corners(std::size_t link) const;
  Box bounds(std::size_t link, const Pose& tissue_T_link) const;
  // Smallest width of the link's shapes (m), of those that are within a spacing and a way (m) of
  // the tissue's box if any is.
  double thicknessNear(std::size_t link, const Pose& tissue_T_link, double way = 0.0) const;
  const std::vector<Vec3>& edgeOn(std::size_t link) const;  // of a blade or a jaw; else empty

  void setTools(const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports);

  // As if no tool had been looked for in the tissue yet.
  void forgetSearches();

  // All is as it was when the state was copied; the tissue and its tools are those of then.
  void takeBack(const WorldState& state);

  // A tool with an edge touches with it, or only with the shapes of its links.
  void setEdge(std::size_t tool, Edge edge);
  // Of a tool whose edge is inside, the first link: its shapes push the lips of the wound aside.
  bool isInWound(std::size_t link) const;
  bool anyInWound() const;
  // Of such a tool's first link.
  const BladeSides& sidesOn(std::size_t link) const { return sides_[link]; }
  // Whether it may: a rigid patch has no place for what a line touches, and in time tissue would
  // not have come back when what it dented is cut.
  bool mayEdgeTouch(std::size_t tool) const;

  // Of a load step; 0: any number, as where there is time to settle: tools stand, a force drives
  // them, or what is done is undone. Rigid patches are pushed from node to node, and half a time
  // step is no shape: these go on to their end, too.
  int mostIterations() const {
    const bool is_bounded = tools_move && !is_trial && !tools.anyRigid() && !tissue.hasTime();
    return is_bounded ? most_iterations : 0;
  }

  // Of a load step: no time is left in the call, or no iterations; also where there was none for
  // another solve.
  bool isOutOfTime() const;

  // Its shape: [LoadStepper, Grasping, cutters]; what is severed: [Grasping, tearStretched,
  // cutters]; how long it is solved for: [ToolMotion].
  Tissue tissue;
  ToolSet tools;
  ContactFinder finder;               // of tools and supports that touch [Blades]
  ContactFinder drills;               // of the shapes of tools that drill; links as in `finder`
  ContactFinder edges;                // of the bars along edges alone; links as in `finder`
  std::vector<std::string> warnings;  // of `finder` and `drills`
  bool has_supports = false;
  bool is_trial = false;    // what is done is undone, so nothing may sever [Pipeline]
  Deadline deadline;        // of the call under way [Pipeline]
  int most_iterations = 0;  // of a load step while tools are followed; 0: any number [Pipeline]
  bool tools_move = false;  // of themselves, in the call under way [Pipeline]

 private:
  void findSides();
  // What contact is to know of each link, in the finder's order.
  std::vector<SlidingContacts::LinkForm> linkForms(const std::vector<ToolGeometry>& all) const;
  void warnOfSizes(const std::vector<ToolGeometry>& geometry);
  std::vector<ToolShape> barsAlong(const std::vector<Vec3>& edge) const;
  std::vector<ToolGeometry> withEdges(std::vector<ToolGeometry> all) const;
  std::vector<ToolGeometry> edgesOf(std::vector<ToolGeometry> all) const;

  std::vector<BladeSides> sides_;  // per link
};

// What the patch of a tool or support exerts on the tissue; zero when it has none.
PatchAnswer answerOf(const World& world, std::size_t tool);
ForceBalance forceBalanceOf(const World& world);
// Of each tool that holds or pushes, and of each support that is near.
std::vector<LoadingPatch> patchesOfTools(const World& world);
Bedding beddingOf(const World& world);
// Supports are no tools: they alone disturb nothing.
bool anyToolIn(const std::vector<LoadingPatch>& patches, const World& world);
// The tissue moves in time, and no tool or support is near.
bool isFree(const World& world);

}  // namespace robot_tissue
