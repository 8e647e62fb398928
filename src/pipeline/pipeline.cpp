#include "robot_tissue/pipeline/pipeline.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "stopwatch.h"

namespace robot_tissue {
namespace {

constexpr int kPushPasses = 4;     // a curved tool's way out turns as the surface moves
constexpr int kRigidRounds = 6;    // nodes that the solve moved into a rigid tool go out again
constexpr double kTouches = 0.02;  // of the spacing: a gap that is none
constexpr int kMoreSolves = 2;     // where one ended on its way
constexpr double kTooDeep = 0.04;  // of the spacing, in a tool
constexpr double kMostUnbalanced = 0.5;  // of the tools' force, where a solve did not converge
constexpr double kMostLeap = 10.0;       // of the spacing, of a surface's node in a load step
constexpr double kThrough = 0.25;        // of the spacing: how deep a link is that goes through
constexpr double kThroughTool = 0.25;    // of the link's thickness, likewise, whichever is less

ToolGeometry asTool(const SupportConfig& support) {
  ToolGeometry tool;
  tool.name = support.name;
  tool.friction = support.friction;
  tool.links.push_back({"", {support.shape}});
  return tool;
}

std::vector<ToolGeometry> withSupports(std::vector<ToolGeometry> tools,
                                       const std::vector<SupportConfig>& supports) {
  for (const SupportConfig& support : supports) tools.push_back(asTool(support));
  return tools;
}

}  // namespace

Pipeline::Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
                   const std::vector<ToolGeometry>& tools,
                   const std::vector<SupportConfig>& supports)
    : tissue_(tissue, solver),
      supports_(supports),
      finder_({}),
      patches_(tissue_.lattice(), {}),
      contacts_({}, {}) {
  surface_version_ = tissue_.surfaceVersion();
  takeTools(tools);
  tissue_.setContactUpdate({[this] { return longestWays(); },
                            [this](const auto& before) { return contactShare(before); },
                            [this](auto& patches, bool whole, bool last) {
                              return updateContacts(patches, whole, last);
                            }});
}

void Pipeline::takeTools(const std::vector<ToolGeometry>& tools) {
  tools_ = tools;
  names_.clear();
  first_link_ = {0};
  any_rigid_ = false;
  std::vector<double> friction;
  const std::vector<ToolGeometry> all = withSupports(tools, supports_);
  for (const ToolGeometry& tool : all) {
    const bool rigid = tool.patch == ToolConfig::Patch::kRigid;
    any_rigid_ = any_rigid_ || rigid;
    names_.push_back(tool.name);
    friction.push_back(rigid ? -1.0 : tool.friction);
    first_link_.push_back(first_link_.back() + tool.links.size());
  }
  finder_ = ContactFinder(all);
  patches_ = StickingContacts(tissue_.lattice(), names_);
  std::vector<double> thickness;
  for (std::size_t link = 0; link < finder_.linkCount(); ++link) {
    thickness.push_back(finder_.thickness(link));
  }
  contacts_ = SlidingContacts(friction, thickness);
  drives_.assign(tools.size(), {});
  jaws_.assign(tools.size(), {});
  unfinished_ = gave_up_ = false;
  late_iterations_ = 0;
  pose_ = complete({});
  contacts_.commit(pose_, tissue_);
  report_ = StepReport();
  report_.tools.resize(tools.size());
}

void Pipeline::setTools(const std::vector<ToolGeometry>& tools) {
  takeTools(tools);
  lieDown();
  last_pose_.reset();
  checkpoints_.clear();
  touched_ = true;
}

void Pipeline::setEnd(const Deadline& end) {
  end_ = end;
  tissue_.setDeadline(end_);
}

const StepReport& Pipeline::step(const RobotPose& pose) {
  const RobotPose goal = driven(pose);
  const bool stands = standsStill(goal) && !touched_;
  const bool was_lost = stands && report_.lost;
  const std::vector<std::size_t> behind = report_.behind;
  beginReport();
  report_.lost = was_lost;
  if (was_lost) report_.behind = behind;
  if (stands && !isLate()) return report_;
  const Bounded bounded(*this);
  if (tissue_.isLoading()) loadOn();
  if (stands) {
    finish();
    countLate();
  } else {
    late_iterations_ = 0;
    gave_up_ = false;
    unfinished_ = false;
    stepTo(goal, pose);
  }
  report_.late = isLate();
  report_.gave_up = gave_up_;
  return report_;
}

void Pipeline::beginReport() {
  report_.changed = touched_;
  report_.too_fast = report_.lost = report_.late = false;
  report_.gave_up = gave_up_;
  for (auto* tools : {&report_.behind, &report_.jumped, &report_.were_inside, &report_.torn_off}) {
    tools->clear();
  }
  report_.contact_ms = report_.solve_ms = 0.0;
  report_.substeps = 0;
}

// goal: the pose, with the ways of tools that a force drives.
void Pipeline::stepTo(const RobotPose& goal, const RobotPose& pose) {
  if (touched_) dead_end_.reset();
  report_.changed = report_.changed || !tissue_.isUntouched();
  RobotPose there = goal;  // but for tools that wait outside
  if (!last_pose_ || checkpoints_.empty()) {
    startAnew(there);
  } else {
    comeAndGo(there);
  }
  goBackTo(there);
  last_pose_ = walk(there);
  if (report_.lost) leaveStuck(there);
  if (report_.lost) leaveReleased(there);
  unhook(there);
  asked_ = goal;
  touched_ = report_.too_fast || drive(pose);  // there is a way left to go
  if (report_.too_fast || report_.lost) report_.behind = toolsBehind();
  for (Jaws& jaws : jaws_) jaws.let_go = jaws.let_go && (report_.too_fast || report_.lost);
  describeTools();
}

// One load step, the line of the package. Later rounds only if the solve moved nodes into a tool
// with a rigid patch; for the others the solver asks for the contacts itself (updateContacts).
// False: no shape could follow, all is as it was. `insists`: on a shape that did not converge, too.
bool Pipeline::advance(const RobotPose& pose, bool insists) {
  ++report_.substeps;
  Checkpoint good = toolsCheckpoint();  // its shape where there is something to solve
  pose_ = pose;
  openJaws();
  contacts_.ride(pose, tissue_);  // patches move with their tools
  for (int round = 0; round < kRigidRounds; ++round) {
    patches_.ride(pose, tissue_);
    if (round == 0) meet(pose);
    pushRigid(pose);  // robot pose -> contacts -> loading patches
    std::vector<LoadingPatch> patches = patchesOfTools();
    const std::vector<LoadingPatch>& before = tissue_.patches();
    if (!anyToolIn(patches) && !anyToolIn(before)) break;
    if (patches.empty() && wouldTouchAtRest(pose)) patches = lastTouches();
    if (round == 0) good.shape = tissue_.shape();
    follow(std::move(patches));  // loading patches -> solve
    if (any_rigid_ ? leaptFrom(good) : !settlesFrom(good, insists)) {
      goBackTo(good);
      return false;
    }
    if (!any_rigid_) break;
    if (deepestInRigid(pose) <= kDeepEnough * tissue_.lattice().spacing()) break;
    unfinished_ = round + 1 < kRigidRounds && isOutOfTime();
    if (unfinished_) break;
  }
  closeJaws();
  contacts_.commit(pose, tissue_);
  tearOff();
  dead_end_.reset();
  return true;
}

// Goes on where the solve ended on its way. False: no shape followed.
bool Pipeline::settlesFrom(const Checkpoint& good, bool insists) {
  for (int more = 0;; ++more) {
    const bool converged = tissue_.lastReport().status != SolveStatus::kUnconverged;
    if (isLost(good) || (!converged && !insists)) return false;
    if (more == kMoreSolves || !isUnsettled()) return true;
    unfinished_ = isOutOfTime();
    if (unfinished_) return true;
    follow(patchesOfTools());
  }
}

void Pipeline::follow(std::vector<LoadingPatch> patches) {
  const Stopwatch watch(report_.solve_ms);
  const SolveReport solved =
      tissue_.follow(std::move(patches), patches_.left(), !supports_.empty());
  if (solved.status == SolveStatus::kUnconverged) cycles_in_vain_ += solved.iterations;
  report_.changed = true;
}

// No load step takes tissue that is held so far.
bool Pipeline::leaptFrom(const Checkpoint& good) const {
  if (tissue_.isUntouched()) return false;
  const std::vector<Vec3>& now = tissue_.state().displacement;
  const std::vector<Vec3>& before = *good.shape.displacement;
  double farthest = 0.0;
  for (const auto& carriers : tissue_.surface().carriers) {
    for (const NodeWeight& carrier : carriers) {
      const Vec3 way = now[at(carrier.node)] - before[at(carrier.node)];
      farthest = std::max(farthest, way.squaredNorm());
    }
  }
  const double leap = kMostLeap * tissue_.lattice().spacing();
  return farthest > leap * leap;
}

// No tissue gets into this shape from the last good one, as where tools squeeze it flat.
bool Pipeline::isLost(const Checkpoint& good) const {
  if (leaptFrom(good)) return true;
  if (tissue_.lastReport().inverted_cells > good.shape.report.inverted_cells) return true;
  return wentThrough(good) || SlidingContacts::pushesAbsurdly(tissue_);
}

// Into what gives way, deeper than it was.
bool Pipeline::wentThrough(const Checkpoint& good) const {
  for (std::size_t link = 0; link < first_link_[tools_.size()] && link < depths_.size(); ++link) {
    const double before = link < good.depths.size() ? good.depths[link] : 0.0;
    if (depths_[link] > std::max(throughAt(link), before)) return true;
  }
  return false;
}

// Deeper in the surface (m), a link is on its way to the other side of it.
double Pipeline::throughAt(std::size_t link) const {
  return std::min(kThrough * tissue_.lattice().spacing(), kThroughTool * finder_.thickness(link));
}

// The solve ended on its way, as where tissue slips far.
bool Pipeline::isUnsettled() const {
  if (left_inside_ > kTooDeep * tissue_.lattice().spacing()) return true;
  if (tissue_.lastReport().status != SolveStatus::kUnconverged) return false;
  const ForceBalance forces = forceBalance();
  return forces.unbalanced().norm() > kMostUnbalanced * forces.tools.norm();
}

bool Pipeline::isRigid(int tool) const {
  return at(tool) < tools_.size() && tools_[at(tool)].patch == ToolConfig::Patch::kRigid;
}

// How deep the shape is in tools with rigid patches (m): the others' touches are the solver's.
double Pipeline::deepestInRigid(const RobotPose& pose) {
  double deepest = 0.0;
  for (const Contact& contact : contactsAt(pose, tissue_.state().displacement).contacts) {
    if (isRigid(contact.tool)) deepest = std::max(deepest, contact.depth_m);
  }
  return deepest;
}

// Nodes under a tool with a rigid patch go out of it.
void Pipeline::pushRigid(const RobotPose& pose) {
  if (!any_rigid_) return;
  for (int pass = 0; pass < kPushPasses; ++pass) {
    ContactSet contacts = contactsAt(pose, patches_.displacement(tissue_));
    auto& all = contacts.contacts;
    const double touches = kTouches * tissue_.lattice().spacing();
    const auto is_others = [&](const Contact& contact) {
      return !isRigid(contact.tool) || contact.depth_m < -touches;
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
    if (pass == 0) patches_.keepTouching(contacts, tissue_);
    if (deepest(contacts) <= 0.0) return;
    patches_.pushOut(contacts, tissue_, pose);
  }
}

// Of each tool that holds or pushes, and of each support that is near.
std::vector<LoadingPatch> Pipeline::patchesOfTools() const {
  std::vector<LoadingPatch> patches;
  for (std::size_t tool = 0; tool < names_.size(); ++tool) {
    const int index = static_cast<int>(tool);
    const bool may_push = tool >= tools_.size() || contacts_.pushes(index, tissue_);
    const std::vector<ContactSpring> springs =
        may_push ? contacts_.springsOf(index) : std::vector<ContactSpring>();
    if (springs.empty() && !patches_.holds(index)) continue;
    patches.push_back(patches_.loadingPatch(index));
    patches.back().contacts = springs;
  }
  return patches;
}

// Supports are no tools: they alone disturb nothing.
bool Pipeline::anyToolIn(const std::vector<LoadingPatch>& patches) const {
  const auto end = names_.begin() + static_cast<std::ptrdiff_t>(tools_.size());
  const std::size_t named = &patches == &tissue_.patches() ? tissue_.namedPatches() : 0;
  return std::any_of(
      patches.begin() + static_cast<std::ptrdiff_t>(named), patches.end(),
      [&](const auto& patch) { return std::find(names_.begin(), end, patch.name) != end; });
}

SolveReport Pipeline::settle() {
  const Bounded bounded(*this);
  const SolveReport report = balance();
  touch();
  return report;
}

SolveReport Pipeline::balance() {
  contacts_.ride(pose_, tissue_);
  patches_.ride(pose_, tissue_);
  meet(pose_);
  return tissue_.follow(patchesOfTools(), tissue_.freeNodes(), true);
}

void Pipeline::load(const LoadStep& step, const Tissue::OnIncrement& on_increment,
                    int most_increments) {
  const Bounded bounded(*this);
  tissue_.load(
      step,
      [&](int increment, int increments, const SolveReport& report) {
        contacts_.commit(pose_, tissue_);
        contacts_.ride(pose_, tissue_);
        describeTools();
        if (on_increment) on_increment(increment, increments, report);
      },
      most_increments);
  touch();
}

SolveReport Pipeline::release(const std::vector<std::string>& names) {
  const Bounded bounded(*this);
  const SolveReport report = tissue_.release(names);
  touch();
  return report;
}

CutReport Pipeline::cut(const std::vector<Vec3>& corners) {
  const Bounded bounded(*this);
  const CutReport report = tissue_.cut(corners);
  touch();
  return report;
}

void Pipeline::reset() {
  trial_from_.reset();
  patches_.clear();
  contacts_.clear();
  for (Jaws& jaws : jaws_) jaws.let_go = false;
  for (std::size_t tool = 0; tool < tools_.size(); ++tool) forgetJaws(tool);
  drives_.assign(tools_.size(), {});
  tissue_.reset();
  checkpoints_.clear();
  last_pose_.reset();
  pose_ = complete({});
  contacts_.commit(pose_, tissue_);
  unfinished_ = gave_up_ = false;
  late_iterations_ = 0;
  touched_ = true;
  describeTools();
}

// After the tissue changed by other means than the tools' motion.
void Pipeline::touch() {
  contacts_.commit(pose_, tissue_);
  touched_ = true;
  gave_up_ = false;
  late_iterations_ = 0;
  checkpoints_.clear();
  if (last_pose_) checkIn(*last_pose_);
  describeTools();
}

}  // namespace robot_tissue
