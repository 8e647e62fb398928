// The straight line of one update:
//   robot pose -> contacts -> loading patches -> solve (-> publish, in the ros layer)
//
// The tools' way is walked in load steps: a fifth of the spacing, less for a thin tool, so that no
// tool is through before it is met. Within a step the solver asks for the contacts at the shape it
// came to and goes on until they stand. Where nothing is near, a step is as long as the way that is
// free. A tool that appears inside the tissue is walked in from outside.
//
// With rigid patches, as in the paper, the shape depends on the steps. Then what is left of the
// way, less than a step, is solved from the end of the last whole step and anew at the next update,
// and the shapes at the ends of the steps are kept while a tool touches: going back the way it
// came, it finds the shapes that it left.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/pipeline/step_report.h"
#include "robot_tissue/pipeline/still_pose.h"
#include "robot_tissue/pipeline/tool_touch.h"

namespace robot_tissue {

class Landing;
struct Checkpoint;
struct World;

class Pipeline {
 public:
  // Throws InputError.
  Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
           const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports = {});
  ~Pipeline();
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Where a tool is that stands nowhere; coming from there it comes in from outside the tissue.
  static Pose away();
  static bool isAway(const Pose& pose);

  // Puts other tools in the place of the present ones; what these held is let go.
  void setTools(const std::vector<ToolGeometry>& tools);
  // One line each, e.g. a mesh that cuts itself.
  const std::vector<std::string>& toolWarnings() const;
  const std::vector<ToolGeometry>& tools() const;

  // Follows the tools to their new pose, one entry a link of the tools. Poses with a non-finite
  // number throw InputError.
  const StepReport& step(const RobotPose& pose);
  // Where tissue.time is set, time goes by in steps from one pose's stamp to the next one's; with
  // this call while the tools stand (s).
  SolveReport wait(double duration);
  // As Tissue::stopTime.
  void stopTime();
  // The stamp from which the first pose's time counts; otherwise it is that pose's own.
  void startClock(double seconds);
  // The poses at which step() does nothing, until one of the calls below; none while something is
  // left to do, or a force drives a tool.
  std::optional<StillPose> stillPose() const;
  // Load steps that the tools' way to the pose takes; 0 before the first step. With more of them a
  // step is a jump, too fast to be followed.
  double stepsTo(const RobotPose& pose) const;
  static constexpr int kMostLoadSteps = 400;
  // The tools that such a jump to the pose takes.
  std::vector<std::size_t> jumpsTo(const RobotPose& pose) const;
  // Load steps of the way to the pose before any tool on it can touch.
  double freeStepsTo(const RobotPose& pose) const;
  // Whether the tool would be in the tissue at that pose, in the shape as it is.
  bool isInTissue(std::size_t tool, const RobotPose& pose) const;
  // Steps between these calls are undone: nothing that follows depends on them. They sever nothing.
  // A reset, loaded state or other tools end a trial.
  void beginTrial();
  void undoTrial();
  // Time that a step, or one of the calls below, may take (s). Then it begins no further solve, the
  // rest of the way and of the loads is left to the next step, and so is a tool that would have to
  // be drawn out; it is late, and the next step goes on from where it came to, also when the tools
  // stand.
  void setBudget(double seconds) { budget_s_ = seconds; }
  // Iterations that a load step may make while tools are followed; 0, or in time: any number. From
  // a third of them on, shapes in balance are shown while contacts still settle, as where tissue
  // slips, and told as late; they settle in the load steps that follow, or where the tools stand.
  // What is in no balance at the last is gone on with in the next step, as where time runs out.
  void setMostIterations(int iterations);
  // Whether a solve, a load or contacts that still settle were left for want of time.
  bool isLate() const;
  // Goes on with what was left, while the tools have no pose: they stay where they are.
  const StepReport& carryOn();
  // The tools are where they were asked to be last, and the shape is that of this pose, in balance.
  bool hasArrived() const;
  // From here on load steps that take far too long again and again, counted by iterations over all
  // solves since the last reset, are cut off, and ways given up (Patience, StepReport::hopeless).
  // `times`: of the usual patience with a scene.
  void limitPatience(double times = 1.0);
  // No call begins a solve after it; what a call leaves then it tells as late. One without a time,
  // that only a stop ends, changes nothing before.
  void setEnd(const Deadline& end);

  // As Tissue's, with the tools and supports where they are. Where no time passes, what nothing
  // holds falls onto supports that are below it, and comes to lie on them.
  SolveReport settle();
  // Whether there is something that has to come to lie on supports before anything else is done
  // with it.
  bool isLoose() const;
  // Throws InputError, and changes nothing: a patch whose box holds no node, or fixed ones; that
  // shares nodes with another one, or has another one's name; that turns where method or nodes do
  // not let it; a load that takes more than most_increments.
  void load(const LoadStep& step, const Tissue::OnIncrement& on_increment = {},
            int most_increments = 100000);
  // As Tissue's; what a call lets loose comes to lie on supports.
  SolveReport release(const std::vector<std::string>& names);
  CutReport cut(const std::vector<Vec3>& corners);
  RemoveReport remove(const RemovedSpace& space);
  SolveReport undo(int count);
  SutureResult suture(const SutureConfig& config);
  // As Tissue's; the shape is balanced under what stands.
  void retune(const TissueConfig& tissue, const SolverConfig& solver);
  // Of all tools, from the next contact on; that of supports stays, and rigid patches have none.
  void setFriction(double friction);
  // Rest shape; at the next step the tools come in from outside.
  void reset();
  // The cells, loads and sutures of another tissue of the same lattice, with these displacements
  // (m); tools as after a reset.
  void takeOver(const Tissue& other, Tissue::Displacements displacement);
  // As Tissue's; what tools and graspers hold is let go, and they come in from outside.
  SolveReport loadState(const std::string& bytes);

  // A grasper holds what is between its jaws now, or lets go. Throws InputError: no grasper, no
  // pose yet, nothing between the jaws.
  void grasp(std::size_t tool);
  void letGo(std::size_t tool);
  // From the next step on the tool is where its force on the tissue equals this one (N, tissue
  // frame), along the force from its pose; empty: at its pose again. Throws InputError: the force
  // is zero or not finite, or the tool's role is one that does not touch.
  void push(std::size_t tool, const std::optional<Vec3>& force);

  const Tissue& tissue() const;
  const StepReport& report() const;
  // Where the links are for the tissue: those that a force drives where it drove them, those that
  // no shape could follow where one last did. Empty before the first step.
  const std::optional<RobotPose>& pose() const;
  ForceBalance forceBalance() const;
  // From here on ToolReport::max_penetration is looked for only when findDepths() is called: it
  // takes a search of the surface, and wrenches need not wait for it. Until then it is zero.
  void leaveDepths() { leaves_depths_ = true; }
  // Of the shape as it is; each at most once.
  void findDepths() const;
  // Where the tool pushes or holds the tissue, in the shape as it is now.
  std::vector<ToolTouch> touchesOf(std::size_t tool) const;
  // How far along a unit direction a line from the point leaves the shapes of the tools in this
  // pose for good (m, at most `farthest`): from there it is seen from outside.
  double exitOf(const RobotPose& pose, const Vec3& point, const Vec3& direction,
                double farthest) const;

 private:
  struct Parts;  // the classes behind it, see doc/architecture.md
  struct State;  // what steps change of them
  struct Mark;   // of when a trial began
  // While one lives, solves have the budget from its construction on, and end by setEnd's time.
  class Bounded {
   public:
    explicit Bounded(Pipeline& pipeline);
    ~Bounded();
    Bounded(const Bounded&) = delete;
    Bounded& operator=(const Bounded&) = delete;

   private:
    Pipeline& pipeline_;
  };

  void takeTools(const std::vector<ToolGeometry>& tools);
  void forgetTools();
  void meetNewTissue();
  void endTrial();
  void beginReport(bool tools_stand);
  const StepReport& endReport();
  void stepTo(const RobotPose& goal, const RobotPose& pose);
  bool goInLegs(const RobotPose& pose);
  void goTo(RobotPose pose);
  bool partAlongWay();
  // before: where time began to go by in this update; null: it did not.
  bool drive(const RobotPose& pose, const Checkpoint* before);
  void touch();
  void describeTools();
  void expectTouch();                  // expected_touch.cpp
  double stiffnessUnderTools() const;  // live_changes.cpp
  // late_work.cpp
  void loadOn();
  void finish();
  void countLate();
  // settling.cpp
  SolveReport balance();
  SolveReport changeTissue(const std::function<SolveReport()>& change);
  SolveReport settleLoose();
  std::optional<Tissue::Shape> shapeOfLoose() const;
  SolveReport comeToLie(const std::optional<Tissue::Shape>& before, const SolveReport& report);
  SolveReport land(const Tissue::Shape& before);
  bool liesNear(const std::vector<Vec3>& there, bool rests);
  bool wentFartherFrom(const std::vector<Vec3>& there, double spacings) const;
  void putInPlace(Tissue::Displacements displacement, std::shared_ptr<const CellSet> cells);
  bool isBehind() const;  // the shape shown is not yet the one of the tools' pose, in balance

  std::unique_ptr<Parts> parts_;
  World& world_;
  State& state_;
  std::vector<SupportConfig> supports_;
  std::unique_ptr<const Landing> landing_;  // null: the scene needs none
  double budget_s_ = std::numeric_limits<double>::infinity();
  std::optional<Deadline> end_;  // of all calls
  bool leaves_depths_ = false;
  std::shared_ptr<const Mark> trial_from_;  // null: none is under way
};

}  // namespace robot_tissue
