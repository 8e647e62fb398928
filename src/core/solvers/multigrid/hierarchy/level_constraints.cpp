#include "solvers/multigrid/hierarchy/level_constraints.h"

#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

constexpr double kNext = -1.0;  // between the parts of a pattern

}  // namespace

template <typename Real>
LevelConstraints<Real>::LevelConstraints(CompositeGrid<Real>& grid) : grid_(grid) {
  reset();
}

template <typename Real>
void LevelConstraints<Real>::reset() {
  pattern_ = Pattern();
  from_fine_.assign(grid_.levelCount() - 1, FromFine());
}

template <typename Real>
Holds LevelConstraints<Real>::bind(const ConstrainedState& shape, const DofConstraints& hold) {
  Pattern pattern = patternOf(shape, hold);
  const bool by_force = std::any_of(shape.patches.begin(), shape.patches.end(), byForce);
  const bool held_alike = !by_force && pattern.dirichlet == pattern_.dirichlet;
  if (held_alike && pattern.springs == pattern_.springs) {
    renewSprings(shape, hold);
    return Holds::kAsBefore;
  }
  pattern_ = by_force ? Pattern() : std::move(pattern);
  if (!held_alike) {
    holdFinest(shape, hold);
    for (std::size_t level = 1; level < grid_.levelCount(); ++level) holdCoarse(level);
  }
  addSpringsToFinest(shape, hold);
  for (std::size_t level = 1; level < grid_.levelCount(); ++level) addSpringsToCoarse(level);
  if (held_alike) return Holds::kAsBefore;
  grid_.placeInterfaces();
  return Holds::kOthers;
}

template <typename Real>
typename LevelConstraints<Real>::Pattern LevelConstraints<Real>::patternOf(
    const ConstrainedState& shape, const DofConstraints& hold) {
  Pattern pattern = {{kNext}, {kNext}};
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const int node : hold.hardOf(index)) {
      pattern.dirichlet.push_back(node);
      pattern.dirichlet.push_back(hold.dirichletMask()[at(node)]);
    }
    pattern.dirichlet.push_back(kNext);
    for (const RimSpring& rim : patch.rim) pattern.springs.push_back(rim.node);
    pattern.springs.push_back(kNext);
    for (const ContactSpring& contact : patch.contacts) {
      pattern.springs.push_back(static_cast<double>(contact.carriers.size()));
      for (const NodeWeight& carrier : contact.carriers) {
        pattern.springs.push_back(carrier.node);
        pattern.springs.push_back(carrier.weight);
      }
    }
  }
  return pattern;
}

template <typename Real>
void LevelConstraints<Real>::holdFinest(const ConstrainedState& shape, const DofConstraints& hold) {
  GridLevel<Real>& level = grid_.finest();
  level.freeAll();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    level.constrained.groups.emplace_back();
    LevelGroup& group = level.constrained.groups.back();
    group.turns = shape.patches[index].turns;
    if (!byForce(shape.patches[index])) continue;
    for (const int node : hold.hardOf(index)) {
      group.nodes.push_back(grid_.entryOf(node));
      group.arms.push_back(hold.armOf(shape, index, node) / grid_.spacing());
    }
  }
  for (std::size_t i = 0; i < grid_.nodes().size(); ++i) {
    const std::size_t node = at(grid_.nodes()[i]);
    level.hold(grid_.entries()[i], hold.carrierOf(node) >= 0 ? 0U : hold.dirichletMask()[node]);
  }
  if (!grid_.weight().front().empty()) level.right_hand_side = grid_.weight();
}

template <typename Real>
void LevelConstraints<Real>::addSpringsToFinest(const ConstrainedState& shape,
                                                const DofConstraints& hold) {
  GridLevel<Real>& level = grid_.finest();
  std::vector<LevelSpring>& springs = level.constrained.springs;
  springs.clear();
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& rim : patch.rim) {
      springs.emplace_back();
      springs.back().carriers.push_back({grid_.entryOf(rim.node), 1.0});
    }
    for (const ContactSpring& contact : patch.contacts) {
      springs.emplace_back();
      springs.back().ends = endsOf(contact);
      for (const NodeWeight& carrier : contact.carriers) {
        springs.back().carriers.push_back({grid_.entryOf(carrier.node), carrier.weight});
      }
    }
  }
  renewSprings(shape, hold);
  level.bind();
  const double unit = grid_.modulus() * grid_.spacing() * grid_.spacing();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    level.constrained.right_hand_side[index].template head<3>() = shape.patches[index].force / unit;
  }
}

// Springs join the nodes that they did; their stiffness, anchors and laws may have changed.
template <typename Real>
void LevelConstraints<Real>::renewSprings(const ConstrainedState& shape,
                                          const DofConstraints& hold) {
  auto spring = grid_.finest().constrained.springs.begin();
  contacts_.clear();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const RimSpring& rim : patch.rim) {
      spring->stiffness = stiffnessOf(patch, rim) / (grid_.modulus() * grid_.spacing());
      spring->anchor = rim.anchor / grid_.spacing();
      if (byForce(patch)) {
        spring->group = static_cast<int>(index);
        spring->arm = hold.armOf(shape, index, rim.node) / grid_.spacing();
      }
      ++spring;
    }
    contacts_.push_back(patch.contacts);
    for (const ContactSpring& contact : contacts_.back()) {
      spring->contact = &contact;
      ++spring;
    }
  }
}

template <typename Real>
void LevelConstraints<Real>::renewGroups(const ConstrainedState& shape,
                                         const DofConstraints& hold) {
  bind(shape, hold);
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (!byForce(shape.patches[index])) continue;
    for (const int node : hold.hardOf(index)) {
      for (int axis = 0; axis < 3; ++axis) {
        grid_.finest().displacement[at(axis)][at(grid_.entryOf(node))] =
            static_cast<Real>(shape.state.displacement[at(node)][axis] / grid_.spacing());
      }
    }
  }
}

template <typename Real>
void LevelConstraints<Real>::holdCoarse(std::size_t index) {
  const GridLevel<Real>& fine = grid_.level(index - 1);
  GridLevel<Real>& coarse = grid_.level(index);
  const GridTransfer<Real>& transfer = grid_.transfer(index - 1);
  coarse.freeAll();
  if (grid_.isBlock()) {
    // Where it is cut, what stands at a fixed node's place may be of another piece.
    grid_.forNodesAt(index, [&](int entry, int node) {
      std::array<int, 3> on_fine = grid_.lattice().gridIndex(node);
      for (int& place : on_fine) place >>= index - 1;
      if (grid_.cutBox(index - 1).has(on_fine)) return;
      if (grid_.lattice().isFixed(node)) coarse.hold(entry, kAllAxes);
    });
  }
  for (std::size_t group = 0; group < fine.constrained.groups.size(); ++group) {
    coarse.constrained.groups.emplace_back();
    coarse.constrained.groups.back().turns = fine.constrained.groups[group].turns;
    for (std::size_t i = 0; i < fine.constrained.groups[group].nodes.size(); ++i) {
      const NodeShares carriers = transfer.carriersOf(fine.constrained.groups[group].nodes[i]);
      if (carriers.size() > 1) continue;
      coarse.constrained.groups.back().nodes.push_back(carriers.front().node);
      coarse.constrained.groups.back().arms.push_back(fine.constrained.groups[group].arms[i] /
                                                      GridTransfer<Real>::kTwice);
    }
  }
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.dirichletAxes(node) == 0 || !fine.exists(node)) continue;
    const NodeShares carriers = transfer.carriersOf(node);
    if (carriers.size() == 1) coarse.hold(carriers.front().node, fine.dirichletAxes(node));
  }
  from_fine_[index - 1].ties.clear();
  addTies(index);
}

template <typename Real>
void LevelConstraints<Real>::addSpringsToCoarse(std::size_t index) {
  const std::vector<LevelSpring>& fine = grid_.level(index - 1).constrained.springs;
  GridLevel<Real>& coarse = grid_.level(index);
  std::vector<int>& fine_springs = from_fine_[index - 1].springs;
  coarse.constrained.springs.clear();
  fine_springs.clear();
  FreeShares shares{
      std::vector<std::optional<NodeShares>>(grid_.level(index - 1).constrained.count()),
      std::vector<int>(at(coarse.count()), 0),
      {}};
  coarse.constrained.springs.reserve(fine.size());
  for (std::size_t i = 0; i < fine.size(); ++i) {
    std::vector<LevelSpring::Carrier> carriers = freeCarriers(index, fine[i].carriers, shares);
    if (carriers.empty() && fine[i].group < 0) continue;
    coarse.constrained.springs.emplace_back();
    LevelSpring& spring = coarse.constrained.springs.back();
    spring.carriers = std::move(carriers);
    spring.ends = fine[i].ends;
    spring.group = fine[i].group;
    spring.arm = fine[i].arm / GridTransfer<Real>::kTwice;
    fine_springs.push_back(static_cast<int>(i));
  }
  const std::vector<LevelSpring>& ties = from_fine_[index - 1].ties;
  coarse.constrained.springs.insert(coarse.constrained.springs.end(), ties.begin(), ties.end());
  coarse.bind();
}

// The coarse nodes that carry a spring of the fine lattice, without those that do not move.
template <typename Real>
std::vector<LevelSpring::Carrier> LevelConstraints<Real>::freeCarriers(
    std::size_t index, const std::vector<LevelSpring::Carrier>& fine, FreeShares& known) const {
  std::vector<LevelSpring::Carrier>& carriers = known.carriers;
  carriers.clear();
  for (const LevelSpring::Carrier& carrier : fine) {
    std::optional<NodeShares>& shares = known.of_constrained[at(carrier.constrained)];
    if (!shares) shares = freeShares(index, carrier.node);
    for (const NodeWeight& share : *shares) {
      int& place = known.place_of[at(share.node)];
      if (place == 0) {
        carriers.push_back({share.node, 0.0});
        place = static_cast<int>(carriers.size());
      }
      carriers[at(place - 1)].weight += share.weight * carrier.weight;
    }
  }
  for (const LevelSpring::Carrier& carrier : carriers) known.place_of[at(carrier.node)] = 0;
  return carriers;  // a copy, without room for more
}

template <typename Real>
NodeShares LevelConstraints<Real>::freeShares(std::size_t index, int fine_node) const {
  if (grid_.level(index - 1).dirichletAxes(fine_node) == kAllAxes) return {};
  const GridLevel<Real>& coarse = grid_.level(index);
  NodeShares shares = grid_.transfer(index - 1).carriersOf(fine_node);
  const auto stands = [&coarse](const NodeWeight& share) {
    return coarse.dirichletAxes(share.node) == kAllAxes;
  };
  shares.erase(std::remove_if(shares.begin(), shares.end(), stands), shares.end());
  return shares;
}

// One for each component that is given where no coarse node stands, and for hard nodes of groups.
template <typename Real>
void LevelConstraints<Real>::addTies(std::size_t index) {
  const GridLevel<Real>& fine = grid_.level(index - 1);
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.dirichletAxes(node) == 0 || !fine.exists(node)) continue;
    addTie(index, node, fine.dirichletAxes(node), -1, Vec3::Zero());
  }
  for (std::size_t group = 0; group < fine.constrained.groups.size(); ++group) {
    if (grid_.level(index).constrained.groups[group].nodes.empty()) continue;
    const LevelGroup& hard = fine.constrained.groups[group];
    for (std::size_t i = 0; i < hard.nodes.size(); ++i) {
      addTie(index, hard.nodes[i], kAllAxes, static_cast<int>(group), hard.arms[i]);
    }
  }
}

template <typename Real>
void LevelConstraints<Real>::addTie(std::size_t index, int node, unsigned axes, int group,
                                    const Vec3& arm) {
  const NodeShares carriers = grid_.transfer(index - 1).carriersOf(node);
  if (carriers.size() == 1) return;
  const GridLevel<Real>& coarse = grid_.level(index);
  LevelSpring spring;
  double weight = 0.0;
  for (const NodeWeight& carrier : carriers) {
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
      weight * weight * grid_.level(index - 1).restStiffness(node) / GridTransfer<Real>::kTwice;
  for (int axis = 0; axis < 3; ++axis) {
    if ((axes >> axis & 1U) != 0) spring.stiffness(axis, axis) = stiffness;
  }
  spring.group = group;
  spring.arm = arm / GridTransfer<Real>::kTwice;
  from_fine_[index - 1].ties.push_back(std::move(spring));
}

template class LevelConstraints<float>;
template class LevelConstraints<double>;

}  // namespace robot_tissue
