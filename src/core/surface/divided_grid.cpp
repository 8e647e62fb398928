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

DividedGrid::DividedGrid(const Lattice& lattice, const LatticeState& state)
    : lattice_(lattice), divisions_(lattice, state), maps_(divisions_.count()) {}

int DividedGrid::cellAt(const std::array<int, 3>& index) const {
  if (divisions_.count() == 0) return -1;
  const int cell = lattice_.cellAt(index);
  return cell < 0 || divisions_.find(cell) == nullptr ? -1 : cell;
}

bool DividedGrid::isBent(const HalfIndex& octant) const {
  return cellAt({octant[0] / 2, octant[1] / 2, octant[2] / 2}) >= 0;
}

const std::vector<DividedGrid::Map>& DividedGrid::mapsOf(int cell) const {
  std::vector<Map>& maps = maps_[at(divisions_.number(cell))];
  if (!maps.empty()) return maps;
  const CellDivision straight;
  for (int corner = 0; corner < kCorners; ++corner) {
    const auto solids = divisions_.find(cell)->aroundCorner(corner);
    const auto straight_solids = straight.aroundCorner(corner);
    for (std::size_t i = 0; i < solids.size(); ++i) {
      maps.push_back({barycentricWeights(solids[i]), columnsOf(straight_solids[i])});
    }
  }
  return maps;
}

Vec3 DividedGrid::straightened(const Vec3& place) const {
  const Vec3 low = place.array().floor();
  const int cell =
      cellAt({static_cast<int>(low.x()), static_cast<int>(low.y()), static_cast<int>(low.z())});
  if (cell < 0) return place;
  Eigen::Vector4d point;
  point << place - low - kMiddle, 1.0;
  Eigen::Vector4d weights = Eigen::Vector4d::Zero();
  const Map* inside = nullptr;
  double least = -std::numeric_limits<double>::infinity();
  for (const Map& map : mapsOf(cell)) {
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
    const int cell = is_around ? cellAt(low) : -1;
    if (cell >= 0) return Vec3(low[0], low[1], low[2]) + divisions_.find(cell)->at(from_low);
  }
  return 0.5 * Vec3(point[0], point[1], point[2]);
}

}  // namespace robot_tissue
