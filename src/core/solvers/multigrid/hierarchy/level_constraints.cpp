// GridHierarchy: what holds the nodes, on every level.
#include <algorithm>

#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

namespace robot_tissue {
namespace {

constexpr double kNext = -1.0;  // between the parts of a bond

}  // namespace

template <typename Real>
void GridHierarchy<Real>::bind(const ConstrainedState& shape, const DofConstraints& hold) {
  Bond bond = bondOf(shape, hold);
  const bool by_force = std::any_of(shape.patches.begin(), shape.patches.end(), byForce);
  const bool held_alike = !by_force && bond.held == bond_.held;
  if (held_alike && bond.springs == bond_.springs) return renewSprings(shape, hold);
  bond_ = by_force ? Bond() : std::move(bond);
  if (!held_alike) {
    holdFinest(shape, hold);
    for (std::size_t level = 0; level + 1 < levels_.size(); ++level) holdCoarse(level);
  }
  hangFinest(shape, hold);
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level) hangCoarse(level);
  if (!held_alike) placeInterfaces();
}

template <typename Real>
typename GridHierarchy<Real>::Bond GridHierarchy<Real>::bondOf(const ConstrainedState& shape,
                                                               const DofConstraints& hold) {
  Bond bond = {{kNext}, {kNext}};
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const int node : hold.hardOf(index)) {
      bond.held.push_back(node);
      bond.held.push_back(hold.dirichletMask()[at(node)]);
    }
    bond.held.push_back(kNext);
    for (const RimSpring& rim : patch.rim) bond.springs.push_back(rim.node);
    bond.springs.push_back(kNext);
    for (const ContactSpring& contact : patch.contacts) {
      bond.springs.push_back(static_cast<double>(contact.carriers.size()));
      for (const NodeWeight& carrier : contact.carriers) {
        bond.springs.push_back(carrier.node);
        bond.springs.push_back(carrier.weight);
      }
    }
  }
  return bond;
}

template <typename Real>
void GridHierarchy<Real>::holdFinest(const ConstrainedState& shape, const DofConstraints& hold) {
  GridLevel<Real>& level = levels_.front();
  level.freeAll();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    level.constrained.groups.emplace_back();
    LevelGroup& group = level.constrained.groups.back();
    group.turns = shape.patches[index].turns;
    if (!byForce(shape.patches[index])) continue;
    for (const int node : hold.hardOf(index)) {
      group.nodes.push_back(entryOf(node));
      group.arms.push_back(hold.armOf(shape, index, node) / spacing_);
    }
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t node = at(nodes_[i]);
    level.hold(entries_[i], hold.carriers()[node] >= 0 ? 0U : hold.dirichletMask()[node]);
  }
  if (!weight_.front().empty()) level.right_hand_side = weight_;
}

template <typename Real>
void GridHierarchy<Real>::hangFinest(const ConstrainedState& shape, const DofConstraints& hold) {
  GridLevel<Real>& level = levels_.front();
  std::vector<LevelSpring>& springs = level.constrained.springs;
  springs.clear();
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& rim : patch.rim) {
      springs.emplace_back();
      springs.back().carriers.push_back({entryOf(rim.node), 1.0});
    }
    for (const ContactSpring& contact : patch.contacts) {
      springs.emplace_back();
      for (const NodeWeight& carrier : contact.carriers) {
        springs.back().carriers.push_back({entryOf(carrier.node), carrier.weight});
      }
    }
  }
  renewSprings(shape, hold);
  level.bind();
  const double unit = modulus_ * spacing_ * spacing_;
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    level.constrained.right_hand_side[index].template head<3>() = shape.patches[index].force / unit;
  }
}

// Springs hang where they did; what they are may have changed.
template <typename Real>
void GridHierarchy<Real>::renewSprings(const ConstrainedState& shape, const DofConstraints& hold) {
  auto spring = levels_.front().constrained.springs.begin();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const RimSpring& rim : patch.rim) {
      spring->stiffness = stiffnessOf(patch, rim) / (modulus_ * spacing_);
      spring->anchor = rim.anchor / spacing_;
      if (byForce(patch)) {
        spring->group = static_cast<int>(index);
        spring->arm = hold.armOf(shape, index, rim.node) / spacing_;
      }
      ++spring;
    }
    for (const ContactSpring& contact : patch.contacts) {
      spring->contact = &contact;
      ++spring;
    }
  }
}

template <typename Real>
void GridHierarchy<Real>::renewGroups(const ConstrainedState& shape, const DofConstraints& hold) {
  bind(shape, hold);
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    for (const int node : hold.hardOf(index)) {
      for (int axis = 0; axis < 3; ++axis) {
        levels_.front().displacement[at(axis)][at(entryOf(node))] =
            static_cast<Real>(shape.state.displacement[at(node)][axis] / spacing_);
      }
    }
  }
}

template <typename Real>
void GridHierarchy<Real>::holdCoarse(std::size_t index) {
  const GridLevel<Real>& fine = levels_[index];
  GridLevel<Real>& coarse = levels_[index + 1];
  coarse.freeAll();
  if (!sources_.empty()) holdFixed(index + 1);
  for (std::size_t group = 0; group < fine.constrained.groups.size(); ++group) {
    coarse.constrained.groups.emplace_back();
    coarse.constrained.groups.back().turns = fine.constrained.groups[group].turns;
    for (std::size_t i = 0; i < fine.constrained.groups[group].nodes.size(); ++i) {
      const NodeShares carriers =
          links_[index].transfer.carriersOf(fine.constrained.groups[group].nodes[i]);
      if (carriers.size() > 1) continue;
      coarse.constrained.groups.back().nodes.push_back(carriers.front().node);
      coarse.constrained.groups.back().arms.push_back(fine.constrained.groups[group].arms[i] /
                                                      GridTransfer<Real>::kTwice);
    }
  }
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.dirichletAxes(node) == 0 || !fine.exists(node)) continue;
    const NodeShares carriers = links_[index].transfer.carriersOf(node);
    if (carriers.size() == 1) coarse.hold(carriers.front().node, fine.dirichletAxes(node));
  }
  links_[index].ties.clear();
  addTies(index);
}

template <typename Real>
void GridHierarchy<Real>::hangCoarse(std::size_t index) {
  const std::vector<LevelSpring>& fine = levels_[index].constrained.springs;
  GridLevel<Real>& coarse = levels_[index + 1];
  std::vector<int>& sources = links_[index].sources;
  coarse.constrained.springs.clear();
  sources.clear();
  for (std::size_t i = 0; i < fine.size(); ++i) {
    LevelSpring spring = fine[i];
    spring.contact = nullptr;
    spring.arm /= GridTransfer<Real>::kTwice;
    spring.carriers = freeCarriers(index, fine[i].carriers);
    if (spring.carriers.empty() && spring.group < 0) continue;
    coarse.constrained.springs.push_back(std::move(spring));
    sources.push_back(static_cast<int>(i));
  }
  const std::vector<LevelSpring>& ties = links_[index].ties;
  coarse.constrained.springs.insert(coarse.constrained.springs.end(), ties.begin(), ties.end());
  coarse.bind();
}

// The coarse nodes that carry a spring of the fine lattice, without those that do not move.
template <typename Real>
std::vector<LevelSpring::Carrier> GridHierarchy<Real>::freeCarriers(
    std::size_t index, const std::vector<LevelSpring::Carrier>& fine) const {
  const GridLevel<Real>& coarse = levels_[index + 1];
  std::vector<LevelSpring::Carrier> carriers;
  for (const LevelSpring::Carrier& carrier : fine) {
    if (levels_[index].dirichletAxes(carrier.node) == kAllAxes) continue;
    for (const NodeShare& share : links_[index].transfer.carriersOf(carrier.node)) {
      if (coarse.dirichletAxes(share.node) == kAllAxes) continue;
      const LevelSpring::Carrier part{share.node, share.weight * carrier.weight};
      const auto same = std::find_if(carriers.begin(), carriers.end(),
                                     [&](const auto& other) { return other.node == part.node; });
      if (same == carriers.end()) {
        carriers.push_back(part);
      } else {
        same->weight += part.weight;
      }
    }
  }
  return carriers;
}

// A fine node that is held where no coarse one is keeps those around it back, as stiffly as it is.
template <typename Real>
void GridHierarchy<Real>::addTies(std::size_t index) {
  const GridLevel<Real>& fine = levels_[index];
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.dirichletAxes(node) == 0 || !fine.exists(node)) continue;
    addTie(index, node, fine.dirichletAxes(node), -1, Vec3::Zero());
  }
  for (std::size_t group = 0; group < fine.constrained.groups.size(); ++group) {
    if (levels_[index + 1].constrained.groups[group].nodes.empty()) continue;
    const LevelGroup& hard = fine.constrained.groups[group];
    for (std::size_t i = 0; i < hard.nodes.size(); ++i) {
      addTie(index, hard.nodes[i], kAllAxes, static_cast<int>(group), hard.arms[i]);
    }
  }
}

template <typename Real>
void GridHierarchy<Real>::addTie(std::size_t index, int node, unsigned axes, int group,
                                 const Vec3& arm) {
  const NodeShares carriers = links_[index].transfer.carriersOf(node);
  if (carriers.size() == 1) return;
  const GridLevel<Real>& coarse = levels_[index + 1];
  LevelSpring spring;
  double weight = 0.0;
  for (const NodeShare& carrier : carriers) {
    if (coarse.dirichletAxes(carrier.node) == kAllAxes) continue;
    if (group >= 0) {
      const auto& hard = coarse.constrained.groups[at(group)].nodes;
      if (std::find(hard.begin(), hard.end(), carrier.node) != hard.end()) continue;
    }
    spring.carriers.push_back({carrier.node, carrier.weight});
    weight += carrier.weight;
  }
  if (spring.carriers.empty()) return;
  for (LevelSpring::Carrier& carrier : spring.carriers) carrier.weight /= weight;
  const double stiffness =
      weight * weight * levels_[index].restStiffness(node) / GridTransfer<Real>::kTwice;
  for (int axis = 0; axis < 3; ++axis) {
    if ((axes >> axis & 1U) != 0) spring.stiffness(axis, axis) = stiffness;
  }
  spring.group = group;
  spring.arm = arm / GridTransfer<Real>::kTwice;
  links_[index].ties.push_back(std::move(spring));
}

template class GridHierarchy<float>;
template class GridHierarchy<double>;

}  // namespace robot_tissue
