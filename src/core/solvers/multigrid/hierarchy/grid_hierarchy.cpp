#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "simd/field_kernel.h"
#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

}  // namespace

template <typename Real>
GridHierarchy<Real>::GridHierarchy(const Lattice& lattice, const ElasticModel& model,
                                   const CellSet& cells, Workers* workers)
    : lattice_(lattice), workers_(workers), spacing_(lattice.spacing()) {
  modulus_ = 0.0;
  for (const Cell& cell : cells.all()) {
    modulus_ = std::max(modulus_, model.cellModuli(cell).shear);
  }
  if (modulus_ == 0.0) modulus_ = 1.0;
  sources_ = levelSources(lattice, model, cells, modulus_, tuning::kFewestPoints);
  if (!sources_.empty()) {
    measureStiffness();
    openParts(partsAround(middle(), tuning::kLayersAroundMiddle));
  } else {
    openAll(model, cells);
  }
}

// What is no block: all of it, with the nodes that stand beside the grid.
template <typename Real>
void GridHierarchy<Real>::openAll(const ElasticModel& model, const CellSet& cells) {
  LevelGrid grid(lattice_.size());
  int beside = static_cast<int>(cells.ghosts().size());
  for (int node = 0; node < cells.nodeCount(); ++node) {
    const std::array<int, 3>& place = lattice_.gridIndex(cells.original(node));
    entries_.push_back(cells.isGhost(node) ? grid.beside + node - cells.latticeNodeCount()
                                           : grid.index(place[0], place[1], place[2]));
  }
  nodes_.resize(entries_.size());
  std::iota(nodes_.begin(), nodes_.end(), 0);
  std::vector<LevelCell> level_cells = finestCells(model, cells);
  while (true) {
    const GridBox all = grid.whole();
    addLevel(grid, beside, level_cells, {all, levels_.empty() ? GridBox{{1}, {0}} : all}, 0.0);
    free_.push_back(all);
    if (*std::max_element(grid.size.begin(), grid.size.end()) <= tuning::kFewestPoints) break;
    Coarsening to = coarsened(grid, level_cells, levels_.back().count());
    level_cells = std::move(to.cells);
    beside = to.nodes_beside;
    const LevelGrid coarse = to.grid;
    addLink({grid, std::move(to)});
    grid = coarse;
  }
  motion = std::move(motions_.front());
  levels_.front().constrained.setUnits(spacing_, modulus_);
  weigh(model, cells);
}

template <typename Real>
void GridHierarchy<Real>::addLevel(const LevelGrid& grid, int beside,
                                   const std::vector<LevelCell>& cells, const LevelPart& part,
                                   double greatest_stiffness) {
  levels_.emplace_back(grid, beside, cells, part, greatest_stiffness);
  if (workers_ != nullptr) levels_.back().share(*workers_);
  motions_.emplace_back();
  for (auto& values : motions_.back()) values.assign(at(levels_.back().count()), Real(0));
  if (!links_.empty()) links_.back().start = links_.back().wanted = motions_.back();
}

template <typename Real>
void GridHierarchy<Real>::addLink(GridTransfer<Real> transfer) {
  links_.push_back({std::move(transfer), {}, {}, {}, {}, {}});
}

template <typename Real>
void GridHierarchy<Real>::weigh(const ElasticModel& model, const CellSet& cells) {
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
std::vector<LevelCell> GridHierarchy<Real>::finestCells(const ElasticModel& model,
                                                        const CellSet& cells) const {
  std::vector<LevelCell> level_cells;
  level_cells.reserve(cells.all().size());
  for (const Cell& cell : cells.all()) {
    LevelCell level_cell;
    level_cell.place = lattice_.gridIndex(lattice_.cells()[at(cell.place)].nodes[0]);
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

// Nodes in a row of the grid are neighbors in the fields.
template <typename Real>
bool GridHierarchy<Real>::setDisplacement(const std::vector<Vec3>& displacement,
                                          const std::vector<std::uint8_t>& held) {
  const double unit = 1.0 / spacing_;
  bool others_moved = false;
  for (int axis = 0; axis < 3; ++axis) {
    Real* to = levels_.front().displacement[at(axis)].data();
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const std::size_t node = at(nodes_[i]);
      Real& here = to[entries_[i]];
      const Real now = static_cast<Real>(displacement[node][axis] * unit);
      const bool same = std::abs(now - here) <= tuning::kSame * std::abs(here);
      others_moved = others_moved || (!same && held[node] == 0);
      if (!same) here = now;
    }
  }
  if (others_moved) placeCoarse(displacement);
  return others_moved;
}

template <typename Real>
void GridHierarchy<Real>::findSmoothMotion() {
  group_motion.assign(levels_.front().constrained.groups.size(), GroupVector::Zero());
  if (levels_.size() == 1) return;
  restrictTo(1);
  solveCoarse(1);
  links_.front().transfer.prolong(levels_[1].displacement, links_.front().start, motion);
  group_motion = groupMotion(1);
  if (!isWhole()) takeMotion();
  if (!isMotionFinite()) noMotion();
}

template <typename Real>
void GridHierarchy<Real>::noMotion() {
  for (auto& values : motion) std::fill(values.begin(), values.end(), Real(0));
  for (GroupVector& vector : group_motion) vector.setZero();
  for (Field<Real>& of_level : motion_beyond_) {
    for (auto& values : of_level) std::fill(values.begin(), values.end(), Real(0));
  }
}

template <typename Real>
bool GridHierarchy<Real>::isMotionFinite() const {
  double sum = squaredMotionBeyond();
  for (const auto& values : motion) {
    sum += dotOf(values.data(), values.data(), static_cast<int>(values.size()));
  }
  for (const GroupVector& vector : group_motion) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

template <typename Real>
bool GridHierarchy<Real>::isFinite() const {
  double sum = 0.0;
  for (const GridLevel<Real>& level : levels_) {
    for (const auto& values : level.displacement) {
      sum += dotOf(values.data(), values.data(), level.count());
    }
  }
  for (const auto& values : levels_.front().force) {
    sum += dotOf(values.data(), values.data(), levels_.front().count());
  }
  for (const GroupVector& vector : levels_.front().constrained.motion) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

template <typename Real>
void GridHierarchy<Real>::go(double share) {
  finest().moveBy(motion, group_motion, share);
  if (!isWhole()) moveBeyond(motion_beyond_, share);
}

// In the finer level's units.
template <typename Real>
std::vector<GroupVector> GridHierarchy<Real>::groupMotion(std::size_t coarse) const {
  std::vector<GroupVector> of_groups = levels_[coarse].constrained.motion;
  for (GroupVector& vector : of_groups) {
    vector.template head<3>() *= GridTransfer<Real>::kTwice;
  }
  return of_groups;
}

template <typename Real>
void GridHierarchy<Real>::solveCoarse(std::size_t index) {
  GridLevel<Real>& level = levels_[index];
  if (index + 1 == levels_.size()) {
    level.smooth(tuning::kStepsCoarsest);
    return;
  }
  level.smoothAndFindForces(tuning::kStepsBefore);
  correct(index);
  level.findForces();
  level.smooth(tuning::kStepsAfter);
}

// Moves a level by what the next coarser one says.
template <typename Real>
void GridHierarchy<Real>::correct(std::size_t index) {
  GridLevel<Real>& level = levels_[index];
  LevelLink& link = links_[index];
  restrictTo(index + 1);
  solveCoarse(index + 1);
  link.transfer.prolong(levels_[index + 1].displacement, link.start, motions_[index]);
  level.moveBy(motions_[index], groupMotion(index + 1), 1.0);
  link.transfer.place(levels_[index + 1].displacement, level.interfaceNodes(), level.displacement);
}

// Displacement and forces of the finer level: the coarse one starts with them.
template <typename Real>
void GridHierarchy<Real>::restrictTo(std::size_t index) {
  constexpr double kTwice = GridTransfer<Real>::kTwice;
  GridLevel<Real>& fine = levels_[index - 1];
  GridLevel<Real>& coarse = levels_[index];
  LevelLink& link = links_[index - 1];
  fine.showInterface();
  link.transfer.restrictForces(fine.force, link.wanted);
  fine.hideInterface();
  link.transfer.restrictDisplacement(fine.displacement, coarse.part().covered, coarse.displacement);
  link.start = coarse.displacement;
  for (GroupVector& vector : coarse.constrained.motion) vector.setZero();
  for (std::size_t i = 0; i < coarse.constrained.springs.size(); ++i) {
    LevelSpring& spring = coarse.constrained.springs[i];
    if (i < link.sources.size()) {
      spring.stiffness = fine.constrained.springs[at(link.sources[i])].stiffness / kTwice;
    }
    spring.anchor = coarse.constrained.meanOf(spring, coarse.displacement);
  }
  link.wanted_of_groups = fine.constrained.force;
  for (GroupVector& vector : link.wanted_of_groups) {
    vector.template head<3>() /= kTwice * kTwice;
    vector.template tail<3>() /= kTwice * kTwice * kTwice;
  }
  coarse.setFasRightHandSide(link.wanted, link.wanted_of_groups);
}

template class GridHierarchy<float>;
template class GridHierarchy<double>;

}  // namespace robot_tissue
