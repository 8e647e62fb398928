// Where vertical lines run inside a closed mesh (own). Lengths are in spacings from the grid's
// lowest node.
#pragma once

#include <utility>
#include <vector>

#include "robot_tissue/core/grid.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

class MeshColumns {
 public:
  // The mesh must pass meshFault and face outwards; it may reach beyond the grid.
  MeshColumns(const TriangleMesh& mesh, const Grid& grid);

  // Heights between which the line through x and y, in the grid, is inside: ascending, apart. Lines
  // through a vertex or along an edge may miss the mesh there.
  std::vector<std::pair<double, double>> insideAt(double x, double y) const;

 private:
  using Corners = std::array<Vec3, 3>;

  int columnOf(double x, double y) const;

  std::array<int, 2> columns_{};
  std::vector<Corners> triangles_;
  std::vector<std::vector<int>> met_;  // per column of cells, the triangles over or in it
};

}  // namespace robot_tissue
