// The half grid with its planes where a blade parted cells (own): the places of its points are
// those of cutting/cell_division.h, between them it is linear in each tetrahedron.
#pragma once

#include <array>
#include <vector>

#include "cutting/cell_division.h"
#include "geometry/mesh_pieces.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

class DividedGrid : public BentGrid {
 public:
  DividedGrid(const Lattice& lattice, const LatticeState& state);

  Vec3 straightened(const Vec3& place) const override;
  Vec3 placeOf(const HalfIndex& point) const override;

 private:
  // Barycentric coordinates of a point x of the cell are weights * (x, 1), of the straight
  // tetrahedron with these corners (spacings from the cell's middle).
  struct Map {
    Eigen::Matrix4d weights;
    Eigen::Matrix<double, 3, 4> straight;
  };
  struct DividedCell {
    CellDivision division;
    std::vector<Map> maps;
  };

  const DividedCell* cellAt(const std::array<int, 3>& index) const;

  const Lattice& lattice_;
  std::vector<int> divided_of_;  // per cell, -1: nothing parts it; empty: no cell is parted
  std::vector<DividedCell> divided_;
};

}  // namespace robot_tissue
