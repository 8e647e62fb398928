#include "surface/divided_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_tissue {
namespace {

// Barycentric (1): a point that is so far outside a tetrahedron is in it. Rounding.
constexpr double kOutside = 1e-12;

const Vec3 kMiddle = Vec3::Constant(0.5);

Eigen::Matrix<double, 3, 4> columnsOf(const Tetrahedron& solid) {
  Eigen::Matrix<double, 3, 4> columns;
  for (int corner = 0; corner < 4; ++corner) columns.col(corner) = solid[at(corner)];
  return columns;
}

Eigen::Matrix4d barycentricWeights(const Tetrahedron& solid) {
  Eigen::Matrix4d corners;
  corners << columnsOf(solid), Eigen::RowVector4d::Ones();
  return corners.inverse();
}

}  // namespace

DividedGrid::DividedGrid(const Lattice& lattice, const LatticeState& state) : lattice_(lattice) {
  if (state.springs_cut == 0) return;
  const CellDivision straight;
  divided_of_.assign(lattice.cells().size(), -1);
  for (const Cell& cell : lattice.cells()) {
    if (!hasPartedSprings(lattice, state, cell)) continue;
    divided_of_[at(cell.place)] = static_cast<int>(divided_.size());
    DividedCell divided{CellDivision(lattice, state, cell), {}};
    for (int corner = 0; corner < kCorners; ++corner) {
      const auto solids = divided.division.aroundCorner(corner);
      const auto straight_solids = straight.aroundCorner(corner);
      for (std::size_t i = 0; i < solids.size(); ++i) {
        divided.maps.push_back({barycentricWeights(solids[i]), columnsOf(straight_solids[i])});
      }
    }
    divided_.push_back(std::move(divided));
  }
}

const DividedGrid::DividedCell* DividedGrid::cellAt(const std::array<int, 3>& index) const {
  if (divided_of_.empty()) return nullptr;
  const int cell = lattice_.cellAt(index);
  if (cell < 0 || divided_of_[at(cell)] < 0) return nullptr;
  return &divided_[at(divided_of_[at(cell)])];
}

Vec3 DividedGrid::straightened(const Vec3& place) const {
  const Vec3 low = place.array().floor();
  const DividedCell* divided =
      cellAt({static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(low.z())});
  if (divided == nullptr) return place;
  Eigen::Vector4d point;
  point << place - low - kMiddle, 1.0;
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();
  const Map* inside = nullptr;
  double least = -std::numeric_limits<double>::infinity();
  for (const Map& map : divided->maps) {
    const Eigen::Vector4d here = map.weights * point;
    if (here.minCoeff() <= least) continue;
    least = here.minCoeff();
    weights = here;
    inside = &map;
    if (least > -kOutside) break;
  }
  Vec3 straight = low + kMiddle + inside->straight * weights;
  for (int axis = 0; axis < 3; ++axis) {
    if (place[axis] == low[axis]) straight[axis] = low[axis];  // on a plane of nodes
  }
  return straight;
}

// Any cell around the point has it at the same place.
Vec3 DividedGrid::placeOf(const HalfIndex& point) const {
  for (int around = 0; around < kCorners; ++around) {
    std::array<int, 3> low{};
    CellPoint from_low{};
    bool is_around = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool lower = (around >> axis & 1) != 0;
      is_around = is_around && (!lower || point[axis] % 2 == 0);
      low[axis] = point[axis] / 2 - (lower ? 1 : 0);
      from_low[axis] = point[axis] - 2 * low[axis];
    }
    const DividedCell* divided = is_around ? cellAt(low) : nullptr;
    if (divided == nullptr) continue;
    return Vec3(low[0], low[1], low[2]) + divided->division.at(from_low);
  }
  return 0.5 * Vec3(point[0], point[1], point[2]);
}

}  // namespace robot_tissue
