#include "solvers/newton/dof_map.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

constexpr int kOwn = 0;  // in of_: a component with an unknown of its own, until these are numbered

}  // namespace

DofMap::DofMap(const Lattice& lattice, const TissueModel& model, const ConstrainedState& shape)
    : lattice_(&lattice),
      of_(shape.state.displacement.size(), {kOwn, kOwn, kOwn}),
      carrier_(of_.size(), -1),
      patches_(shape.patches.size()) {
  for (std::size_t node = 0; node < of_.size(); ++node) {
    const int index = static_cast<int>(node);
    if (isFixed(lattice, *shape.state.cells, index) ||
        model.nodeStiffness(shape.state, index).isZero(0.0))
      of_[node].fill(kHeld);
  }
  bind(shape.patches);
  number();
  measure(shape);
}

void DofMap::bind(const std::vector<LoadingPatch>& patches) {
  for (std::size_t index = 0; index < patches.size(); ++index) {
    const LoadingPatch& patch = patches[index];
    for (const int node : hardNodes(patch)) {
      if (byForce(patch)) {
        carrier_[at(node)] = static_cast<int>(index);
        of_[at(node)].fill(kOwn);
        continue;
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (holds(patch, axis)) of_[at(node)][axis] = kHeld;
      }
    }
    if (byForce(patch)) patches_[index].first = kOwn;
    if (byForce(patch) && patch.turns) patches_[index].first_turn = kOwn;
  }
}

void DofMap::number() {
  for (PatchDofs& patch : patches_) {
    if (patch.first == kOwn) patch.first = 3 * count_++;
  }
  count_ *= 3;
  for (PatchDofs& patch : patches_) {
    if (patch.first_turn != kOwn) continue;
    patch.first_turn = count_;
    count_ += 3;
  }
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      int& unknown = of_[node][axis];
      if (unknown == kHeld) continue;
      unknown = carrier_[node] >= 0 ? patches_[at(carrier_[node])].first + static_cast<int>(axis)
                                    : count_++;
    }
  }
}

// The length that makes a turn (rad) an unknown in m: the mean distance of the patch's nodes and
// anchors from its center.
void DofMap::measure(const ConstrainedState& shape) {
  for (std::size_t index = 0; index < patches_.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    double sum = 0.0;
    for (const int node : patch.nodes) {
      sum += (restPosition(*lattice_, *shape.state.cells, node) - patch.center).norm();
    }
    const double nodes = static_cast<double>(std::max<std::size_t>(patch.nodes.size(), 1));
    patches_[index].length = std::max(sum / nodes, lattice_->spacing());
  }
}

bool DofMap::operator==(const DofMap& other) const {
  const auto same = [](const PatchDofs& a, const PatchDofs& b) {
    return a.first == b.first && a.first_turn == b.first_turn && a.length == b.length;
  };
  return of_ == other.of_ && carrier_ == other.carrier_ &&
         std::equal(patches_.begin(), patches_.end(), other.patches_.begin(), other.patches_.end(),
                    same);
}

DofMap::Shares DofMap::sharesOf(const ConstrainedState& shape, int node, int axis) const {
  const int carrier = carrier_[at(node)];
  if (carrier >= 0) return sharesOf(shape, at(carrier), position(shape, node), axis);
  Shares shares;
  if (of(node, axis) != kHeld) shares.add(of(node, axis), 1.0);
  return shares;
}

// A turn w moves a point at arm r from the center by w x r.
DofMap::Shares DofMap::sharesOf(const ConstrainedState& shape, std::size_t patch, const Vec3& point,
                                int axis) const {
  Shares shares;
  if (patches_[patch].first == kHeld) return shares;
  shares.add(patches_[patch].first + axis, 1.0);
  if (patches_[patch].first_turn == kHeld) return shares;
  const Vec3 arm = point - centerOf(shape.patches[patch]);
  const int next = (axis + 1) % 3, last = (axis + 2) % 3;
  shares.add(patches_[patch].first_turn + next, arm[last] / patches_[patch].length);
  shares.add(patches_[patch].first_turn + last, -arm[next] / patches_[patch].length);
  return shares;
}

DofMap::Share DofMap::turnOf(std::size_t patch, int axis) const {
  const PatchDofs& unknowns = patches_[patch];
  if (unknowns.first_turn == kHeld) return {};
  return {unknowns.first_turn + axis, 1.0 / unknowns.length};
}

Vec3 DofMap::position(const ConstrainedState& shape, int node) const {
  return restPosition(*lattice_, *shape.state.cells, node) + shape.state.displacement[at(node)];
}

Eigen::VectorXd DofMap::gather(const ConstrainedState& shape,
                               const std::vector<Vec3>& per_node) const {
  Eigen::VectorXd gathered = Eigen::VectorXd::Zero(count_);
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const Share& share : sharesOf(shape, static_cast<int>(node), axis)) {
        gathered[share.unknown] += share.weight * per_node[node][axis];
      }
    }
  }
  return gathered;
}

double DofMap::heldNorm(const std::vector<Vec3>& per_node) const {
  double squared = 0.0;
  for (std::size_t node = 0; node < of_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (of_[node][at(axis)] == kHeld) squared += per_node[node][axis] * per_node[node][axis];
    }
  }
  return std::sqrt(squared);
}

Vec3 DofMap::turnAbout(const PatchDofs& unknowns, const Eigen::VectorXd& step, double share) const {
  if (unknowns.first_turn == kHeld) return Vec3::Zero();
  return share / unknowns.length * step.segment<3>(unknowns.first_turn);
}

void DofMap::move(ConstrainedState& shape, const Eigen::VectorXd& step, double share) const {
  for (std::size_t node = 0; node < of_.size(); ++node) {
    if (carrier_[node] >= 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const int unknown = of_[node][at(axis)];
      if (unknown != kHeld) shape.state.displacement[node][axis] += share * step[unknown];
    }
  }
  for (std::size_t index = 0; index < patches_.size(); ++index) {
    if (patches_[index].first == kHeld) continue;
    const Vec3 translation = share * step.segment<3>(patches_[index].first);
    movePatch(*lattice_, shape.patches[index], translation, turnAbout(patches_[index], step, share),
              shape.state);
  }
}

}  // namespace robot_tissue
