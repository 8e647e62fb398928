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
  int axis = 0;            // 0, 1, 2 = x, y, z
  double stiffness = 0.0;  // N/m
};

class Lattice;

// The springs of a lattice, in ascending order of their lower ends; each is put together when it is
// asked for, as there are three for every node. Must not outlive the lattice.
class SpringList {
 public:
  class Iterator {
   public:
    Iterator(const SpringList& list, std::size_t index) : list_(&list), index_(index) {}
    Spring operator*() const { return (*list_)[index_]; }
    Iterator& operator++() {
      ++index_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return index_ != other.index_; }

   private:
    const SpringList* list_;
    std::size_t index_;
  };

  explicit SpringList(const Lattice& lattice) : lattice_(lattice) {}
  std::size_t size() const;
  Spring operator[](std::size_t index) const;
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  const Lattice& lattice_;
};

// Directions of a node's six neighbors: 2 * axis + (1 when upwards).
constexpr int kNeighbors = 6;

class Lattice {
 public:
  // Throws InputError when the extent is no multiple of the spacing or a box holds no node.
  explicit Lattice(const TissueConfig& config);

  int nodeCount() const { return static_cast<int>(index_of_.size()); }
  double spacing() const { return grid_.spacing(); }
  const std::array<int, 3>& size() const { return grid_.size(); }  // grid points along x, y, z

  // Nodes are numbered with x running fastest; -1 where the grid has none.
  int node(int i, int j, int k) const {
    const auto& size = grid_.size();
    if (i < 0 || j < 0 || k < 0 || i >= size[0] || j >= size[1] || k >= size[2]) return -1;
    return node_at_[at(i + size[0] * (j + size[1] * k))];
  }
  const std::array<int, 3>& gridIndex(int node) const { return index_of_[at(node)]; }
  Vec3 restPosition(int node) const;
  bool isFixed(int node) const { return fixed_[at(node)] != 0; }
  double mass(int node) const { return mass_[at(node)]; }  // kg

  // Box around the nodes at rest (m).
  const Box& bounds() const { return grid_.shape(); }

  const std::vector<Cell>& cells() const { return cells_->all(); }
  // The cell whose lowest corner stands at the grid index, -1 = none.
  int cellAt(const std::array<int, 3>& index) const;
  Vec3 cellCenter(const Cell& cell) const;  // at rest (m)
  const std::vector<Composition>& compositions() const { return compositions_.kinds; }
  // Which of them the cell has, or the one that it is a part of.
  std::size_t compositionOf(const Cell& cell) const {
    return compositions_.of_cell[at(cell.place)];
  }

  // There is tissue in the cell's eighth at the corner: a mesh may not reach all of a cell.
  bool hasTissueAt(int place, int corner) const {
    return isFull() || (eighths_[at(place)] >> corner & 1) != 0;
  }
  bool isFull() const { return eighths_.empty(); }  // there is in all of them

  SpringList springs() const { return SpringList(*this); }
  // Index of the spring in `direction`, -1 at the border.
  int springOf(int node, int direction) const { return springs_of_node_[at(node)][at(direction)]; }
  // Node in `direction`, -1 at the border.
  int neighbor(int node, int direction) const;

  // Nodes whose rest position is in the closed box, with a slack of a thousandth of the spacing.
  std::vector<int> nodesIn(const Box& box) const;

  LatticeState restState() const;

  // Masses of the nodes and stiffnesses of the springs, from the materials of the cells around
  // them.
  void weigh(const TissueConfig& config);

 private:
  friend class SpringList;

  Lattice(const TissueConfig& config, const FilledGrid& tissue);
  void placeNodes(const std::vector<double>& filled);
  void placeCells(const FilledGrid& tissue);
  void placeEighths(const TissueConfig& config);
  void placeSprings();
  void fix(const std::vector<Box>& boxes);

  Grid grid_;
  std::vector<int> node_at_;                  // per grid point, -1 = none
  std::vector<std::array<int, 3>> index_of_;  // per node
  std::shared_ptr<const CellSet> cells_;
  std::vector<std::uint8_t> eighths_;  // per cell, bit c: hasTissueAt; empty: all
  CellCompositions compositions_;
  std::vector<std::uint8_t> fixed_;
  std::vector<double> mass_;
  std::vector<int> lower_ends_;           // per spring: 4 times the node, and the axis
  std::vector<double> spring_stiffness_;  // per spring (N/m)
  std::vector<std::array<int, kNeighbors>> springs_of_node_;
};

}  // namespace robot_tissue
