// One lattice of several, each of twice the spacing of the one before, or a part of it: nodes on a
// grid, cells with moduli between them, and what holds the nodes (own). The finest is the tissue's;
// the others are lattices of the same kind, whose cells have the mean moduli of the eight in them.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "robot_tissue/core/types.h"
#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/constrained_nodes.h"
#include "solvers/multigrid/level/level_membrane.h"

namespace robot_tissue {

template <typename Real>
class GridLevel {
 public:
  // As CellOperator. The greatest stiffness is measured where it is not known.
  GridLevel(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
            const LevelPart& part, double greatest_stiffness = 0.0);

  const LevelGrid& grid() const { return cells_.grid(); }
  int count() const { return cells_.count(); }  // entries of a field
  std::array<int, 3> placeOf(int node) const { return cells_.placeOf(node); }
  double restStiffness(int node) const { return static_cast<double>(rest_stiffness_[at(node)]); }
  bool exists(int node) const { return rest_stiffness_[at(node)] > 0; }
  // Greatest eigenvalue of D^-1 K at rest, D the nodes' own stiffnesses, with a margin.
  double greatestStiffness() const { return 1.0 / step_; }

  // Per entry, the root of the weight with which the node counts in lengths; empty: 1 each.
  void setWeightRoots(Numbers<Real> roots) { weight_roots_ = std::move(roots); }

  // What holds the nodes: first nothing does, then `hold` one by one, then `bind`. Bits of axes.
  void freeAll();
  void hold(int node, unsigned axes) {
    held_[at(node)] |= static_cast<std::uint8_t>(axes);
    are_holds_new_ = true;
  }
  const std::vector<std::uint8_t>& dirichletMask() const { return held_; }
  unsigned dirichletAxes(int node) const { return held_[at(node)]; }
  ConstrainedNodes<Real> constrained;  // with springs and groups
  void bind();

  // Membranes act from now on; to be bound, and renewed, anew.
  void setMembrane(LevelMembrane<Real> membrane);
  const std::shared_ptr<LevelMembrane<Real>>& membrane() const { return membrane_; }
  // On a coarse level: as the finer one carries them, and as that is held.
  void bindMembrane(const GridLevel& fine);
  // From the finest level on: as stiff as the shape makes them now.
  void renewMembrane();
  // The smoother takes nodes on membranes together, or each alone, as from the first.
  void coupleMembrane(bool together);
  // The displacement is where the level starts from.
  void startMembrane();

  const LevelPart& part() const { return cells_.part(); }
  // Nodes next to free ones that only the next coarser level moves.
  const std::vector<int>& interfaceNodes() const { return interface_; }
  // `force` on them: all that acts, to be restricted; or 0, as they count as balanced here.
  void showInterface();
  void hideInterface();

  void share(Workers& workers) { cells_.share(workers); }
  // As CellOperator, of the entries of a field.
  template <typename Visit>
  void forParts(Visit visit) const {
    cells_.forParts(visit);
  }
  template <typename SumOf>
  double sumOfSpans(SumOf sumOf) const {
    return cells_.sumOfSpans(sumOf);
  }

  // Per entry, stiffness of the nodes' inertia in a time step; empty: none. Forces are stale then.
  void setInertia(Numbers<Real> stiffness) { cells_.inertia = std::move(stiffness); }
  // As CellOperator. Forces are stale then.
  void setViscosity(double share, const Field<Real>& rate_from) {
    cells_.setViscosity(share, rate_from);
  }
  // What damps strain, as forces of the cells on all nodes at these displacements.
  Field<Real> viscousForces(const Field<Real>& at_displacement);

  // As CellOperator: the cells are stretched as the finer level's, where the displacement is now.
  void relieve(const GridLevel& finer);
  void endRelief() { cells_.endRelief(); }

  // Unbalanced forces at `displacement`, and the stiffness D that the smoother's steps go by.
  void findForces(Find what = Find::kForcesAndStiffness);
  // The same, where cells are as findForces() last found them: only what holds the nodes changed.
  // Not of levels with membranes.
  void findForcesOfConstrained();
  // Takes so many steps of the smoother from there on; `force` and stiffness are stale then.
  void smooth(int steps);
  void smoothAndFindForces(int steps);
  // Sets the right-hand side b of the full approximation scheme. With f the forces of the cells and
  // r the finer level's unbalanced forces, restricted:
  //   f + b = r         in the covered part
  //   b = r - f_c       on its rim, f_c the forces of covered cells, for which the finer ones act
  //   b = 0             elsewhere
  void setFasRightHandSide(const Field<Real>& residual,
                           const std::vector<GroupVector>& residual_of_groups);
  void clearRightHandSide();
  // displacement += alpha * motion, held components left out.
  void moveBy(const Field<Real>& motion, const std::vector<GroupVector>& of_groups, double alpha);

  Field<Real> displacement;
  Field<Real> right_hand_side;  // acts besides
  Field<Real> force;            // unbalanced, 0 in held components

  // Of nodes' motions, squared and summed by their weights: what would balance each node alone, a
  // field's, and the way from other displacements.
  double squaredLocalMotion() const;
  double squaredLength(const Field<Real>& motion) const;
  double squaredDistanceFrom(const Field<Real>& other) const;
  // Of all that acts on the node but holds: cells, load and springs (as of findForces).
  Vec3 wholeForce(int node) const;

 private:
  template <typename MotionOf>
  double weightedSquares(MotionOf motionOf) const;
  void measureSteps();
  void takeHolds();

  void clearStep();
  void setFasRightHandSideInPart(const Field<Real>& residual);
  void setFasRightHandSideOfConstrained(const Field<Real>& residual,
                                        const std::vector<GroupVector>& residual_of_groups);

  CellOperator<Real> cells_;
  std::shared_ptr<LevelMembrane<Real>> membrane_;  // null: no membranes
  std::vector<std::uint8_t> held_;
  Numbers<Real> rest_stiffness_;  // mean over the axes
  Numbers<Real> weight_roots_;
  double step_ = 0.5;       // one over greatestStiffness()
  Field<Real> last_step_;   // of the smoother
  Field<Real> of_covered_;  // forces; empty where the covered part is the whole
  std::vector<int> interface_;
  std::vector<int> partly_held_;
  Numbers<Real> not_held_;           // 1 where a node may move, else 0
  bool are_holds_new_ = true;        // interface_, partly_held_ and not_held_ are of others
  Numbers<Real> free_;               // 1 where a node may move and is none of `constrained`, else 0
  bool is_stiffness_known_ = false;  // at this shape
  SymmetricField<Real> inverse_;     // of the stiffness of such nodes, else 0
};

extern template class GridLevel<float>;
extern template class GridLevel<double>;

}  // namespace robot_tissue
