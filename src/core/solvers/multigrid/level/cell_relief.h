// The relief of a coarse level's cells (own).
//
// A coarse node starts where the fine node at its place is. Where tissue is bent, the fine nodes
// that a coarse cell's edge passes lie on an arc, and the edge is its chord: the coarse cell is
// squeezed, and bent far in itself, where no fine cell is. What is slender buckles under less than
// that, so that coarse levels lead anywhere. With relief F of a coarse cell is taken to be, where a
// visit of its level begins,
//
//   F_0 = R U,   F = R V,   U^2 = mean of F_f^T F_f over the finer cells f in it,
//
// turned as its own corners say, stretched as the finer cells are, and not bent; from there on its
// corners' motion counts. As the kernel has it: m_a = e_a - F_0 e_a, and what the motion adds.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue {

// Means of F^T F over the cells of a level that lie in one of the next coarser, by their shear
// moduli. Cells that a cut has parted there have one mean.
class StretchMeans {
 public:
  explicit StretchMeans(const LevelGrid& finer);

  void add(const std::array<int, 3>& place, const Eigen::Matrix3d& strain, double weight);
  // At a cell of the coarser level; zero where there is none of the finer one.
  Eigen::Matrix3d squareAt(const std::array<int, 3>& coarse_place) const;

 private:
  std::size_t indexOf(const std::array<int, 3>& coarse_place) const;

  std::array<int, 3> size_;
  std::vector<Eigen::Matrix3d> sums_;
  std::vector<double> weights_;
};

// F_0; F where the cell is flat or turned over, as it is not known then which way it is turned.
Eigen::Matrix3d relievedStrain(const Eigen::Matrix3d& strain, const Eigen::Matrix3d& mean_square);

}  // namespace robot_tissue
