// What may move under loading patches, for methods that move nodes one at a time: components of
// nodes that are free, patches by force as a whole, and the forces on both.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "loads/constrained_state.h"
#include "material/energy_model.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {

// A motion (m, rad), or forces (N, N m) that do work in it. Patches by displacement: zero.
struct Motion {
  struct OfPatch {
    Vec3 shift = Vec3::Zero();  // or force
    Vec3 turn = Vec3::Zero();   // about the patch's center; or moment
  };

  std::vector<Vec3> nodes;
  std::vector<OfPatch> patches;
};

// Which components are held, and by what. A component is held, bit 1 << axis, when its node is
// fixed or loose, or hard in a patch that holds the axis; nodes that are hard in a patch by force
// move with that.
class DofConstraints {
 public:
  DofConstraints(const Lattice& lattice, const EnergyModel& model);

  // Places hard nodes of patches by displacement.
  void bind(ConstrainedState& shape);
  void place(ConstrainedState& shape) const;

  const std::vector<std::uint8_t>& dirichletMask() const { return dirichlet_; }
  // Nodes that a contact hangs on, ascending.
  const std::vector<int>& touched() const { return touched_; }
  // Index of the patch by force in which the node is hard, -1 = none.
  int carrierOf(std::size_t node) const { return carriers_.empty() ? -1 : carriers_[node]; }
  const std::vector<int>& hardOf(std::size_t patch) const { return hard_[patch]; }
  int freeNodes() const { return free_nodes_; }  // of which not all is held
  Vec3 freePart(int node, const Vec3& vector) const;

  // Adds what rim springs and contacts do to the node.
  void addSprings(const ConstrainedState& shape, int node, NodeBalance& balance) const;

  // Of the patch's own force, its hard nodes and its rim (N, N m about its center).
  Motion::OfPatch forceOn(const ConstrainedState& shape, std::size_t patch) const;
  // The same from forces on the nodes, those of rims not included.
  Motion::OfPatch forceOn(const ConstrainedState& shape, std::size_t patch,
                          const std::vector<Vec3>& forces) const;

  // Where a node of a patch by force is, from the patch's center (m).
  Vec3 armOf(const ConstrainedState& shape, std::size_t patch, int node) const;

 private:
  void letGo(const LatticeState& state);
  void carry(int node, std::size_t patch);
  void addContacts(const ConstrainedState& shape, int node, NodeBalance& balance) const;

  // Where a spring of a node stands.
  struct SpringPlace {
    std::size_t patch = 0;
    std::size_t spring = 0;
    double weight = 1.0;  // of the node in a contact's point; 1 of a rim's spring
    int next = -1;        // index in SpringList::all of the node's next spring, -1 = none
  };
  // The springs of each node, as linked lists in one array.
  struct SpringList {
    std::vector<SpringPlace> all;
    std::size_t node_count = 0;
    std::vector<int> first;  // per node: index in all, -1 = none; empty: there was none yet
    std::vector<int> nodes;  // those with a spring

    int firstOf(int node) const { return first.empty() ? -1 : first[at(node)]; }
    void clear(std::size_t of_nodes);
    void add(int node, std::size_t patch, std::size_t spring, double weight);
  };

  const Lattice& lattice_;
  const EnergyModel& model_;
  std::shared_ptr<const CellSet> cells_;  // of the last bind
  std::vector<std::uint8_t> held_by_itself_;
  int free_by_themselves_ = 0, free_nodes_ = 0;
  std::vector<std::uint8_t> dirichlet_;
  std::vector<int> carriers_;           // as carrierOf; empty: there was no patch by force yet
  std::vector<std::vector<int>> hard_;  // per patch
  SpringList rims_;
  SpringList contacts_;
  std::vector<int> touched_;
};

}  // namespace robot_tissue
