#include "robot_tissue/core/lattice_levels.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

constexpr int kFewest = 3;       // grid points along the shortest side of a level to be coarsened
constexpr int kStepsBefore = 3;  // of the smoother on a coarse level, before it is corrected
constexpr int kStepsAfter = 3;   // and after
constexpr int kStepsCoarsest = 12;
constexpr double kTwice = 2.0;  // a level's spacing in the finer one's

// Of a fine node, along one axis: the coarse nodes around it.
struct Around {
  int low = 0;
  int count = 1;

  explicit Around(int fine) : low(fine / 2), count(1 + fine % 2) {}
  double weight() const { return 1.0 / count; }
};

}  // namespace

template <typename Real>
LatticeLevels<Real>::LatticeLevels(const Lattice& lattice, const ElasticModel& model,
                                   const CellSet& cells)
    : spacing_(lattice.spacing()) {
  LevelGrid grid(lattice.size());
  int beside = static_cast<int>(cells.ghosts().size());
  for (int node = 0; node < cells.nodeCount(); ++node) {
    const std::array<int, 3>& place = lattice.gridIndex(cells.original(node));
    entries_.push_back(cells.isGhost(node) ? grid.beside + node - cells.latticeNodeCount()
                                           : grid.index(place[0], place[1], place[2]));
  }
  std::vector<LevelCell> level_cells = finestCells(lattice, model, cells);
  while (true) {
    addLevel(grid, beside, level_cells);
    if (*std::max_element(grid.size.begin(), grid.size.end()) <= kFewest) break;
    steps_.emplace_back();
    Coarsening& to = steps_.back().to;
    to = coarsened(grid, level_cells, levels_.back().count());
    level_cells.swap(to.cells);
    to.cells.clear();
    grid = to.grid;
    beside = to.nodes_beside;
  }
  levels_.front().setUnits(spacing_, modulus_);
  motions_.resize(levels_.size());
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    for (auto& values : motions_[level]) values.assign(at(levels_[level].count()), Real(0));
    if (level + 1 == levels_.size()) break;
    for (Field<Real>* field : {&steps_[level].start, &steps_[level].wanted}) {
      for (auto& values : *field) values.assign(at(levels_[level + 1].count()), Real(0));
    }
  }
}

template <typename Real>
void LatticeLevels<Real>::addLevel(const LevelGrid& grid, int beside,
                                   const std::vector<LevelCell>& cells) {
  levels_.emplace_back(grid, beside, cells, !levels_.empty());
}

template <typename Real>
std::vector<LevelCell> LatticeLevels<Real>::finestCells(const Lattice& lattice,
                                                        const ElasticModel& model,
                                                        const CellSet& cells) {
  modulus_ = 0.0;
  for (const Cell& cell : cells.all()) {
    modulus_ = std::max(modulus_, model.cellModuli(cell).shear);
  }
  if (modulus_ == 0.0) modulus_ = 1.0;
  weights_.assign(entries_.size(), Vec3::Zero());
  std::vector<LevelCell> level_cells;
  for (const Cell& cell : cells.all()) {
    LevelCell level_cell;
    level_cell.place = lattice.gridIndex(lattice.cells()[at(cell.place)].nodes[0]);
    const Moduli moduli = model.cellModuli(cell);
    level_cell.shear = moduli.shear / modulus_;
    level_cell.bulk = moduli.bulk / modulus_;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.nodes[at(corner)];
      weights_[at(node)] += model.cornerWeight(cell);
      level_cell.nodes[at(corner)] = entries_[at(node)];
    }
    level_cells.push_back(level_cell);
  }
  return level_cells;
}

// The coarse nodes that carry a fine one.
template <typename Real>
NodeShares LatticeLevels<Real>::carriersOf(std::size_t level, int node) const {
  const Coarsening& to = steps_[level].to;
  const auto found = to.carriers.find(node);
  if (found != to.carriers.end()) return found->second;
  return sharesAround(to.grid, levels_[level].grid().placeOf(node));
}

template <typename Real>
void LatticeLevels<Real>::bind(const LoadedShape& shape, const PatchHold& hold) {
  bindFinest(shape, hold);
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level) bindCoarse(level);
}

template <typename Real>
void LatticeLevels<Real>::bindFinest(const LoadedShape& shape, const PatchHold& hold) {
  LatticeLevel<Real>& level = levels_.front();
  level.freeAll();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    level.groups.emplace_back();
    LevelGroup& group = level.groups.back();
    group.turns = patch.turns;
    if (byForce(patch)) {
      for (const int node : hold.hardOf(index)) {
        group.nodes.push_back(entryOf(node));
        group.arms.push_back(hold.armOf(shape, index, node) / spacing_);
      }
    }
    for (const RimSpring& rim : patch.rim) {
      LevelSpring spring;
      spring.carriers.push_back({entryOf(rim.node), 1.0});
      spring.stiffness = stiffnessOf(patch, rim) / (modulus_ * spacing_);
      spring.anchor = rim.anchor / spacing_;
      if (byForce(patch)) {
        spring.group = static_cast<int>(index);
        spring.arm = hold.armOf(shape, index, rim.node) / spacing_;
      }
      level.springs.push_back(spring);
    }
    for (const ContactSpring& contact : patch.contacts) {
      LevelSpring spring;
      for (const NodeWeight& carrier : contact.carriers) {
        spring.carriers.push_back({entryOf(carrier.node), carrier.weight});
      }
      spring.contact = &contact;
      level.springs.push_back(spring);
    }
  }
  for (std::size_t node = 0; node < entries_.size(); ++node) {
    const bool carried = hold.carriers()[node] >= 0;
    level.hold(entries_[node], carried ? 0U : hold.held()[node]);
  }
  level.bind();
  level.clearLoad();
  const double unit = modulus_ * spacing_ * spacing_;
  for (std::size_t node = 0; node < entries_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      level.load[at(axis)][at(entries_[node])] = static_cast<Real>(weights_[node][axis] / unit);
    }
  }
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    if (byForce(shape.patches[index])) {
      level.group_load[index].template head<3>() = shape.patches[index].force / unit;
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
void LatticeLevels<Real>::bindCoarse(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index];
  LatticeLevel<Real>& coarse = levels_[index + 1];
  coarse.freeAll();
  for (std::size_t group = 0; group < fine.groups.size(); ++group) {
    coarse.groups.emplace_back();
    coarse.groups.back().turns = fine.groups[group].turns;
    for (std::size_t i = 0; i < fine.groups[group].nodes.size(); ++i) {
      const NodeShares carriers = carriersOf(index, fine.groups[group].nodes[i]);
      if (carriers.size() > 1) continue;
      coarse.groups.back().nodes.push_back(carriers.front().node);
      coarse.groups.back().arms.push_back(fine.groups[group].arms[i] / kTwice);
    }
  }
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.heldAxes(node) == 0 || !fine.exists(node)) continue;
    const NodeShares carriers = carriersOf(index, node);
    if (carriers.size() == 1) coarse.hold(carriers.front().node, fine.heldAxes(node));
  }
  steps_[index].sources.clear();
  for (std::size_t i = 0; i < fine.springs.size(); ++i) {
    LevelSpring spring = fine.springs[i];
    spring.contact = nullptr;
    spring.arm /= kTwice;
    spring.carriers = freeCarriers(index, spring.carriers);
    if (spring.carriers.empty() && spring.group < 0) continue;
    coarse.springs.push_back(spring);
    steps_[index].sources.push_back(static_cast<int>(i));
  }
  addTies(index);
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
    for (const NodeShare& share : carriersOf(index, carrier.node)) {
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
  LatticeLevel<Real>& coarse = levels_[index + 1];
  const auto tie = [&](int node, unsigned axes, int group, const Vec3& arm) {
    LevelSpring spring;
    double weight = 0.0;
    const NodeShares carriers = carriersOf(index, node);
    if (carriers.size() == 1) return;
    for (const NodeShare& carrier : carriers) {
      if (coarse.heldAxes(carrier.node) == kAllHeld) continue;
      if (group >= 0) {
        const auto& hard = coarse.groups[at(group)].nodes;
        if (std::find(hard.begin(), hard.end(), carrier.node) != hard.end()) continue;
      }
      spring.carriers.push_back({carrier.node, carrier.weight});
      weight += carrier.weight;
    }
    if (spring.carriers.empty()) return;
    for (LevelSpring::Carrier& carrier : spring.carriers) carrier.weight /= weight;
    for (int axis = 0; axis < 3; ++axis) {
      if ((axes >> axis & 1U) == 0) continue;
      spring.stiffness(axis, axis) = weight * weight * fine.restStiffness(node) / kTwice;
    }
    spring.group = group;
    spring.arm = arm / kTwice;
    coarse.springs.push_back(spring);
  };
  for (int node = 0; node < fine.count(); ++node) {
    if (fine.heldAxes(node) == 0 || !fine.exists(node)) continue;
    tie(node, fine.heldAxes(node), -1, Vec3::Zero());
  }
  for (std::size_t group = 0; group < fine.groups.size(); ++group) {
    if (coarse.groups[group].nodes.empty()) continue;
    for (std::size_t i = 0; i < fine.groups[group].nodes.size(); ++i) {
      tie(fine.groups[group].nodes[i], kAllHeld, static_cast<int>(group),
          fine.groups[group].arms[i]);
    }
  }
}

template <typename Real>
void LatticeLevels<Real>::confine(const LevelBox& box) {
  LevelBox inside = box;
  for (LatticeLevel<Real>& level : levels_) {
    level.confine(inside);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool to_the_end = inside.high[axis] == level.grid().size[axis] - 1;
      inside.low[axis] = (inside.low[axis] + 1) / 2;
      inside.high[axis] = (inside.high[axis] + (to_the_end ? 1 : 0)) / 2;
    }
  }
}

template <typename Real>
void LatticeLevels<Real>::setDisplacement(const std::vector<Vec3>& displacement) {
  LatticeLevel<Real>& level = levels_.front();
  for (std::size_t node = 0; node < entries_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      level.displacement[at(axis)][at(entries_[node])] =
          static_cast<Real>(displacement[node][axis] / spacing_);
    }
  }
}

template <typename Real>
Vec3 LatticeLevels<Real>::displacementOf(int node) const {
  const auto& displacement = levels_.front().displacement;
  const std::size_t entry = at(entries_[at(node)]);
  return spacing_ * Vec3(static_cast<double>(displacement[0][entry]),
                         static_cast<double>(displacement[1][entry]),
                         static_cast<double>(displacement[2][entry]));
}

template <typename Real>
void LatticeLevels<Real>::findSmoothMotion() {
  if (levels_.size() == 1) {
    for (auto& values : motion) values.assign(at(levels_.front().count()), Real(0));
    group_motion.assign(levels_.front().groups.size(), GroupVector::Zero());
    return;
  }
  restrictTo(1);
  solveCoarse(1);
  prolong(1, motions_.front());
  motion = motions_.front();
  group_motion = levels_[1].group_motion;
  for (GroupVector& vector : group_motion) vector.template head<3>() *= kTwice;
  if (isFinite()) return;
  for (auto& values : motion) std::fill(values.begin(), values.end(), Real(0));
  for (GroupVector& vector : group_motion) vector.setZero();
  for (LatticeLevel<Real>& level : levels_) level.calm();
}

template <typename Real>
bool LatticeLevels<Real>::isFinite() const {
  double sum = 0.0;
  for (const auto& values : motion) {
    sum += dotOf(values.data(), values.data(), static_cast<int>(values.size()));
  }
  for (const GroupVector& vector : group_motion) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

template <typename Real>
void LatticeLevels<Real>::solveCoarse(std::size_t index) {
  LatticeLevel<Real>& level = levels_[index];
  if (index + 1 == levels_.size()) {
    level.smooth(kStepsCoarsest, false);
    return;
  }
  level.smooth(kStepsBefore, true);
  correct(index);
  level.findForces(true);
  level.smooth(kStepsAfter, false);
}

// Moves a level by what the next coarser one says.
template <typename Real>
void LatticeLevels<Real>::correct(std::size_t index) {
  restrictTo(index + 1);
  solveCoarse(index + 1);
  prolong(index + 1, motions_[index]);
  std::vector<GroupVector> of_groups = levels_[index + 1].group_motion;
  for (GroupVector& vector : of_groups) vector.template head<3>() *= kTwice;
  levels_[index].moveBy(motions_[index], of_groups, 1.0);
}

// Displacement and forces of the finer level: the coarse one starts with them.
template <typename Real>
void LatticeLevels<Real>::restrictTo(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index - 1];
  LatticeLevel<Real>& coarse = levels_[index];
  Step& step = steps_[index - 1];
  restrictForces(index);
  restrictDisplacement(index);
  step.start = coarse.displacement;
  for (GroupVector& vector : coarse.group_motion) vector.setZero();
  for (std::size_t i = 0; i < coarse.springs.size(); ++i) {
    LevelSpring& spring = coarse.springs[i];
    if (i < step.sources.size()) {
      spring.stiffness = fine.springs[at(step.sources[i])].stiffness / kTwice;
    }
    spring.anchor = coarse.meanOf(spring);
  }
  step.wanted_of_groups = fine.group_force;
  for (GroupVector& vector : step.wanted_of_groups) {
    vector.template head<3>() /= kTwice * kTwice;
    vector.template tail<3>() /= kTwice * kTwice * kTwice;
  }
  coarse.loadFor(step.wanted, step.wanted_of_groups);
}

template <typename Real>
void LatticeLevels<Real>::restrictForces(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index - 1];
  Step& step = steps_[index - 1];
  const LevelGrid& from = fine.grid();
  const LevelGrid& to = levels_[index].grid();
  std::vector<Real> line(at(from.size[0]) + 3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Real* wanted = step.wanted[axis].data();
    const Real* force = fine.force[axis].data();
    std::fill(step.wanted[axis].begin() + to.beside, step.wanted[axis].end(), Real(0));
    for (int k = 0; k < to.size[2]; ++k) {
      for (int j = 0; j < to.size[1]; ++j) {
        std::fill(line.begin(), line.end(), Real(0));
        for (int z = std::max(0, 2 * k - 1); z <= std::min(from.size[2] - 1, 2 * k + 1); ++z) {
          for (int y = std::max(0, 2 * j - 1); y <= std::min(from.size[1] - 1, 2 * j + 1); ++y) {
            const Real weight = Real(z == 2 * k ? 1.0 : 0.5) * Real(y == 2 * j ? 0.25 : 0.125);
            const Real* row = force + from.index(0, y, z);
            for (int i = 0; i < from.size[0]; ++i) line[at(i) + 1] += weight * row[i];
          }
        }
        Real* row = wanted + to.index(0, j, k);
        for (int i = 0; i < to.size[0]; ++i) {
          const Real* here = line.data() + 2 * i;
          row[i] = here[1] + Real(0.5) * (here[0] + here[2]);
        }
      }
    }
    for (const int node : step.to.carried) {
      const Real quarter = Real(0.25) * force[node];
      if (node < from.beside) {
        for (const NodeShare& share : sharesAround(to, from.placeOf(node))) {
          wanted[share.node] -= static_cast<Real>(share.weight) * quarter;
        }
      }
      for (const NodeShare& share : step.to.carriers.at(node)) {
        wanted[share.node] += static_cast<Real>(share.weight) * quarter;
      }
    }
  }
}

template <typename Real>
void LatticeLevels<Real>::restrictDisplacement(std::size_t index) {
  const LatticeLevel<Real>& fine = levels_[index - 1];
  LatticeLevel<Real>& coarse = levels_[index];
  const LevelGrid& from = fine.grid();
  const LevelGrid& to = coarse.grid();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real* moved = fine.displacement[axis].data();
    Real* place = coarse.displacement[axis].data();
    for (int k = 0; 2 * k < from.size[2]; ++k) {
      for (int j = 0; 2 * j < from.size[1]; ++j) {
        const Real* row = moved + from.index(0, 2 * j, 2 * k);
        Real* half = place + to.index(0, j, k);
        for (int i = 0; 2 * i < from.size[0]; ++i) half[i] = Real(0.5) * row[2 * i];
      }
    }
    for (const Coarsening::Start& start : steps_[index - 1].to.starts) {
      double mean = 0.0;
      for (const NodeShare& share : start.fine) {
        mean += share.weight * static_cast<double>(moved[share.node]);
      }
      place[start.node] = static_cast<Real>(mean / kTwice);
    }
  }
}

// The coarse level's motion since it started, at the nodes of the finer one.
template <typename Real>
void LatticeLevels<Real>::prolong(std::size_t index, Field<Real>& motion_to) {
  const LevelGrid& to = levels_[index - 1].grid();
  const LatticeLevel<Real>& coarse = levels_[index];
  const LevelGrid& from = coarse.grid();
  const Step& step = steps_[index - 1];
  std::vector<Real> line(at(from.size[0]) + 1);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real* now = coarse.displacement[axis].data();
    const Real* start = step.start[axis].data();
    for (int k = 0; k < to.size[2]; ++k) {
      for (int j = 0; j < to.size[1]; ++j) {
        const Around y(j), z(k);
        std::fill(line.begin(), line.end(), Real(0));
        for (int b = 0; b < z.count; ++b) {
          for (int a = 0; a < y.count; ++a) {
            const int first = from.index(0, y.low + a, z.low + b);
            const Real weight = static_cast<Real>(kTwice * y.weight() * z.weight());
            for (int i = 0; i < from.size[0]; ++i) {
              line[at(i)] += weight * (now[first + i] - start[first + i]);
            }
          }
        }
        Real* row = motion_to[axis].data() + to.index(0, j, k);
        for (int i = 0; i < to.size[0]; ++i) {
          const std::size_t low = at(i / 2);
          row[i] = i % 2 == 0 ? line[low] : Real(0.5) * (line[low] + line[low + 1]);
        }
      }
    }
    for (const int node : step.to.carried) {
      double mean = 0.0;
      for (const NodeShare& share : step.to.carriers.at(node)) {
        mean += share.weight * static_cast<double>(now[share.node] - start[share.node]);
      }
      motion_to[axis][at(node)] = static_cast<Real>(kTwice * mean);
    }
  }
}

template class LatticeLevels<float>;
template class LatticeLevels<double>;

}  // namespace robot_tissue
