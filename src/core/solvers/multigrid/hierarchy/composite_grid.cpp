#include "solvers/multigrid/hierarchy/composite_grid.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "solvers/multigrid/hierarchy/open_parts.h"
#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

LevelGrid gridOf(const GridBox& points) {
  std::array<int, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    size[axis] = points.high[axis] - points.low[axis] + 1;
  return LevelGrid(size);
}

// The value at a place one beyond the grid's end along some axes, from the nodes before it:
// u(n) = 2 u(n - 1) - u(n - 2) along each of these.
NodeShares extrapolated(const LevelGrid& grid, const std::array<int, 3>& beyond) {
  std::array<int, 3> last = beyond;
  for (std::size_t axis = 0; axis < 3; ++axis)
    last[axis] = std::min(last[axis], grid.size[axis] - 1);
  NodeShares shares = {{grid.index(last[0], last[1], last[2]), 1.0}};
  const std::array<int, 3> strides = {1, grid.row, grid.plane};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (last[axis] == beyond[axis]) continue;
    const std::size_t count = shares.size();
    for (std::size_t i = 0; i < count; ++i) {
      shares.push_back({shares[i].node - strides[axis], -shares[i].weight});
      shares[i].weight *= 2.0;
    }
  }
  return shares;
}

// The point of a level's whole grid so far from a point of it, or where the grid ends before.
std::array<int, 3> lastOn(const LevelSource& source, const std::array<int, 3>& from,
                          const std::array<int, 3>& way) {
  std::array<int, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    place[axis] = std::min(from[axis] + way[axis], source.size[axis] - 1);
  }
  return place;
}

double greatestShear(const ElasticModel& model, const Lattice& lattice) {
  double greatest = 0.0;
  for (const Cell& cell : lattice.cells())
    greatest = std::max(greatest, model.cellModuli(cell).shear);
  return greatest == 0.0 ? 1.0 : greatest;
}

}  // namespace

template <typename Real>
CompositeGrid<Real>::CompositeGrid(const Lattice& lattice, const ElasticModel& model,
                                   const CellSet& cells, Workers* workers, KnownLevels known)
    : lattice_(lattice),
      workers_(workers),
      spacing_(lattice.spacing()),
      modulus_(greatestShear(model, lattice)),
      between_(known.between.isEmpty() ? wholeOf(lattice.size()) : known.between),
      sources_(std::move(known.sources)),
      light_nodes_(lightNodes(cells)) {
  if (sources_.empty() && !model.movesInTime() && model.membrane() == nullptr) {
    sources_ = levelSources(lattice, model, between_, modulus_, tuning::kFewestPoints);
  }
  if (!isBlock()) between_ = wholeOf(lattice.size());
  listCuts(lattice, model, cells, modulus_, sources_);
  if (!isBlock()) {
    openAll(model, cells);
  } else if (known.stiffness.empty()) {
    measureStiffness();
    openParts(partsAround(middle(), tuning::kLayersAroundMiddle));
  } else {
    measureChanged(known);
    openParts(partsAround(from(known.box, between_.low), known.layers));
  }
}

template <typename Real>
std::vector<double> CompositeGrid<Real>::greatestStiffness() const {
  std::vector<double> greatest;
  for (const GridLevel<Real>& level : levels_) greatest.push_back(level.greatestStiffness());
  return greatest;
}

// Of lattices of equal cells, by a block of them that all stand for finer ones, the stiffest there
// is: not of each part anew. Where they are cut, what is listed is measured, too; of cells that are
// cut and not equal, all.
template <typename Real>
void CompositeGrid<Real>::measureStiffness() {
  for (std::size_t level = 0; level < sources_.size(); ++level) {
    LevelSource& source = sources_[level];
    if (source.isUniform() && source.uncut_stiffness == 0.0) {
      GridBox points = source.whole();
      for (int& high : points.high) high = std::min(high, tuning::kMeasuredCells);
      const LevelGrid grid = gridOf(points);
      const GridLevel<Real> block(grid, 0, source.uncutIn(points, grid),
                                  {points, level == 0 ? kCoversNothing : points});
      source.uncut_stiffness = block.greatestStiffness();
    }
    source.greatest_stiffness = source.uncut_stiffness;
    if (!isCut()) continue;
    const GridBox points = source.isUniform() ? source.listed.box : source.whole();
    source.greatest_stiffness = std::max(source.greatest_stiffness, stiffnessIn(level, points));
  }
}

// Of all the greatest, or of what has changed.
template <typename Real>
void CompositeGrid<Real>::measureChanged(const KnownLevels& known) {
  GridBox box = known.changed;
  for (std::size_t level = 0; level < sources_.size(); ++level) {
    const GridBox points = evenAround(box, tuning::kBesideChanged, sources_[level].whole());
    sources_[level].greatest_stiffness =
        std::max(known.stiffness[level], stiffnessIn(level, points));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] /= 2;
      box.high[axis] = (box.high[axis] + 1) / 2;
    }
  }
}

// Of a level with the cells between these points alone, all free.
template <typename Real>
double CompositeGrid<Real>::stiffnessIn(std::size_t level, const GridBox& points) const {
  const LevelSource& source = sources_[level];
  const LevelGrid grid = gridOf(points);
  const GridBox all = grid.whole();
  return GridLevel<Real>(grid, source.listed.beside, source.cellsIn(points, grid),
                         {all, level == 0 ? kCoversNothing : all})
      .greatestStiffness();
}

// A part about as large as a tool opens, for the trial at rest; it hangs on the lattice alone, so
// that what the trial measures does, too.
template <typename Real>
GridBox CompositeGrid<Real>::middle() const {
  GridBox box = whole();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = box.high[axis] = box.high[axis] / 2;
  }
  return around(box, tuning::kAroundMiddle);
}

template <typename Real>
bool CompositeGrid<Real>::open(const GridBox& box, int layers) {
  if (!isBlock()) return false;
  const std::vector<GridBox> free = partsAround(from(box, between_.low), layers);
  if (free == free_) return false;
  openParts(free);
  return true;
}

// What is between ends is open as a whole.
template <typename Real>
std::vector<GridBox> CompositeGrid<Real>::partsAround(const GridBox& box, int layers) const {
  if (!hasEnds()) return openPartsAround(sources_, box, layers);
  std::vector<GridBox> free;
  for (const LevelSource& source : sources_) free.push_back(source.whole());
  return free;
}

template <typename Real>
void CompositeGrid<Real>::openParts(const std::vector<GridBox>& free) {
  free_ = free;
  points_.clear();
  levels_.clear();
  transfers_.clear();
  levels_.reserve(free_.size());
  for (std::size_t level = 0; level < free_.size(); ++level) {
    LevelSource& source = sources_[level];
    points_.push_back(withNeighbors(free_[level], source.whole()));
    const GridBox& points = points_.back();
    const LevelGrid grid = gridOf(points);
    const LevelPart part = {
        from(free_[level], points.low),
        level == 0 ? kCoversNothing
                   : from(coveredBy(free_[level - 1], sources_[level - 1].whole()), points.low)};
    if (level > 0) addTransfer(transferTo(level, grid));
    addLevel(grid, source.listed.beside, source.cellsIn(points, grid), part,
             source.greatest_stiffness);
  }
  finest().constrained.setUnits(spacing_, modulus_);
  nodes_.clear();
  entries_.clear();
  const GridBox& points = points_.front();
  for (int k = points.low[2]; k <= points.high[2]; ++k) {
    for (int j = points.low[1]; j <= points.high[1]; ++j) {
      for (int i = points.low[0]; i <= points.high[0]; ++i) {
        nodes_.push_back(nodeAt(i, j, k));
        entries_.push_back(entryOf(nodes_.back()));
      }
    }
  }
  for (int ghost = 0; ghost < sources_.front().listed.beside; ++ghost) {
    nodes_.push_back(lattice_.nodeCount() + ghost);
    entries_.push_back(entryOf(nodes_.back()));
  }
  weighNodes();
}

// From the coarsest level there is so far. A coarse node that stands one beyond the fine grid's end
// starts where the fine nodes before it lead.
template <typename Real>
GridTransfer<Real> CompositeGrid<Real>::transferTo(std::size_t level, const LevelGrid& grid) const {
  const GridBox &fine = points_[level - 1], &points = points_[level];
  const LevelGrid& fine_grid = levels_.back().grid();
  std::array<int, 3> place{};
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] = fine.low[axis] / 2 - points.low[axis];
  Coarsening to;
  to.grid = grid;
  for (int k = 0; k <= fine_grid.size[2] / 2; ++k) {
    for (int j = 0; j <= fine_grid.size[1] / 2; ++j) {
      for (int i = 0; i <= fine_grid.size[0] / 2; ++i) {
        const std::array<int, 3> twice = {2 * i, 2 * j, 2 * k};
        if (fine_grid.whole().has(twice)) continue;
        if (sources_[level - 1].listed.box.has(lastOn(sources_[level - 1], fine.low, twice)))
          continue;
        to.starts.push_back(
            {grid.index(place[0] + i, place[1] + j, place[2] + k), extrapolated(fine_grid, twice)});
      }
    }
  }
  if (isCut()) addListed(level, grid, to);
  return {fine_grid, std::move(to), place};
}

// What is listed of P.
template <typename Real>
void CompositeGrid<Real>::addListed(std::size_t level, const LevelGrid& grid,
                                    Coarsening& to) const {
  const ListedCells &from = sources_[level - 1].listed, &there = sources_[level].listed;
  const PartEntries fine(from.grid, points_[level - 1], levels_.back().grid());
  const PartEntries coarse(there.grid, points_[level], grid);
  for (const Coarsening::Carried& carried : from.to_coarser.carried) {
    to.carried.push_back({fine(carried.node), coarse(carried.carriers)});
  }
  for (const Coarsening::Start& start : from.to_coarser.starts) {
    to.starts.push_back({coarse(start.node), fine(start.fine)});
  }
}

// What is no block: all of it, with the nodes that stand beside the grid.
template <typename Real>
void CompositeGrid<Real>::openAll(const ElasticModel& model, const CellSet& cells) {
  LevelGrid grid(lattice_.size());
  int beside = static_cast<int>(cells.ghosts().size());
  for (int node = 0; node < cells.nodeCount(); ++node) {
    const std::array<int, 3> place = lattice_.gridIndex(cells.original(node));
    entries_.push_back(cells.isGhost(node) ? grid.beside + node - cells.latticeNodeCount()
                                           : grid.index(place[0], place[1], place[2]));
  }
  nodes_.resize(entries_.size());
  std::iota(nodes_.begin(), nodes_.end(), 0);
  std::vector<LevelCell> level_cells = finestCells(model, cells);
  while (true) {
    const GridBox all = grid.whole();
    addLevel(grid, beside, level_cells, {all, levels_.empty() ? kCoversNothing : all}, 0.0);
    free_.push_back(all);
    const int longest = *std::max_element(grid.size.begin(), grid.size.end());
    if (levels_.size() > 1 && longest <= tuning::kFewestPoints) break;
    Coarsening to = coarsened(grid, level_cells, levels_.back().count());
    level_cells = std::move(to.cells);
    findReaches(level_cells);
    beside = to.nodes_beside;
    const LevelGrid coarse = to.grid;
    addTransfer({grid, std::move(to)});
    grid = coarse;
  }
  finest().constrained.setUnits(spacing_, modulus_);
  weighNodes();
  if (model.membrane() != nullptr) {
    membranes_.add({model.membrane(), entries_, spacing_, modulus_}, transfers_, levels_);
  }
  loads_.find(model, cells, wholeLevels());
}

template <typename Real>
std::vector<LevelCell> CompositeGrid<Real>::finestCells(const ElasticModel& model,
                                                        const CellSet& cells) const {
  std::vector<LevelCell> level_cells;
  level_cells.reserve(cells.all().size());
  for (const Cell& cell : cells.all()) {
    const auto place = lattice_.gridIndex(lattice_.cells()[at(cell.place)].nodes[0]);
    level_cells.push_back(
        levelCellOf(model, cell, modulus_, place, [this](int node) { return entryOf(node); }));
  }
  return level_cells;
}

template <typename Real>
void CompositeGrid<Real>::addLevel(const LevelGrid& grid, int beside,
                                   const std::vector<LevelCell>& cells, const LevelPart& part,
                                   double greatest_stiffness) {
  levels_.emplace_back(grid, beside, cells, part, greatest_stiffness);
  if (workers_ != nullptr) levels_.back().share(*workers_);
}

template <typename Real>
void CompositeGrid<Real>::addTransfer(GridTransfer<Real> transfer) {
  transfers_.push_back(std::move(transfer));
  if (workers_ != nullptr) transfers_.back().share(*workers_);
}

// Full blocks go without: there each weight is 1.
template <typename Real>
void CompositeGrid<Real>::weighNodes() {
  if (light_nodes_.empty()) return;
  Numbers<Real> roots(at(finest().count()), Real(1));
  for (const LightNode& light : light_nodes_) {
    const int entry = entryOf(light.node);
    if (entry >= 0) roots[at(entry)] = static_cast<Real>(std::sqrt(light.weight));
  }
  finest().setWeightRoots(std::move(roots));
}

template <typename Real>
WholeLevels<Real> CompositeGrid<Real>::wholeLevels() {
  return {levels_, transfers_, entries_, spacing_, modulus_};
}

template <typename Real>
void CompositeGrid<Real>::takeTimeStep(const InertialTerm* inertia) {
  if (!loads_.takeTimeStep(inertia, wholeLevels())) return;
  finest().constrained.setUnits(spacing_, modulus());
}

template <typename Real>
int CompositeGrid<Real>::entryOf(int node) const {
  if (!isBlock()) return entries_[at(node)];
  const int ghost = node - lattice_.nodeCount();
  if (ghost >= 0) return levels_.front().grid().beside + ghost;
  const GridBox& points = points_.front();
  std::array<int, 3> place = lattice_.gridIndex(node);
  for (std::size_t axis = 0; axis < 3; ++axis) place[axis] -= between_.low[axis];
  if (!points.has(place)) return -1;
  return levels_.front().grid().index(place[0] - points.low[0], place[1] - points.low[1],
                                      place[2] - points.low[2]);
}

template <typename Real>
void CompositeGrid<Real>::placeInterface(std::size_t fine) {
  transfers_[fine].place(levels_[fine + 1].displacement, levels_[fine].interfaceNodes(),
                         levels_[fine].displacement);
}

// From the coarsest on.
template <typename Real>
void CompositeGrid<Real>::placeInterfaces() {
  for (std::size_t fine = transfers_.size(); fine-- > 0;) placeInterface(fine);
}

template class CompositeGrid<float>;
template class CompositeGrid<double>;

}  // namespace robot_tissue
