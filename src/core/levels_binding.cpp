// LatticeLevels: what holds the nodes, on every level.
#include <algorithm>

#include "robot_tissue/core/lattice_levels.h"

namespace robot_tissue {
namespace {

constexpr double kNext = -1.0;  // between the parts of a bond

}  // namespace

template <typename Real>
void LatticeLevels<Real>::bind(const LoadedShape& shape, const PatchHold& hold) {
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
  if (!held_alike) placeRims();
}

template <typename Real>
typename LatticeLevels<Real>::Bond LatticeLevels<Real>::bondOf(const LoadedShape& shape,
                                                               const PatchHold& hold) {
  Bond bond = {{kNext}, {kNext}};
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const int node : hold.hardOf(index)) {
      bond.held.push_back(node);
      bond.held.push_back(hold.held()[at(node)]);
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
void LatticeLevels<Real>::holdFinest(const LoadedShape& shape, const PatchHold& hold) {
  LatticeLevel<Real>& level = levels_.front();
  level.freeAll();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    level.firm.groups.emplace_back();
    LevelGroup& group = level.firm.groups.back();
    group.turns = shape.patches[index].turns;
    if (!byForce(shape.patches[index])) continue;
    for (const int node : hold.hardOf(index)) {
      group.nodes.push_back(entryOf(node));
      group.arms.push_back(hold.armOf(shape, index, node) / spacing_);
    }
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const std::size_t node = at(nodes_[i]);
    level.hold(entries_[i], hold.carriers()[node] >= 0 ? 0U : hold.held()[node]);
  }
  if (!weight_.front().empty()) level.load = weight_;
}

template <typename Real>
void LatticeLevels<Real>::hangFinest(const LoadedShape& shape, const PatchHold& hold) {
  LatticeLevel<Real>& level = levels_.front();
  std::vector<LevelSpring>& springs = level.firm.springs;
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
    level.firm.load[index].template head<3>() = shape.patches[index].force / unit;
  }
}

// Springs hang where they did; what they are may have changed.
template <typename Real>
void LatticeLevels<Real>::renewSprings(const LoadedShape& shape, const PatchHold& hold) {
  auto spring = levels_.front().firm.springs.begin();
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
void LatticeLevels<Real>::renewGroups(const LoadedShape& shape, const PatchHold& hold) {
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
void LatticeLevels<Real>::holdCoarse(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index];
  LatticeLevel<Real>& coarse = levels_[index + 1];
  coarse.freeAll();
  if (!sources_.empty()) holdFixed(index + 1);
  for (std::size_t group = 0; group < fine.firm.groups.size(); ++group) {
    coarse.firm.groups.emplace_back();
    coarse.firm.groups.back().turns = fine.firm.groups[group].turns;
    for (std::size_t i = 0; i < fine.firm.groups[group].nodes.size(); ++i) {
      const NodeShares carriers =
          steps_[index].transfer.carriersOf(fine.firm.groups[group].nodes[i]);
      if (carriers.size() > 1) continue;
      coarse.firm.groups.back().nodes.push_back(carriers.front().node);
      coarse.firm.groups.back().arms.push_back(fine.firm.groups[group].arms[i] /
                                               LevelTransfer<Real>::kTwice);
    }
  }
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.heldAxes(node) == 0 || !fine.exists(node)) continue;
    const NodeShares carriers = steps_[index].transfer.carriersOf(node);
    if (carriers.size() == 1) coarse.hold(carriers.front().node, fine.heldAxes(node));
  }
  steps_[index].ties.clear();
  addTies(index);
}

template <typename Real>
void LatticeLevels<Real>::hangCoarse(std::size_t index) {
  const std::vector<LevelSpring>& fine = levels_[index].firm.springs;
  LatticeLevel<Real>& coarse = levels_[index + 1];
  std::vector<int>& sources = steps_[index].sources;
  coarse.firm.springs.clear();
  sources.clear();
  for (std::size_t i = 0; i < fine.size(); ++i) {
    LevelSpring spring = fine[i];
    spring.contact = nullptr;
    spring.arm /= LevelTransfer<Real>::kTwice;
    spring.carriers = freeCarriers(index, fine[i].carriers);
    if (spring.carriers.empty() && spring.group < 0) continue;
    coarse.firm.springs.push_back(std::move(spring));
    sources.push_back(static_cast<int>(i));
  }
  const std::vector<LevelSpring>& ties = steps_[index].ties;
  coarse.firm.springs.insert(coarse.firm.springs.end(), ties.begin(), ties.end());
  coarse.bind();
}

// The coarse nodes that carry a spring of the fine lattice, without those that do not move.
template <typename Real>
std::vector<LevelSpring::Carrier> LatticeLevels<Real>::freeCarriers(
    std::size_t index, const std::vector<LevelSpring::Carrier>& fine) const {
  const LatticeLevel<Real>& coarse = levels_[index + 1];
  std::vector<LevelSpring::Carrier> carriers;
  for (const LevelSpring::Carrier& carrier : fine) {
    if (levels_[index].heldAxes(carrier.node) == kAllHeld) continue;
    for (const NodeShare& share : steps_[index].transfer.carriersOf(carrier.node)) {
      if (coarse.heldAxes(share.node) == kAllHeld) continue;
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
void LatticeLevels<Real>::addTies(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index];
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.heldAxes(node) == 0 || !fine.exists(node)) continue;
    addTie(index, node, fine.heldAxes(node), -1, Vec3::Zero());
  }
  for (std::size_t group = 0; group < fine.firm.groups.size(); ++group) {
    if (levels_[index + 1].firm.groups[group].nodes.empty()) continue;
    const LevelGroup& hard = fine.firm.groups[group];
    for (std::size_t i = 0; i < hard.nodes.size(); ++i) {
      addTie(index, hard.nodes[i], kAllHeld, static_cast<int>(group), hard.arms[i]);
    }
  }
}

template <typename Real>
void LatticeLevels<Real>::addTie(std::size_t index, int node, unsigned axes, int group,
                                 const Vec3& arm) {
  const NodeShares carriers = steps_[index].transfer.carriersOf(node);
  if (carriers.size() == 1) return;
  const LatticeLevel<Real>& coarse = levels_[index + 1];
  LevelSpring spring;
  double weight = 0.0;
  for (const NodeShare& carrier : carriers) {
    if (coarse.heldAxes(carrier.node) == kAllHeld) continue;
    if (group >= 0) {
      const auto& hard = coarse.firm.groups[at(group)].nodes;
      if (std::find(hard.begin(), hard.end(), carrier.node) != hard.end()) continue;
    }
    spring.carriers.push_back({carrier.node, carrier.weight});
    weight += carrier.weight;
  }
  if (spring.carriers.empty()) return;
  for (LevelSpring::Carrier& carrier : spring.carriers) carrier.weight /= weight;
  const double stiffness =
      weight * weight * levels_[index].restStiffness(node) / LevelTransfer<Real>::kTwice;
  for (int axis = 0; axis < 3; ++axis) {
    if ((axes >> axis & 1U) != 0) spring.stiffness(axis, axis) = stiffness;
  }
  spring.group = group;
  spring.arm = arm / LevelTransfer<Real>::kTwice;
  steps_[index].ties.push_back(std::move(spring));
}

template class LatticeLevels<float>;
template class LatticeLevels<double>;

}  // namespace robot_tissue
