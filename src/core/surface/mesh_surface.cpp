#include "surface/mesh_surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/cut_mesh_surface.h"
#include "surface/smooth_carriers.h"

namespace robot_tissue {
namespace {

// Spacings between two cells that are equally near. Rounding.
constexpr double kAsNear = 1e-9;

Vec3 inCell(const Lattice& lattice, const Cell& cell, const Vec3& point) {
  const auto lowest = lattice.gridIndex(lattice.cells()[at(cell.place)].nodes.front());
  return point - Vec3(lowest[0], lowest[1], lowest[2]);
}

Vec3 clamped(const Vec3& place) { return place.cwiseMax(0.0).cwiseMin(1.0); }

}  // namespace

int nearestCell(const Lattice& lattice, const Vec3& point) {
  std::array<int, 3> middle{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    middle[axis] = static_cast<int>(std::floor(point[static_cast<Eigen::Index>(axis)]));
  }
  int nearest = -1;
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = middle[2] - 1; k <= middle[2] + 1; ++k) {
    for (int j = middle[1] - 1; j <= middle[1] + 1; ++j) {
      for (int i = middle[0] - 1; i <= middle[0] + 1; ++i) {
        const int index = lattice.cellAt({i, j, k});
        if (index < 0) continue;
        const Cell& cell = lattice.cells()[at(index)];
        const Vec3 place = inCell(lattice, cell, point);
        const double distance = (place - clamped(place)).norm();
        const bool as_near = nearest >= 0 && std::abs(distance - shortest) <= kAsNear;
        if (as_near ? cell.share() > lattice.cells()[at(nearest)].share() : distance < shortest) {
          nearest = index;
          shortest = distance;
        }
      }
    }
  }
  return nearest;
}

int cellAround(const Lattice& lattice, const Vec3& point) {
  const int nearest = nearestCell(lattice, point);
  if (nearest < 0) {
    throw InputError("surface: a vertex lies in no cell; allowed: the lattice's mesh");
  }
  return nearest;
}

Vec3 placeIn(const Lattice& lattice, const Cell& cell, const Vec3& point) {
  return clamped(inCell(lattice, cell, point));
}

TissueSurface meshSurface(const Lattice& lattice, const LatticeState& state,
                          const TriangleMesh& mesh) {
  if (!isAsMade(state)) return cutMeshSurface(lattice, state, mesh);
  TissueSurface surface;
  surface.rest = mesh.vertices;
  surface.node.assign(mesh.vertices.size(), -1);
  surface.triangles = mesh.triangles;
  surface.opened.assign(mesh.triangles.size(), 0);
  for (const Vec3& vertex : mesh.vertices) {
    const Vec3 point = (vertex - lattice.bounds().min()) / lattice.spacing();
    const Cell& cell = *state.cells->owner(cellAround(lattice, point), 0);
    surface.carriers.push_back(smoothCarriers(*state.cells, cell, placeIn(lattice, cell, point)));
  }
  return surface;
}

}  // namespace robot_tissue
