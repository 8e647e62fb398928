#include "solvers/multigrid/hierarchy/coarse_correction.h"

#include <algorithm>
#include <cmath>

#include "simd/field_kernel.h"
#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {

namespace tuning = hierarchy_tuning;

template <typename Real>
CoarseCorrection<Real>::CoarseCorrection(CompositeGrid<Real>& grid,
                                         FasRestriction<Real>& restriction,
                                         UncoveredPart<Real>& uncovered)
    : grid_(grid), restriction_(restriction), uncovered_(uncovered) {
  reset();
}

template <typename Real>
void CoarseCorrection<Real>::reset() {
  motions_.resize(grid_.levelCount());
  for (std::size_t level = 0; level < motions_.size(); ++level) {
    for (auto& values : motions_[level]) values.assign(at(grid_.level(level).count()), Real(0));
  }
  missing_.clear();
  for (int entry = 0; entry < grid_.finest().count(); ++entry) {
    if (!grid_.finest().exists(entry)) missing_.push_back(entry);
  }
  group_motion_.clear();
  uncovered_motion_.clear();
}

template <typename Real>
void CoarseCorrection<Real>::find() {
  group_motion_.assign(grid_.finest().constrained.groups.size(), GroupVector::Zero());
  if (grid_.levelCount() == 1) return;
  restriction_.restrictTo(1);
  solve(1);
  grid_.transfer(0).prolong(grid_.level(1).displacement, restriction_.start(1), motions_.front());
  for (auto& values : motions_.front()) {
    for (const int entry : missing_) values[at(entry)] = Real(0);
  }
  group_motion_ = prolongedGroupMotion(1);
  if (!grid_.isWhole()) takeUncoveredMotion();
  if (!isFinite()) giveUp();
}

template <typename Real>
void CoarseCorrection<Real>::moveBy(double alpha) {
  grid_.finest().moveBy(motions_.front(), group_motion_, alpha);
  uncovered_.moveBy(uncovered_motion_, alpha);
}

template <typename Real>
double CoarseCorrection<Real>::squaredUncovered() const {
  return uncovered_.squared(uncovered_motion_);
}

template <typename Real>
void CoarseCorrection<Real>::solve(std::size_t index) {
  GridLevel<Real>& level = grid_.level(index);
  if (index + 1 == grid_.levelCount()) {
    level.smooth(tuning::kStepsCoarsest);
    return;
  }
  level.smooth(tuning::kStepsBefore);
  level.findForces(Find::kForces);
  correct(index);
  level.findForces(isTurned(index) ? Find::kForcesAndStiffness : Find::kForces);
  level.smooth(tuning::kStepsAfter);
}

// Whether it went so far from where its stiffness was found that this may look another way.
template <typename Real>
bool CoarseCorrection<Real>::isTurned(std::size_t index) const {
  return greatestIn(motions_[index], grid_.level(index).count()) > tuning::kSameStiffness;
}

// Moves a level by what the next coarser one says.
template <typename Real>
void CoarseCorrection<Real>::correct(std::size_t index) {
  const std::size_t coarse = index + 1;
  restriction_.restrictTo(coarse);
  solve(coarse);
  grid_.transfer(index).prolong(grid_.level(coarse).displacement, restriction_.start(coarse),
                                motions_[index]);
  grid_.level(index).moveBy(motions_[index], prolongedGroupMotion(coarse), 1.0);
  grid_.placeInterface(index);
}

// In the finer level's units; turns (rad) are the same.
template <typename Real>
std::vector<GroupVector> CoarseCorrection<Real>::prolongedGroupMotion(std::size_t coarse) const {
  std::vector<GroupVector> of_groups = grid_.level(coarse).constrained.motion;
  for (GroupVector& vector : of_groups) {
    vector.template head<3>() *= GridTransfer<Real>::kTwice;
  }
  return of_groups;
}

// What the coarse levels moved, as a motion yet to be made: they go back to where they started.
template <typename Real>
void CoarseCorrection<Real>::takeUncoveredMotion() {
  uncovered_motion_.resize(grid_.levelCount() - 1);
  for (std::size_t level = 1; level < grid_.levelCount(); ++level) {
    const Field<Real>& start = restriction_.start(level);
    Field<Real>& moved = uncovered_motion_[level - 1];
    Field<Real>& now = grid_.level(level).displacement;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      moved[axis].resize(now[axis].size());
      subtract(now[axis].data(), start[axis].data(), Real(1), moved[axis].data(),
               grid_.level(level).count());
    }
    now = start;
  }
}

template <typename Real>
bool CoarseCorrection<Real>::isFinite() const {
  double sum = squaredUncovered();
  for (const auto& values : motions_.front()) {
    sum += grid_.finest().sumOfSpans([&values](int first, int count) {
      return dotOf(values.data() + first, values.data() + first, count);
    });
  }
  for (const GroupVector& vector : group_motion_) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

// No motion. The levels go back to where they started: not all entries are set anew when a shape is
// restricted, and a number that is not finite would stay there for good, in all further solves.
template <typename Real>
void CoarseCorrection<Real>::giveUp() {
  for (std::size_t level = 1; level < grid_.levelCount(); ++level) {
    grid_.level(level).displacement = restriction_.start(level);
  }
  for (auto& values : motions_.front()) std::fill(values.begin(), values.end(), Real(0));
  for (GroupVector& vector : group_motion_) vector.setZero();
  for (Field<Real>& of_level : uncovered_motion_) {
    for (auto& values : of_level) std::fill(values.begin(), values.end(), Real(0));
  }
}

template class CoarseCorrection<float>;
template class CoarseCorrection<double>;

}  // namespace robot_tissue
