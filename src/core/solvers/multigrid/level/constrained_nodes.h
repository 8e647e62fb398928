// Nodes of a level that do not move like the others: those with springs, held in part, on a
// membrane, or hard in a patch that a force moves (own). Forces and steps in double precision.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/types.h"
#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/level_membrane.h"
#include "solvers/multigrid/level/woodbury_update.h"

namespace robot_tissue {

// Joins a weighted mean of nodes to a place, or to a group; or, with weights of both signs, nodes
// to nodes.
struct LevelSpring {
  struct Carrier {
    int node = 0;
    double weight = 0.0;
    int constrained = 0;  // set by ConstrainedNodes
  };
  std::vector<Carrier> carriers;
  double ends = 1.0;                                    // at least the sum of its |weight|
  int group = -1;                                       // whose motion counts with weight -1
  Vec3 arm = Vec3::Zero();                              // of its end there, from the center
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  // as it is now
  Vec3 anchor = Vec3::Zero();                           // mean displacement without a force
  const ContactSpring* contact = nullptr;               // whose law it has instead
  bool joins = false;                                   // counts as pushing in the stiffness

  bool acts() const { return contact != nullptr || !stiffness.isZero(0.0); }
};

// Of a node beside its cells', in the directions that it has (membranes).
struct OwnStiffness {
  int node = 0;
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  int constrained = 0;  // set by ConstrainedNodes
};

// Nodes that move as one hard body: a shift and, where it turns, a turn about the center.
struct LevelGroup {
  std::vector<int> nodes;
  std::vector<Vec3> arms;  // of the nodes, from the center
  bool turns = false;
};
using GroupVector = Eigen::Matrix<double, 6, 1>;  // shift, turn; or force, moment

template <typename Real>
Eigen::Matrix3d matrixAt(const SymmetricField<Real>& field, int node) {
  const auto number = [&](std::size_t part) { return static_cast<double>(field[part][at(node)]); };
  Eigen::Matrix3d matrix;
  matrix << number(0), number(5), number(4), number(5), number(1), number(3), number(4), number(3),
      number(2);
  return matrix;
}

template <typename Real>
class ConstrainedNodes {
 public:
  std::vector<LevelSpring> springs;          // `bind` after a change of nodes
  std::vector<LevelGroup> groups;            // likewise
  std::vector<OwnStiffness> own_stiffness;   // likewise
  std::vector<GroupVector> right_hand_side;  // on groups, besides
  std::vector<GroupVector> force;            // on groups, unbalanced
  std::vector<GroupVector> motion;           // of groups, since it was last set to zero

  // Springs that do not act are left out from now on, until this or `bind` is called again: most
  // contacts that are looked at push nowhere.
  void leaveOutLoose();

  // Springs in contact with a gap of less than this (spacings) already count as stiff. 0: those
  // that push alone, which takes the fewest cycles; more keeps nodes that a cycle throws towards a
  // tool out of it.
  double soon_touches = 0.0;

  // `held`: bits of axes, per node; `partly_held`: nodes with some of them, but not all.
  void bind(const std::vector<std::uint8_t>& held, const std::vector<int>& partly_held);
  // Nodes on the membrane, of which `own_stiffness` is, are balanced together from now on; null:
  // each alone. `greatest`: as GridLevel::greatestStiffness.
  void couple(std::shared_ptr<const LevelMembrane<Real>> membrane, double greatest);
  // Of the laws of contacts: the spacing (m) and E0 (Pa).
  void setUnits(double spacing, double modulus) {
    spacing_ = spacing;
    modulus_ = modulus;
  }
  std::vector<int> nodes() const;  // ascending
  std::size_t count() const { return all_.size(); }

  // Forces of the cells and of springs; the free components go to `forces`.
  void findForces(const CellOperator<Real>& cells, const Field<Real>& displacement, Find what,
                  Field<Real>& forces);
  // Forces are these now.
  void setForces(const Field<Real>& forces) {
    for (std::size_t i = 0; i < all_.size(); ++i) forces_[i] = vectorAt(forces, all_[i].node);
  }
  // With d the motion that would balance each node or group alone, D^-1 f:
  // step = keep * step + share * d, no component longer than `longest`; displacement += step.
  void step(double keep, double share, double longest, Field<Real>& displacement);
  void clearStep();
  // displacement += alpha * motion; hard nodes go with their groups.
  void moveBy(const Field<Real>& of_nodes, const std::vector<GroupVector>& of_groups, double alpha,
              Field<Real>& displacement);

  // Of D^-1 f, nodes by their weights, whose roots these are; empty: 1 each.
  double squaredLocalMotion(const Numbers<Real>& weight_roots) const;
  // Of hard nodes, under such motions of their groups.
  double squaredMotionOf(const std::vector<GroupVector>& of_groups) const;
  // Of cells, right-hand side and springs, as last found; null where the node is none of these.
  const Vec3* wholeForce(int node) const;
  bool isFree(int constrained, int axis) const {
    return (all_[at(constrained)].held >> axis & 1U) == 0;
  }
  // A spring in contact pushes that did not when the stiffness was last found.
  bool hasNewPush() const { return has_new_push_; }
  // Sum over the springs in contact, as last found.
  const Vec3& contactForce() const { return contact_force_; }
  // Where the nodes are from now on, until forces are found.
  void takePlaces(const Field<Real>& displacement);
  // Mean displacement of what carries the spring, less the group's motion there.
  Vec3 meanOf(const LevelSpring& spring) const;

 private:
  struct ConstrainedNode {
    int node = 0;
    int group = -1;
    unsigned held = 0;
    Vec3 arm = Vec3::Zero();
    Vec3 step = Vec3::Zero();
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();
  };
  using Matrix6 = Eigen::Matrix<double, 6, 6>;

  void findIndices(std::size_t level_nodes, const std::vector<int>& partly_held);
  void addSpring(LevelSpring& spring, Find what);
  void addStiffness(const LevelSpring& spring, const Eigen::Matrix3d& stiffness);
  bool isJoining(const LevelSpring& spring, const Vec3& point) const;
  void join(const LevelSpring& spring, const Vec3& point);
  void joinAlong(const LevelSpring& spring, const Vec3& direction, double stiffness);
  // D^-1 f of the nodes that are in no group, per entry of all_ (D with joining springs:
  // WoodburyUpdate; with a membrane: constrained_balance.cpp); the reference holds until the next
  // call.
  const std::vector<Vec3>& balancing() const;
  void takeFreeForces(std::vector<Vec3>& forces) const;
  void divide(std::vector<Vec3>& forces) const;
  std::vector<Vec3> balancingTogether() const;
  std::vector<Vec3> timesTogether(const std::vector<Vec3>& motions) const;
  void shortenTogether(double longest);
  void addToGroup(const ConstrainedNode& hard, const Vec3& force_on_it, Find what);
  static void holdInStiffness(ConstrainedNode& constrained);
  void findInverses() const;
  void invertGroups();

  double spacing_ = 1.0, modulus_ = 1.0;
  Vec3 contact_force_ = Vec3::Zero();
  bool has_new_push_ = false;
  std::vector<ConstrainedNode> all_;  // by node, ascending
  std::vector<int> index_of_;         // per node of the level: in all_, or none
  std::vector<int> acting_;           // of the springs
  std::vector<Vec3> places_;          // displacement, per entry of all_
  std::vector<Vec3> forces_;          // likewise
  WoodburyUpdate::Springs joining_;   // of springs in contact, one a direction
  // Found when D^-1 is asked for: of a quarter of the places with springs (a sphere, a box's edge)
  // forces alone are told.
  mutable bool are_inverses_known_ = false;
  mutable std::vector<Eigen::Matrix3d> inverses_;  // of the stiffness, per entry of all_
  mutable WoodburyUpdate joined_;
  mutable std::vector<Vec3> balancing_;
  std::shared_ptr<const LevelMembrane<Real>> coupling_;  // null: each node alone
  double greatest_ = 1.0;
  std::vector<Matrix6> group_stiffness_, group_inverse_;
  std::vector<GroupVector> group_step_;
};

extern template class ConstrainedNodes<float>;
extern template class ConstrainedNodes<double>;

}  // namespace robot_tissue
