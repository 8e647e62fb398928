#include "solvers/multigrid/hierarchy/fas_restriction.h"

namespace robot_tissue {

template <typename Real>
FasRestriction<Real>::FasRestriction(CompositeGrid<Real>& grid,
                                     const LevelConstraints<Real>& constraints)
    : grid_(grid), constraints_(constraints) {
  reset();
}

template <typename Real>
void FasRestriction<Real>::reset() {
  has_relief_ = false;
  to_.assign(grid_.levelCount() - 1, {});
  for (std::size_t coarse = 1; coarse < grid_.levelCount(); ++coarse) {
    for (auto& values : to_[coarse - 1].residual) {
      values.assign(at(grid_.level(coarse).count()), Real(0));
    }
    to_[coarse - 1].start = to_[coarse - 1].residual;
  }
}

template <typename Real>
void FasRestriction<Real>::restrictTo(std::size_t index) {
  constexpr double kTwice = GridTransfer<Real>::kTwice;
  GridLevel<Real>& fine = grid_.level(index - 1);
  GridLevel<Real>& coarse = grid_.level(index);
  const GridTransfer<Real>& transfer = grid_.transfer(index - 1);
  ToLevel& to = to_[index - 1];
  fine.showInterface();
  transfer.restrictForces(fine.force, to.residual);
  fine.hideInterface();
  transfer.restrictDisplacement(fine.displacement, coarse.part().covered, coarse.displacement);
  to.start = coarse.displacement;
  coarse.startMembrane();
  for (GroupVector& vector : coarse.constrained.motion) vector.setZero();
  restrictSprings(index);
  to.residual_of_groups = fine.constrained.force;
  for (GroupVector& vector : to.residual_of_groups) {
    vector.template head<3>() /= kTwice * kTwice;
    vector.template tail<3>() /= kTwice * kTwice * kTwice;
  }
  if (has_relief_) coarse.relieve(fine);
  coarse.setFasRightHandSide(to.residual, to.residual_of_groups);
}

template <typename Real>
void FasRestriction<Real>::relieve(bool with_relief) {
  if (has_relief_ == with_relief) return;
  has_relief_ = with_relief;
  if (with_relief) return;
  for (std::size_t coarse = 1; coarse < grid_.levelCount(); ++coarse) {
    grid_.level(coarse).endRelief();
  }
}

// As stiff as the fine level's are now (E0 h: half the number), and without a force at the start.
template <typename Real>
void FasRestriction<Real>::restrictSprings(std::size_t index) {
  const GridLevel<Real>& fine = grid_.level(index - 1);
  GridLevel<Real>& coarse = grid_.level(index);
  const std::vector<int>& fine_springs = constraints_.fineSpringsOf(index);
  coarse.constrained.takePlaces(coarse.displacement);
  for (std::size_t i = 0; i < coarse.constrained.springs.size(); ++i) {
    LevelSpring& spring = coarse.constrained.springs[i];
    if (i < fine_springs.size()) {
      spring.stiffness =
          fine.constrained.springs[at(fine_springs[i])].stiffness / GridTransfer<Real>::kTwice;
    }
    spring.anchor = coarse.constrained.meanOf(spring);
  }
  coarse.constrained.leaveOutLoose();
}

template class FasRestriction<float>;
template class FasRestriction<double>;

}  // namespace robot_tissue
