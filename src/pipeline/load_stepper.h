// One load step, the line of the package: robot pose -> contacts -> loading patches -> solve.
#pragma once

#include <vector>

#include "checkpoint.h"
#include "shape_judge.h"
#include "touch_finder.h"
#include "unfinished_load_step.h"
#include "world.h"

namespace robot_tissue {

// How a load step ended. But for kArrived all is as it was before it.
enum class LoadStepEnd {
  kArrived,    // the tools are there, and the tissue has followed; or settles later
  kUnderWay,   // time ran out in it, and it can be gone on with from what it came to
  kOutOfTime,  // no shape followed, and time ran out
  kTooLong,    // one followed, but the error of the time step asks for shorter ones
  kNoShape     // no shape followed
};

class LoadStepper {
 public:
  // The step under way is kept by the caller.
  LoadStepper(World& world, TouchFinder& touch_finder, const ShapeJudge& judge, Grasping& grasping,
              UnfinishedLoadStep& under_way)
      : world_(world),
        touch_finder_(touch_finder),
        judge_(judge),
        grasping_(grasping),
        under_way_(under_way) {}

  // The tools go there.
  LoadStepEnd advance(const RobotPose& pose, IfUnconverged otherwise = IfUnconverged::kTake);
  // Goes on with what is under way, to where that led; where nothing is, as advance to the pose.
  LoadStepEnd finish(const RobotPose& pose);
  bool isUnderWay() const { return under_way_.isOf(world_.tissue); }
  const RobotPose& goesTo() const { return under_way_.goesTo(); }  // only what is under way
  void forgetUnderWay() { under_way_.forget(); }

  // Equilibrium under what acts now, gravity and loads too.
  SolveReport balance();
  // Balance where a tool, or all of them, let go.
  void lieDown();

  Checkpoint checkpoint() const;
  void goBackTo(const Checkpoint& good);

 private:
  // What came of solving for a shape that follows the tools.
  enum class Solved {
    kFollows,        // the tissue is in it, or comes to it later (World::unfinished)
    kLost,           // it is none that the tissue takes
    kLeftToNextCall  // finding the contacts took the time to solve for them
  };

  LoadStepEnd goTo(const RobotPose& pose, IfUnconverged otherwise);
  LoadStepEnd goOn();
  void arrive();
  LoadStepEnd leave(const Checkpoint& good, IfUnconverged otherwise, Solved solved,
                    int iterations_before);
  Solved followTools(const RobotPose& pose, Checkpoint& good, IfUnconverged otherwise);
  Solved settle(const Checkpoint& good, IfUnconverged otherwise);
  bool mayNotSolveOn() const;
  void solveOn();
  void follow(std::vector<LoadingPatch> patches);
  bool isRefused(IfUnconverged otherwise) const;
  bool isRoundForNextCall() const;
  double durationOf(const RobotPose& from, const RobotPose& to) const;
  void expectTimeStep(double duration);
  void beginTimeStep(double duration, Touched touched);
  bool endsTooLong();
  void meet(const RobotPose& pose, double way = 0.0);
  double wayOfKnownPlaces() const;
  std::vector<LoadingPatch> touchesAtRest(const RobotPose& pose);
  void pushRigid(const RobotPose& pose);
  StickingContacts::Edges edgesAround(const RobotPose& pose, int link, const Vec3& outward,
                                      const Vec3& point) const;
  double deepestInRigid(const RobotPose& pose);
  Checkpoint toolsCheckpoint() const;  // without the shape

  World& world_;
  TouchFinder& touch_finder_;
  const ShapeJudge& judge_;
  Grasping& grasping_;
  UnfinishedLoadStep& under_way_;
  bool begins_free_ = false;  // the time step under way: nothing is near
};

}  // namespace robot_tissue
