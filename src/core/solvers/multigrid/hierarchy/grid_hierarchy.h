// The tissue's lattice and, above it, lattices of twice, four times ... its spacing: what is smooth
// and far is found on the coarse ones (nonlinear multigrid: Brandt 1977; its use for the trilinear
// cell with a volume barrier, doc/model.md, is our own).
//
// Nodes move as the trilinear mean of the coarse nodes around them, P; a coarse node starts where
// the node at its place is. On the coarse lattice the forces are those of its own cells plus a
// right-hand side with which, at the start, they are P^T of the fine lattice's.
//
// Lengths in spacings h of the finest lattice, forces in modulus() * h^2, as GridLevel.
#pragma once

#include <cstdint>
#include <vector>

#include "loads/dof_constraints.h"
#include "solvers/multigrid/hierarchy/coarse_correction.h"
#include "solvers/multigrid/hierarchy/composite_grid.h"
#include "solvers/multigrid/hierarchy/fas_restriction.h"
#include "solvers/multigrid/hierarchy/level_constraints.h"
#include "solvers/multigrid/hierarchy/node_displacements.h"
#include "solvers/multigrid/hierarchy/uncovered_part.h"

namespace robot_tissue {

template <typename Real>
class GridHierarchy {
 public:
  // As CompositeGrid.
  GridHierarchy(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
                Workers* workers, KnownLevels known = {});
  GridHierarchy(const GridHierarchy&) = delete;
  GridHierarchy& operator=(const GridHierarchy&) = delete;

  // As CompositeGrid::open; new levels have the shape as it is, and are to be bound.
  bool open(const GridBox& box, int layers, const std::vector<Vec3>& displacement);

  const CompositeGrid<Real>& grid() const { return grid_; }
  // As CompositeGrid; the levels are good for nothing then.
  std::vector<LevelSource> takeSources() { return grid_.takeSources(); }
  bool isWhole() const { return grid_.isWhole(); }
  GridLevel<Real>& finest() { return grid_.finest(); }
  const GridLevel<Real>& finest() const { return grid_.finest(); }

  // As CompositeGrid::takeTimeStep.
  void takeTimeStep(const InertialTerm* inertia) { grid_.takeTimeStep(inertia); }

  // As CompositeGrid::renewMembranes; when what holds the nodes is bound.
  bool renewMembranes() { return grid_.renewMembranes(); }
  void forgetMembranes() { grid_.forgetMembranes(); }
  void coupleMembranes(bool together) { grid_.coupleMembranes(together); }

  // As FasRestriction.
  void relieve(bool with_relief) { restriction_.relieve(with_relief); }

  LevelConstraints<Real>& constraints() { return constraints_; }
  NodeDisplacements<Real>& displacements() { return displacements_; }
  const NodeDisplacements<Real>& displacements() const { return displacements_; }
  UncoveredPart<Real>& uncovered() { return uncovered_; }
  const UncoveredPart<Real>& uncovered() const { return uncovered_; }
  CoarseCorrection<Real>& correction() { return correction_; }
  const CoarseCorrection<Real>& correction() const { return correction_; }

  bool isFinite() const;  // the shape, and the finest level's forces

 private:
  CompositeGrid<Real> grid_;
  NodeDisplacements<Real> displacements_;
  LevelConstraints<Real> constraints_;
  FasRestriction<Real> restriction_;
  UncoveredPart<Real> uncovered_;
  CoarseCorrection<Real> correction_;
};

extern template class GridHierarchy<float>;
extern template class GridHierarchy<double>;

}  // namespace robot_tissue
