// The lattice's nodes by arithmetic alone: answers which nodes a box holds before any is made.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// The nodes of a box: along each axis the indices first .. last, none when first > last.
struct NodeRange {
  std::array<int, 3> first{};
  std::array<int, 3> last{};

  bool empty() const;
};

class Grid {
 public:
  // The shape's extent is a whole multiple of the spacing (spacingFits), in reach of int. That is
  // not checked: of any other extent the number of cells is the nearest whole one, counted from the
  // lower corner, so that the last nodes are off the shape's upper sides by up to half a spacing.
  Grid(const Box& shape, double spacing);
  // With only the cells that are not 0 (one entry a cell) and the nodes at their corners.
  Grid(const Grid& whole, std::vector<std::uint8_t> cells);

  // The smallest range with all nodes of the closed box, with a slack of a thousandth of the
  // spacing. So boxes with the same nodes have the same range.
  NodeRange nodesIn(const Box& box) const;
  bool shareNode(const NodeRange& a, const NodeRange& b) const;
  // True when the box holds the center of a cell between eight nodes: cells carry the material.
  bool holdsCell(const Box& box) const;
  const std::array<int, 3>& size() const { return size_; }  // nodes along x, y, z
  int cellCount() const { return (size_[0] - 1) * (size_[1] - 1) * (size_[2] - 1); }
  // Points, numbered with x running fastest, at the corners of a cell, numbered likewise.
  std::array<int, 8> cornersOf(int cell) const;
  const Box& shape() const { return shape_; }
  double spacing() const { return spacing_; }

 private:
  // Indices of the points that stand `offset` spacings above the nodes.
  NodeRange pointsIn(const Box& box, double offset) const;
  NodeRange shrunk(const NodeRange& range) const;

  Box shape_;
  double spacing_;
  std::array<int, 3> size_{};
  std::vector<std::uint8_t> cells_;  // 1 = is there; empty: all are
  std::vector<std::uint8_t> nodes_;  // the same
};

// True when every extent is a whole multiple of the spacing to a thousandth of it.
bool spacingFits(const Vec3& extent, double spacing);

// Nodes of a grid whose spacing fits; a double, as the number may be absurd.
double nodeCount(const Vec3& extent, double spacing);

// The nearest spacings below and above that fit all three extents; fewer when there are none.
std::vector<double> nearestSpacings(const Vec3& extent, double spacing);

}  // namespace robot_tissue
