#include "robot_tissue/core/unknowns.h"

#include <cmath>

namespace robot_tissue {
namespace {

constexpr int kOwn = 0;  // until the unknowns are numbered

}  // namespace

Unknowns::Unknowns(const Lattice& lattice, const TissueModel& model,
                   const std::vector<LoadingPatch>& patches, const LatticeState& state)
    : of_(at(lattice.nodeCount()), {kOwn, kOwn, kOwn}) {
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const bool held = lattice.isFixed(node) || model.nodeStiffness(state, node).isZero(0.0);
    if (held) of_[at(node)].fill(kHeld);
  }
  // A patch's nodes are numbered with its first node.
  std::vector<int> leader(of_.size());
  for (std::size_t node = 0; node < leader.size(); ++node) leader[node] = static_cast<int>(node);
  for (const LoadingPatch& patch : patches) {
    const bool by_force = patch.drive == LoadingPatch::Drive::kForce;
    for (const int node : patch.nodes) {
      if (by_force) {
        leader[at(node)] = patch.nodes.front();
        of_[at(node)].fill(kOwn);
        continue;
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (holds(patch, axis)) of_[at(node)][axis] = kHeld;
      }
    }
  }
  for (std::size_t node = 0; node < of_.size(); ++node) {
    const std::size_t first = at(leader[node]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (of_[node][axis] == kHeld) continue;
      of_[node][axis] = first < node ? of_[first][axis] : count_++;
    }
  }
}

Eigen::VectorXd Unknowns::gather(const std::vector<Vec3>& per_node) const {
  Eigen::VectorXd gathered = Eigen::VectorXd::Zero(count_);
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const int unknown = of_[node][at(axis)];
      if (unknown != kHeld) gathered[unknown] += per_node[node][axis];
    }
  }
  return gathered;
}

double Unknowns::heldNorm(const std::vector<Vec3>& per_node) const {
  double squared = 0.0;
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (of_[node][at(axis)] == kHeld) squared += per_node[node][axis] * per_node[node][axis];
    }
  }
  return std::sqrt(squared);
}

void Unknowns::addTo(std::vector<Vec3>& per_node, const Eigen::VectorXd& step, double share) const {
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const int unknown = of_[node][at(axis)];
      if (unknown != kHeld) per_node[node][axis] += share * step[unknown];
    }
  }
}

}  // namespace robot_tissue
