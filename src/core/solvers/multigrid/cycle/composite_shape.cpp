#include "solvers/multigrid/cycle/composite_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "simd/field_kernel.h"

namespace robot_tissue {
namespace {

template <typename Real>
double dot(const Numbers<Real>& a, const Numbers<Real>& b) {
  return dotOf(a.data(), b.data(), static_cast<int>(a.size()));
}

template <typename Real>
void addTo(Field<Real>& to, const Field<Real>& other, double alpha) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(other[axis].data(), static_cast<Real>(alpha), to[axis].data(),
             static_cast<int>(to[axis].size()));
  }
}

// `work` and what these forces add to it.
template <typename Real>
double withWork(double work, const Field<Real>& force, const std::vector<GroupVector>& on_groups,
                const CompositeVector<Real>& step) {
  for (std::size_t axis = 0; axis < 3; ++axis) work += dot(force[axis], step.nodes[axis]);
  for (std::size_t group = 0; group < step.groups.size(); ++group) {
    work += on_groups[group].dot(step.groups[group]);
  }
  return work;
}

}  // namespace

template <typename Real>
void CompositeVector<Real>::add(const CompositeVector& other, double alpha) {
  addTo(nodes, other.nodes, alpha);
  for (std::size_t group = 0; group < groups.size(); ++group) {
    groups[group] += alpha * other.groups[group];
  }
  for (std::size_t level = 0; level < uncovered.size(); ++level) {
    addTo(uncovered[level], other.uncovered[level], alpha);
  }
}

template <typename Real>
double workOf(const CompositeVector<Real>& force, const CompositeVector<Real>& step) {
  const double uncovered = UncoveredPart<Real>::workOf(force.uncovered, step.uncovered);
  return withWork(uncovered, force.nodes, force.groups, step);
}

template <typename Real>
double workInPart(const CompositeVector<Real>& force, const CompositeVector<Real>& step) {
  return withWork(0.0, force.nodes, force.groups, step);
}

template <typename Real>
void CompositeShape<Real>::reset(std::unique_ptr<GridHierarchy<Real>> levels) {
  levels_ = std::move(levels);
}

template <typename Real>
void CompositeShape<Real>::copy(const Field<Real>& from, Field<Real>& to) const {
  for (std::size_t axis = 0; axis < 3; ++axis) to[axis].resize(from[axis].size());
  finest().forParts([&](int first, int count) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::copy_n(from[axis].begin() + first, count, to[axis].begin() + first);
    }
  });
}

template <typename Real>
void CompositeShape<Real>::keepPlaces(Vector& places) const {
  copy(finest().displacement, places.nodes);
  places.groups = finest().constrained.motion;
  places.uncovered = levels_->uncovered().places();
}

template <typename Real>
void CompositeShape<Real>::keepForces(Vector& forces) {
  keepForcesInPart(forces);
  forces.uncovered = levels_->uncovered().findForces();
}

template <typename Real>
void CompositeShape<Real>::keepForcesInPart(Vector& forces) const {
  copy(finest().force, forces.nodes);
  forces.groups = finest().constrained.force;
}

template <typename Real>
void CompositeShape<Real>::placeAt(const Vector& places) {
  finest().constrained.motion = places.groups;
  copy(places.nodes, finest().displacement);
  levels_->uncovered().placeAt(places.uncovered);
}

template <typename Real>
void CompositeShape<Real>::restore(const Vector& places) {
  placeAt(places);
  finest().findForces(Find::kForcesAndSprings);
}

template <typename Real>
void CompositeShape<Real>::move(const Vector& step, double alpha) {
  finest().moveBy(step.nodes, step.groups, alpha);
  levels_->uncovered().moveBy(step.uncovered, alpha);
  finest().findForces(Find::kForcesAndSprings);
}

template <typename Real>
void CompositeShape<Real>::moveFrom(const Vector& places, const Vector& step, double alpha) {
  placeAt(places);
  move(step, alpha);
}

template <typename Real>
void CompositeShape<Real>::correctAndSmooth(double alpha, int smoother_steps) {
  levels_->correction().moveBy(alpha);
  finest().findForces();
  finest().smoothAndFindForces(smoother_steps);
}

template <typename Real>
void CompositeShape<Real>::renewMembranes() {
  if (levels_->renewMembranes()) finest().findForces();
}

template <typename Real>
double CompositeShape<Real>::workOfForces(const Vector& step) {
  return workOfForcesInPart(step) +
         UncoveredPart<Real>::workOf(levels_->uncovered().findForces(), step.uncovered);
}

template <typename Real>
double CompositeShape<Real>::workOfForcesInPart(const Vector& step) const {
  return withWork(0.0, finest().force, finest().constrained.force, step);
}

template <typename Real>
double CompositeShape<Real>::greatestForce() const {
  return greatestIn(finest().force, finest().count());
}

template <typename Real>
Vec3 CompositeShape<Real>::netForce() const {
  Vec3 net = Vec3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    net[axis] += sumOf(finest().force[at(axis)].data(), finest().count());
  }
  return net;
}

template <typename Real>
double CompositeShape<Real>::distanceFrom(const Vector& places) const {
  return std::sqrt(levels_->uncovered().squaredDistanceFrom(places.uncovered) +
                   finest().squaredDistanceFrom(places.nodes));
}

template <typename Real>
double CompositeShape<Real>::displacementNorm() const {
  return std::sqrt(finest().squaredLength(finest().displacement) +
                   levels_->uncovered().squaredDisplacement());
}

template <typename Real>
double CompositeShape<Real>::displacementRounding() const {
  return std::numeric_limits<Real>::epsilon() * displacementNorm();
}

template <typename Real>
double CompositeShape<Real>::correctionNorm() const {
  return std::sqrt(finest().squaredLocalMotion() +
                   finest().squaredLength(levels_->correction().motion()) +
                   levels_->correction().squaredUncovered() +
                   finest().constrained.squaredMotionOf(levels_->correction().groupMotion()));
}

template <typename Real>
double CompositeShape<Real>::longestSmoothMotion() const {
  return greatestIn(levels_->correction().motion(), finest().count());
}

template <typename Real>
double CompositeShape<Real>::missedBeyond() const {
  if (levels_->isWhole()) return 0.0;
  const double moved = displacementNorm();
  return moved == 0.0 ? 0.0 : std::sqrt(levels_->uncovered().squaredRoughness()) / moved;
}

template double workOf(const CompositeVector<float>&, const CompositeVector<float>&);
template double workOf(const CompositeVector<double>&, const CompositeVector<double>&);
template double workInPart(const CompositeVector<float>&, const CompositeVector<float>&);
template double workInPart(const CompositeVector<double>&, const CompositeVector<double>&);
template struct CompositeVector<float>;
template struct CompositeVector<double>;
template class CompositeShape<float>;
template class CompositeShape<double>;

}  // namespace robot_tissue
