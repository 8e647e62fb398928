#include "solvers/multigrid/cycle/composite_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "simd/field_kernel.h"

namespace robot_tissue {
namespace {

template <typename Real>
double dot(const std::vector<Real>& a, const std::vector<Real>& b) {
  return dotOf(a.data(), b.data(), static_cast<int>(a.size()));
}

template <typename Real>
void addTo(Field<Real>& to, const Field<Real>& other, double share) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addShare(other[axis].data(), static_cast<Real>(share), to[axis].data(),
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
void CompositeVector<Real>::add(const CompositeVector& other, double share) {
  addTo(nodes, other.nodes, share);
  for (std::size_t group = 0; group < groups.size(); ++group) {
    groups[group] += share * other.groups[group];
  }
  for (std::size_t level = 0; level < beyond.size(); ++level) {
    addTo(beyond[level], other.beyond[level], share);
  }
}

template <typename Real>
double workOf(const CompositeVector<Real>& force, const CompositeVector<Real>& step) {
  const double beyond = GridHierarchy<Real>::workBeyond(force.beyond, step.beyond);
  return withWork(beyond, force.nodes, force.groups, step);
}

template <typename Real>
void CompositeShape<Real>::reset(std::unique_ptr<GridHierarchy<Real>> levels) {
  levels_ = std::move(levels);
}

template <typename Real>
void CompositeShape<Real>::keepPlaces(Vector& places) const {
  places.nodes = finest().displacement;
  places.groups = finest().constrained.motion;
  places.beyond = levels_->placesBeyond();
}

template <typename Real>
void CompositeShape<Real>::keepForces(Vector& forces) {
  forces.nodes = finest().force;
  forces.groups = finest().constrained.force;
  forces.beyond = levels_->findForcesBeyond();
}

template <typename Real>
void CompositeShape<Real>::placeAt(const Vector& places) {
  finest().constrained.motion = places.groups;
  finest().displacement = places.nodes;
  levels_->putBeyond(places.beyond);
}

template <typename Real>
void CompositeShape<Real>::restore(const Vector& places) {
  placeAt(places);
  finest().findForces();
}

template <typename Real>
void CompositeShape<Real>::move(const Vector& step, double share) {
  finest().moveBy(step.nodes, step.groups, share);
  levels_->moveBeyond(step.beyond, share);
  finest().findForces();
}

template <typename Real>
void CompositeShape<Real>::moveFrom(const Vector& places, const Vector& step, double share) {
  placeAt(places);
  move(step, share);
}

template <typename Real>
void CompositeShape<Real>::correctAndSmooth(double share, int smoother_steps) {
  levels_->go(share);
  finest().findForces();
  finest().smoothAndFindForces(smoother_steps);
}

template <typename Real>
double CompositeShape<Real>::workOfForces(const Vector& step) {
  return workOfForcesInPart(step) +
         GridHierarchy<Real>::workBeyond(levels_->findForcesBeyond(), step.beyond);
}

template <typename Real>
double CompositeShape<Real>::workOfForcesInPart(const Vector& step) const {
  return withWork(0.0, finest().force, finest().constrained.force, step);
}

template <typename Real>
double CompositeShape<Real>::greatestForce() const {
  double greatest = 0.0;
  for (const auto& values : finest().force) {
    greatest = std::max(greatest, greatestOf(values.data(), finest().count()));
  }
  return greatest;
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
  double squared = levels_->squaredDistanceBeyond(places.beyond);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    squared += squaredDistance(finest().displacement[axis].data(), places.nodes[axis].data(),
                               finest().count());
  }
  return std::sqrt(squared);
}

template <typename Real>
double CompositeShape<Real>::displacementNorm() const {
  return std::sqrt(squared(finest().displacement) + levels_->squaredDisplacementBeyond());
}

template <typename Real>
double CompositeShape<Real>::correctionNorm() const {
  return std::sqrt(finest().squaredLocalMotion() + squared(levels_->motion) +
                   levels_->squaredMotionBeyond() +
                   finest().constrained.squaredMotionOf(levels_->group_motion));
}

template <typename Real>
double CompositeShape<Real>::longestSmoothMotion() const {
  double longest = 0.0;
  for (const auto& values : levels_->motion) {
    longest = std::max(longest, greatestOf(values.data(), finest().count()));
  }
  return longest;
}

template <typename Real>
double CompositeShape<Real>::missedBeyond() const {
  if (levels_->isWhole()) return 0.0;
  const double moved = displacementNorm();
  return moved == 0.0 ? 0.0 : std::sqrt(levels_->squaredRoughnessBeyond()) / moved;
}

template <typename Real>
double CompositeShape<Real>::squared(const Field<Real>& field) const {
  double squared = 0.0;
  for (const auto& values : field) squared += dot(values, values);
  return squared;
}

template double workOf(const CompositeVector<float>&, const CompositeVector<float>&);
template double workOf(const CompositeVector<double>&, const CompositeVector<double>&);
template struct CompositeVector<float>;
template struct CompositeVector<double>;
template class CompositeShape<float>;
template class CompositeShape<double>;

}  // namespace robot_tissue
