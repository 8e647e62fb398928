#include "loads/bed_columns.h"

#include <algorithm>
#include <limits>

namespace robot_tissue {
namespace {

// Of a layer that gives way across the axis, and along it (Pa).
Vec3 fullModuli(const Moduli& moduli, int side) {
  Vec3 full = Vec3::Constant(moduli.shear);
  // E / (1 - nu^2): the nodes across give way to the sides, but not as freely as a bar's.
  full[side / 2] = 2.0 * moduli.shear / (1.0 - poissonRatio(moduli));
  return full;
}

}  // namespace

MaterialRange materialAlong(const Cell& cell, int axis) {
  if (cell.fill == nullptr) return {0.0, 1.0};
  const double middle = 0.5 + cell.fill->centroid[axis];
  const double reach = cell.fill->reachAlong(Vec3::Unit(axis));
  return {std::max(0.0, middle - reach), std::min(1.0, middle + reach)};
}

std::vector<int> cellsAt(const CellSet& cells, const std::vector<int>& nodes) {
  std::vector<int> met;
  for (const int node : nodes) {
    for (const CellSet::Meeting& there : cells.meetings(node)) {
      met.push_back(static_cast<int>(there.cell));
    }
  }
  std::sort(met.begin(), met.end());
  met.erase(std::unique(met.begin(), met.end()), met.end());
  return met;
}

void BedColumns::add(const Cell& cell, const HeldLayer& layer, const Compliance& compliance_at) {
  const Moduli moduli = model_.moduliIn(cell);
  if (moduli.shear <= 0.0) return;
  const double thickness = cell.fill == nullptr ? 1.0 : 1.0 - gapAt(*cell.fill, layer.side);
  const double wide = cell.share() / thickness;
  const double unit = wide / cell.stiffnessShare() * lattice_.spacing() / kFaceNodes;
  const Vec3 full = unit * fullModuli(moduli, layer.side);
  const RimLaw law = rimLaw(poissonRatio(moduli));
  for (int r = 0; r < kFaceNodes; ++r) {
    const int corner = faceCorner(layer.side, r);
    if (!cell.owns(corner)) continue;
    const Vec3 compliance = compliance_at(corner, law);
    const Vec3 joint = compliance.cwiseInverse().cwiseMin(kHardestRim);
    if (joint.maxCoeff() == 0.0) continue;
    const int opposite = faceCorner(layer.side ^ 1, r);
    columns_.push_back({cell.nodes[at(corner)], cell.owns(opposite) ? cell.nodes[at(opposite)] : -1,
                        layer.thickness, full, unit * moduli.shear * joint,
                        compliance.maxCoeff() > 0.0});
  }
}

std::map<int, Vec3> BedColumns::springs(const std::function<bool(int node)>& is_in_plate) {
  for (const Column& column : columns_) {
    if (column.is_rim) continue;
    if (is_in_plate(column.on_plate)) hard_.insert(column.on_plate);
    if (column.thickness == 0.0 && is_in_plate(column.across)) hard_.insert(column.across);
  }
  for (const Column& column : columns_) joinOnPlate(column);
  for (const Column& column : columns_) joinAcross(column, is_in_plate);
  return stiffness_;
}

bool BedColumns::isHard(int node) const {
  return hard_.count(node) != 0 || (node < lattice_.nodeCount() && lattice_.isFixed(node));
}

std::optional<HeldLayer> BedColumns::layerAt(const Cell& cell, int side) const {
  const double gap = cell.fill == nullptr ? 0.0 : gapAt(*cell.fill, side);
  if (gap == 0.0 && goesOn(cell, side)) return std::nullopt;
  return HeldLayer{side, 1.0 - gap};
}

// There is a cell beyond the side.
bool BedColumns::goesOn(const Cell& cell, int side) const {
  for (int r = 0; r < kFaceNodes; ++r) {
    const int corner = faceCorner(side, r);
    if (cell.owns(corner) && cellWith(cell.nodes[at(corner)], faceCorner(side ^ 1, r)) != nullptr)
      return true;
  }
  return false;
}

Vec3 BedColumns::lowest(const Cell& cell) const {
  return lattice_.restPosition(lattice_.cells()[at(cell.place)].nodes.front());
}

double BedColumns::depthInTissue(const Cell& cell, int corner, int axis, int side,
                                 double depth) const {
  if (depth >= 1.0 || depth <= -1.0) return depth;
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  // The cell that the edge is in has the corner on its lower or upper side.
  const bool is_inside = depth > -kBedSlack;
  const bool is_upper = (side > 0) != is_inside;
  const int its_corner = is_upper ? corner | 1 << axis : corner & ~(1 << axis);
  const Cell* there = cellWith(cell.nodes[at(corner)], its_corner);
  if (there == nullptr) return is_inside ? kInfinite : depth;
  const MaterialRange material = materialAlong(*there, axis);
  const double edge = (is_upper ? 1.0 : 0.0) + side * depth;
  const bool ends = side > 0 ? material.to <= std::min(edge + kBedSlack, 1.0 - kBedSlack)
                             : material.from >= std::max(edge - kBedSlack, kBedSlack);
  return ends ? kInfinite : depth;
}

// The cell that has the node at that corner; null: there is none.
const Cell* BedColumns::cellWith(int node, int corner) const {
  for (const CellSet::Meeting& there : cells_.meetings(node)) {
    if (static_cast<int>(there.corner) == corner)
      return &cells_.all()[at(static_cast<int>(there.cell))];
  }
  return nullptr;
}

void BedColumns::joinOnPlate(const Column& column) {
  if (isHard(column.on_plate)) return;
  sprung_.insert(column.on_plate);
  add(column.on_plate, column.joint);
}

// Joint and layer in series, less what goes by the node on the plate: so what is across is held
// as it would be, were the joint at the surface.
void BedColumns::joinAcross(const Column& column, const std::function<bool(int)>& is_in_plate) {
  const int node = column.across;
  if (node < 0 || isHard(node)) return;
  if (column.thickness == 0.0) return add(node, column.joint);
  if (is_in_plate(node)) return;
  const auto inSeries = [](const Vec3& a, const Vec3& b) -> Vec3 {
    return (a.cwiseInverse() + b.cwiseInverse()).cwiseInverse();
  };
  const Vec3 through = column.thickness * column.full;
  const Vec3 there =
      sprung_.count(column.on_plate) != 0 ? inSeries(column.joint, through) : through;
  const Vec3 lacking = inSeries(column.joint, column.full / column.thickness) - there;
  add(node, lacking.cwiseMax(0.0));
}

void BedColumns::add(int node, const Vec3& stiffness) {
  if (stiffness.isZero(0.0)) return;
  stiffness_.emplace(node, Vec3::Zero()).first->second += stiffness;
}

}  // namespace robot_tissue
