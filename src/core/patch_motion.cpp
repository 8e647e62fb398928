#include "robot_tissue/core/patch_motion.h"

#include <algorithm>

namespace robot_tissue {
namespace {

bool isLoose(const CellSet& cells, int node) { return cells.first(node) == cells.last(node); }

}  // namespace

PatchHold::PatchHold(const Lattice& lattice, const EnergyModel& model)
    : lattice_(lattice), model_(model) {}

void PatchHold::bind(LoadedShape& shape) {
  const std::size_t nodes = shape.state.displacement.size();
  held_.assign(nodes, 0);
  carriers_.assign(nodes, -1);
  first_rim_.assign(nodes, -1);
  rims_.clear();
  hard_.clear();
  for (std::size_t node = 0; node < nodes; ++node) {
    const int index = static_cast<int>(node);
    if (isFixed(lattice_, *shape.state.cells, index) || isLoose(*shape.state.cells, index))
      held_[node] = kAllHeld;
  }
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    hard_.push_back(hardNodes(patch));
    for (const int node : hard_.back()) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (holds(patch, axis)) held_[at(node)] |= static_cast<std::uint8_t>(1U << axis);
      }
      if (byForce(patch)) carriers_[at(node)] = static_cast<int>(index);
    }
    for (std::size_t spring = 0; spring < patch.rim.size(); ++spring) {
      int& first = first_rim_[at(patch.rim[spring].node)];
      rims_.push_back({index, spring, first});
      first = static_cast<int>(rims_.size()) - 1;
    }
  }
}

void PatchHold::place(LoadedShape& shape) const {
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

Vec3 PatchHold::freePart(int node, const Vec3& vector) const {
  Vec3 free = vector;
  for (int axis = 0; axis < 3; ++axis) {
    if ((held_[at(node)] >> axis & 1) != 0) free[axis] = 0.0;
  }
  return free;
}

void PatchHold::addRims(const LoadedShape& shape, int node, NodeBalance& balance) const {
  for (int rim = first_rim_[at(node)]; rim >= 0; rim = rims_[at(rim)].next) {
    const LoadingPatch& patch = shape.patches[rims_[at(rim)].patch];
    const RimSpring& spring = patch.rim[rims_[at(rim)].spring];
    const Eigen::Matrix3d stiffness = stiffnessOf(patch, spring);
    balance.force += stiffness * (spring.anchor - shape.state.displacement[at(node)]);
    balance.block += stiffness;
  }
}

Vec3 PatchHold::armOf(const LoadedShape& shape, std::size_t patch, int node) const {
  return restPosition(lattice_, *shape.state.cells, node) + shape.state.displacement[at(node)] -
         Unknowns::centerOf(shape.patches[patch]);
}

Motion::OfPatch PatchHold::forceOn(const LoadedShape& shape, std::size_t patch) const {
  std::vector<Vec3> forces(shape.state.displacement.size(), Vec3::Zero());
  for (const int node : hard_[patch]) forces[at(node)] = model_.nodeForce(shape.state, node);
  return forceOn(shape, patch, forces);
}

Motion::OfPatch PatchHold::forceOn(const LoadedShape& shape, std::size_t index,
                                   const std::vector<Vec3>& forces) const {
  const LoadingPatch& patch = shape.patches[index];
  Motion::OfPatch on_patch;
  on_patch.shift = patch.force;
  const auto add = [&](int node, const Vec3& force) {
    on_patch.shift += force;
    if (patch.turns) on_patch.turn += armOf(shape, index, node).cross(force);
  };
  for (const int node : hard_[index]) add(node, forces[at(node)]);
  for (const RimSpring& spring : patch.rim) {
    const Vec3& displacement = shape.state.displacement[at(spring.node)];
    add(spring.node, -(stiffnessOf(patch, spring) * (spring.anchor - displacement)));
  }
  return on_patch;
}

}  // namespace robot_tissue
