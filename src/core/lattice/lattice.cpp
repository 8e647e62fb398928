#include "robot_tissue/core/lattice.h"

#include <algorithm>
#include <cmath>

#include "geometry/mesh_slicing.h"
#include "lattice/connectivity.h"
#include "lattice/held_layers.h"
#include "lattice/slivers.h"

namespace robot_tissue {
namespace {

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

// What the four cells round a spring give it: moduli add up, E h / 4 a cell, so that a bar of any
// cross section has the stiffness E A / L; a spring constant is the paper's, the same on a face.
class SpringStiffness {
 public:
  void add(double constant) {
    sum_ += constant;
    ++constants_;
  }
  void add(double modulus, double spacing, double share) {
    sum_ += share * modulus * spacing / 4.0;
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
  fix(config.fixed);
  compositions_ = compositionsOf(config, tissue);
  placeCells(tissue);
  placeEighths(config);
  placeSprings();
  weigh(config);
}

// A node for every grid point that is a corner of a cell.
void Lattice::placeNodes(const std::vector<double>& filled) {
  node_at_.assign(at(size()[0] * size()[1] * size()[2]), -1);
  for (int cell = 0; cell < grid_.cellCount(); ++cell) {
    if (filled[at(cell)] <= 0.0) continue;
    for (const int point : grid_.cornersOf(cell)) node_at_[at(point)] = 0;
  }
  const auto nodes =
      node_at_.size() - at(static_cast<int>(std::count(node_at_.begin(), node_at_.end(), -1)));
  fixed_.assign(nodes, 0);
  if (nodes == node_at_.size()) {
    node_at_ = std::vector<int>();
    return;
  }
  index_of_.reserve(nodes);
  for (std::size_t point = 0; point < node_at_.size(); ++point) {
    if (node_at_[point] < 0) continue;
    node_at_[point] = static_cast<int>(index_of_.size());
    index_of_.push_back(indexOfPoint(static_cast<int>(point)));
  }
}

std::array<int, 3> Lattice::indexOfPoint(int point) const {
  const auto number = static_cast<unsigned>(point), along_x = static_cast<unsigned>(size()[0]),
             along_y = static_cast<unsigned>(size()[1]), row = number / along_x;
  return {static_cast<int>(number % along_x), static_cast<int>(row % along_y),
          static_cast<int>(row / along_y)};
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
      cell.nodes[corner] = hasAllPoints() ? points[corner] : node_at_[at(points[corner])];
    }
    cells.push_back(cell);
  }
  cells.shrink_to_fit();
  stiffenSlivers(cells, nodeCount());
  layOnFixedNodes(cells, fixed_);
  const bool are_all = hasAllPoints() && static_cast<int>(cells.size()) == grid_.cellCount();
  cells_ = are_all ? std::make_shared<const CellSet>(std::move(cells), size())
                   : std::make_shared<const CellSet>(std::move(cells), nodeCount());
}

void Lattice::placeEighths(const TissueConfig& config) {
  if (config.mesh == nullptr) return;
  eighths_.assign(cells().size(), 0);
  const int layers = size()[2] - 1, thick = (layers + kSlabs - 1) / kSlabs;
  for (int first = 0; first < layers; first += thick) {
    const HalfSlab slab(*config.mesh, grid_, first, std::min(first + thick, layers));
    for (const Cell& cell : cells()) {
      const std::array<int, 3> lowest = gridIndex(cell.nodes.front());
      if (slab.has(lowest)) eighths_[at(cell.place)] = slab.eighthsOf(lowest);
    }
  }
}

// One along every edge of a cell.
void Lattice::placeSprings() {
  springs_up_.reserve(at(nodeCount()));
  for (int node = 0; node < nodeCount(); ++node) {
    std::uint32_t up = 8U * static_cast<std::uint32_t>(spring_count_);
    const CellSet::Meetings around = cells_->meetings(node);
    for (int axis = 0; axis < 3; ++axis) {
      const bool has = std::any_of(around.begin(), around.end(),
                                   [axis](auto met) { return (met.corner >> axis & 1U) == 0; });
      if (!has) continue;
      up |= 1U << axis;
      ++spring_count_;
    }
    springs_up_.push_back(up);
  }
}

Lattice::Substance Lattice::substanceOf(const TissueConfig& config,
                                        const Composition& composition) {
  Substance mean;
  mean.density = densityOf(config, composition);
  for (const MaterialShare& part : composition) {
    const Material& material = materialOf(config, part.region);
    mean.has_spring_constants = material.spring_stiffness.has_value();
    mean.spring_stiffness += part.share * material.spring_stiffness.value_or(0.0);
    mean.young_modulus += part.share * material.young_modulus;
  }
  return mean;
}

void Lattice::weigh(const TissueConfig& config) {
  substances_.clear();
  substances_.reserve(compositions().size());
  for (const Composition& composition : compositions()) {
    substances_.push_back(substanceOf(config, composition));
  }
}

double Lattice::mass(int node) const {
  const double volume = std::pow(spacing(), 3), corner_volume = volume / kCorners;
  double mass = 0.0;
  for (const CellSet::Meeting& met : cells_->meetings(node)) {
    const Cell& cell = cells()[at(met.cell)];
    const double density = substanceOf(cell).density;
    mass += cell.fill == nullptr
                ? density * corner_volume
                : cell.share() * density * volume * cell.fill->cornerShare(met.corner);
  }
  return mass;
}

double Lattice::springStiffness(const Spring& spring) const {
  SpringStiffness stiffness;
  for (const CellSet::Meeting& met : cells_->meetings(spring.a)) {
    if (met.corner >> spring.axis & 1) continue;
    const Cell& cell = cells()[at(met.cell)];
    const Substance& here = substanceOf(cell);
    if (here.has_spring_constants) {
      stiffness.add(here.spring_stiffness);
    } else {
      stiffness.add(here.young_modulus, spacing(), cell.stiffnessShare());
    }
  }
  return stiffness.value();
}

void Lattice::fix(const std::vector<Box>& boxes) {
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
  const std::array<int, 3> index = gridIndex(node);
  return grid_.shape().min() + spacing() * Vec3(index[0], index[1], index[2]);
}

int Lattice::cellAt(const std::array<int, 3>& index) const {
  const int lowest = node(index[0], index[1], index[2]);
  if (lowest < 0) return -1;
  const CellSet::Meetings around = cells_->meetings(lowest);
  const auto* found =
      std::find_if(around.begin(), around.end(), [](const auto& cell) { return cell.corner == 0; });
  return found == around.end() ? -1 : static_cast<int>(found->cell);
}

Vec3 Lattice::cellCenter(const Cell& cell) const {
  return restPosition(cell.nodes.front()) + Vec3::Constant(0.5 * spacing());
}

int Lattice::neighbor(int node, int direction) const {
  const int axis = direction / 2;
  if (direction % 2 == 0) {
    const int lower = pointBelow(node, axis);
    return lower >= 0 && springUp(lower, axis) >= 0 ? lower : -1;
  }
  if (springUp(node, axis) < 0) return -1;
  if (hasAllPoints()) return node + (axis == 0 ? 1 : axis == 1 ? size()[0] : size()[0] * size()[1]);
  std::array<int, 3> index = index_of_[at(node)];
  ++index[at(axis)];
  return this->node(index[0], index[1], index[2]);
}

std::size_t SpringList::size() const { return at(lattice_.spring_count_); }

Spring SpringList::operator[](std::size_t number) const {
  const auto& up = lattice_.springs_up_;
  const auto is_after = [](std::size_t spring, std::uint32_t of_node) {
    return spring < of_node >> 3U;
  };
  const auto next = std::upper_bound(up.begin(), up.end(), number, is_after);
  return *Iterator(lattice_, static_cast<int>(number), static_cast<int>(next - up.begin()) - 1);
}

SpringList::Iterator SpringList::begin() const {
  Iterator first(lattice_, -1, 0);
  return ++first;
}

Spring SpringList::Iterator::operator*() const {
  int axis = 0;
  while (lattice_->springUp(node_, axis) != number_) ++axis;
  return {node_, lattice_->neighbor(node_, 2 * axis + 1), axis, number_};
}

SpringList::Iterator& SpringList::Iterator::operator++() {
  ++number_;
  while (node_ + 1 < lattice_->nodeCount() && lattice_->firstSpring(node_ + 1) <= number_) ++node_;
  return *this;
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
  state.displacement.assign(at(nodeCount()), Vec3::Zero());
  state.cells = cells_;
  state.severed.assign(springs().size(), 0);
  state.pieces = countPieces(*this, state);
  return state;
}

}  // namespace robot_tissue
