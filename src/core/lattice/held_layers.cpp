#include "lattice/held_layers.h"

#include <algorithm>

namespace robot_tissue {
namespace {

// Of the spacing (1): layers count as so thick at least. Less: nodes next to them are all but held
// themselves, and solves take longer. Chosen.
constexpr double kThinnest = 0.05;

// Of the spacing: a gap that is none. Rounding.
constexpr double kNoGap = 1e-3;

// Moved towards the side.
FillIntegrals shifted(const CellFill& fill, int side, double by) {
  const int axis = side / 2;
  if (side % 2 == 0) by = -by;
  const Vec3 shift = by * Vec3::Unit(axis);
  const Eigen::Matrix3d cross = shift * fill.centroid.transpose();
  FillIntegrals moved = integralsOf(fill);
  moved.first += fill.share * shift;
  moved.second += fill.share * (cross + cross.transpose() + shift * shift.transpose());
  moved.triple += fill.share * by * fill.products((axis + 1) % 3, (axis + 2) % 3);
  return moved;
}

// Towards the held side, by the gap between.
CellFill laidOn(const CellFill& fill, const HeldLayer& layer) {
  CellFill laid = fillOf(shifted(fill, layer.side, gapAt(fill, layer.side)));
  laid.lent = fill.lent;
  laid.held_side = layer.side;
  laid.thickness = layer.thickness;
  return laid;
}

}  // namespace

double gapAt(const CellFill& fill, int side) {
  const int axis = side / 2;
  const double middle = fill.centroid[axis];
  const double reach = fill.reachAlong(Vec3::Unit(axis));
  const double gap = 0.5 - reach + (side % 2 == 0 ? middle : -middle);
  return gap < kNoGap ? 0.0 : std::min(gap, 1.0 - kThinnest);
}

std::optional<HeldLayer> heldLayer(const Cell& cell, const std::function<bool(int side)>& is_held) {
  if (cell.fill == nullptr) return std::nullopt;
  HeldLayer layer;
  for (int side = 0; side < kSides; ++side) {
    if (!is_held(side) || is_held(side ^ 1)) continue;
    const double thickness = 1.0 - gapAt(*cell.fill, side);
    if (thickness < layer.thickness) layer = {side, thickness};
  }
  return layer.thickness < 1.0 ? std::optional<HeldLayer>(layer) : std::nullopt;
}

void layOnFixedNodes(std::vector<Cell>& cells, const std::vector<std::uint8_t>& fixed) {
  for (Cell& cell : cells) {
    const auto layer = heldLayer(cell, [&](int side) {
      for (int r = 0; r < kFaceNodes; ++r) {
        if (fixed[at(cell.nodes[at(faceCorner(side, r))])] == 0) return false;
      }
      return true;
    });
    if (layer) cell.fill = SharedConst<CellFill>(laidOn(*cell.fill, *layer));
  }
}

CellFill fillInMesh(const CellFill& fill) {
  if (fill.held_side < 0) return fill;
  return fillOf(shifted(fill, fill.held_side ^ 1, 1.0 - fill.thickness));
}

CellFill partOfLayer(const Cell& whole, const Cell& part, const CellFill& fill) {
  if (whole.fill == nullptr || whole.fill->held_side < 0) return fill;
  const HeldLayer layer{whole.fill->held_side, whole.fill->thickness};
  bool is_held = false;
  for (int r = 0; r < kFaceNodes; ++r) is_held = is_held || part.owns(faceCorner(layer.side, r));
  return is_held ? laidOn(fill, layer) : fill;
}

}  // namespace robot_tissue
