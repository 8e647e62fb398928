// Graspers, and what is between their jaws.
//
// The gap counts where tissue is: seen from a point of the tissue that lies between them, the jaws
// are as far apart as the points of both that are nearest to it. What they share elsewhere, as at a
// hinge, plays no part. What a grasper holds rides on its jaws; then the gap counts there.
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "world.h"

namespace robot_tissue {

// How a grasper's jaws stand to the tissue.
struct Jaws {
  // kUnseen: no tissue is between them; the gap, which tells open from closed, counts at tissue.
  enum class State { kUnseen, kOpen, kClosed };
  // What keeps closed jaws from holding.
  enum class Loss { kClosedBefore, kReleased, kTorn };
  State state = State::kUnseen;
  Loss loss = Loss::kClosedBefore;
  // The tissue came anew, not the jaws: as the robot has them, they are open or closed.
  bool stood_before = false;
  std::array<Vec3, 2> grip = {Vec3::Zero(), Vec3::Zero()};  // where, in each's frame (m)
  bool let_go = false;  // told to since the last step: in the next they do not take hold again
  bool were_apart = false;
};

class Grasping {
 public:
  // The jaws, of each tool, are kept by the caller.
  Grasping(World& world, std::vector<Jaws>& jaws) : world_(world), jaws_(jaws) {}

  void setTools(std::size_t count) {
    jaws_.assign(count, {});
    last_looks_.assign(count, std::nullopt);
    last_gaps_.assign(count, std::nullopt);
  }
  const std::vector<Jaws>& jaws() const { return jaws_; }
  void restore(const std::vector<Jaws>& jaws) { jaws_ = jaws; }

  void openJaws();
  void closeJaws();
  void forgetJaws(std::size_t tool);
  // The tissue is another one: jaws that are closed hold none of it until they have opened.
  void meetNewTissue();
  // Jaws that come in from outside in that pose are open if tissue is between them there.
  void comeBackAround(std::size_t tool, const RobotPose& pose);
  // Whether the jaws leave no room for tissue between them, in that pose.
  bool areShut(std::size_t tool, const RobotPose& pose) const;
  // A grasper holds what is between its jaws now. False: nothing is.
  bool grasp(std::size_t tool);
  // Returns whether it held something.
  bool letGo(std::size_t tool);
  // Of letting go since the last step.
  void forgetLetGo();
  // Those that are pulled harder than they hold lose the tissue, or tear out what they hold of it.
  void endOverpulled();

  bool grasps(std::size_t tool) const;
  bool hasJaws(std::size_t tool, const RobotPose& pose) const;
  std::optional<double> gapAtTissue(std::size_t tool, const RobotPose& pose) const;
  bool jawsOverlap(std::size_t tool) const;
  // Why a grasper holds nothing whose jaws are closed, or press tissue between them, or that is
  // asked to grasp now; else empty.
  std::string whyItHoldsNothing(std::size_t tool, bool is_asked = false) const;

 private:
  // Two jaws seen from a point.
  struct Pinch {
    double gap = 0.0;  // m
    Vec3 middle = Vec3::Zero();
    bool is_between = false;  // the point is between them
    bool overlaps = false;    // each is in the other there
  };

  // For narrowestPinch(): that is asked several times an update.
  struct Look {
    std::array<Pose, 2> jaws;
    std::vector<Vec3> points;
    std::optional<Pinch> narrowest;
  };

  // For leastGap(): between meshes that takes long, and it stays while neither moves relative to
  // the other.
  struct Gap {
    Pose jaw_T_other = Pose::Identity();
    double reach = 0.0;  // m
    double gap = 0.0;    // m: as ContactFinder::gap tells it

    bool tells(double asked_reach) const { return asked_reach <= reach || gap <= reach; }
  };

  std::optional<double> leastGap(std::size_t tool, const RobotPose& pose, double reach) const;
  std::optional<Pinch> pinchAt(std::size_t tool, const RobotPose& pose, const Vec3& point) const;
  std::vector<Vec3> pointsNearJaws(std::size_t tool, const RobotPose& pose) const;
  std::optional<Pinch> narrowestPinch(std::size_t tool, const RobotPose& pose) const;
  void watchJaws(std::size_t tool);
  double gapAsAsked(std::size_t tool, double otherwise) const;
  std::size_t hold(std::size_t tool);
  std::vector<StickingContacts::Grip> gripsOf(std::size_t tool, std::size_t jaw, double gap) const;
  std::map<int, double> nodesBetweenJaws(std::size_t tool, std::size_t jaw, double gap) const;
  double shareAt(std::size_t jaw, std::size_t other, int node) const;
  std::size_t otherJaw(std::size_t tool, std::size_t jaw) const;
  bool pushesWith(std::size_t link) const;
  bool isPinched(const SlidingContacts::ContactConstraint& touch) const;
  std::vector<std::size_t> overpulled() const;
  bool tearOut(std::size_t tool);
  void lose(std::size_t tool);

  World& world_;
  std::vector<Jaws>& jaws_;                              // per tool
  mutable std::vector<std::optional<Look>> last_looks_;  // likewise
  mutable std::vector<std::optional<Gap>> last_gaps_;    // likewise
};

}  // namespace robot_tissue
