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

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "robot_tissue/coupling/sticking_contacts.h"
#include "robot_tissue/pipeline/still_pose.h"

namespace robot_tissue {

// What one tool met, after the solve. Its frame is that of its first link.
struct ToolReport {
  Vec3 force_on_tool = Vec3::Zero();   // of the tissue on the tool, tool frame (N)
  Vec3 torque_on_tool = Vec3::Zero();  // about the tool's origin, tool frame (N m)
  bool saturated = false;              // the wrench was longer than the tool's max_force
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
  std::string holds_nothing;      // of a grasper that is closed, or told to grasp: why; else empty
  Vec3 offset = Vec3::Zero();     // of a tool that a force drives, from its pose, tissue frame (m)
};

// Lists of tools are of their numbers, each once.
struct StepReport {
  bool changed = false;   // false: the shape is as it was
  bool too_fast = false;  // the tools moved further than could be followed in time
  bool lost = false;      // no shape could follow the tools: the last good one stays
  bool late = false;      // it ran out of its time before the shape was in balance
  bool gave_up = false;   // late again and again where the tools stand: it ends
  // Where too_fast or lost: tools not yet at their pose. Those that are nowhere near the tissue on
  // their way always are.
  std::vector<std::size_t> behind;
  std::vector<std::size_t> jumped;  // too far to be followed: all tools let go and came in anew
  std::vector<std::size_t> were_inside;  // appeared inside the tissue and came in from outside
  std::vector<std::size_t> torn_off;     // graspers that lost what they held
  int substeps = 0;                      // load steps that the way took
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

class Pipeline {
 public:
  // Throws InputError.
  Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
           const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports = {});
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;

  // Where a tool is that stands nowhere; coming from there it comes in from outside the tissue.
  static Pose away();

  // Puts other tools in the place of the present ones; what these held is let go.
  void setTools(const std::vector<ToolGeometry>& tools);
  // One line each, e.g. a mesh that cuts itself.
  const std::vector<std::string>& toolWarnings() const { return finder_.warnings(); }
  const std::vector<ToolGeometry>& tools() const { return tools_; }

  // Follows the tools to their new pose, one entry a link of the tools. Poses with a non-finite
  // number throw InputError.
  const StepReport& step(const RobotPose& pose);
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
  // Steps between these calls are undone, and nothing that follows hangs on them.
  void beginTrial();
  void undoTrial();
  // Time that a step, or one of the calls below, may take (s). Then it begins no further solve, the
  // rest of the way and of the loads is left to the next step, and so is a tool that would have to
  // be drawn out; it is late, and the next one goes on from there, also when the tools stand.
  void setBudget(double seconds) { budget_s_ = seconds; }
  // There is such a rest of a solve or a load.
  bool isLate() const;
  // Goes on with it while the tools have no pose: they stay where they are.
  const StepReport& carryOn();
  // The tools are where they were asked to be last, and the shape is the one there, in balance.
  bool hasArrived() const;
  // No call begins a solve after it; what a call leaves then it tells as late.
  void setEnd(const Deadline& end);

  // As Tissue's, with the tools and supports where they are.
  SolveReport settle();
  void load(const LoadStep& step, const Tissue::OnIncrement& on_increment = {},
            int most_increments = 100000);
  SolveReport release(const std::vector<std::string>& names);
  CutReport cut(const std::vector<Vec3>& corners);
  // Rest shape; at the next step the tools come in from outside.
  void reset();

  // A grasper holds what is between its jaws now, or lets go. Throws InputError: no grasper, no
  // pose yet, nothing between the jaws.
  void grasp(std::size_t tool);
  void letGo(std::size_t tool);
  // From the next step on the tool is where its force on the tissue equals this one (N, tissue
  // frame), along the force from its pose; empty: at its pose again.
  void push(std::size_t tool, const std::optional<Vec3>& force);

  const Tissue& tissue() const { return tissue_; }
  const StepReport& report() const { return report_; }
  // Where the links are for the tissue: those that a force drives where it drove them, those that
  // no shape could follow where one last did. Empty before the first step.
  const std::optional<RobotPose>& pose() const { return last_pose_; }
  ForceBalance forceBalance() const;

 private:
  static constexpr double kDeepEnough = 0.01;  // of the spacing: penetration that counts

  // How a grasper's jaws stand to the tissue.
  struct Jaws {
    // kUnseen: no tissue is between them, which alone tells open from closed.
    enum class State { kUnseen, kOpen, kClosed };
    // What keeps closed jaws from holding.
    enum class Loss { kClosedBefore, kReleased, kTorn };
    State state = State::kOpen;
    Loss loss = Loss::kClosedBefore;
    std::array<Vec3, 2> grip = {Vec3::Zero(), Vec3::Zero()};  // where, in each's frame (m)
    bool asked = false;                                       // to grasp, in vain
    bool let_go = false;  // told so since the last step, in which they hold nothing anew
    bool were_apart = false;
  };
  // Two jaws seen from a point.
  struct Pinch {
    double gap = 0.0;  // m
    Vec3 middle = Vec3::Zero();
    bool is_between = false;  // the point is between them
  };

  // Where a whole load step ended. Only rigid patches come back to its shape later: without them it
  // has none but on the way through a step.
  struct Checkpoint {
    RobotPose pose;
    Tissue::Shape shape;
    StickingContacts::Attachments attachments;
    SlidingContacts contacts;
    std::vector<Jaws> jaws;
    std::vector<double> depths;
  };
  // All that the next step hangs on.
  struct Mark;
  // Of a link: in the box a vertex goes so far at once (m) and no farther.
  struct Surroundings {
    Box box;
    double longest = 0.0;
  };
  // What is done in its life has the budget, counted from its beginning, and ends with all calls.
  class Bounded {
   public:
    explicit Bounded(Pipeline& pipeline);
    ~Bounded() { pipeline_.tissue_.setDeadline(pipeline_.end_); }
    Bounded(const Bounded&) = delete;
    Bounded& operator=(const Bounded&) = delete;

   private:
    Pipeline& pipeline_;
  };
  // Numbers of links, from `first` up to before `end`.
  struct Links {
    std::size_t first = 0;
    std::size_t end = 0;
  };
  // A shortest load step that no shape followed.
  struct DeadEnd {
    RobotPose from;
    RobotPose to;
  };
  // A tool that a force drives.
  struct Drive {
    std::optional<Vec3> force;  // N
    double way = 0.0;           // along the force, from its pose (m)
  };

  // pipeline.cpp
  void takeTools(const std::vector<ToolGeometry>& tools);
  bool advance(const RobotPose& pose, bool insists = true);
  bool settlesFrom(const Checkpoint& good, bool insists);
  void follow(std::vector<LoadingPatch> patches);
  bool leaptFrom(const Checkpoint& good) const;
  bool isLost(const Checkpoint& good) const;
  bool wentThrough(const Checkpoint& good) const;
  double throughAt(std::size_t link) const;
  bool isUnsettled() const;
  bool isOutOfTime() const { return deadline_.isOver(); }
  void beginReport();
  void stepTo(const RobotPose& goal, const RobotPose& pose);
  std::vector<LoadingPatch> patchesOfTools() const;
  void pushRigid(const RobotPose& pose);
  double deepestInRigid(const RobotPose& pose);
  bool isRigid(int tool) const;
  bool anyToolIn(const std::vector<LoadingPatch>& patches) const;
  void touch();

  // late_work.cpp
  SolveReport balance();
  void loadOn();
  void finish();
  void countLate();

  // contact_update.cpp
  std::vector<Surroundings> surroundings() const;
  std::vector<double> longestWays();
  double contactShare(const std::vector<Vec3>& before);
  double shareOutside(double share) const;
  std::vector<double> depthsIn(const std::vector<Vec3>& vertices) const;
  bool updateContacts(std::vector<LoadingPatch>& of_tools, bool whole, bool last);
  ContactSet contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement);
  ContactSet touchesAt(const RobotPose& pose, const std::vector<std::uint8_t>& held);
  void meet(const RobotPose& pose);
  Vec3 inwardsAt(const Contact& contact) const;
  bool turnOut(const RobotPose& pose, Contact& contact) const;
  std::vector<std::optional<Contact>> trackTouches(const RobotPose& pose);
  bool wouldTouchAtRest(const RobotPose& pose);
  std::vector<LoadingPatch> lastTouches() const;

  // tool_substeps.cpp
  static bool isAway(const Pose& pose);
  RobotPose walk(const RobotPose& pose);
  RobotPose complete(const RobotPose& pose) const;
  Checkpoint toolsCheckpoint() const;  // without the shape
  Checkpoint checkpoint() const;
  void goBackTo(const Checkpoint& good);
  void checkIn(const RobotPose& pose);
  void goBackTo(RobotPose& pose);
  void leaveStuck(RobotPose& pose);
  bool isHooked(std::size_t tool) const;
  void letGoOf(std::size_t tool);
  RobotPose withTool(std::size_t tool, const RobotPose& pose, RobotPose others) const;
  void startAnew(RobotPose& pose);
  void lieDown();
  void comeAndGo(RobotPose& pose);
  bool standsStill(const RobotPose& pose) const;
  bool isAt(std::size_t tool, const RobotPose& here, const RobotPose& there) const;
  std::vector<std::size_t> toolsBehind() const;
  std::vector<std::size_t> farFrom(const RobotPose& from, const RobotPose& goal) const;
  double stepsBetween(const RobotPose& from, const RobotPose& to) const;
  double freeSteps(const RobotPose& from, const RobotPose& to) const;
  bool letPass(RobotPose& start, const RobotPose& pose) const;
  bool leadsNowhere(const RobotPose& from, const RobotPose& to) const;
  bool touchesTissue(std::size_t tool) const;
  bool passesBy(std::size_t tool, const RobotPose& from, const RobotPose& to) const;
  void passTo(const RobotPose& pose);
  double stepOf(std::size_t link) const;

  // initial_overlap.cpp
  static RobotPose moved(const Links& links, const Vec3& way, RobotPose pose);
  ContactSet overlapOf(const Links& links, const RobotPose& pose) const;
  std::optional<Vec3> middleBeneath(const Links& links, const RobotPose& pose) const;
  bool isInTissue(const Links& links, const RobotPose& pose) const;
  bool isInTissue(std::size_t tool, const RobotPose& pose) const;
  std::vector<Vec3> waysOut(const Links& links, const RobotPose& pose) const;
  std::optional<int> stepsOut(const Links& links, const RobotPose& pose, const Vec3& way,
                              int most) const;
  bool resolveOverlap(const Links& links, RobotPose& pose) const;
  void resolveOverlap(std::size_t tool, RobotPose& pose);
  void unhook(RobotPose& pose);
  void leaveReleased(RobotPose& pose);
  void comeAnew(const std::vector<std::size_t>& tools, RobotPose& pose);
  bool waitsOutside(std::size_t tool, bool any_came, RobotPose& pose);

  // tool_actions.cpp
  RobotPose driven(const RobotPose& pose) const;
  bool drive(const RobotPose& pose);

  // jaws.cpp
  std::size_t firstJaw(std::size_t tool) const { return first_link_[tool + 1] - 2; }
  bool hasJaws(std::size_t tool, const RobotPose& pose) const;
  std::optional<double> leastGap(std::size_t tool, const RobotPose& pose) const;
  std::optional<Pinch> pinchAt(std::size_t tool, const RobotPose& pose, const Vec3& point) const;
  std::optional<Pinch> narrowestPinch(std::size_t tool, const RobotPose& pose) const;
  std::optional<double> gapAtTissue(std::size_t tool, const RobotPose& pose) const;
  bool grasps(std::size_t tool) const;
  void openJaws();
  void closeJaws();
  void watchJaws(std::size_t tool);
  void forgetJaws(std::size_t tool);
  std::size_t hold(std::size_t tool);
  std::vector<int> nodesBetweenJaws(std::size_t tool, std::size_t jaw, double gap) const;
  void tearOff();
  std::string whyItHoldsNothing(std::size_t tool) const;
  bool pushesWith(std::size_t link) const;

  // tool_reports.cpp
  void describeTools();
  ToolReport describe(std::size_t tool) const;
  Vec3 normalOf(std::size_t tool) const;
  double deepestPointOf(std::size_t tool) const;
  bool jawsOverlap(std::size_t tool) const;
  PatchAnswer answerOf(std::size_t tool) const;

  Tissue tissue_;
  std::vector<SupportConfig> supports_;
  std::vector<ToolGeometry> tools_;      // the supports' are not among them
  std::vector<std::string> names_;       // of tools and supports
  std::vector<std::size_t> first_link_;  // per tool and support, and the end
  ContactFinder finder_;                 // of tools and supports
  StickingContacts patches_;
  SlidingContacts contacts_;
  std::vector<Drive> drives_;
  std::vector<Jaws> jaws_;  // per tool
  bool any_rigid_ = false;
  unsigned surface_version_ = 0;
  RobotPose pose_;   // of the load step under way, or the last that a shape followed
  RobotPose asked_;  // where the tools are
  std::optional<RobotPose> last_pose_;
  std::vector<Checkpoint> checkpoints_;
  double budget_s_ = std::numeric_limits<double>::infinity();
  std::optional<Deadline> end_;  // of all calls
  Deadline deadline_;            // of the call under way
  int cycles_in_vain_ = 0;       // of solves that did not converge, since the last whole load step
  std::optional<DeadEnd> dead_end_;  // none: the tissue has changed since
  int late_iterations_ = 0;          // of the method, where the tools stand
  bool gave_up_ = false;             // there
  bool unfinished_ = false;     // the last load step had no time for all that it would have done
  bool touched_ = true;         // the reports are to be brought up to date
  std::vector<Vec3> vertices_;  // of the last contacts
  std::vector<Vec3> outwards_;  // their normals
  double left_inside_ = 0.0;    // depth of the deepest of them, after the last solve (m)
  std::vector<double> depths_;  // likewise, in each link by the nearest way out (m)
  StepReport report_;
  std::shared_ptr<const Mark> trial_from_;  // null: none is under way
};

}  // namespace robot_tissue
