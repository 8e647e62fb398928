// One lattice of several, each of twice the spacing of the one before, or a part of it: nodes on a
// grid, cells with moduli between them, and what holds the nodes (own). The finest is the tissue's;
// the others are lattices of the same kind, whose cells have the mean moduli of the eight in them.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/types.h"
#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/constrained_nodes.h"

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
  // Of any motion, in the nodes' stiffnesses.
  double greatestStiffness() const { return 1.0 / step_; }

  // What holds the nodes: by nothing, then one by one, then `bind`. Bits of axes.
  void freeAll();
  void hold(int node, unsigned axes) { held_[at(node)] |= static_cast<std::uint8_t>(axes); }
  unsigned dirichletAxes(int node) const { return held_[at(node)]; }
  ConstrainedNodes<Real> constrained;  // with springs and groups
  void bind();

  const LevelPart& part() const { return cells_.part(); }
  // Nodes that only a coarser level moves, but that neither are held nor out of reach of free ones.
  const std::vector<int>& interfaceNodes() const { return interface_; }
  // Shows the forces on them, or counts them as balanced again.
  void showInterface();
  void hideInterface();

  void share(Workers& workers) { cells_.share(workers); }

  // Unbalanced forces at `displacement`, and the stiffness that the smoother's steps go by.
  void findForces();
  // Takes so many steps of the smoother from there on; `force` and stiffness are stale then.
  void smooth(int steps);
  void smoothAndFindForces(int steps);
  // Drops the way that the smoother was on.
  void calm();
  // Makes the force what is asked, by a load: where it covers a finer level. Beside that, what the
  // cells of the covered part do is asked for.
  void setFasRightHandSide(const Field<Real>& wanted,
                           const std::vector<GroupVector>& wanted_of_groups);
  void clearRightHandSide();
  // Adds a share of a motion, held components left out.
  void moveBy(const Field<Real>& motion, const std::vector<GroupVector>& of_groups, double share);

  Field<Real> displacement;
  Field<Real> right_hand_side;  // acts besides
  Field<Real> force;            // unbalanced, 0 in held components

  // Motion that would balance each node alone, squared and summed.
  double squaredLocalMotion() const;
  // Of all that acts on the node but holds: cells, load and springs (as of findForces).
  Vec3 wholeForce(int node) const;

 private:
  void findForces(Find what);
  void measureSteps();
  void findFree();

  void setFasRightHandSideBeside(const Field<Real>& wanted);
  void setFasRightHandSideOfConstrained(const Field<Real>& wanted,
                                        const std::vector<GroupVector>& wanted_of_groups);

  CellOperator<Real> cells_;
  std::vector<std::uint8_t> held_;
  std::vector<Real> rest_stiffness_;
  double step_ = 0.5;  // one over the greatest stiffness of a motion in nodes' stiffnesses
  Field<Real> step_along_;
  Field<Real> of_covered_;  // forces; empty where the covered part is the whole
  std::vector<int> interface_;
  std::vector<Real> free_;     // 1 where a node may move and is not firm, else 0
  std::vector<Real> inverse_;  // of the stiffness of such nodes, else 0
};

extern template class GridLevel<float>;
extern template class GridLevel<double>;

}  // namespace robot_tissue
