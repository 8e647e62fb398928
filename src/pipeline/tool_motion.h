// The tools' way in load steps, and what becomes of tools that come, go, jump or are stuck.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "load_stepper.h"
#include "overlap_resolver.h"
#include "shape_judge.h"
#include "way_lengths.h"

namespace robot_tissue {

// What is remembered of the tools' way so far.
struct WayBehind {
  std::vector<Checkpoint> checkpoints;
  RobotPose last_goal;  // of the last walk
  // Per tool, updates in which it was behind: as no shape followed, and clear of the tissue.
  std::vector<int> lost_in_a_row, clear_in_a_row;
  int late_iterations = 0;    // of a load step that is being finished
  bool begins_short = false;  // no shape followed the last load step, and time was over
};

class ToolMotion {
 public:
  // Why tools come in from outside: they were nowhere, or jumped; or no shape followed them.
  enum class Entry { kAppears, kLetGo };

  // `behind` is kept by the caller.
  ToolMotion(World& world, const WayLengths& ways, const OverlapResolver& overlap,
             Grasping& grasping, const ShapeJudge& judge, LoadStepper& load_step, WayBehind& behind)
      : world_(world),
        ways_(ways),
        overlap_(overlap),
        grasping_(grasping),
        judge_(judge),
        load_step_(load_step),
        behind_(behind) {}

  RobotPose walk(const RobotPose& pose);
  // What the last load step had no time for; tools come to where one that is under way leads.
  LoadStepEnd finishStanding();
  void startAnew(RobotPose& pose, Entry entry = Entry::kAppears);
  void comeAndGo(RobotPose& pose, Entry entry = Entry::kAppears,
                 const std::vector<std::size_t>& jumped = {});
  void goBackTo(RobotPose& pose);
  // Where the tools are now, to stay there if no shape follows from a checkpoint; absent: these
  // tools have none.
  std::optional<Checkpoint> lastGood() const;
  void stayAt(const Checkpoint& last_good, const RobotPose& goal);
  void leaveStuck(RobotPose& pose);
  void leaveBehind(RobotPose& pose);
  void leaveReleased(RobotPose& pose);
  void leaveJam(RobotPose& pose);
  void unhook(RobotPose& pose);

  bool standsStill(const RobotPose& pose) const;
  std::vector<std::size_t> toolsBehind() const;

  bool hasCheckpoints() const { return !behind_.checkpoints.empty(); }
  // The last pose is one to come back to, and the only one.
  void checkInAnew();
  void forget() { behind_ = WayBehind(); }

 private:
  enum class Others { kNone, kCame };  // of the tools, in this step
  // How a walk ended, or that it goes on.
  enum class WalkEnd {
    kGoesOn,
    kArrived,
    kOutOfTime,     // or out of iterations: a part of the way is left to the next update
    kUnderWay,      // in a load step, which the next update goes on with
    kToBeginShort,  // no shape followed a load step: the next update tries a shorter one
    kDeadEnd,       // no shape follows even the shortest load step
    kCutOff,        // load steps take far too long (Patience)
    kLostAtEnd      // no shape where there is no way
  };
  class Walk;

  const RobotPose& reached() const;
  bool leadsNowhere(const RobotPose& from, const RobotPose& to) const;
  bool turnsBack(const RobotPose& start, const RobotPose& pose) const;
  void forgetUnfinished();
  bool finishes(RobotPose& start, const RobotPose& pose);
  bool letPass(RobotPose& start, const RobotPose& pose) const;
  double stepsOf(double load_steps, const RobotPose& start, const RobotPose& pose) const;
  double stepDuration(double steps, const RobotPose& start, const RobotPose& pose) const;
  bool isBounded() const;
  bool isShort(double before_ms) const;
  RobotPose walkFrom(const RobotPose& start, const RobotPose& pose);
  void note(WalkEnd end);
  void passTo(const RobotPose& pose);
  void checkIn(const RobotPose& pose);
  bool isHooked(std::size_t tool) const;
  void resolveOverlap(std::size_t tool, Entry entry, RobotPose& pose);
  void letGoOf(std::size_t tool);
  bool isAttached(std::size_t tool) const;
  void comeAnew(const std::vector<std::size_t>& tools, RobotPose& pose);
  bool waitsOutside(std::size_t tool, Others others, RobotPose& pose);

  World& world_;
  const WayLengths& ways_;
  const OverlapResolver& overlap_;
  Grasping& grasping_;
  const ShapeJudge& judge_;
  LoadStepper& load_step_;
  WayBehind& behind_;
};

}  // namespace robot_tissue
