#include "robot_tissue/core/lattice.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_slicing.h"
#include "lattice/connectivity.h"
#include "lattice/slivers.h"

namespace robot_tissue {
namespace {

constexpr int kAxes = 4;  // numbers of axes that an end leaves room for
// So many times a mesh is sliced at half the spacing, each time a part of it: as much memory at a
// time as slicing it at the spacing takes.
constexpr int kSlabs = 8;

// Which cells of half the spacing a mesh reaches into, of layers of cells of the grid along z, from
// `first` to before `end`.
class HalfSlab {
 public:
  HalfSlab(const TriangleMesh& mesh, const Grid& grid, int first, int end)
      : first_(first), end_(end) {
    Box slab = grid.shape();
    slab.max().z() = slab.min().z() + grid.spacing() * end;
    slab.min().z() += grid.spacing() * first;
    const Grid halves(slab, 0.5 * grid.spacing());
    row_ = halves.size()[0] - 1;
    plane_ = row_ * (halves.size()[1] - 1);
    occupied_ = slicedWithin(mesh, halves).occupied;
  }

  bool has(const std::array<int, 3>& cell) const { return cell[2] >= first_ && cell[2] < end_; }

  // Bit c: that at the cell's corner c.
  std::uint8_t eighthsOf(const std::array<int, 3>& cell) const {
    unsigned bits = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int half = 2 * cell[0] + (corner & 1) + row_ * (2 * cell[1] + (corner >> 1 & 1)) +
                       plane_ * (2 * (cell[2] - first_) + (corner >> 2 & 1));
      if (occupied_[at(half)] != 0) bits |= 1U << corner;
    }
    return static_cast<std::uint8_t>(bits);
  }

 private:
  int first_, end_;
  int row_ = 0, plane_ = 0;
  std::vector<std::uint8_t> occupied_;
};

// Means over a cell's materials.
struct CellStiffness {
  bool has_constants = false;
  double spring_stiffness = 0.0;  // N/m
  double young_modulus = 0.0;     // Pa
};

CellStiffness stiffnessOf(const TissueConfig& config, const Composition& composition) {
  CellStiffness mean;
  for (const MaterialShare& part : composition) {
    const Material& material = materialOf(config, part.region);
    mean.has_constants = material.spring_stiffness.has_value();
    mean.spring_stiffness += part.share * material.spring_stiffness.value_or(0.0);
    mean.young_modulus += part.share * material.young_modulus;
  }
  return mean;
}

// What the four cells round a spring give it: moduli add up, E h / 4 a cell, so that a bar of any
// cross section has the stiffness E A / L; a spring constant is the paper's, the same on a face.
class SpringStiffness {
 public:
  void add(const CellStiffness& cell, double spacing, double share) {
    if (cell.has_constants) {
      sum_ += cell.spring_stiffness;
      ++constants_;
    } else {
      sum_ += share * cell.young_modulus * spacing / 4.0;
    }
  }
  double value() const { return constants_ > 0 ? sum_ / constants_ : sum_; }

 private:
  double sum_ = 0.0;
  int constants_ = 0;
};

}  // namespace

Lattice::Lattice(const TissueConfig& config) : Lattice(config, filledGrid(config)) {}

Lattice::Lattice(const TissueConfig& config, const FilledGrid& tissue) : grid_(tissue.grid) {
  placeNodes(tissue.filled);
  compositions_ = compositionsOf(config, tissue);
  placeCells(tissue);
  placeEighths(config);
  placeSprings();
  weigh(config);
  fix(config.fixed);
}

// A node for every grid point that is a corner of a cell.
void Lattice::placeNodes(const std::vector<double>& filled) {
  node_at_.assign(at(size()[0] * size()[1] * size()[2]), -1);
  for (int cell = 0; cell < grid_.cellCount(); ++cell) {
    if (filled[at(cell)] <= 0.0) continue;
    for (const int point : grid_.cornersOf(cell)) node_at_[at(point)] = 0;
  }
  index_of_.reserve(node_at_.size() -
                    at(static_cast<int>(std::count(node_at_.begin(), node_at_.end(), -1))));
  int count = 0;
  for (std::size_t point = 0; point < node_at_.size(); ++point) {
    if (node_at_[point] < 0) continue;
    node_at_[point] = count++;
    const int row = static_cast<int>(point) / size()[0];
    index_of_.push_back({static_cast<int>(point) % size()[0], row % size()[1], row / size()[1]});
  }
}

void Lattice::placeCells(const FilledGrid& tissue) {
  std::vector<Cell> cells;
  auto partial = tissue.partial.begin();
  for (int number = 0; number < grid_.cellCount(); ++number) {
    if (tissue.filled[at(number)] <= 0.0) continue;
    Cell cell;
    cell.place = static_cast<int>(cells.size());
    if (partial != tissue.partial.end() && partial->first == number) {
      cell.fill = SharedConst<CellFill>((partial++)->second);
    }
    const auto points = grid_.cornersOf(number);
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      cell.nodes[corner] = node_at_[at(points[corner])];
    }
    cells.push_back(cell);
  }
  cells.shrink_to_fit();
  stiffenSlivers(cells, nodeCount());
  cells_ = std::make_shared<const CellSet>(std::move(cells), nodeCount());
}

void Lattice::placeEighths(const TissueConfig& config) {
  if (config.mesh == nullptr) return;
  eighths_.assign(cells().size(), 0);
  const int layers = size()[2] - 1, thick = (layers + kSlabs - 1) / kSlabs;
  for (int first = 0; first < layers; first += thick) {
    const HalfSlab slab(*config.mesh, grid_, first, std::min(first + thick, layers));
    for (const Cell& cell : cells()) {
      const std::array<int, 3>& lowest = gridIndex(cell.nodes.front());
      if (slab.has(lowest)) eighths_[at(cell.place)] = slab.eighthsOf(lowest);
    }
  }
}

// One along every edge of a cell.
void Lattice::placeSprings() {
  std::array<int, kNeighbors> none{};
  none.fill(-1);
  springs_of_node_.assign(index_of_.size(), none);
  lower_ends_.reserve(3 * index_of_.size());
  for (int node = 0; node < nodeCount(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      for (auto cell = cells_->first(node); cell != cells_->last(node); ++cell) {
        if (cell->corner >> axis & 1) continue;
        const int upper = cells()[at(cell->cell)].nodes[at(cell->corner | 1 << axis)];
        const int spring = static_cast<int>(lower_ends_.size());
        lower_ends_.push_back(kAxes * node + axis);
        springs_of_node_[at(node)][at(2 * axis + 1)] = spring;
        springs_of_node_[at(upper)][at(2 * axis)] = spring;
        break;
      }
    }
  }
}

void Lattice::weigh(const TissueConfig& config) {
  mass_.assign(index_of_.size(), 0.0);
  std::vector<SpringStiffness> stiffness(lower_ends_.size());
  const double volume = std::pow(spacing(), 3), corner_volume = volume / kCorners;
  for (const Cell& cell : cells()) {
    const Composition& composition = compositions()[compositionOf(cell)];
    const double density = densityOf(config, composition);
    const CellStiffness here = stiffnessOf(config, composition);
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.nodes[at(corner)];
      mass_[at(node)] += cell.fill == nullptr
                             ? density * corner_volume
                             : cell.share() * density * volume * cell.fill->cornerShare(corner);
      for (int axis = 0; axis < 3; ++axis) {
        if (corner >> axis & 1) continue;
        stiffness[at(springOf(node, 2 * axis + 1))].add(here, spacing(), cell.share());
      }
    }
  }
  spring_stiffness_.clear();
  spring_stiffness_.reserve(stiffness.size());
  for (const SpringStiffness& each : stiffness) spring_stiffness_.push_back(each.value());
}

void Lattice::fix(const std::vector<Box>& boxes) {
  fixed_.assign(index_of_.size(), 0);
  for (std::size_t box = 0; box < boxes.size(); ++box) {
    const std::vector<int> nodes = nodesIn(boxes[box]);
    if (nodes.empty()) {
      throw InputError("tissue.fixed[" + std::to_string(box) +
                       "]: no node in this box; allowed: a box that holds one node or more");
    }
    for (const int node : nodes) fixed_[at(node)] = 1;
  }
}

Vec3 Lattice::restPosition(int node) const {
  const auto& index = index_of_[at(node)];
  return grid_.shape().min() + spacing() * Vec3(index[0], index[1], index[2]);
}

int Lattice::cellAt(const std::array<int, 3>& index) const {
  const int lowest = node(index[0], index[1], index[2]);
  if (lowest < 0) return -1;
  const auto* found = std::find_if(cells_->first(lowest), cells_->last(lowest),
                                   [](const auto& cell) { return cell.corner == 0; });
  return found == cells_->last(lowest) ? -1 : found->cell;
}

Vec3 Lattice::cellCenter(const Cell& cell) const {
  return restPosition(cell.nodes.front()) + Vec3::Constant(0.5 * spacing());
}

int Lattice::neighbor(int node, int direction) const {
  if (springOf(node, direction) < 0) return -1;
  std::array<int, 3> index = gridIndex(node);
  index[at(direction / 2)] += direction % 2 == 1 ? 1 : -1;
  return this->node(index[0], index[1], index[2]);
}

std::size_t SpringList::size() const { return lattice_.lower_ends_.size(); }

Spring SpringList::operator[](std::size_t index) const {
  const int end = lattice_.lower_ends_[index];
  const int node = end / kAxes, axis = end % kAxes;
  return {node, lattice_.neighbor(node, 2 * axis + 1), axis, lattice_.spring_stiffness_[index]};
}

std::vector<int> Lattice::nodesIn(const Box& box) const {
  const NodeRange range = grid_.nodesIn(box);
  std::vector<int> nodes;
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      for (int i = range.first[0]; i <= range.last[0]; ++i) {
        if (node(i, j, k) >= 0) nodes.push_back(node(i, j, k));
      }
    }
  }
  return nodes;
}

LatticeState Lattice::restState() const {
  LatticeState state;
  state.displacement.assign(index_of_.size(), Vec3::Zero());
  state.cells = cells_;
  state.severed.assign(lower_ends_.size(), 0);
  state.pieces = countPieces(*this, state);
  return state;
}

}  // namespace robot_tissue
