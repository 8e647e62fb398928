// One lattice of several, each of twice the spacing of the one before: nodes on a grid, cells with
// moduli between them, and what holds the nodes (own). The finest is the tissue's; the others are
// lattices of the same kind, whose cells have the mean moduli of the eight in them.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h, with
// the h of the level.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/cell_kernel.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/lattice_coarsening.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// One value a node along x, y and z.
template <typename Real>
using Field = std::array<std::vector<Real>, 3>;

// Joins a weighted mean of nodes to a place, or to a group.
struct LevelSpring {
  struct Carrier {
    int node = 0;
    double weight = 0.0;
    int firm = 0;  // set by LatticeLevel
  };
  std::vector<Carrier> carriers;
  int group = -1;                                       // whose motion counts with weight -1
  Vec3 arm = Vec3::Zero();                              // of its end there, from the center
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // as it is now
  Vec3 anchor = Vec3::Zero();                           // mean displacement without a force
  const ContactSpring* contact = nullptr;               // whose law it has instead
};

// Nodes that move as one hard body: a shift and, where it turns, a turn about the center.
struct LevelGroup {
  std::vector<int> nodes;
  std::vector<Vec3> arms;  // of the nodes, from the center
  bool turns = false;
};
using GroupVector = Eigen::Matrix<double, 6, 1>;  // shift, turn; or force, moment

// Grid points from low to high, both included.
struct LevelBox {
  std::array<int, 3> low{};
  std::array<int, 3> high{};

  bool has(const std::array<int, 3>& place) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] < low[axis] || place[axis] > high[axis]) return false;
    }
    return true;
  }
};

template <typename Real>
class LatticeLevel {
 public:
  // With `beside` nodes beside the grid. A coarse lattice stands for a finer one.
  LatticeLevel(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
               bool is_coarse);

  const LevelGrid& grid() const { return grid_; }
  int count() const { return count_; }  // entries of a field

  double restStiffness(int node) const { return static_cast<double>(rest_stiffness_[at(node)]); }
  bool exists(int node) const { return rest_stiffness_[at(node)] > 0; }

  // Of any motion, in the nodes' stiffnesses.
  double greatestStiffness() const { return 1.0 / step_; }

  // What holds the nodes: by nothing, then one by one, then `bind`. Bits of axes.
  void freeAll();
  void hold(int node, unsigned axes) { held_[at(node)] |= static_cast<std::uint8_t>(axes); }
  unsigned heldAxes(int node) const { return held_[at(node)]; }
  void bind();

  // Scale of the laws of contacts: the spacing (m) and E0 (Pa).
  void setUnits(double spacing, double modulus);

  // Where nodes may move; the others stay, and count as balanced.
  void confine(const LevelBox& box) { box_ = box; }
  const LevelBox& box() const { return box_; }
  std::array<int, 3> placeOf(int node) const {
    return node < grid_.beside ? grid_.placeOf(node) : beside_places_[at(node - grid_.beside)];
  }
  bool mayMove(int node) const { return inverse_[at(node)] != Real(0); }  // but for firm nodes

  // Unbalanced forces at `displacement`; with the steps that the smoother may take from there on.
  void findForces(bool with_steps);
  // Takes so many steps; forces at their end if asked, with new steps.
  void smooth(int steps, bool forces_at_end);
  // Drops the way that the smoother was on.
  void calm();
  // Makes the force what is asked, by a load.
  void loadFor(const Field<Real>& wanted, const std::vector<GroupVector>& wanted_of_groups);
  void clearLoad();
  // Adds a share of a motion, held components left out.
  void moveBy(const Field<Real>& motion, const std::vector<GroupVector>& of_groups, double share);

  Field<Real> displacement;
  Field<Real> load;   // acts besides
  Field<Real> force;  // unbalanced, 0 in held components
  std::vector<LevelSpring> springs;
  std::vector<LevelGroup> groups;         // `bind` after a change
  std::vector<GroupVector> group_load;    // acts besides
  std::vector<GroupVector> group_force;   // unbalanced
  std::vector<GroupVector> group_motion;  // since it was last set to zero
  // Motion that would balance each node alone, squared and summed.
  double squaredLocalMotion() const;
  // Nodes that such a motion, alone, would take further than that.
  std::vector<int> nodesOutOfBalance(double motion) const;
  // And of hard nodes under such motions of their groups.
  double squaredMotionOf(const std::vector<GroupVector>& of_groups) const;
  // Of all that acts on the node but holds: cells, load and springs (as of findForces).
  Vec3 wholeForce(int node) const;
  Vec3 springForce(const LevelSpring& spring) const;
  // Mean displacement of what carries the spring, less the group's motion there.
  Vec3 meanOf(const LevelSpring& spring) const;

 private:
  // A node that is not stepped like the others: with springs, held in part or in a group.
  struct Firm {
    int node = 0;
    int group = -1;
    Vec3 arm = Vec3::Zero();
    Vec3 force = Vec3::Zero();
    Vec3 step = Vec3::Zero();
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  };

  CellGrid<Real> cellGrid(bool with_stiffness);
  void placeCells(const std::vector<LevelCell>& cells);
  void layBlocks();
  void measureSteps();
  void findFirm();
  int firmAt(int node) const;
  void addSprings(bool with_steps);
  void renewSteps();
  void step(double keep, double share);
  Vec3 vectorAt(const Field<Real>& field, int node) const;

  LevelGrid grid_;
  LevelBox box_;
  std::vector<std::array<int, 3>> beside_places_;
  int count_ = 0;
  double spacing_ = 1.0, modulus_ = 1.0;
  bool is_coarse_ = false;
  std::vector<Real> shear_, bulk_;
  std::vector<int> blocks_;
  std::vector<LooseCell<Real>> loose_;
  std::vector<std::uint8_t> held_;
  std::vector<Real> rest_stiffness_;
  double step_ = 0.5;  // one over the greatest stiffness of a motion in nodes' stiffnesses

  Field<Real> lower_, upper_, way_;
  std::vector<Real> lower_stiffness_, upper_stiffness_;
  std::vector<Real> inverse_;  // of the nodes' stiffness; 0 = held or firm
  std::vector<Firm> firm_;
  std::vector<Eigen::Matrix<double, 6, 6>> group_inverse_;
  std::vector<GroupVector> group_way_;
};

extern template class LatticeLevel<float>;
extern template class LatticeLevel<double>;

}  // namespace robot_tissue
