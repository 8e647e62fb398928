// The half grid with its points where a blade parted cells (cutting/cell_division.h) (own).
#pragma once

#include <array>
#include <vector>

#include "cutting/cell_division.h"
#include "geometry/bent_grid.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {

class DividedGrid : public BentGrid {
 public:
  // The lattice must outlive this.
  DividedGrid(const Lattice& lattice, const LatticeState& state);

  Vec3 straightened(const Vec3& place) const override;
  Vec3 placeOf(const HalfIndex& point) const override;
  bool isBent(const HalfIndex& octant) const override;

 private:
  // Barycentric coordinates of a point x of the cell are weights * (x, 1), of the straight
  // tetrahedron with these corners (spacings from the cell's middle).
  struct Map {
    Eigen::Matrix4d weights;
    Eigen::Matrix<double, 3, 4> straight;
  };

  int cellAt(const std::array<int, 3>& index) const;  // that is divided; -1: none
  const std::vector<Map>& mapsOf(int cell) const;

  const Lattice& lattice_;
  CellDivisions divisions_;
  mutable std::vector<std::vector<Map>> maps_;  // per division; made when it is asked for
};

}  // namespace robot_tissue
