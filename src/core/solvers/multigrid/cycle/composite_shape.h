// The shape on the composite grid (doc/architecture.md, "Words") as one vector x, with the forces
// f(x) that are unbalanced there: what the solver adds, measures and moves as a whole.
//
// Lengths in spacings of the finest lattice, forces in CompositeGrid::modulus() * spacing^2.
#pragma once

#include <memory>
#include <vector>

#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

namespace robot_tissue {

// Positions, a step between two of them, or forces that do work in a step.
template <typename Real>
struct CompositeVector {
  Field<Real> nodes;                               // of the finest lattice's open part
  std::vector<GroupVector> groups;                 // of patches by force
  typename UncoveredPart<Real>::Vector uncovered;  // by coarse levels; empty where all is open

  // this += alpha * other.
  void add(const CompositeVector& other, double alpha);
};

// Work of forces in a step.
template <typename Real>
double workOf(const CompositeVector<Real>& force, const CompositeVector<Real>& step);

// Likewise, without what is beyond the open part.
template <typename Real>
double workInPart(const CompositeVector<Real>& force, const CompositeVector<Real>& step);

template <typename Real>
class CompositeShape {
 public:
  using Vector = CompositeVector<Real>;

  // On these levels from now on; before, there is no shape.
  void reset(std::unique_ptr<GridHierarchy<Real>> levels);
  bool exists() const { return levels_ != nullptr; }
  GridHierarchy<Real>& levels() { return *levels_; }
  const GridHierarchy<Real>& levels() const { return *levels_; }
  GridLevel<Real>& finest() { return levels_->finest(); }
  const GridLevel<Real>& finest() const { return levels_->finest(); }

  // Room for a vector, of whoever is at work: what it holds is lost when another one is.
  Vector& spare() { return spare_; }
  void keepPlaces(Vector& places) const;
  void keepForces(Vector& forces);
  void keepForcesInPart(Vector& forces) const;
  void restore(const Vector& places);
  void move(const Vector& step, double alpha);                            // x += alpha * step
  void moveFrom(const Vector& places, const Vector& step, double alpha);  // x = places + ...
  // The smooth motion that the coarse levels found last (CoarseCorrection), times alpha
  // (1 or less), then steps of the smoother.
  void correctAndSmooth(double alpha, int smoother_steps);

  // Membranes are as stiff as this shape makes them, for the coarse levels and the smoother.
  void renewMembranes();

  // Work in a step by the forces as they are now; and what the open part has in it.
  double workOfForces(const Vector& step);
  double workOfForcesInPart(const Vector& step) const;

  double greatestForce() const;  // on a node along an axis
  Vec3 netForce() const;         // sum over the open part's nodes

  // Lengths, in which a node counts by the tissue that it carries (LightNode).
  double distanceFrom(const Vector& places) const;
  double displacementNorm() const;
  double displacementRounding() const;  // its last digit
  // Of the motion that the coarse levels, and each node alone, say is left: (|s|^2 + |d|^2)^1/2.
  double correctionNorm() const;
  double longestSmoothMotion() const;  // of a node along an axis
  // What the coarse levels miss beyond the open part, as trilinear means, over the displacement.
  double missedBeyond() const;

 private:
  void placeAt(const Vector& places);
  void copy(const Field<Real>& from, Field<Real>& to) const;  // of the finest level

  std::unique_ptr<GridHierarchy<Real>> levels_;
  Vector spare_;
};

extern template struct CompositeVector<float>;
extern template struct CompositeVector<double>;
extern template class CompositeShape<float>;
extern template class CompositeShape<double>;

}  // namespace robot_tissue
