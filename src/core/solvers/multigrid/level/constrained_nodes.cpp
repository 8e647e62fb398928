#include "solvers/multigrid/level/constrained_nodes.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "robot_tissue/core/carriers.h"
#include "solvers/multigrid/level/group_inverse.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

// Sum of the sizes of a spring's weights: 1 on its nodes, and -1 on a group.
constexpr double kBothEnds = 2.0;

constexpr int kNone = -1;

using Jacobian = Eigen::Matrix<double, 3, 6>;

// The derivative of the motion of the group's point at that arm (spacings) by the group's motion.
Jacobian jacobianAt(const LevelGroup& group, const Vec3& arm) {
  Jacobian jacobian = Jacobian::Zero();
  jacobian.leftCols<3>().setIdentity();
  if (group.turns) jacobian.rightCols<3>() = -crossMatrix(arm);
  return jacobian;
}

Vec3 motionAt(const LevelGroup& group, const Vec3& arm, const GroupVector& motion) {
  const Vec3 shift = motion.head<3>();
  if (!group.turns) return shift;
  const Vec3 turn = motion.tail<3>();
  return shift + turn.cross(arm);
}

// Of a spring in contact, along its normal n: n . K n.
double stiffnessAlong(const LevelSpring& spring) {
  const Vec3& normal = spring.contact->normal;
  return normal.dot(spring.stiffness * normal);
}

// Without what joins: K - (n . K n) n n^T. A thread joins in all directions.
Eigen::Matrix3d stiffnessAcross(const LevelSpring& spring) {
  if (spring.contact->is_thread) return Eigen::Matrix3d::Zero();
  const Vec3& normal = spring.contact->normal;
  Eigen::Matrix3d stiffness = spring.stiffness;
  stiffness -= stiffnessAlong(spring) * normal * normal.transpose();
  return stiffness;
}

// To no more than `longest` in any component.
template <typename Vector>
void cut(Vector& vector, double longest) {
  const double greatest = vector.cwiseAbs().maxCoeff();
  if (greatest > longest) vector *= longest / greatest;
}

}  // namespace

template <typename Real>
std::vector<int> ConstrainedNodes<Real>::nodes() const {
  std::vector<int> nodes;
  for (const ConstrainedNode& constrained : all_) nodes.push_back(constrained.node);
  return nodes;
}

// Per node of the level its index among the constrained ones, kNone where it is none of these.
template <typename Real>
void ConstrainedNodes<Real>::findIndices(std::size_t level_nodes,
                                         const std::vector<int>& partly_held) {
  index_of_.assign(level_nodes, kNone);
  std::vector<int> nodes;
  const auto add = [&](int node) {
    if (std::exchange(index_of_[at(node)], 0) == kNone) nodes.push_back(node);
  };
  for (const int node : partly_held) add(node);
  for (const LevelSpring& spring : springs) {
    for (const LevelSpring::Carrier& carrier : spring.carriers) add(carrier.node);
  }
  for (const LevelGroup& group : groups) {
    for (const int node : group.nodes) add(node);
  }
  for (const OwnStiffness& own : own_stiffness) add(own.node);
  std::sort(nodes.begin(), nodes.end());
  all_.assign(nodes.size(), {});
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    index_of_[at(nodes[i])] = static_cast<int>(i);
    all_[i].node = nodes[i];
  }
}

template <typename Real>
void ConstrainedNodes<Real>::bind(const std::vector<std::uint8_t>& held,
                                  const std::vector<int>& partly_held) {
  findIndices(held.size(), partly_held);
  for (ConstrainedNode& constrained : all_) constrained.held = held[at(constrained.node)];
  for (auto* vectors : {&places_, &forces_}) vectors->assign(all_.size(), Vec3::Zero());
  // Nothing moves until forces are found.
  inverses_.assign(all_.size(), Eigen::Matrix3d::Zero());
  joining_.clear();
  joined_.join(joining_, inverses_);
  are_inverses_known_ = true;
  for (LevelSpring& spring : springs) {
    for (LevelSpring::Carrier& carrier : spring.carriers) {
      carrier.constrained = index_of_[at(carrier.node)];
    }
  }
  acting_.resize(springs.size());
  std::iota(acting_.begin(), acting_.end(), 0);
  for (OwnStiffness& own : own_stiffness) own.constrained = index_of_[at(own.node)];
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < groups[group].nodes.size(); ++i) {
      ConstrainedNode& constrained = all_[at(index_of_[at(groups[group].nodes[i])])];
      constrained.group = static_cast<int>(group);
      constrained.held = kAllAxes;
      constrained.arm = groups[group].arms[i];
    }
  }
  group_inverse_.assign(groups.size(), Matrix6::Zero());
  for (auto* vectors : {&right_hand_side, &force, &motion, &group_step_}) {
    vectors->assign(groups.size(), GroupVector::Zero());
  }
}

template <typename Real>
void ConstrainedNodes<Real>::leaveOutLoose() {
  acting_.clear();
  for (std::size_t i = 0; i < springs.size(); ++i) {
    if (springs[i].acts()) acting_.push_back(static_cast<int>(i));
  }
}

template <typename Real>
void ConstrainedNodes<Real>::takePlaces(const Field<Real>& displacement) {
  for (std::size_t i = 0; i < all_.size(); ++i) places_[i] = vectorAt(displacement, all_[i].node);
}

template <typename Real>
Vec3 ConstrainedNodes<Real>::meanOf(const LevelSpring& spring) const {
  Vec3 mean = Vec3::Zero();
  for (const LevelSpring::Carrier& carrier : spring.carriers) {
    mean += carrier.weight * places_[at(carrier.constrained)];
  }
  if (spring.group >= 0) {
    const std::size_t group = at(spring.group);
    mean -= motionAt(groups[group], spring.arm, motion[group]);
  }
  return mean;
}

template <typename Real>
void ConstrainedNodes<Real>::addSpring(LevelSpring& spring, Find what) {
  const Vec3 mean = meanOf(spring);
  Vec3 on_nodes = Vec3::Zero();
  if (spring.contact == nullptr) {
    on_nodes = spring.stiffness * (spring.anchor - mean);
  } else {
    const Vec3 point = spring.contact->rest + spacing_ * mean;
    on_nodes = forceAt(*spring.contact, point) / (modulus_ * spacing_ * spacing_);
    if (!spring.contact->is_thread) contact_force_ += on_nodes;
    if (what != Find::kForces) {
      spring.stiffness = stiffnessAt(*spring.contact, point) / (modulus_ * spacing_);
      spring.joins = isJoining(spring, point);
    } else {
      has_new_push_ = has_new_push_ || (!spring.joins && isJoining(spring, point));
    }
  }
  for (const LevelSpring::Carrier& carrier : spring.carriers) {
    forces_[at(carrier.constrained)] += carrier.weight * on_nodes;
  }
  if (what != Find::kForces) {
    if (spring.joins) join(spring, spring.contact->rest + spacing_ * mean);
    addStiffness(spring, spring.joins ? stiffnessAcross(spring) : spring.stiffness);
  }
  if (spring.group < 0) return;
  const std::size_t group = at(spring.group);
  force[group] -= jacobianAt(groups[group], spring.arm).transpose() * on_nodes;
}

// The stiffness matrix's row sums, |w_i| (sum over j of |w_j|) K, in the place of its diagonal
// w_i^2 K: no motion is stiffer than the smoother's steps allow (l1-Jacobi: Baker, Falgout, Kolev,
// Yang 2011). Of a joining spring what is along its normal is left out, as WoodburyUpdate has that.
template <typename Real>
void ConstrainedNodes<Real>::addStiffness(const LevelSpring& spring,
                                          const Eigen::Matrix3d& stiffness) {
  const double ends = spring.group >= 0 ? kBothEnds : spring.ends;
  for (const LevelSpring::Carrier& carrier : spring.carriers) {
    all_[at(carrier.constrained)].stiffness += ends * std::abs(carrier.weight) * stiffness;
  }
  if (spring.group < 0) return;
  const std::size_t group = at(spring.group);
  const Jacobian jacobian = jacobianAt(groups[group], spring.arm);
  group_stiffness_[group] += ends * jacobian.transpose() * stiffness * jacobian;
}

// A spring in contact that pushes, or would with its gap less by `soon_touches`; a taut thread.
template <typename Real>
bool ConstrainedNodes<Real>::isJoining(const LevelSpring& spring, const Vec3& point) const {
  const ContactSpring& contact = *spring.contact;
  if (contact.is_thread) {
    if (spring.stiffness.isZero(0.0)) return false;
  } else {
    const double gap = contact.normal.dot(point - contact.plane_point) - soon_touches * spacing_;
    if (contact.multiplier - contact.stiffness * gap <= 0.0) return false;
  }
  return groups.empty() ||
         std::none_of(spring.carriers.begin(), spring.carriers.end(), [this](const auto& carrier) {
           return all_[at(carrier.constrained)].group >= 0;
         });
}

// A thread that is much longer than its rest length is about as stiff across itself as along: it
// joins in three directions.
template <typename Real>
void ConstrainedNodes<Real>::join(const LevelSpring& spring, const Vec3& point) {
  if (!spring.contact->is_thread) {
    return joinAlong(spring, spring.contact->normal,
                     spring.contact->stiffness / (modulus_ * spacing_));
  }
  const double length = point.norm();
  const Vec3 along = length > 0.0 ? Vec3(point / length) : Vec3(Vec3::UnitX());
  const Vec3 across = along.unitOrthogonal();
  for (const Vec3& direction : {along, across, Vec3(along.cross(across))}) {
    const double stiffness = direction.dot(spring.stiffness * direction);
    if (stiffness > level_tuning::kNoStiffness) joinAlong(spring, direction, stiffness);
  }
}

template <typename Real>
void ConstrainedNodes<Real>::joinAlong(const LevelSpring& spring, const Vec3& direction,
                                       double stiffness) {
  joining_.add(stiffness, spring.carriers.size());
  for (std::size_t i = 0; i < spring.carriers.size(); ++i) {
    const LevelSpring::Carrier& carrier = spring.carriers[i];
    Vec3 along = carrier.weight * direction;
    for (int axis = 0; axis < 3; ++axis) {
      if ((all_[at(carrier.constrained)].held >> axis & 1U) != 0) along[axis] = 0.0;
    }
    joining_.partOfLast(i) = {carrier.constrained, along};
  }
}

template <typename Real>
void ConstrainedNodes<Real>::addToGroup(const ConstrainedNode& hard, const Vec3& force_on_it,
                                        Find what) {
  const std::size_t group = at(hard.group);
  const Jacobian jacobian = jacobianAt(groups[group], hard.arm);
  force[group] += jacobian.transpose() * force_on_it;
  if (what == Find::kForces) return;
  group_stiffness_[group] += jacobian.transpose() * hard.stiffness * jacobian;
}

template <typename Real>
void ConstrainedNodes<Real>::findForces(const CellOperator<Real>& cells,
                                        const Field<Real>& displacement, Find what,
                                        Field<Real>& forces) {
  takePlaces(displacement);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    ConstrainedNode& constrained = all_[i];
    forces_[i] = vectorAt(cells.whole, constrained.node);
    if (what == Find::kForces) continue;
    constrained.stiffness = matrixAt(cells.stiffness, constrained.node);
  }
  force = right_hand_side;
  contact_force_.setZero();
  has_new_push_ = false;
  if (what != Find::kForces) {
    for (const OwnStiffness& own : own_stiffness) {
      all_[at(own.constrained)].stiffness += own.stiffness;
    }
    group_stiffness_.assign(groups.size(), Matrix6::Zero());
    joining_.clear();
  }
  for (const int spring : acting_) addSpring(springs[at(spring)], what);
  for (std::size_t i = 0; i < all_.size(); ++i) {
    const ConstrainedNode& constrained = all_[i];
    if (constrained.group >= 0) addToGroup(constrained, forces_[i], what);
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_held = (constrained.held >> axis & 1U) != 0;
      forces[at(axis)][at(constrained.node)] =
          is_held ? Real(0) : static_cast<Real>(forces_[i][axis]);
    }
    if (what != Find::kForces) holdInStiffness(all_[i]);
  }
  if (what == Find::kForces) return;
  invertGroups();
  are_inverses_known_ = false;
}

template <typename Real>
void ConstrainedNodes<Real>::holdInStiffness(ConstrainedNode& constrained) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((constrained.held >> axis & 1U) == 0) continue;
    constrained.stiffness.row(axis).setZero();
    constrained.stiffness.col(axis).setZero();
    constrained.stiffness(axis, axis) = 1.0;
  }
}

template <typename Real>
void ConstrainedNodes<Real>::invertGroups() {
  for (std::size_t group = 0; group < groups.size(); ++group) {
    group_inverse_[group] = inverseOfGroup(group_stiffness_[group], groups[group].turns);
  }
}

template <typename Real>
void ConstrainedNodes<Real>::clearStep() {
  for (ConstrainedNode& constrained : all_) constrained.step.setZero();
  for (GroupVector& step : group_step_) step.setZero();
}

template <typename Real>
void ConstrainedNodes<Real>::step(double keep, double share, double longest,
                                  Field<Real>& displacement) {
  for (std::size_t group = 0; group < groups.size(); ++group) {
    GroupVector& step = group_step_[group];
    step = keep * step + share * group_inverse_[group] * force[group];
    cut(step, longest);
    motion[group] += step;
  }
  const std::vector<Vec3>& motions = balancing();
  for (std::size_t i = 0; i < all_.size(); ++i) {
    ConstrainedNode& constrained = all_[i];
    if (constrained.group >= 0) {
      const std::size_t group = at(constrained.group);
      constrained.step = motionAt(groups[group], constrained.arm, group_step_[group]);
    } else {
      constrained.step = keep * constrained.step + share * motions[i];
      if (coupling_ == nullptr) cut(constrained.step, longest);
    }
  }
  if (coupling_ != nullptr) shortenTogether(longest);
  for (const ConstrainedNode& constrained : all_) {
    for (int axis = 0; axis < 3; ++axis) {
      displacement[at(axis)][at(constrained.node)] += static_cast<Real>(constrained.step[axis]);
    }
  }
}

template <typename Real>
void ConstrainedNodes<Real>::moveBy(const Field<Real>& of_nodes,
                                    const std::vector<GroupVector>& of_groups, double alpha,
                                    Field<Real>& displacement) {
  for (const ConstrainedNode& constrained : all_) {
    Vec3 moved = alpha * vectorAt(of_nodes, constrained.node);
    if (constrained.group >= 0) {
      const std::size_t group = at(constrained.group);
      moved = alpha * motionAt(groups[group], constrained.arm, of_groups[group]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_held = constrained.group < 0 && (constrained.held >> axis & 1U) != 0;
      if (!is_held) displacement[at(axis)][at(constrained.node)] += static_cast<Real>(moved[axis]);
    }
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    motion[group] += alpha * of_groups[group];
  }
}

template <typename Real>
double ConstrainedNodes<Real>::squaredLocalMotion(const Numbers<Real>& weight_roots) const {
  double squared = 0.0;
  const std::vector<Vec3>& motions = balancing();
  for (std::size_t i = 0; i < all_.size(); ++i) {
    if (all_[i].group >= 0) continue;
    const double root = weight_roots.empty() ? 1.0 : double{weight_roots[at(all_[i].node)]};
    squared += (root * motions[i]).squaredNorm();
  }
  std::vector<GroupVector> of_groups;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    of_groups.push_back(group_inverse_[group] * force[group]);
  }
  return squared + squaredMotionOf(of_groups);
}

template <typename Real>
double ConstrainedNodes<Real>::squaredMotionOf(const std::vector<GroupVector>& of_groups) const {
  double squared = 0.0;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (const Vec3& arm : groups[group].arms) {
      squared += motionAt(groups[group], arm, of_groups[group]).squaredNorm();
    }
  }
  return squared;
}

template <typename Real>
const Vec3* ConstrainedNodes<Real>::wholeForce(int node) const {
  const int constrained = index_of_[at(node)];
  return constrained == kNone ? nullptr : &forces_[at(constrained)];
}

template class ConstrainedNodes<float>;
template class ConstrainedNodes<double>;

}  // namespace robot_tissue
