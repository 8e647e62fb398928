#include "robot_tissue/core/lattice_levels.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr int kFewest = 3;       // grid points along the longest side of the coarsest level
constexpr int kStepsBefore = 3;  // of the smoother on a coarse level, before it is corrected
constexpr int kStepsAfter = 3;   // and after
constexpr int kStepsCoarsest = 12;
constexpr double kSame = 1e-15;  // relative, of a displacement that went to m and back

}  // namespace

template <typename Real>
LatticeLevels<Real>::LatticeLevels(const Lattice& lattice, const ElasticModel& model,
                                   const CellSet& cells, Workers* workers)
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
    levels_.emplace_back(grid, beside, level_cells, !levels_.empty());
    if (workers != nullptr) levels_.back().share(*workers);
    const int count = levels_.back().count();
    motions_.emplace_back();
    for (auto& values : motions_.back()) values.assign(at(count), Real(0));
    if (levels_.size() > 1) steps_.back().start = steps_.back().wanted = motions_.back();
    if (*std::max_element(grid.size.begin(), grid.size.end()) <= kFewest) break;
    Coarsening to = coarsened(grid, level_cells, count);
    level_cells = std::move(to.cells);
    beside = to.nodes_beside;
    const LevelGrid coarse = to.grid;
    steps_.push_back({{grid, std::move(to)}, {}, {}, {}, {}});
    grid = coarse;
  }
  levels_.front().firm.setUnits(spacing_, modulus_);
  motion = std::move(motions_.front());
  weigh(model, cells);
}

template <typename Real>
void LatticeLevels<Real>::weigh(const ElasticModel& model, const CellSet& cells) {
  const double unit = modulus_ * spacing_ * spacing_;
  for (const Cell& cell : cells.all()) {
    const Vec3 weight = model.cornerWeight(cell) / unit;
    if (weight.isZero(0.0)) continue;
    for (auto& values : weight_) values.resize(motion.front().size(), Real(0));
    for (const int node : cell.nodes) {
      for (int axis = 0; axis < 3; ++axis) {
        weight_[at(axis)][at(entryOf(node))] += static_cast<Real>(weight[axis]);
      }
    }
  }
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
  std::vector<LevelCell> level_cells;
  level_cells.reserve(cells.all().size());
  for (const Cell& cell : cells.all()) {
    LevelCell level_cell;
    level_cell.place = lattice.gridIndex(lattice.cells()[at(cell.place)].nodes[0]);
    const Moduli moduli = model.cellModuli(cell);
    level_cell.shear = moduli.shear / modulus_;
    level_cell.bulk = moduli.bulk / modulus_;
    for (int corner = 0; corner < kCorners; ++corner) {
      level_cell.nodes[at(corner)] = entryOf(cell.nodes[at(corner)]);
    }
    level_cells.push_back(level_cell);
  }
  return level_cells;
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
  placeAll();
}

// All coarse nodes where the shape is: cycles move those in the boxes, whose cells have others,
// too.
template <typename Real>
void LatticeLevels<Real>::placeAll() {
  for (std::size_t coarse = 1; coarse < levels_.size(); ++coarse) {
    LevelBox all;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      all.high[axis] = levels_[coarse].grid().size[axis] - 1;
    }
    steps_[coarse - 1].transfer.restrictDisplacement(levels_[coarse - 1].displacement, all,
                                                     levels_[coarse].displacement);
  }
}

// Nodes in a row of the grid are neighbors in the fields.
template <typename Real>
bool LatticeLevels<Real>::setDisplacement(const std::vector<Vec3>& displacement,
                                          const std::vector<std::uint8_t>& held) {
  const double unit = 1.0 / spacing_;
  bool others_moved = false;
  for (int axis = 0; axis < 3; ++axis) {
    Real* to = levels_.front().displacement[at(axis)].data();
    for (std::size_t node = 0; node < entries_.size(); ++node) {
      Real& here = to[entries_[node]];
      const Real now = static_cast<Real>(displacement[node][axis] * unit);
      const bool same = std::abs(now - here) <= kSame * std::abs(here);
      others_moved = others_moved || (!same && held[node] == 0);
      if (!same) here = now;
    }
  }
  return others_moved;
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
  group_motion.assign(levels_.front().firm.groups.size(), GroupVector::Zero());
  if (levels_.size() == 1) return;
  restrictTo(1);
  solveCoarse(1);
  steps_.front().transfer.prolong(levels_[1].displacement, steps_.front().start,
                                  levels_.front().box(), motion);
  group_motion = groupMotion(1);
  if (isFinite()) return;
  for (auto& values : motion) std::fill(values.begin(), values.end(), Real(0));
  for (GroupVector& vector : group_motion) vector.setZero();
}

template <typename Real>
bool LatticeLevels<Real>::isFinite() const {
  double sum = 0.0;
  for (const Span& span : levels_.front().spans()) {
    for (const auto& values : motion) {
      sum += dotOf(values.data() + span.first, values.data() + span.first, span.count);
    }
  }
  for (const GroupVector& vector : group_motion) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

// In the finer level's units.
template <typename Real>
std::vector<GroupVector> LatticeLevels<Real>::groupMotion(std::size_t coarse) const {
  std::vector<GroupVector> of_groups = levels_[coarse].firm.motion;
  for (GroupVector& vector : of_groups) {
    vector.template head<3>() *= LevelTransfer<Real>::kTwice;
  }
  return of_groups;
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
  LatticeLevel<Real>& level = levels_[index];
  restrictTo(index + 1);
  solveCoarse(index + 1);
  steps_[index].transfer.prolong(levels_[index + 1].displacement, steps_[index].start, level.box(),
                                 motions_[index]);
  level.moveBy(motions_[index], groupMotion(index + 1), 1.0);
}

// Displacement and forces of the finer level: the coarse one starts with them.
template <typename Real>
void LatticeLevels<Real>::restrictTo(std::size_t index) {
  constexpr double kTwice = LevelTransfer<Real>::kTwice;
  const LatticeLevel<Real>& fine = levels_[index - 1];
  LatticeLevel<Real>& coarse = levels_[index];
  Step& step = steps_[index - 1];
  step.transfer.restrictForces(fine.force, coarse.box(), step.wanted);
  step.transfer.restrictDisplacement(fine.displacement, coarse.box(), coarse.displacement);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Span& span : coarse.spans()) {
      std::copy_n(coarse.displacement[axis].begin() + span.first, span.count,
                  step.start[axis].begin() + span.first);
    }
  }
  for (GroupVector& vector : coarse.firm.motion) vector.setZero();
  for (std::size_t i = 0; i < coarse.firm.springs.size(); ++i) {
    LevelSpring& spring = coarse.firm.springs[i];
    if (i < step.sources.size()) {
      spring.stiffness = fine.firm.springs[at(step.sources[i])].stiffness / kTwice;
    }
    spring.anchor = coarse.firm.meanOf(spring, coarse.displacement);
  }
  step.wanted_of_groups = fine.firm.force;
  for (GroupVector& vector : step.wanted_of_groups) {
    vector.template head<3>() /= kTwice * kTwice;
    vector.template tail<3>() /= kTwice * kTwice * kTwice;
  }
  coarse.loadFor(step.wanted, step.wanted_of_groups);
}

template class LatticeLevels<float>;
template class LatticeLevels<double>;

}  // namespace robot_tissue
