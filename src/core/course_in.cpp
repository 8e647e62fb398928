#include "course_in.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr int kFewestSteps = 3;            // of the smoother in a cycle
constexpr double kStepsOfRoot = 1.6;       // likewise, of the root of the greatest stiffness
constexpr double kSinglePrecision = 1e-3;  // tolerance that single precision reaches
constexpr int kMostTurns = 20;             // solves, until turning patches have settled
constexpr double kTurned = 1e-4;           // rad

}  // namespace

template <typename Real>
void CourseIn<Real>::forget() {
  factor_ = least_factor_;
  layers_ = kFirstLayers;
  has_start_ = has_way_ = false;
  knows_shape_ = false;
  loaded_.clear();
  held_ = 0.0;
}

template <typename Real>
void CourseIn<Real>::findLevels(const LatticeState& state) {
  if (cells_ == state.cells) return;
  levels_ = std::make_unique<LatticeLevels<Real>>(lattice_, model_, *state.cells, workers_.get());
  cells_ = state.cells;
  has_start_ = has_way_ = false;
  knows_shape_ = false;
  loaded_.clear();
  steps_ = std::max(
      kFewestSteps,
      static_cast<int>(std::lround(kStepsOfRoot * std::sqrt(finest().greatestStiffness()))));
  findLeastFactor(state);
}

template <typename Real>
SolveReport CourseIn<Real>::run(LoadedShape& shape, const PatchHold& hold,
                                const std::vector<int>& disturbed, const Budget& budget) {
  prepare(shape, hold, disturbed);
  SolveReport report;
  if (seeds_.high[0] < 0) return report;
  const bool changed = in_contact_ || !disturbed.empty();
  const bool carried_on = first_of_step_ && has_way_ && greatest_ > 0.0 && carryOn();
  first_of_step_ = false;
  for (int round = 0; round < kMostTurns; ++round) {
    report.status = iterate(changed, carried_on, budget);
    writeBack(shape, hold);
    if (!settlePatches(shape, hold) || report.status != SolveStatus::kOk) break;
  }
  knows_shape_ = true;
  report.iterations = cycles_;
  report.error_estimate = std::isfinite(error_) ? error_ : 1.0;
  answer(shape, hold, report);
  return report;
}

template <typename Real>
void CourseIn<Real>::prepare(LoadedShape& shape, const PatchHold& hold,
                             const std::vector<int>& disturbed) {
  findLevels(shape.state);
  levels_->bind(shape, hold);
  const bool others_moved = levels_->setDisplacement(shape.state.displacement, hold.held());
  limited_from_.clear();
  for (const NodeLimit& limit : limits_) {
    limited_from_.push_back(shape.state.displacement[at(limit.node)]);
  }
  if (first_of_step_) noteStep();
  free_nodes_ = 0.0;
  for (const std::uint8_t held : hold.held()) free_nodes_ += held != kAllHeld ? 1.0 : 0.0;
  findSeeds(shape, hold, disturbed, others_moved || !knows_shape_);
  confine(aroundSeeds());
  finest().findForces(true);
  in_contact_ = !hold.touched().empty();
  cycles_ = 0;
  greatest_ = unbalanced();
}

// Remembers the way of the last step, if anything moved in it.
template <typename Real>
void CourseIn<Real>::noteStep() {
  const Field<Real>& now = finest().displacement;
  if (has_start_ && step_start_ != now) {
    last_way_.swap(step_start_);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      last_way_[axis].resize(now[axis].size());
      subtract(now[axis].data(), last_way_[axis].data(), last_way_[axis].data(), finest().count());
    }
    has_way_ = true;
  }
  step_start_ = now;
  has_start_ = true;
}

template <typename Real>
void CourseIn<Real>::writeBack(LoadedShape& shape, const PatchHold& hold) const {
  for (std::size_t node = 0; node < shape.state.displacement.size(); ++node) {
    if (hold.held()[node] == kAllHeld) continue;
    const Vec3 moved = levels_->displacementOf(static_cast<int>(node));
    Vec3& place = shape.state.displacement[node];
    for (int axis = 0; axis < 3; ++axis) {
      if ((hold.held()[node] >> axis & 1) == 0) place[axis] = moved[axis];
    }
  }
}

// Patches by force go where the levels moved them, as rigid bodies do. True: one turned so far that
// its nodes are no longer where they were found to balance.
template <typename Real>
bool CourseIn<Real>::settlePatches(LoadedShape& shape, const PatchHold& hold) {
  bool any = false, turned = false;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    LoadingPatch& patch = shape.patches[index];
    const GroupVector motion = finest().firm.motion[index];
    if (!byForce(patch) || motion.isZero(0.0)) continue;
    movePatch(lattice_, patch, lattice_.spacing() * motion.template head<3>(),
              motion.template tail<3>(), shape.state);
    any = true;
    turned = turned || motion.template tail<3>().norm() > kTurned;
  }
  if (!any) return false;
  levels_->renewGroups(shape, hold);
  finest().findForces(true);
  return turned;
}

template <typename Real>
void CourseIn<Real>::answer(LoadedShape& shape, const PatchHold& hold, SolveReport& report) {
  held_ = answerPatches(shape, hold, report);
  double left = unbalanced();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    left = std::max(left, finest().firm.force[index].template head<3>().norm());
  }
  report.residual = left / std::max({held_, greatest_, kStill});
  report.active_nodes = nodesInBox(hold);
  report.layers = layersRaised();
}

// The greatest force of a patch on a node, in the levels' units.
template <typename Real>
double CourseIn<Real>::answerPatches(const LoadedShape& shape, const PatchHold& hold,
                                     SolveReport& report) const {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  const double unit = levels_->modulus() * lattice_.spacing() * lattice_.spacing();
  double held = 0.0;
  std::vector<Vec3> raw(shape.patches.empty() ? 0 : displacement.size());
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const int node : hold.hardOf(index)) {
      raw[at(node)] = unit * finest().wholeForce(levels_->entryOf(node));
      held = std::max(held, raw[at(node)].norm() / unit);
    }
    for (const RimSpring& spring : patch.rim) {
      const Vec3 stretch = spring.anchor - displacement[at(spring.node)];
      held = std::max(held, (stiffnessOf(patch, spring) * stretch).norm() / unit);
    }
    for (const ContactSpring& spring : patch.contacts) {
      held = std::max(held, forceOf(spring, displacement).norm() / unit);
    }
    report.patches.push_back(answerOf(lattice_, shape.state, patch, raw));
  }
  return held;
}

std::unique_ptr<LayeredCourse> makeLayeredCourse(const Lattice& lattice, const ElasticModel& model,
                                                 const LayeredOptions& options) {
  if (options.tolerance >= kSinglePrecision) {
    return std::make_unique<CourseIn<float>>(lattice, model, options);
  }
  return std::make_unique<CourseIn<double>>(lattice, model, options);
}

template class CourseIn<float>;
template class CourseIn<double>;

}  // namespace robot_tissue
