#include "solvers/multigrid/level/grid_level.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/steady_numbers.h"
#include "simd/field_kernel.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = level_tuning;

}  // namespace

template <typename Real>
GridLevel<Real>::GridLevel(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
                           const LevelPart& part, double greatest_stiffness)
    : cells_(grid, beside, cells, part) {
  for (Field<Real>* field : {&displacement, &right_hand_side, &force, &last_step_}) {
    for (auto& values : *field) values.assign(at(count()), Real(0));
  }
  for (auto& values : inverse_) values.assign(at(count()), Real(0));
  for (auto* values : {&free_, &rest_stiffness_}) values->assign(at(count()), Real(0));
  held_.assign(at(count()), 0);
  cells_.findForces({displacement, right_hand_side, free_, force, inverse_},
                    Find::kForcesAndStiffness);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(cells_.stiffness[axis].data(), Real(1.0 / 3.0), rest_stiffness_.data(), count());
  }
  bind();
  if (greatest_stiffness > 0.0) {
    step_ = 1.0 / greatest_stiffness;
  } else {
    measureSteps();
  }
  cells_.per_greatest = static_cast<Real>(step_);
}

// The power method at rest, u <- D^-1 K u, with the Rayleigh quotient (u, K u) / (u, D u); it
// starts with numbers that are the same each time.
template <typename Real>
void GridLevel<Real>::measureSteps() {
  findForces();
  SteadyNumbers numbers;
  for (auto& values : displacement) {
    for (std::size_t node = 0; node < values.size(); ++node) {
      values[node] = free_[node] * numbers.nextReal<Real>();
    }
  }
  double greatest = 1.0;
  for (int probe = 0; probe < tuning::kPowerSteps; ++probe) {
    double squared = 0.0;
    for (const auto& values : displacement) {
      squared += dotOf(values.data(), values.data(), count());
    }
    if (squared == 0.0) break;
    const Real scale = static_cast<Real>(tuning::kPowerMotion * std::sqrt(count() / squared));
    for (auto& values : displacement) {
      for (Real& value : values) value *= scale;
    }
    findForces(Find::kForces);
    double product = 0.0, length = 0.0;
    for (int node = 0; node < count(); ++node) {
      const Vec3 moved = vectorAt(displacement, node), pulls = vectorAt(force, node);
      product -= moved.dot(pulls);
      length += moved.dot(matrixAt(cells_.stiffness, node) * moved);
      const Vec3 next = -matrixAt(inverse_, node) * pulls;
      for (int axis = 0; axis < 3; ++axis) {
        displacement[at(axis)][at(node)] = static_cast<Real>(next[axis]);
      }
    }
    greatest = std::max(greatest, product / length);
  }
  step_ = 1.0 / (tuning::kStiffnessMargin * greatest);
  for (auto& values : displacement) std::fill(values.begin(), values.end(), Real(0));
}

template <typename Real>
void GridLevel<Real>::setMembrane(LevelMembrane<Real> membrane) {
  membrane_ = std::make_shared<LevelMembrane<Real>>(std::move(membrane));
  for (const int entry : membrane_->entries()) {
    constrained.own_stiffness.emplace_back();
    constrained.own_stiffness.back().node = entry;
  }
  bind();
}

template <typename Real>
void GridLevel<Real>::bindMembrane(const GridLevel& fine) {
  membrane_->bind(*fine.membrane_, fine.held_);
}

template <typename Real>
void GridLevel<Real>::renewMembrane() {
  membrane_->renew(displacement);
  const std::vector<Eigen::Matrix3d> diagonal = membrane_->diagonal(greatestStiffness());
  for (std::size_t i = 0; i < diagonal.size(); ++i) {
    constrained.own_stiffness[i].stiffness = diagonal[i];
  }
}

template <typename Real>
void GridLevel<Real>::coupleMembrane(bool together) {
  constrained.couple(together ? membrane_ : nullptr, greatestStiffness());
}

template <typename Real>
void GridLevel<Real>::startMembrane() {
  if (membrane_) membrane_->startAt(displacement);
}

template <typename Real>
void GridLevel<Real>::freeAll() {
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  are_holds_new_ = true;
  constrained.springs.clear();
  constrained.groups.clear();
}

template <typename Real>
void GridLevel<Real>::bind() {
  if (are_holds_new_) takeHolds();
  constrained.bind(held_, partly_held_);
  free_ = not_held_;
  for (const int node : constrained.nodes()) free_[at(node)] = Real(0);
}

template <typename Real>
void GridLevel<Real>::takeHolds() {
  are_holds_new_ = false;
  not_held_.assign(at(count()), Real(0));
  interface_.clear();
  partly_held_.clear();
  const GridBox& free = part().free;
  const auto look = [&](int node, const std::array<int, 3>& place) {
    if (held_[at(node)] != 0 || !exists(node)) return;
    if (free.has(place)) {
      not_held_[at(node)] = Real(1);
    } else {
      interface_.push_back(node);
    }
  };
  const GridBox all = grid().whole();
  for (int k = 0; k <= all.high[2]; ++k) {
    for (int j = 0; j <= all.high[1]; ++j) {
      for (int i = 0; i <= all.high[0]; ++i) look(grid().index(i, j, k), {i, j, k});
    }
  }
  for (int node = grid().beside; node < count(); ++node) look(node, placeOf(node));
  for (int node = 0; node < count(); ++node) {
    const std::uint8_t held = held_[at(node)];
    if (held != 0 && held != kAllAxes) partly_held_.push_back(node);
  }
}

template <typename Real>
void GridLevel<Real>::showInterface() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int node : interface_) force[axis][at(node)] = cells_.whole[axis][at(node)];
  }
}

template <typename Real>
void GridLevel<Real>::hideInterface() {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const int node : interface_) force[axis][at(node)] = Real(0);
  }
}

template <typename Real>
void GridLevel<Real>::relieve(const GridLevel& finer) {
  StretchMeans means(finer.grid());
  finer.cells_.addStretches(finer.displacement, means);
  cells_.relieve(displacement, means);
}

template <typename Real>
void GridLevel<Real>::findForces(Find what) {
  cells_.findForces({displacement, right_hand_side, free_, force, inverse_}, what);
  if (membrane_) membrane_->addForces(displacement, cells_.whole);
  constrained.findForces(cells_, displacement, what, force);
  is_stiffness_known_ = what == Find::kForcesAndStiffness;
}

template <typename Real>
Field<Real> GridLevel<Real>::viscousForces(const Field<Real>& at_displacement) {
  Field<Real> none = force;
  for (auto& values : none) std::fill(values.begin(), values.end(), Real(0));
  cells_.findViscousForces({at_displacement, none, free_, force, inverse_});
  is_stiffness_known_ = false;
  return cells_.whole;
}

template <typename Real>
void GridLevel<Real>::findForcesOfConstrained() {
  cells_.takeFree({displacement, right_hand_side, free_, force, inverse_});
  constrained.findForces(cells_, displacement, Find::kForcesAndStiffness, force);
}

// Chebyshev's polynomials of the fourth kind (Lottes 2022): with lambda the greatest eigenvalue of
// D^-1 K,
//
//   z_k = (2 k - 3) / (2 k + 1) z_(k-1) + (8 k - 4) / (2 k + 1) / lambda D^-1 f(u),   u += z_k
template <typename Real>
void GridLevel<Real>::smooth(int steps) {
  clearStep();
  for (int k = 1; k <= steps; ++k) {
    const double keep = k == 1 ? 0.0 : (2.0 * k - 3.0) / (2.0 * k + 1.0);
    const double share = (8.0 * k - 4.0) / (2.0 * k + 1.0) * step_;
    const StepAlong<Real> step = {static_cast<Real>(keep), static_cast<Real>(share),
                                  static_cast<Real>(tuning::kLongestStep)};
    cells_.forParts([&](int first, int length) {
      stepAlong(pointersTo(std::as_const(inverse_), first), pointersTo(std::as_const(force), first),
                step, pointersTo(last_step_, first), pointersTo(displacement, first), length);
    });
    constrained.step(keep, share, tuning::kLongestStep, displacement);
    if (k == steps) break;
    findForces(Find::kForces);
    // The stiffest springs of all: without them in D the next step would throw it far off.
    if (constrained.hasNewPush()) {
      constrained.findForces(cells_, displacement, Find::kForcesAndSprings, force);
    }
  }
}

template <typename Real>
void GridLevel<Real>::smoothAndFindForces(int steps) {
  if (!is_stiffness_known_) findForces();
  smooth(steps);
  findForces(Find::kForcesAndSprings);
}

template <typename Real>
void GridLevel<Real>::clearStep() {
  cells_.forParts([this](int first, int length) {
    for (auto& values : last_step_) std::fill_n(values.begin() + first, length, Real(0));
  });
  constrained.clearStep();
}

template <typename Real>
void GridLevel<Real>::clearRightHandSide() {
  for (auto& values : right_hand_side) std::fill(values.begin(), values.end(), Real(0));
  std::fill(constrained.right_hand_side.begin(), constrained.right_hand_side.end(),
            GroupVector::Zero());
}

template <typename Real>
void GridLevel<Real>::setFasRightHandSide(const Field<Real>& residual,
                                          const std::vector<GroupVector>& residual_of_groups) {
  clearRightHandSide();
  const bool covers_all = part().covered == part().free;
  if (!covers_all) {
    cells_.findForcesOfCovered({displacement, right_hand_side, free_, force, inverse_});
    of_covered_ = cells_.whole;
  }
  findForces();
  if (covers_all) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      fasRightHandSide(residual[axis].data(), free_.data(), right_hand_side[axis].data(),
                       force[axis].data(), count());
    }
  } else {
    setFasRightHandSideInPart(residual);
  }
  setFasRightHandSideOfConstrained(residual, residual_of_groups);
}

// In the covered part f = f_c: r - f_c is what GridLevel::setFasRightHandSide asks for there, too.
template <typename Real>
void GridLevel<Real>::setFasRightHandSideInPart(const Field<Real>& residual) {
  GridBox with_interface = part().covered;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    with_interface.low[axis] = std::max(with_interface.low[axis] - 1, 0);
    with_interface.high[axis] = std::min(with_interface.high[axis] + 1, grid().size[axis] - 1);
  }
  const int length = with_interface.high[0] - with_interface.low[0] + 1;
  const int beside = grid().beside;  // all covered
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fasRightHandSideBeside(residual[axis].data() + beside, of_covered_[axis].data() + beside,
                           free_.data() + beside, right_hand_side[axis].data() + beside,
                           force[axis].data() + beside, count() - beside);
    for (int k = with_interface.low[2]; k <= with_interface.high[2]; ++k) {
      for (int j = with_interface.low[1]; j <= with_interface.high[1]; ++j) {
        const int first = grid().index(with_interface.low[0], j, k);
        fasRightHandSideBeside(residual[axis].data() + first, of_covered_[axis].data() + first,
                               free_.data() + first, right_hand_side[axis].data() + first,
                               force[axis].data() + first, length);
      }
    }
  }
}

template <typename Real>
void GridLevel<Real>::setFasRightHandSideOfConstrained(
    const Field<Real>& residual, const std::vector<GroupVector>& residual_of_groups) {
  const std::vector<int> constrained_nodes = constrained.nodes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < constrained_nodes.size(); ++i) {
      const std::size_t node = at(constrained_nodes[i]);
      if (!constrained.isFree(static_cast<int>(i), static_cast<int>(axis))) continue;
      if (!part().covered.has(placeOf(constrained_nodes[i]))) continue;
      right_hand_side[axis][node] = residual[axis][node] - force[axis][node];
      force[axis][node] = residual[axis][node];
    }
  }
  for (std::size_t group = 0; group < constrained.groups.size(); ++group) {
    constrained.right_hand_side[group] = residual_of_groups[group] - constrained.force[group];
    constrained.force[group] = residual_of_groups[group];
  }
  constrained.setForces(force);
}

template <typename Real>
void GridLevel<Real>::moveBy(const Field<Real>& motion, const std::vector<GroupVector>& of_groups,
                             double alpha) {
  cells_.forParts([&](int first, int length) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      addWhereFree(motion[axis].data() + first, free_.data() + first, static_cast<Real>(alpha),
                   displacement[axis].data() + first, length);
    }
  });
  constrained.moveBy(motion, of_groups, alpha, displacement);
}

// By their weights, of the motion that motionOf(node) is.
template <typename Real>
template <typename MotionOf>
double GridLevel<Real>::weightedSquares(MotionOf motionOf) const {
  double squared = 0.0;
  for (std::size_t node = 0; node < weight_roots_.size(); ++node) {
    const Vec3 motion = motionOf(static_cast<int>(node));
    squared += (static_cast<double>(weight_roots_[node]) * motion).squaredNorm();
  }
  return squared;
}

template <typename Real>
double GridLevel<Real>::squaredLocalMotion() const {
  const double squared = constrained.squaredLocalMotion(weight_roots_);
  if (weight_roots_.empty()) {
    return squared + sumOfSpans([this](int first, int length) {
             return squaredProduct(pointersTo(inverse_, first), pointersTo(force, first), length);
           });
  }
  return squared + weightedSquares([this](int node) -> Vec3 {
           return matrixAt(inverse_, node) * vectorAt(force, node);
         });
}

template <typename Real>
double GridLevel<Real>::squaredLength(const Field<Real>& motion) const {
  if (!weight_roots_.empty()) {
    return weightedSquares([&motion](int node) { return vectorAt(motion, node); });
  }
  double squared = 0.0;
  for (const auto& values : motion) {
    squared += sumOfSpans([&values](int first, int length) {
      return dotOf(values.data() + first, values.data() + first, length);
    });
  }
  return squared;
}

template <typename Real>
double GridLevel<Real>::squaredDistanceFrom(const Field<Real>& other) const {
  if (!weight_roots_.empty()) {
    return weightedSquares([this, &other](int node) -> Vec3 {
      return vectorAt(displacement, node) - vectorAt(other, node);
    });
  }
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += sumOfSpans([&](int first, int length) {
      return squaredDistance(displacement[axis].data() + first, other[axis].data() + first, length);
    });
  }
  return squared;
}

template <typename Real>
Vec3 GridLevel<Real>::wholeForce(int node) const {
  if (const Vec3* whole = constrained.wholeForce(node)) return *whole;
  return vectorAt(cells_.whole, node);
}

template class GridLevel<float>;
template class GridLevel<double>;

}  // namespace robot_tissue
