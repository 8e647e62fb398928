// The constant model: nodes on a rectangular grid, joined by one spring to each of their up to six
// neighbors (paper, section 4.1 and figure 1). Never changes after construction, but for its
// material (weigh); what changes is in LatticeState. Own: cells, moduli, regions, fixed nodes,
// shapes by a mesh: a cell that a mesh fills in part knows how much of it, and where (CellFill).
// Cells that meet in an edge or corner alone are joined by their common nodes, so by a hinge; a gap
// thinner than a cell is bridged.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/composition.h"
#include "robot_tissue/core/filled_grid.h"
#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct Spring {
  int a = 0;  // node at the lower end along `axis`
  int b = 0;
  int axis = 0;  // 0, 1, 2 = x, y, z
  int number = 0;
};

class Lattice;

// The springs of a lattice, in ascending order of their lower ends; each is put together when it is
// asked for, as there are three for every node. Must not outlive the lattice.
class SpringList {
 public:
  class Iterator {
   public:
    Iterator(const Lattice& lattice, int number, int node)
        : lattice_(&lattice), number_(number), node_(node) {}
    Spring operator*() const;
    Iterator& operator++();
    bool operator!=(const Iterator& other) const { return number_ != other.number_; }

   private:
    const Lattice* lattice_;
    int number_;
    int node_;  // its lower end
  };

  explicit SpringList(const Lattice& lattice) : lattice_(lattice) {}
  std::size_t size() const;
  // Looks for its lower end: to go through all of them iterators are faster.
  Spring operator[](std::size_t number) const;
  Iterator begin() const;
  Iterator end() const { return {lattice_, static_cast<int>(size()), 0}; }

 private:
  const Lattice& lattice_;
};

// Directions of a node's six neighbors: 2 * axis + (1 when upwards).
constexpr int kNeighbors = 6;

class Lattice {
 public:
  // Throws InputError when the extent is no multiple of the spacing or a box holds no node.
  explicit Lattice(const TissueConfig& config);

  int nodeCount() const { return static_cast<int>(fixed_.size()); }
  double spacing() const { return grid_.spacing(); }
  const std::array<int, 3>& size() const { return grid_.size(); }  // grid points along x, y, z

  // Nodes are numbered with x running fastest; -1 where the grid has none.
  int node(int i, int j, int k) const {
    const auto& size = grid_.size();
    if (i < 0 || j < 0 || k < 0 || i >= size[0] || j >= size[1] || k >= size[2]) return -1;
    const int point = i + size[0] * (j + size[1] * k);
    return hasAllPoints() ? point : node_at_[at(point)];
  }
  std::array<int, 3> gridIndex(int node) const {
    return hasAllPoints() ? indexOfPoint(node) : index_of_[at(node)];
  }
  Vec3 restPosition(int node) const;
  bool isFixed(int node) const { return fixed_[at(node)] != 0; }
  double mass(int node) const;  // kg; summed up anew over the cells each time

  // Box around the nodes at rest (m).
  const Box& bounds() const { return grid_.shape(); }

  const std::vector<Cell>& cells() const { return cells_->all(); }
  // The cell whose lowest corner stands at the grid index, -1 = none.
  int cellAt(const std::array<int, 3>& index) const;
  Vec3 cellCenter(const Cell& cell) const;  // at rest (m)
  const std::vector<Composition>& compositions() const { return compositions_.kinds; }
  // Which of them the cell has, or the one that it is a part of.
  std::size_t compositionOf(const Cell& cell) const {
    return compositions_.of_cell.empty() ? 0 : compositions_.of_cell[at(cell.place)];
  }

  // There is tissue in the cell's eighth at the corner: a mesh may not reach all of a cell.
  bool hasTissueAt(int place, int corner) const {
    return isFull() || (eighths_[at(place)] >> corner & 1) != 0;
  }
  bool isFull() const { return eighths_.empty(); }  // there is in all of them

  SpringList springs() const { return SpringList(*this); }
  // Number of the spring in `direction`, -1 at the border.
  int springOf(int node, int direction) const {
    if (direction % 2 == 1) return springUp(node, direction / 2);
    const int lower = pointBelow(node, direction / 2);
    return lower < 0 ? -1 : springUp(lower, direction / 2);
  }
  double springStiffness(const Spring& spring) const;  // N/m; likewise
  // Node in `direction`, -1 at the border.
  int neighbor(int node, int direction) const;

  // Nodes whose rest position is in the closed box, with a slack of a thousandth of the spacing.
  std::vector<int> nodesIn(const Box& box) const;

  LatticeState restState() const;

  // Masses of the nodes and stiffnesses of the springs are from now on of the materials that the
  // cells around them have there.
  void weigh(const TissueConfig& config);

 private:
  friend class SpringList;

  // Means over a cell's materials.
  struct Substance {
    double density = 0.0;  // kg/m^3
    bool has_spring_constants = false;
    double spring_stiffness = 0.0;  // N/m
    double young_modulus = 0.0;     // Pa
  };

  Lattice(const TissueConfig& config, const FilledGrid& tissue);
  void placeNodes(const std::vector<double>& filled);
  void placeCells(const FilledGrid& tissue);
  void placeEighths(const TissueConfig& config);
  void placeSprings();
  void fix(const std::vector<Box>& boxes);
  static Substance substanceOf(const TissueConfig& config, const Composition& composition);
  const Substance& substanceOf(const Cell& cell) const { return substances_[compositionOf(cell)]; }
  // Every grid point has a node, of the same number.
  bool hasAllPoints() const { return node_at_.empty(); }
  std::array<int, 3> indexOfPoint(int point) const;
  int pointBelow(int node, int axis) const;
  int firstSpring(int node) const { return static_cast<int>(springs_up_[at(node)] >> 3U); }
  int springUp(int node, int axis) const;

  Grid grid_;
  std::vector<int> node_at_;                  // per grid point, -1 = none; empty: hasAllPoints
  std::vector<std::array<int, 3>> index_of_;  // per node; likewise
  std::shared_ptr<const CellSet> cells_;
  std::vector<std::uint8_t> eighths_;  // per cell, bit c: hasTissueAt; empty: all
  CellCompositions compositions_;
  std::vector<std::uint8_t> fixed_;
  std::vector<Substance> substances_;  // of compositions()
  // Per node: 8 times how many springs nodes before it have upwards, and bit a: it has one itself
  // along axis a.
  std::vector<std::uint32_t> springs_up_;
  int spring_count_ = 0;
};

inline int Lattice::springUp(int node, int axis) const {
  const std::uint32_t up = springs_up_[at(node)];
  if ((up >> axis & 1U) == 0) return -1;
  const std::uint32_t before = up & ((1U << axis) - 1U);  // bits 0 and 1 alone
  return static_cast<int>((up >> 3U) + (before & 1U) + (before >> 1U));
}

// The node next to it down the axis; where the grid has all points, that or one that has no spring
// up the axis; -1: there is none.
inline int Lattice::pointBelow(int node, int axis) const {
  const auto& size = grid_.size();
  if (hasAllPoints()) {
    const int step = axis == 0 ? 1 : axis == 1 ? size[0] : size[0] * size[1];
    return node < step ? -1 : node - step;
  }
  std::array<int, 3> index = index_of_[at(node)];
  --index[at(axis)];
  return this->node(index[0], index[1], index[2]);
}

}  // namespace robot_tissue
