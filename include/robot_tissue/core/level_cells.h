// The cells of one lattice of several (core/lattice_level.h): where they are, and their forces.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "robot_tissue/core/cell_kernel.h"
#include "robot_tissue/core/lattice_coarsening.h"

namespace robot_tissue {

// One value a node along x, y and z.
template <typename Real>
using Field = std::array<std::vector<Real>, 3>;

// Grid points from low to high, both included.
struct LevelBox {
  std::array<int, 3> low{};
  std::array<int, 3> high{};

  bool has(const std::array<int, 3>& place) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (place[axis] < low[axis] || place[axis] > high[axis]) return false;
    }
    return true;
  }
};

// Entries first .. first + count - 1 of a field.
struct Span {
  int first = 0;
  int count = 0;
};

template <typename Real>
class LevelCells {
 public:
  // With `beside` nodes beside the grid. A coarse lattice stands for a finer one.
  LevelCells(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
             bool is_coarse);

  const LevelGrid& grid() const { return grid_; }
  int count() const { return count_; }  // entries of a field
  std::array<int, 3> placeOf(int node) const {
    return node < grid_.beside ? grid_.placeOf(node) : beside_places_[at(node - grid_.beside)];
  }

  // Only cells with a corner in the box from now on.
  void confine(const LevelBox& box);
  const LevelBox& box() const { return box_; }
  // Entries of all nodes in the box, and of some around it.
  const std::vector<Span>& spans() const { return spans_; }

  // On their nodes, in two parts; with bounds of the nodes' stiffness, likewise.
  void findForces(const Field<Real>& displacement, bool with_stiffness);
  Field<Real> lower, upper;
  std::vector<Real> lower_stiffness, upper_stiffness;

 private:
  void place(const std::vector<LevelCell>& cells);

  LevelGrid grid_;
  int count_ = 0;
  bool is_coarse_ = false;
  std::vector<Real> shear_, bulk_;
  std::vector<LooseCell<Real>> loose_;
  std::vector<std::array<int, 3>> beside_places_;
  LevelBox box_;
  std::vector<Span> spans_;
  std::vector<int> blocks_;
};

extern template class LevelCells<float>;
extern template class LevelCells<double>;

}  // namespace robot_tissue
