// The cells of one lattice of several (core/lattice_level.h): where they are, and their forces.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "robot_tissue/core/cell_kernel.h"
#include "robot_tissue/core/lattice_coarsening.h"
#include "robot_tissue/core/workers.h"

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

  // All that cells and the load do to the nodes of the spans: `whole`, and `force`, the same where
  // `free` is 1, else 0. With steps also bounds of the nodes' stiffness and their inverses where
  // free.
  struct Loads {
    const Field<Real>& displacement;
    const Field<Real>& load;
    const std::vector<Real>& free;
    Field<Real>& force;
    std::vector<Real>& inverse;
  };
  void findForces(const Loads& loads, bool with_steps);
  // In these threads from now on, with the same results.
  void share(Workers& workers);
  Field<Real> whole;
  std::vector<Real> stiffness;

 private:
  // Forces and stiffness that planes of cells sum up on planes of nodes: a plane of cells on its
  // lower and upper nodes, the one before on those same lower ones.
  struct Sums {
    std::array<std::vector<Real>, 4> below, lower, upper;
  };

  void place(const std::vector<LevelCell>& cells);
  void makeSums(int threads);
  void findPlanes(const Loads& loads, bool with_steps, int first, int end, Sums& sums);
  CellGrid<Real> gridOf(const Loads& loads) const;
  void addPlane(const Loads& loads, bool with_steps, int plane, Sums& sums) const;
  void finishPlane(const Loads& loads, bool with_steps, int plane, const Sums& sums);
  void finishBeside(const Loads& loads, bool with_steps);

  LevelGrid grid_;
  int count_ = 0;
  bool is_coarse_ = false;
  std::vector<Real> shear_, bulk_;
  std::vector<LooseCell<Real>> loose_;
  std::vector<int> loose_nodes_;                 // of loose cells
  std::array<std::vector<Real>, 4> loose_sums_;  // on them: forces, stiffness
  std::vector<std::array<int, 3>> beside_places_;
  LevelBox box_;
  std::vector<Span> spans_;
  Span rows_;                             // likewise, in each plane
  std::vector<std::vector<int>> blocks_;  // per plane of cells: first cells
  Workers* workers_ = nullptr;
  std::vector<Sums> sums_;  // per thread
};

extern template class LevelCells<float>;
extern template class LevelCells<double>;

}  // namespace robot_tissue
