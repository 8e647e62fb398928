// One load step, the line of the package: robot pose -> contacts -> loading patches -> solve.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "grasping.h"
#include "tool_contact_update.h"
#include "touch_finder.h"
#include "world.h"

namespace robot_tissue {

// What is kept of the end of a whole load step to come back to. `shape` is empty where nothing was
// to be solved and, without rigid patches, once the step is over: they alone come back later.
struct Checkpoint {
  RobotPose pose;
  Tissue::Shape shape;
  StickingContacts::Attachments attachments;
  SlidingContacts contacts;
  std::vector<Jaws> jaws;
  std::vector<double> depths;
};

// What is done with a shape that did not converge.
enum class IfUnconverged { kTake, kRefuse };

// A load step that time ran out in.
struct UnfinishedLoadStep {
  Checkpoint came_to;
  IfUnconverged otherwise = IfUnconverged::kTake;
  int iterations = 0;                  // so far
  Tissue::Displacements from;          // the last good shape
  std::uint64_t surface_revision = 0;  // of that shape
};

// What a load step leaves to the next.
struct LoadStepState {
  bool ran_out_of_time = false;  // the last one that no shape followed
  std::optional<UnfinishedLoadStep> under_way;
};

class LoadStepper {
 public:
  // The state is kept by the caller.
  LoadStepper(World& world, TouchFinder& touch_finder, ToolContactUpdate& contact_update,
              Grasping& grasping, LoadStepState& state)
      : world_(world),
        touch_finder_(touch_finder),
        contact_update_(contact_update),
        grasping_(grasping),
        state_(state) {}

  // The tools go there. False: no shape could follow, all is as it was.
  bool advance(const RobotPose& pose, IfUnconverged otherwise = IfUnconverged::kTake);
  // Equilibrium under what acts now, gravity and loads too.
  SolveReport balance();
  void lieDown();
  // What the shape stretches too far (Tissue::tear).
  void tear();

  Checkpoint checkpoint() const;
  void goBackTo(const Checkpoint& good);

  // As the last load step that no shape followed ended.
  bool ranOutOfTime() const { return state_.ran_out_of_time; }
  // Whether time ran out in it, and it can be gone on with from what it came to.
  bool isUnderWay() const;
  const RobotPose& goesTo() const { return state_.under_way->came_to.pose; }  // only while it is
  // Goes on with it, to where it led; where there is none, as advance to the pose.
  bool finish(const RobotPose& pose) { return isUnderWay() ? goOn() : advance(pose); }
  void forgetUnderWay() { state_.under_way.reset(); }
  // The shape that it began at is the one that there is, though taken back.
  void keepUnderWay();
  // Whether one of these links stands deeper in the surface than tissue that gives way lets it.
  bool isAnyThrough(const std::vector<std::size_t>& links, const RobotPose& pose) const;

 private:
  bool goOn();
  bool takesShapeOrLeaves(const RobotPose& pose, IfUnconverged otherwise);
  bool goesOnOrLeaves();
  void arrive();
  void leave(const Checkpoint& good, IfUnconverged otherwise, int iterations);
  void solveOn();
  double durationOf(const RobotPose& from, const RobotPose& to) const;
  void expectTimeStep(double duration);
  void beginTimeStep(double duration, Touched touched);
  void meet(const RobotPose& pose, double way = 0.0);
  double wayOfKnownPlaces() const;
  void pushRigid(const RobotPose& pose);
  double deepestInRigid(const RobotPose& pose);
  std::vector<LoadingPatch> touchesAtRest(const RobotPose& pose);
  void follow(std::vector<LoadingPatch> patches);
  bool takesShape(const RobotPose& pose, Checkpoint& good, IfUnconverged otherwise);
  bool followTools(const RobotPose& pose, Checkpoint& good, IfUnconverged otherwise);
  bool leavesToNextCall();
  bool settlesFrom(const Checkpoint& good, IfUnconverged otherwise);
  bool isRefused(IfUnconverged otherwise) const;
  bool isLost(const Checkpoint& good) const;
  bool leaptFrom(const Checkpoint& good) const;
  bool turnedOver(const Checkpoint& good) const;
  bool wentThrough(const Checkpoint& good) const;
  bool isSwallowed(const Checkpoint& good) const;
  double throughAt(std::size_t link) const;
  bool isUnsettled() const;
  bool isOutOfTime() const;
  void endOverpulled();
  bool takesOut(std::size_t tool);
  Checkpoint toolsCheckpoint() const;  // without the shape

  World& world_;
  TouchFinder& touch_finder_;
  ToolContactUpdate& contact_update_;
  Grasping& grasping_;
  LoadStepState& state_;
  bool waits_for_call_ = false;  // the load step under way, before its first solve
};

}  // namespace robot_tissue
