// The cells between the nodes, that carry the material: 8 corners, 12 springs each. Corner c sits
// at the cell's lowest node plus (c & 1, c >> 1 & 1, c >> 2 & 1) spacings.
//
// A cut may split a cell (core/cutting/split_cells.h). Its parts are cells again, with 8 corners
// each; where a part lost a corner, a ghost stands in for the node (Molino, Bao, Fedkiw 2004, "A
// virtual node algorithm for changing mesh topology during simulation"). Ghosts are nodes that the
// lattice does not know: numbered from Lattice::nodeCount() on, with a displacement of their own,
// without springs.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "robot_tissue/core/cell_fill.h"
#include "robot_tissue/core/grid_box.h"
#include "robot_tissue/core/shared_const.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class Lattice;
struct LatticeState;

constexpr int kCorners = 8;

// Beyond the faces of a cell that is filled in part: the nodes opposite the faces that it has in
// common with cells beside it, two neighbors an axis at most. What they and the cell's own corners
// tell of d2x/dx_a^2 (material/fill_law.h) is the cell's, too.
constexpr int kFaceNodes = 4;
constexpr int kSides = 6;                         // number 2 a is down axis a, 2 a + 1 up
constexpr int kBeyond = kSides * kFaceNodes;      // four a side
constexpr int kMostReached = kCorners + kBeyond;  // corners first

struct CellReach {
  // Node kFaceNodes side + r is the one beyond corner faceCorner(side, r); -1: none.
  std::array<int, kBeyond> nodes{};
  // Per side: how much of the d2x/dx_a^2 that the strain takes is by that neighbor; 0: none.
  std::array<double, kSides> share{};

  bool has(int side) const { return share[at(side)] > 0.0; }
  // Of the mean of both neighbors' d2x/dx_a^2, and of half their difference: what this side adds.
  double inMean(int side) const { return !has(side) ? 0.0 : has(side ^ 1) ? 0.5 : 1.0; }
  double inUneven(int side) const {
    return !has(side) || !has(side ^ 1) ? 0.0 : side % 2 == 0 ? -0.5 : 0.5;
  }
  // Of cells with these shares of h^3 on both sides of one with `own`, 0: of none. A sliver tells
  // little of its neighbor, and its nodes are held by next to nothing.
  void weigh(int axis, double own, double below, double above) {
    const double filled = std::max(own, below + above);
    share[at(2 * axis)] = below / filled;
    share[at(2 * axis + 1)] = above / filled;
  }
};

// The corner with the bits of r along the axes after the side's own, on that side of the cell.
constexpr int faceCorner(int side, int r) {
  const int axis = side / 2, next = (axis + 1) % 3, last = (axis + 2) % 3;
  return (side & 1) << axis | (r & 1) << next | (r >> 1 & 1) << last;
}

struct Cell {
  std::array<int, kCorners> nodes{};
  int place = 0;               // which of the lattice's cells it is, or is a part of
  std::uint8_t own = 0xff;     // bit c: corner c is its own; not set: a cut took it from this part
  SharedConst<CellFill> fill;  // what of that cell's volume h^3 it holds; null: all
  SharedConst<CellReach> reach;  // of one that is filled in part; null: no neighbor

  bool owns(int corner) const { return (own >> corner & 1) != 0; }
  bool isPart() const { return own != 0xff; }
  int lowestOwn() const {  // of its corners: every cell owns one
    int corner = 0;
    while (!owns(corner)) ++corner;
    return corner;
  }
  double share() const { return fill == nullptr ? 1.0 : fill->share; }  // of h^3, in (0, 1]
  // What it has of the stiffness of its material in all of h^3.
  double stiffnessShare() const { return fill == nullptr ? 1.0 : fill->share * fill->firmness(); }
  // What the corner carries of it, in eighths of a full cell.
  double eighthsAt(int corner) const {
    return fill == nullptr ? 1.0 : kCorners * fill->share * fill->cornerShare(corner);
  }
};

// What becomes of cells that a cut has split: they go as a whole, or stay as parts with ghosts.
enum class SplitCells { kLost, kParted };

struct Ghost {
  int original = 0;    // the lattice's node at its grid point, that it stands in for
  bool fixed = false;  // the original is, and so is an own corner of a part that has the ghost:
                       // what a cut parts from all fixed nodes is free
};

// Cells, and who meets at a node. Constant after construction: a cut makes a new set.
class CellSet {
 public:
  // Where a node is met: cell (index into all()) and corner of it, or, from kCorners on, which of
  // the nodes that it reaches.
  struct Meeting {
    static_assert(kMostReached <= 32, "corner has five bits");
    Meeting(int of_cell = 0, int of_corner = 0)
        : cell(static_cast<std::uint32_t>(of_cell) & 0x7ffffffU),
          corner(static_cast<std::uint32_t>(of_corner) & 31U) {}

    std::uint32_t cell : 27;
    std::uint32_t corner : 5;
  };

  // The cells around a node, in ascending order: a range.
  class Meetings {
   public:
    Meetings() = default;
    Meetings(const Meeting* first, const Meeting* last)
        : listed_(first), count_(static_cast<std::size_t>(last - first)) {}
    void add(const Meeting& meeting) { found_[count_++] = meeting; }

    const Meeting* begin() const { return listed_ != nullptr ? listed_ : found_.data(); }
    const Meeting* end() const { return begin() + count_; }
    bool isEmpty() const { return count_ == 0; }

   private:
    const Meeting* listed_ = nullptr;  // null: those found
    std::array<Meeting, kCorners> found_;
    std::size_t count_ = 0;
  };

  CellSet() = default;
  // Cells in ascending order of their places, and how many nodes the lattice has.
  CellSet(std::vector<Cell> cells, int lattice_nodes, std::vector<Ghost> ghosts = {});
  // All cells of a grid with so many points along each axis, x running fastest: who meets at a node
  // is found by arithmetic, as the lists would be half as large as the cells.
  CellSet(std::vector<Cell> cells, const std::array<int, 3>& points);

  const std::vector<Cell>& all() const { return cells_; }
  const std::vector<Ghost>& ghosts() const { return ghosts_; }
  // With the ghosts, which come after the lattice's.
  int nodeCount() const { return node_count_; }
  int latticeNodeCount() const { return nodeCount() - static_cast<int>(ghosts_.size()); }
  bool isGhost(int node) const { return node >= latticeNodeCount(); }
  // The lattice's node at the same grid point: the node itself, or the ghost's original.
  int original(int node) const {
    return isGhost(node) ? ghosts_[at(node - latticeNodeCount())].original : node;
  }
  // The cell at the place that owns the corner; null where a cut left none.
  const Cell* owner(int place, int corner) const;
  // The node that a node of `from`, an earlier or later set of the same lattice, is here: of a
  // ghost the one that its part has in its place. -1: what had it is gone.
  int nodeOf(const CellSet& from, int node) const;
  // The one that has that side (CellReach) of the cell in common with it; null: none.
  const Cell* across(const Cell& cell, int side) const;
  // The cells that have the node as a corner; at most 8 that own it.
  Meetings meetings(int node) const {
    if (points_[0] > 0) return meetingsOnGrid(node);
    return {meetings_.data() + first_[at(node)], meetings_.data() + first_[at(node) + 1]};
  }
  // Those that reach it beyond a face.
  Meetings reaching(int node) const {
    if (reaching_.empty()) return {};
    return {reaching_.data() + first_reaching_[at(node)],
            reaching_.data() + first_reaching_[at(node) + 1]};
  }
  // Calls visit(meeting) for all cells that have the node or reach it, in ascending order.
  template <typename Visit>
  void visitAround(int node, Visit visit) const;

 private:
  Meetings meetingsOnGrid(int node) const;
  void listMeetings();
  void findReaches();
  void listReaching();

  std::vector<Cell> cells_;
  std::vector<Ghost> ghosts_;
  int node_count_ = 0;
  std::array<int, 3> points_{};  // of the grid that the cells are all of; 0: they are listed
  std::vector<int> first_;       // per node, index into meetings_
  std::vector<Meeting> meetings_;
  std::vector<int> first_reaching_;  // per node, index into reaching_; empty as that is
  std::vector<Meeting> reaching_;
};

template <typename Visit>
void CellSet::visitAround(int node, Visit visit) const {
  const Meetings own = meetings(node);
  const Meeting* met = own.begin();
  for (const Meeting& beyond : reaching(node)) {
    for (; met != own.end() && met->cell < beyond.cell; ++met) visit(*met);
    visit(beyond);
  }
  for (; met != own.end(); ++met) visit(*met);
}

// The corners of a cell with `nodes` and `reach`, then the nodes that it reaches; -1: none.
template <typename AnyCell>
std::array<int, kMostReached> reachedNodes(const AnyCell& cell) {
  std::array<int, kMostReached> nodes;
  nodes.fill(-1);
  std::copy(cell.nodes.begin(), cell.nodes.end(), nodes.begin());
  if (cell.reach != nullptr) {
    std::copy(cell.reach->nodes.begin(), cell.reach->nodes.end(), nodes.begin() + kCorners);
  }
  return nodes;
}

// Of a cell that is filled in part, `reach` null where it reaches no nodes: what each of
// reachedNodes adds to dx/dx_a, averaged over the fill, and to d2x/dx_a^2 (1/h, 1/h^2). That is
// the difference between a neighbor's dx/dx_a and its own, of both sides the mean and, as uneven,
// half the difference; the first is taken where the fill's centroid is, by the neighbors' shares.
struct ReachedSlopes {
  std::array<Vec3, kMostReached> strain;
  std::array<Vec3, kMostReached> squares;
  std::array<Vec3, kMostReached> uneven;

  ReachedSlopes() {
    strain.fill(Vec3::Zero());
    squares.fill(Vec3::Zero());
    uneven.fill(Vec3::Zero());
  }
};
ReachedSlopes reachedSlopes(const CellFill& fill, const CellReach* reach);

// Of any node, also of a ghost.
Vec3 restPosition(const Lattice& lattice, const CellSet& cells, int node);  // m
bool isFixed(const Lattice& lattice, const CellSet& cells, int node);

// Cells turned inside out: the mean deformation gradient's determinant is not positive.
int countInvertedCells(const Lattice& lattice, const LatticeState& state);
// Of those with a corner among the points.
int countInvertedCells(const Lattice& lattice, const LatticeState& state, const GridBox& points);

}  // namespace robot_tissue
