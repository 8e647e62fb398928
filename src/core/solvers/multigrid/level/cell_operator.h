// The cells of one lattice of several (core/solvers/multigrid/level/grid_level.h): where they
// are, and their forces.
//
// Lengths are in the level's own spacing h, moduli in E0, forces in E0 h^2, stiffness in E0 h.
#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "simd/field_kernel.h"
#include "simd/numbers.h"
#include "simd/workers.h"
#include "solvers/multigrid/level/cell_kernel.h"
#include "solvers/multigrid/level/cell_relief.h"
#include "solvers/multigrid/level/lattice_coarsening.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {

// One value a node along x, y and z.
template <typename Real>
using Field = std::array<Numbers<Real>, 3>;

template <typename Real>
Vec3 vectorAt(const Field<Real>& field, int node) {
  return {static_cast<double>(field[0][at(node)]), static_cast<double>(field[1][at(node)]),
          static_cast<double>(field[2][at(node)])};
}

// Greatest absolute value of any component of the first `count` nodes.
template <typename Real>
double greatestIn(const Field<Real>& field, int count) {
  double greatest = 0.0;
  for (const auto& values : field) greatest = std::max(greatest, greatestOf(values.data(), count));
  return greatest;
}

// What is found at a shape: forces alone; how stiff springs are there, too; or all that the
// smoother needs for a step (bounds of the nodes' stiffness, and their inverses where the nodes are
// free).
enum class Find { kForces, kForcesAndSprings, kForcesAndStiffness };

// Which part of a level is solved for (doc/architecture.md, "Words": composite grid).
struct LevelPart {
  GridBox free;     // nodes that may move; the others stay, and count as balanced
  GridBox covered;  // by a finer level: cells with a corner in it stand for eight finer ones each
};

template <typename Real>
class CellOperator {
 public:
  // With `beside` nodes beside the grid.
  CellOperator(const LevelGrid& grid, int beside, const std::vector<LevelCell>& cells,
               const LevelPart& part);

  const LevelGrid& grid() const { return grid_; }
  int count() const { return count_; }  // entries of a field
  std::array<int, 3> placeOf(int node) const {
    return node < grid_.beside ? grid_.placeOf(node) : beside_places_[at(node - grid_.beside)];
  }

  const LevelPart& part() const { return part_; }

  // On the nodes: `whole` = forces of cells + right_hand_side, `force` = free * whole (free: 0 or
  // 1), `stiffness`, and `inverse` = that of the stiffness where nodes are free, else 0.
  struct Loads {
    const Field<Real>& displacement;
    const Field<Real>& right_hand_side;
    const Numbers<Real>& free;
    Field<Real>& force;
    SymmetricField<Real>& inverse;
  };
  void findForces(const Loads& loads, Find what);
  // Of the viscous share of the moduli alone.
  void findViscousForces(const Loads& loads);
  // What findForces found, with stiffness, of other nodes that are free.
  void takeFree(const Loads& loads) const;
  // Of covered cells alone, and of the right-hand side.
  void findForcesOfCovered(const Loads& loads);
  // Relief (cell_relief.h): what the cells are stretched by, for a coarser level; and from now on,
  // at this displacement, they are stretched as the finer level's.
  void addStretches(const Field<Real>& displacement, StretchMeans& means) const;
  void relieve(const Field<Real>& displacement, const StretchMeans& of_finer);
  void endRelief();
  // In these threads from now on, with the same results.
  void share(Workers& workers);
  // In a time step with damping, such a share of the moduli (0 to below 1) is of the strain that is
  // added to the shape of these displacements; 0: all is elastic.
  void setViscosity(double share, const Field<Real>& rate_from);
  // Calls visit(first, count) for parts of all entries, each in the thread that finds the forces
  // there, as what they are found from is in its cache.
  template <typename Visit>
  void forParts(Visit visit) const;
  // Sum of sumOf(first, count) over spans of the entries: the same bits in any number of threads.
  template <typename SumOf>
  double sumOfSpans(SumOf sumOf) const;
  Field<Real> whole;
  SymmetricField<Real> stiffness;
  // 1 over the greatest stiffness of any motion at rest, in the nodes' own; 1 until that is known.
  Real per_greatest = Real(1);
  // Of the nodes' inertia in a time step, against displacement (E0 h); empty: none.
  Numbers<Real> inertia;

 private:
  // Forces (0 to 2) and stiffness (from 3 on), or forces alone, on planes of nodes: of a plane of
  // cells on its lower and upper nodes, and `below`, of the plane of cells before on the same lower
  // ones.
  static constexpr std::size_t kForcesAlone = 3, kAllSums = kForcesAlone + kSymmetric;
  using SumsOn = std::array<Numbers<Real>, kAllSums>;
  struct Sums {
    SumsOn below, lower, upper;
  };

  using Blocks = std::vector<std::vector<CellBlock>>;  // per plane of cells

  bool isShared() const;
  void place(const std::vector<LevelCell>& cells);
  void placeSums(std::vector<int> sum_of);
  void findBlocks();
  bool hasRelief() const { return !relief_.front().empty(); }
  std::array<int, kCorners> nodesOf(int cell) const;  // of one of the grid
  void makeSums(int threads);
  void findForces(const Loads& loads, Find what, const Blocks& blocks);
  void findPlanes(const Loads& loads, Find what, const Blocks& blocks, int first, int end,
                  Sums& sums);
  std::array<Real, kNine> inverseOf(const Eigen::Matrix3d& strain) const;
  std::array<Real, kNine> reliefOf(const Eigen::Matrix3d& strain, int lowest,
                                   const StretchMeans& of_finer) const;
  CellGrid<Real> gridOf(const Loads& loads) const;
  void addPlane(const Loads& loads, Find what, const std::vector<CellBlock>& blocks, int plane,
                Sums& sums) const;
  void finishPlane(const Loads& loads, Find what, int plane, const Sums& sums);
  void addInertia(const Loads& loads, Find what, int first, int count);
  void finishBeside(const Loads& loads, Find what);

  LevelGrid grid_;
  int count_ = 0;
  Numbers<Real> shear_, bulk_;
  Numbers<Real> stiffening_;                  // empty: 0 in all
  Real elastic_ = 1, viscous_ = 0;            // shares of the moduli
  std::array<Numbers<Real>, kNine> inverse_;  // CellGrid::inverse; empty: all is elastic
  std::array<Numbers<Real>, kNine> relief_;   // CellGrid::relief; empty: none
  Field<Real> relieved_at_;                   // displacement where relief was found
  Field<Real> motion_;                        // since then
  std::vector<LooseCell<Real>> loose_;
  std::vector<FilledCell<Real>> filled_;
  std::vector<int> loose_nodes_;  // of loose cells and filled ones
  SumsOn loose_sums_;             // on them
  std::vector<std::array<int, 3>> beside_places_;
  LevelPart part_;
  Blocks blocks_;
  Blocks covered_blocks_;  // of cells that stand for finer ones
  Workers* workers_ = nullptr;
  std::vector<Sums> sums_;  // per thread
};

template <typename Real>
template <typename SumOf>
double CellOperator<Real>::sumOfSpans(SumOf sumOf) const {
  const int spans = (count_ + level_tuning::kSpan - 1) / level_tuning::kSpan;
  if (spans == 1) return sumOf(0, count_);
  std::vector<double> sums(at(spans));
  const auto find = [&](int first, int end) {
    for (int span = first; span < end; ++span) {
      const int start = span * level_tuning::kSpan;
      sums[at(span)] = sumOf(start, std::min(level_tuning::kSpan, count_ - start));
    }
  };
  if (isShared()) {
    workers_->share(spans, find);
  } else {
    find(0, spans);
  }
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

template <typename Real>
template <typename Visit>
void CellOperator<Real>::forParts(Visit visit) const {
  if (!isShared() || count_ <= level_tuning::kSpan) return visit(0, count_);
  workers_->share(grid_.size[2], [&](int first_plane, int end_plane) {
    if (first_plane == end_plane) return;
    const int first = grid_.plane * first_plane;
    const int end = end_plane == grid_.size[2] ? count_ : grid_.plane * end_plane;
    visit(first, end - first);
  });
}

extern template class CellOperator<float>;
extern template class CellOperator<double>;

}  // namespace robot_tissue
