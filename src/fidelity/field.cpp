#include "field.h"

#include <cmath>

#include "tuning.h"

namespace robot_tissue {
namespace {

// A cell of the lattice and where in it the point is, each coordinate 0 .. 1.
struct PlaceInCell {
  int place = -1;  // -1 = no cell holds the point
  Vec3 inner = Vec3::Zero();
};

PlaceInCell placeOf(const Lattice& lattice, const Vec3& point) {
  const Vec3 grid = (point - lattice.bounds().min()) / lattice.spacing();
  for (int side = 0; side < kCorners; ++side) {
    std::array<int, 3> index{};
    bool holds = true;
    for (int axis = 0; axis < 3; ++axis) {
      const bool lower = (side >> axis & 1) != 0;  // the cell below the face that the point is on
      const double whole = std::floor(grid[axis] + tuning::kOnFace);
      index[at(axis)] = static_cast<int>(whole) - (lower ? 1 : 0);
      holds = holds && (!lower || grid[axis] - whole < tuning::kOnFace);
    }
    const int cell = holds ? lattice.cellAt(index) : -1;
    if (cell < 0) continue;
    const Vec3 inner = grid - Vec3(index[0], index[1], index[2]);
    return {lattice.cells()[at(cell)].place, inner.cwiseMax(0.0).cwiseMin(1.0)};
  }
  return {};
}

int nearestCorner(const Vec3& inner) {
  int corner = 0;
  for (int axis = 0; axis < 3; ++axis) corner |= (inner[axis] > 0.5 ? 1 : 0) << axis;
  return corner;
}

double weightOf(int corner, const Vec3& inner) {
  double weight = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    weight *= (corner >> axis & 1) != 0 ? inner[axis] : 1.0 - inner[axis];
  }
  return weight;
}

}  // namespace

std::vector<Vec3> nodesOf(const TissueConfig& tissue) {
  const Lattice lattice(tissue);
  std::vector<Vec3> nodes;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    nodes.push_back(lattice.restPosition(node));
  }
  return nodes;
}

Field fieldAt(const Tissue& tissue, const std::vector<Vec3>& points) {
  const std::vector<Vec3> shown = tissue.shownDisplacement();
  Field field{std::vector<Vec3>(points.size(), Vec3::Zero()),
              std::vector<std::uint8_t>(points.size(), 0)};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaceInCell where = placeOf(tissue.lattice(), points[i]);
    if (where.place < 0) continue;
    const Cell* cell = tissue.state().cells->owner(where.place, nearestCorner(where.inner));
    if (cell == nullptr) continue;
    field.inside[i] = 1;
    for (int corner = 0; corner < kCorners; ++corner) {
      const double weight = weightOf(corner, where.inner);
      if (weight > 0.0) field.displacement[i] += weight * shown[at(cell->nodes[at(corner)])];
    }
  }
  return field;
}

}  // namespace robot_tissue
