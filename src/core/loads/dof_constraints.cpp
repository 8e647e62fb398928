#include "loads/dof_constraints.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

bool isLoose(const CellSet& cells, int node) { return cells.meetings(node).isEmpty(); }

}  // namespace

void DofConstraints::SpringList::clear(std::size_t of_nodes) {
  all.clear();
  if (std::exchange(node_count, of_nodes) != of_nodes) {
    first = std::vector<int>();
  } else {
    for (const int node : nodes) first[at(node)] = -1;
  }
  nodes.clear();
}

void DofConstraints::SpringList::add(int node, std::size_t patch, std::size_t spring,
                                     double weight) {
  if (first.empty()) first.assign(node_count, -1);
  if (first[at(node)] < 0) nodes.push_back(node);
  all.push_back({patch, spring, weight, first[at(node)]});
  first[at(node)] = static_cast<int>(all.size()) - 1;
}

DofConstraints::DofConstraints(const Lattice& lattice, const EnergyModel& model)
    : lattice_(lattice), model_(model) {}

void DofConstraints::bind(ConstrainedState& shape) {
  letGo(shape.state);
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    hard_.push_back(hardNodes(patch));
    for (const int node : hard_.back()) {
      const bool was_held = dirichlet_[at(node)] == kAllAxes;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (holds(patch, axis)) dirichlet_[at(node)] |= static_cast<std::uint8_t>(1U << axis);
      }
      if (byForce(patch)) carry(node, index);
      if (dirichlet_[at(node)] == kAllAxes && !was_held) --free_nodes_;
    }
    for (std::size_t spring = 0; spring < patch.rim.size(); ++spring) {
      rims_.add(patch.rim[spring].node, index, spring, 1.0);
    }
    for (std::size_t spring = 0; spring < patch.contacts.size(); ++spring) {
      for (const NodeWeight& carrier : patch.contacts[spring].carriers) {
        contacts_.add(carrier.node, index, spring, carrier.weight);
      }
    }
  }
  touched_ = contacts_.nodes;
  std::sort(touched_.begin(), touched_.end());
}

void DofConstraints::carry(int node, std::size_t patch) {
  if (carriers_.empty()) carriers_.assign(dirichlet_.size(), -1);
  carriers_[at(node)] = static_cast<int>(patch);
}

// Back to what is held without patches. Where the cells are those of the last bind, only what its
// patches held is undone: to look at all nodes again would take longer than a small solve.
void DofConstraints::letGo(const LatticeState& state) {
  const std::size_t nodes = state.displacement.size();
  if (cells_ != state.cells || held_by_itself_.size() != nodes) {
    cells_ = state.cells;
    carriers_ = std::vector<int>();
    held_by_itself_.assign(nodes, 0);
    for (std::size_t node = 0; node < nodes; ++node) {
      const int index = static_cast<int>(node);
      if (isFixed(lattice_, *cells_, index) || isLoose(*cells_, index)) {
        held_by_itself_[node] = kAllAxes;
      }
    }
    free_by_themselves_ = static_cast<int>(
        std::count(held_by_itself_.begin(), held_by_itself_.end(), std::uint8_t{0}));
  }
  for (const std::vector<int>& hard : hard_) {
    for (const int node : hard) {
      if (at(node) < carriers_.size()) carriers_[at(node)] = -1;
    }
  }
  dirichlet_ = held_by_itself_;
  free_nodes_ = free_by_themselves_;
  rims_.clear(nodes);
  contacts_.clear(nodes);
  hard_.clear();
}

void DofConstraints::place(ConstrainedState& shape) const {
  for (const LoadingPatch& patch : shape.patches) {
    if (byForce(patch)) continue;
    std::size_t spring = 0;
    for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
      const int node = patch.nodes[i];
      while (spring < patch.rim.size() && patch.rim[spring].node < node) ++spring;
      if (spring < patch.rim.size() && patch.rim[spring].node == node) continue;
      for (int axis = 0; axis < 3; ++axis) {
        if (!holds(patch, at(axis))) continue;
        shape.state.displacement[at(node)][axis] = patch.displacement[i][axis];
      }
    }
  }
}

Vec3 DofConstraints::freePart(int node, const Vec3& vector) const {
  Vec3 free = vector;
  for (int axis = 0; axis < 3; ++axis) {
    if ((dirichlet_[at(node)] >> axis & 1) != 0) free[axis] = 0.0;
  }
  return free;
}

void DofConstraints::addContacts(const ConstrainedState& shape, int node,
                                 NodeBalance& balance) const {
  const std::vector<Vec3>& displacement = shape.state.displacement;
  for (int index = contacts_.firstOf(node); index >= 0; index = contacts_.all[at(index)].next) {
    const SpringPlace& place = contacts_.all[at(index)];
    const ContactSpring& spring = shape.patches[place.patch].contacts[place.spring];
    balance.force += place.weight * forceOf(spring, displacement);
    balance.block += place.weight * place.weight * stiffnessOf(spring, displacement);
  }
}

void DofConstraints::addSprings(const ConstrainedState& shape, int node,
                                NodeBalance& balance) const {
  addContacts(shape, node, balance);
  for (int index = rims_.firstOf(node); index >= 0; index = rims_.all[at(index)].next) {
    const LoadingPatch& patch = shape.patches[rims_.all[at(index)].patch];
    const RimSpring& spring = patch.rim[rims_.all[at(index)].spring];
    const Eigen::Matrix3d stiffness = stiffnessOf(patch, spring);
    balance.force += stiffness * (spring.anchor - shape.state.displacement[at(node)]);
    balance.block += stiffness;
  }
}

Vec3 DofConstraints::armOf(const ConstrainedState& shape, std::size_t patch, int node) const {
  return restPosition(lattice_, *shape.state.cells, node) + shape.state.displacement[at(node)] -
         centerOf(shape.patches[patch]);
}

Motion::OfPatch DofConstraints::forceOn(const ConstrainedState& shape, std::size_t patch) const {
  std::vector<Vec3> forces(shape.state.displacement.size(), Vec3::Zero());
  for (const int node : hard_[patch]) forces[at(node)] = model_.nodeForce(shape.state, node);
  return forceOn(shape, patch, forces);
}

Motion::OfPatch DofConstraints::forceOn(const ConstrainedState& shape, std::size_t index,
                                        const std::vector<Vec3>& forces) const {
  const LoadingPatch& patch = shape.patches[index];
  Motion::OfPatch on_patch;
  on_patch.shift = patch.force;
  const auto add = [&](int node, const Vec3& force) {
    on_patch.shift += force;
    if (patch.turns) on_patch.turn += armOf(shape, index, node).cross(force);
  };
  for (const int node : hard_[index]) {
    NodeBalance contacts;
    addContacts(shape, node, contacts);
    add(node, forces[at(node)] + contacts.force);
  }
  for (const RimSpring& spring : patch.rim) {
    const Vec3& displacement = shape.state.displacement[at(spring.node)];
    add(spring.node, -(stiffnessOf(patch, spring) * (spring.anchor - displacement)));
  }
  return on_patch;
}

}  // namespace robot_tissue
