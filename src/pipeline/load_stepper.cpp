#include "load_stepper.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "stopwatch.h"
#include "tuning.h"
#include "way_lengths.h"

namespace robot_tissue {
namespace {

Bedding beddingOf(const World& world) {
  return world.has_supports ? Bedding::kSupports : Bedding::kFixedNodes;
}

}  // namespace

// One load step, the line of the package.
bool LoadStepper::advance(const RobotPose& pose, IfUnconverged otherwise) {
  state_.under_way.reset();
  world_.unfinished = false;
  ++world_.report.substeps;
  if (!takesShapeOrLeaves(pose, otherwise)) return false;
  arrive();
  return true;
}

void LoadStepper::arrive() {
  world_.tissue.endTimeStep();
  world_.reached_s = world_.pose.stamp_s;
  grasping_.closeJaws();
  world_.sliding.commit(world_.pose, world_.tissue);
  endOverpulled();
  tear();
  world_.dead_end.reset();
}

bool LoadStepper::takesShape(const RobotPose& pose, Checkpoint& good, IfUnconverged otherwise) {
  Patience& patience = world_.tissue.patience();
  const Patience::LoadStep load_step(patience);
  const bool follows = followTools(pose, good, otherwise);
  if (!follows && !waits_for_call_) patience.noteLost();
  return follows;
}

// Later rounds only if the solve moved nodes into a tool with a rigid patch; for the others the
// solver asks for the contacts itself (ContactUpdate). False: no shape followed.
bool LoadStepper::followTools(const RobotPose& pose, Checkpoint& good, IfUnconverged otherwise) {
  const double spacing = world_.tissue.lattice().spacing();
  for (int round = 1;; ++round) {
    world_.sticking.ride(pose, world_.tissue);
    if (round == 1) {
      expectTimeStep(durationOf(good.pose, pose));
      meet(pose, wayOfKnownPlaces());
    }
    pushRigid(pose);  // robot pose -> contacts -> loading patches
    std::vector<LoadingPatch> patches = patchesOfTools(world_);
    const std::vector<LoadingPatch>& before = world_.tissue.patches();
    const bool stands = round == 1 && !world_.tissue.isMoving();
    if (stands && !anyToolIn(patches, world_) && !anyToolIn(before, world_)) return true;
    if (patches.empty()) patches = touchesAtRest(pose);
    if (round == 1) {
      good.shape = world_.tissue.shape();
      beginTimeStep(durationOf(good.pose, pose),
                    patches.empty() ? Touched::kByNone : Touched::kByTools);
    }
    if (round == 1 && leavesToNextCall()) return false;
    follow(std::move(patches));  // loading patches -> solve
    if (!settlesFrom(good, otherwise)) return false;
    if (!world_.tools.anyRigid() || world_.unfinished) return true;
    const double deepest = deepestInRigid(pose);
    if (deepest <= tuning::kDeepEnough * spacing) return true;
    const bool is_last = round == tuning::kRigidRounds || world_.tissue.patience().left() == 0;
    if (is_last) return deepest <= tuning::kThrough * spacing;
    world_.unfinished = !world_.tissue.isInTimeStep() && isOutOfTime();
    if (world_.unfinished) return true;
  }
}

// s: time between the poses. A robot that jumps would throw the tissue away: a tool that goes
// faster than a load step in kShortestTimeStep takes that for each.
double LoadStepper::durationOf(const RobotPose& from, const RobotPose& to) const {
  const double duration = to.stamp_s - from.stamp_s;
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return duration;
  const double load_steps = WayLengths(world_).stepsBetween(from, to);
  return std::max(duration, tuning::kShortestTimeStep * std::min(1.0, load_steps));
}

void LoadStepper::expectTimeStep(double duration) {
  if (!world_.tissue.hasTime() || !(duration > 0.0)) return;
  world_.tissue.expectTimeStep(duration, Touched::kByTools);
}

// Without a duration the tools are elsewhere at once, as where they come in anew.
void LoadStepper::beginTimeStep(double duration, Touched touched) {
  if (world_.tissue.hasTime() && duration > 0.0) world_.tissue.beginTimeStep(duration, touched);
}

// Solves on, kMoreSolves times at most, while the solve has not settled (isUnsettled). False: the
// shape is lost, or did not converge where that is refused.
bool LoadStepper::settlesFrom(const Checkpoint& good, IfUnconverged otherwise) {
  for (int more = 0;; ++more) {
    if (isLost(good) || isRefused(otherwise)) return false;
    const bool is_last = more == tuning::kMoreSolves || world_.tissue.patience().left() == 0;
    if (is_last || !isUnsettled()) return true;
    const bool converged = world_.tissue.lastReport().status != SolveStatus::kUnconverged;
    if (converged && world_.tissue.mayShowUnsettled()) {
      world_.tissue.noteUnsettled();
      return true;
    }
    world_.unfinished = !world_.tissue.isInTimeStep() && isOutOfTime();
    if (world_.unfinished) return true;
    solveOn();
  }
}

// Where time ran out on the way through rounds, the forces are of no shape that the tissue takes.
bool LoadStepper::isRefused(IfUnconverged otherwise) const {
  return world_.tissue.lastReport().status == SolveStatus::kUnconverged &&
         (otherwise == IfUnconverged::kRefuse || isOutOfTime());
}

void LoadStepper::follow(std::vector<LoadingPatch> patches) {
  const Stopwatch watch(world_.report.solve_ms);
  world_.tissue.follow(std::move(patches), world_.sticking.left(), beddingOf(world_));
  world_.report.changed = true;
}

// Whether a vertex of the surface went farther than kMostLeap spacings: no load step moves tissue
// that tools hold so far, so the solve threw it away.
bool LoadStepper::leaptFrom(const Checkpoint& good) const {
  if (world_.tissue.isUntouched()) return false;
  const std::vector<Vec3>& now = world_.tissue.state().displacement;
  const std::vector<Vec3>& before = *good.shape.displacement;
  double farthest = 0.0;
  for (const CarrierRange carriers : world_.tissue.surface().carriers) {
    const Vec3 way = carriedFrom(
        Vec3::Zero(), carriers, [&](int node) -> Vec3 { return now[at(node)] - before[at(node)]; });
    farthest = std::max(farthest, way.squaredNorm());
  }
  const double leap = tuning::kMostLeap * world_.tissue.lattice().spacing();
  return farthest > leap * leap;
}

// Whether the shape is none that tissue gets into from the last good one: it leapt, has more
// inverted cells, a link went through its surface, or a touch pushes harder than any tissue does.
bool LoadStepper::isLost(const Checkpoint& good) const {
  return leaptFrom(good) || turnedOver(good) || wentThrough(good) || isSwallowed(good) ||
         SlidingContacts::pushesAbsurdly(world_.tissue);
}

// More cells than before are inside out.
bool LoadStepper::turnedOver(const Checkpoint& good) const {
  return world_.tissue.resistsInversion() &&
         world_.tissue.lastReport().inverted_cells > good.shape.report.inverted_cells;
}

// Whether a link or support is deeper in tissue that gives way than throughAt, and than it was. Of
// rigid tools deepestInRigid tells.
bool LoadStepper::wentThrough(const Checkpoint& good) const {
  const std::vector<double>& depths = touch_finder_.depths();
  for (std::size_t tool = 0; tool < world_.tools.sizeWithSupports(); ++tool) {
    if (world_.tools.isRigid(static_cast<int>(tool))) continue;
    const std::size_t end = std::min(world_.tools.endLink(tool), depths.size());
    for (std::size_t link = world_.tools.firstLink(tool); link < end; ++link) {
      const double before = link < good.depths.size() ? good.depths[link] : 0.0;
      if (depths[link] > std::max(throughAt(link), before)) return true;
    }
  }
  return false;
}

// Whether a link that touched touches nothing any more and stands in the tissue all the same:
// contacts are found beside the surface, so one that is all inside has none.
bool LoadStepper::isSwallowed(const Checkpoint& good) const {
  std::vector<std::size_t> links;
  for (const SlidingContacts::ContactConstraint& touch : good.contacts.touches()) {
    const auto link = at(touch.contact.link);
    if (!world_.isInWound(link)) links.push_back(link);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  const auto touches = [&](std::size_t link) {
    const auto& all = world_.sliding.touches();
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& touch) -> bool { return at(touch.contact.link) == link; });
  };
  links.erase(std::remove_if(links.begin(), links.end(), touches), links.end());
  return !links.empty() && isAnyThrough(links, world_.pose);
}

bool LoadStepper::isAnyThrough(const std::vector<std::size_t>& links, const RobotPose& pose) const {
  const std::vector<double> depths =
      world_.finder.penetrations(links, pose, world_.tissue.surface(), world_.tissue.vertices());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (depths[i] > throughAt(links[i])) return true;
  }
  return false;
}

// Depth in the surface (m) beyond which a link is on its way to the other side of it.
double LoadStepper::throughAt(std::size_t link) const {
  return std::min(tuning::kThrough * world_.tissue.lattice().spacing(),
                  tuning::kThroughOfThickness * world_.finder.thickness(link));
}

// Whether the solve ended before it was done, as where tissue slips far: a point is left too deep
// or, unconverged, the forces on the tissue do not add up to zero.
bool LoadStepper::isUnsettled() const {
  if (world_.tissue.goesThroughTime() || !world_.tissue.areContactsSettled()) return false;
  if (contact_update_.leftInside() > tuning::kTooDeep * world_.tissue.lattice().spacing()) {
    return true;
  }
  if (world_.tissue.lastReport().status != SolveStatus::kUnconverged) return false;
  const ForceBalance forces = forceBalanceOf(world_);
  return forces.unbalanced().norm() > tuning::kMostUnbalanced * forces.tools.norm();
}

// How deep the shape is in tools with rigid patches (m): the others' touches are the solver's.
double LoadStepper::deepestInRigid(const RobotPose& pose) {
  double deepest = 0.0;
  for (const Contact& contact :
       touch_finder_.contactsAt(pose, world_.tissue.state().displacement).contacts) {
    if (world_.tools.isRigid(contact.tool)) deepest = std::max(deepest, contact.depth_m);
  }
  return deepest;
}

// Nodes under a tool with a rigid patch go out of it.
void LoadStepper::pushRigid(const RobotPose& pose) {
  if (!world_.tools.anyRigid()) return;
  for (int pass = 0; pass < tuning::kPushPasses; ++pass) {
    ContactSet contacts =
        touch_finder_.contactsAt(pose, world_.sticking.displacement(world_.tissue));
    auto& all = contacts.contacts;
    const double touches = tuning::kTouchingGap * world_.tissue.lattice().spacing();
    const auto is_others = [&](const Contact& contact) {
      return !world_.tools.isRigid(contact.tool) || contact.depth_m < -touches;
    };
    all.erase(std::remove_if(all.begin(), all.end(), is_others), all.end());
    if (pass == 0) world_.sticking.keepTouching(contacts, world_.tissue);
    if (deepest(contacts) <= 0.0) return;
    world_.sticking.pushOut(contacts, world_.tissue, pose);
  }
}

// There is no shape to go back to: one that is none of tissue is kept, and told as unconverged.
SolveReport LoadStepper::balance() {
  world_.sliding.ride(world_.pose, world_.tissue);
  world_.sticking.ride(world_.pose, world_.tissue);
  meet(world_.pose);
  world_.tissue.follow(patchesOfTools(world_), world_.tissue.freeNodes(), Bedding::kSupports);
  tear();
  if (wentThrough({}) || SlidingContacts::pushesAbsurdly(world_.tissue)) {
    world_.tissue.noteUnconverged();
  }
  return world_.tissue.lastReport();
}

// How far a tool may have gone since the last search (m) for the places that it found to do for the
// first solve, after which is searched anew. Where nothing touched there may be no solve, and in a
// jam, as among tools that are thin for the lattice, all of it counts.
double LoadStepper::wayOfKnownPlaces() const {
  if (!anyToolIn(world_.tissue.patches(), world_)) return 0.0;
  if (world_.tissue.lastReport().status != SolveStatus::kOk) return 0.0;
  const double spacing = world_.tissue.lattice().spacing();
  bool any_mesh = false;
  for (std::size_t link = 0; link < world_.tools.linkCount(); ++link) {
    if (world_.finder.thickness(link) < tuning::kThickForPlaces * spacing) return 0.0;
    any_mesh = any_mesh || world_.finder.hasMesh(link);
  }
  return (any_mesh ? tuning::kKnownPlacesOnMesh : tuning::kKnownPlaces) * spacing;
}

void LoadStepper::meet(const RobotPose& pose, double way) {
  touch_finder_.beginStep();
  const std::vector<std::uint8_t> held = world_.sticking.heldNodes(world_.tissue);
  const ContactSet contacts = touch_finder_.touchesAt(pose, held, way);
  world_.sliding.meet(contacts, pose, world_.tissue, held,
                      touch_finder_.trackWandering(pose, contacts));
}

// Patches of all tools, also of those that touch nothing now, where they would touch the rest
// shape: the tissue comes back onto them. Else none.
std::vector<LoadingPatch> LoadStepper::touchesAtRest(const RobotPose& pose) {
  std::vector<LoadingPatch> patches;
  if (!touch_finder_.wouldTouchAtRest(pose)) return patches;
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    patches.push_back(world_.sticking.loadingPatch(static_cast<int>(tool)));
    patches.back().contacts = world_.sliding.springsOf(static_cast<int>(tool));
  }
  return patches;
}

Checkpoint LoadStepper::toolsCheckpoint() const {
  return {
      world_.pose,           {}, world_.sticking.attachments(), world_.sliding, grasping_.jaws(),
      touch_finder_.depths()};
}

Checkpoint LoadStepper::checkpoint() const {
  Checkpoint all = toolsCheckpoint();
  all.shape = world_.tissue.shape();
  return all;
}

// Balance where a tool, or all of them, let go.
void LoadStepper::lieDown() {
  if (world_.tissue.isUntouched()) return;
  world_.sliding.ride(world_.pose, world_.tissue);
  meet(world_.pose);
  world_.tissue.follow(patchesOfTools(world_), {}, beddingOf(world_));
}

// Graspers that are pulled harder than they hold lose the tissue, or take out what they hold of it.
void LoadStepper::endOverpulled() {
  bool any_lost = false;
  for (const std::size_t tool : grasping_.overpulled()) {
    if (takesOut(tool)) continue;
    grasping_.lose(tool);
    addOnce(tool, world_.report.torn_off);
    any_lost = true;
  }
  if (!any_lost) return;
  world_.sticking.ride(world_.pose, world_.tissue);
  world_.tissue.follow(patchesOfTools(world_), world_.sticking.left(), beddingOf(world_));
  world_.sliding.commit(world_.pose, world_.tissue);
}

// False: it lets go, as what it holds is nowhere joined to the rest, too.
bool LoadStepper::takesOut(std::size_t tool) {
  if (!world_.tools[tool].grasp.tears_out) return false;
  if (world_.is_trial) return true;
  const int before = world_.tissue.springsTorn();
  const Stopwatch watch(world_.report.solve_ms);
  if (!world_.tissue.tearOut(world_.sticking.nodes(static_cast<int>(tool)))) return false;
  world_.report.springs_torn += world_.tissue.springsTorn() - before;
  world_.report.changed = true;
  addOnce(tool, world_.report.torn_out);
  world_.sliding.commit(world_.pose, world_.tissue);
  return true;
}

void LoadStepper::tear() {
  if (world_.is_trial || !world_.tissue.mayTear()) return;
  const int before = world_.tissue.springsTorn();
  const std::uint64_t topology = world_.tissue.surface().revision;
  const Stopwatch watch(world_.report.solve_ms);
  world_.tissue.tear();
  if (world_.tissue.surface().revision == topology) return;
  world_.report.springs_torn += world_.tissue.springsTorn() - before;
  world_.report.changed = true;
  world_.sliding.commit(world_.pose, world_.tissue);
}

void LoadStepper::goBackTo(const Checkpoint& good) {
  world_.pose = good.pose;
  world_.reached_s = good.pose.stamp_s;
  world_.tissue.restore(good.shape);
  world_.sticking.restore(good.attachments, world_.tissue);
  world_.sliding = good.contacts;
  grasping_.restore(good.jaws);
  touch_finder_.restoreDepths(good.depths);
}

}  // namespace robot_tissue
