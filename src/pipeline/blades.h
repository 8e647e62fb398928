// Tools with an edge: what they cut on their way, and what that takes of force.
//
// An edge that comes to tissue touches it as any tool, and dents it, until the force on it is
// resistance times its length there, or the dent is kDeepestDent deep, or no shape follows it. Then
// it goes in: it touches no more, the tissue comes back, and what it swept since it touched is cut.
// From there on it cuts where it goes, until it has left the tissue. The shapes of its links touch
// all the time: they are its sides.
//
// The way of an edge is gone in strides (strides.h). At the end of each, what the edge swept on it
// is cut in the shape as it is then, and the tissue comes to balance. What is left of the way, less
// than a stride, is cut with the next one.
//
// A spring that goes is new surface at once, of a spacing's length; the edge pays for it while it
// goes on by one spacing: force = resistance * area / spacing, against its motion. Over that way
// its work is resistance * area. What denting took is a part of it.
#pragma once

#include <limits>
#include <vector>

#include "load_stepper.h"
#include "robot_tissue/core/robot_pose.h"
#include "strides.h"
#include "world.h"

namespace robot_tissue {

// What is left to be paid of one cut.
struct CutDebt {
  double force = 0.0;  // N
  double way = 0.0;    // m
};

enum class EdgePhase { kOutside, kDents, kInside };

// Of one tool; nothing of it is used for tools without an edge.
struct BladeState {
  Strides strides;  // of the first link
  int looks = 0;    // since the end of the last stride
  EdgePhase phase = EdgePhase::kOutside;
  std::vector<Pose> path;          // since it touched, or the end of the last stride
  bool is_coming_back = false;     // from its dent, so it is not cut yet
  double dent_work = 0.0;          // of the tool since it touched (J)
  Vec3 dent_force = Vec3::Zero();  // on the tissue there, its frame (N)
  Vec3 point = Vec3::Zero();       // where it cut last, tool frame (m)
  Vec3 direction = Vec3::Zero();   // of the point's motion, unit, tissue frame
  std::vector<CutDebt> debts;
  // Way of the point since it cut last (m); infinite: its stroke is over.
  double since_cut = std::numeric_limits<double>::infinity();

  const Pose& stands() const { return strides.stands.front(); }  // tissue_T_tool
};

class Blades {
 public:
  // The states, one a tool, are kept by the caller.
  Blades(World& world, LoadStepper& load_step, std::vector<BladeState>& states)
      : world_(world), load_step_(load_step), states_(states) {}

  // They stand nowhere.
  void forget();
  // What they cut from here on is another stroke.
  void endStrokes();

  // Those that come anew to where tissue is are inside: they do not part what they appear in.
  void comeIn(const RobotPose& pose);

  // The way of the tools to the pose in legs that end where blades that may touch are looked at, or
  // cut; the last one ends there. Edges that meet nothing on it do not touch.
  std::vector<RobotPose> legs(const RobotPose& from, const RobotPose& pose);

  // They go to their place in the pose, from where they were last. A tool that comes from nowhere,
  // or jumped, cuts nothing on its way. False: there was no time for all of the way; the pose has
  // where they came to.
  bool goTo(RobotPose& pose);
  // Those with sides that are inside: what they part is to be open before their sides come.
  void partAhead(const RobotPose& pose);

  // No shape follows those that dent: they go in. False: there are none.
  bool breakIn();

  // Adds the wrench of cutting to the report of a tool with an edge.
  void describe(std::size_t tool, ToolReport& report) const;

 private:
  // What an edge presses on the tissue.
  struct Pressing {
    Vec3 force = Vec3::Zero();  // tissue frame (N)
    Vec3 point = Vec3::Zero();  // mean (m)
    double length = 0.0;        // of the edge (m)
    double depth = 0.0;         // of the dent (m)
    bool any() const { return length > 0.0; }
  };

  bool goTo(std::size_t tool, RobotPose& pose);
  void forgetWay(std::size_t tool);
  void setPhase(std::size_t tool, EdgePhase phase);
  double depthInTissue(std::size_t tool, const Pose& tissue_T_tool) const;
  bool meetsTissue(std::size_t tool, const RobotPose& from, const RobotPose& pose) const;
  double lookLength() const;
  void look(std::size_t tool);
  void leave(std::size_t tool);
  void countDentWork(std::size_t tool, const Pose& from);
  void press(std::size_t tool);
  void goIn(std::size_t tool);
  void comeBack(std::size_t tool);
  Pressing pressingOf(std::size_t tool) const;
  void moveTo(const Pose& pose, BladeState& state) const;
  void cutAlongPath(std::size_t tool, BladeState& state);

  World& world_;
  LoadStepper& load_step_;
  std::vector<BladeState>& states_;
};

}  // namespace robot_tissue
