// What would balance the nodes, D^-1 f: each alone, or those that a membrane joins together. Up to
// eight nodes carry a vertex: their motions that leave it in place cost the membrane nothing, but
// by the blocks on the diagonal of its stiffness M they are as stiff as it is. So the smoother's D
// is, with the greatest eigenvalue L of D^-1 K,
//
//   D = D_cells + D_springs + M / L
//
// since a step of it goes by 1 / L of D^-1 f. Conjugate gradients find that, from what the nodes
// would do alone on.
#include <algorithm>
#include <utility>

#include "solvers/multigrid/level/conjugate_gradients.h"
#include "solvers/multigrid/level/constrained_nodes.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {

namespace tuning = level_tuning;

template <typename Real>
const std::vector<Vec3>& ConstrainedNodes<Real>::balancing() const {
  if (!are_inverses_known_) findInverses();
  if (coupling_ != nullptr) {
    balancing_ = balancingTogether();
  } else {
    takeFreeForces(balancing_);
    divide(balancing_);
  }
  return balancing_;
}

template <typename Real>
void ConstrainedNodes<Real>::findInverses() const {
  for (std::size_t i = 0; i < all_.size(); ++i) inverses_[i] = all_[i].stiffness.inverse();
  joined_.join(joining_, inverses_);
  are_inverses_known_ = true;
}

template <typename Real>
void ConstrainedNodes<Real>::takeFreeForces(std::vector<Vec3>& forces) const {
  forces = forces_;
  for (std::size_t i = 0; i < all_.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      if ((all_[i].held >> axis & 1U) != 0) forces[i][axis] = 0.0;
    }
  }
}

template <typename Real>
void ConstrainedNodes<Real>::divide(std::vector<Vec3>& forces) const {
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const Vec3 free = forces[i];
    forces[i] = inverses_[i] * free;
  }
  joined_.apply(forces);
}

template <typename Real>
void ConstrainedNodes<Real>::couple(std::shared_ptr<const LevelMembrane<Real>> membrane,
                                    double greatest) {
  coupling_ = std::move(membrane);
  greatest_ = greatest;
}

template <typename Real>
std::vector<Vec3> ConstrainedNodes<Real>::balancingTogether() const {
  std::vector<Vec3> forces;
  takeFreeForces(forces);
  return conjugateGradients(
      std::move(forces), {tuning::kTogetherShare, tuning::kMostTogether},
      [this](const std::vector<Vec3>& motions) { return timesTogether(motions); },
      [this](std::vector<Vec3> left) {
        divide(left);
        return left;
      });
}

// What stands in D for the membrane goes, and the membrane comes.
template <typename Real>
std::vector<Vec3> ConstrainedNodes<Real>::timesTogether(const std::vector<Vec3>& motions) const {
  std::vector<Vec3> forces, of_membrane;
  forces.reserve(all_.size());
  for (std::size_t i = 0; i < all_.size(); ++i) forces.push_back(all_[i].stiffness * motions[i]);
  joined_.addForces(motions, forces);
  for (const OwnStiffness& own : own_stiffness) {
    of_membrane.push_back(motions[at(own.constrained)]);
  }
  of_membrane = coupling_->timesStiffness(of_membrane);
  for (std::size_t i = 0; i < own_stiffness.size(); ++i) {
    const int index = own_stiffness[i].constrained;
    const Vec3 more = of_membrane[i] / greatest_ - own_stiffness[i].stiffness * motions[at(index)];
    for (int axis = 0; axis < 3; ++axis) {
      if (isFree(index, axis)) forces[at(index)][axis] += more[axis];
    }
  }
  return forces;
}

// One node's step cut alone would tear at the membrane, whose nodes go together.
template <typename Real>
void ConstrainedNodes<Real>::shortenTogether(double longest) {
  double greatest = longest;
  for (const ConstrainedNode& constrained : all_) {
    if (constrained.group < 0) {
      greatest = std::max(greatest, constrained.step.cwiseAbs().maxCoeff());
    }
  }
  for (ConstrainedNode& constrained : all_) {
    if (constrained.group < 0) constrained.step *= longest / greatest;
  }
}

template const std::vector<Vec3>& ConstrainedNodes<float>::balancing() const;
template void ConstrainedNodes<float>::findInverses() const;
template void ConstrainedNodes<float>::takeFreeForces(std::vector<Vec3>&) const;
template void ConstrainedNodes<float>::divide(std::vector<Vec3>&) const;
template void ConstrainedNodes<float>::couple(std::shared_ptr<const LevelMembrane<float>>, double);
template std::vector<Vec3> ConstrainedNodes<float>::balancingTogether() const;
template std::vector<Vec3> ConstrainedNodes<float>::timesTogether(const std::vector<Vec3>&) const;
template void ConstrainedNodes<float>::shortenTogether(double);
template const std::vector<Vec3>& ConstrainedNodes<double>::balancing() const;
template void ConstrainedNodes<double>::findInverses() const;
template void ConstrainedNodes<double>::takeFreeForces(std::vector<Vec3>&) const;
template void ConstrainedNodes<double>::divide(std::vector<Vec3>&) const;
template void ConstrainedNodes<double>::couple(std::shared_ptr<const LevelMembrane<double>>,
                                               double);
template std::vector<Vec3> ConstrainedNodes<double>::balancingTogether() const;
template std::vector<Vec3> ConstrainedNodes<double>::timesTogether(const std::vector<Vec3>&) const;
template void ConstrainedNodes<double>::shortenTogether(double);

}  // namespace robot_tissue
