// A strip of the lattice of model `elastic` under a bonded plate: how much wider than it is the
// plate seems when the nodes at its rim are joined to it by springs.
//
// N cells' height, fixed at the bottom, endless along y, bonded to a rigid plate on top for x < a.
// The plate moves by one unit across the rim (x), along it (y) or normal to the surface (z). In the
// continuum the energy of small motions is W = W0 (a + beta H): scale has no other place to enter.
// The lattice's, per W0 and spacing, is w = a/h + beta N + shift.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "config/material.h"
#include "loads/rim_law.h"
#include "material/elastic_cell.h"
#include "solvers/newton/sparse_factor.h"

namespace robot_tissue {

// Stiffness of the springs between plate and rim nodes in mu h, a slice: across, along and normal
// for the rim column, the same for the next one outwards; infinity = rigid. Deeper ones are rigid.
using RimSprings = Eigen::Matrix<double, 6, 1>;

class Strip {
 public:
  // A plate without friction holds its nodes normal to the surface alone: of its motions that one
  // is meant then.
  enum class Plate { kBonded, kSliding };

  // Lengths under the plate and beside it in heights. The spacing is 1 m, so is the slice's width.
  Strip(int cells, double poisson_ratio, int bonded, int beside, Plate plate = Plate::kBonded)
      : cells_(cells),
        columns_((bonded + beside) * cells + 1),
        rim_column_(bonded * cells),
        plate_(plate) {
    Material material;
    material.young_modulus = 1.0;
    material.poisson_ratio = poisson_ratio;
    const Moduli moduli{shearModulus(material), bulkModulus(material)};
    shear_ = moduli.shear;
    const double normal = moduli.bulk + 4.0 / 3.0 * moduli.shear;
    plate_scale_ = Vec3(shear_, shear_, normal).cwiseSqrt().cwiseInverse() * std::sqrt(cells);
    findSlice(moduli);
    numberNodes();
    solve();
  }

  // w - a/h, a up to the rim column, as a bilinear form of two motions of the plate: its diagonal
  // is that of each motion alone.
  Eigen::Matrix3d excess(const RimSprings& springs) const {
    constexpr double kRigid = 1e9;
    const Matrix6 stiffness = springs.cwiseMin(kRigid).asDiagonal();
    const Matrix6 joined =
        (Matrix6::Identity() + stiffness * compliance_).partialPivLu().solve(stiffness);
    return free_excess_ + gap_.transpose() * joined * gap_;
  }

  // Of the nodes of the rim column, free as those outside it: their motion under a force on them
  // (1 / mu h), and the gaps that the plate's motions leave between them and it.
  Eigen::Matrix3d compliance() const { return compliance_.topLeftCorner<3, 3>(); }
  Eigen::Matrix3d gap() const { return gap_.topRows<3>(); }

 private:
  using Matrix6 = Eigen::Matrix<double, 6, 6>;
  using Motions = Eigen::Matrix<double, 6, 3>;  // of the two columns' nodes, by motion of the plate
  static constexpr int kSliceCorners = 4;
  static constexpr int kSliceSize = 3 * kSliceCorners;
  using SliceHessian = Eigen::Matrix<double, kSliceSize, kSliceSize>;

  // Second derivative of a cell whose corners of one x and z move alike.
  void findSlice(const Moduli& moduli) {
    ElasticCell::Corners rest;
    rest.fill(Vec3::Zero());
    const CellHessian cell = ElasticCell(moduli, 1.0, rest).hessian();
    slice_.setZero();
    for (int i = 0; i < 3 * kCorners; ++i) {
      for (int j = 0; j < 3 * kCorners; ++j) slice_(inSlice(i), inSlice(j)) += cell(i, j);
    }
  }
  static int inSlice(int i) {
    const int corner = i / 3;
    return 3 * ((corner & 1) + (corner >> 2 & 1) * 2) + i % 3;
  }

  int node(int column, int row) const { return column * (cells_ + 1) + row; }
  // Nodes at the far end under the plate move as in an endless strip.
  bool isHeld(int column, int row, int axis) const {
    const bool by_plate = row == cells_ && column < rim_column_;
    return row == 0 || column == 0 || (by_plate && (plate_ == Plate::kBonded || axis == 2));
  }
  void numberNodes() {
    unknown_.assign(at(3 * columns_ * (cells_ + 1)), -1);
    for (int column = 0; column < columns_; ++column) {
      for (int row = 0; row <= cells_; ++row) {
        for (int axis = 0; axis < 3; ++axis) {
          if (!isHeld(column, row, axis)) unknown_[at(3 * node(column, row) + axis)] = count_++;
        }
      }
    }
  }

  void solve() {
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(count_, 3);  // by the plate's three motions
    Eigen::Matrix3d held_energy = Eigen::Matrix3d::Zero();
    for (int column = 0; column + 1 < columns_; ++column) {
      for (int row = 0; row < cells_; ++row) addCell(column, row, entries, loads, held_energy);
    }
    Eigen::SparseMatrix<double> matrix(count_, count_);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const std::unique_ptr<SparseFactor> factor = makeSparseFactor();
    factor->analyze(matrix);
    if (!factor->factorize(matrix)) throw std::runtime_error("strip: not positive definite");
    Eigen::Matrix3d energy = held_energy;
    Motions moved;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd motion = factor->solve(loads.col(axis));
      energy.col(axis) -= loads.transpose() * motion;
      moved.col(axis) = atRim(motion);
    }
    for (int i = 0; i < 6; ++i) {
      const Eigen::VectorXd pull = Eigen::VectorXd::Unit(count_, rimUnknown(i)) * shear_;
      compliance_.col(i) = atRim(factor->solve(pull));
    }
    Motions carried;
    carried << Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
    const auto scale = plate_scale_.asDiagonal();
    free_excess_ = scale * energy * scale - rim_column_ * Eigen::Matrix3d::Identity();
    gap_ = std::sqrt(shear_) * (carried - moved) * scale;
  }

  int rimUnknown(int i) const {
    return unknown_[at(3 * node(rim_column_ + i / 3, cells_) + i % 3)];
  }
  Eigen::Matrix<double, 6, 1> atRim(const Eigen::VectorXd& motion) const {
    Eigen::Matrix<double, 6, 1> result;
    for (int i = 0; i < 6; ++i) result[i] = motion[rimUnknown(i)];
    return result;
  }

  void addCell(int column, int row, std::vector<Eigen::Triplet<double>>& entries,
               Eigen::MatrixXd& loads, Eigen::Matrix3d& held_energy) const {
    constexpr double kNothing = 1e-12;        // Pa m; the modulus is 1 Pa
    std::array<int, kSliceCorners> first;     // of the corners' three components
    std::array<double, kSliceCorners> share;  // of the plate's motion, where the node is held
    for (int corner = 0; corner < kSliceCorners; ++corner) {
      const int height = row + corner / 2;
      first[at(corner)] = 3 * node(column + corner % 2, height);
      share[at(corner)] = static_cast<double>(height) / cells_;
    }
    for (int i = 0; i < kSliceSize; ++i) {
      for (int j = 0; j < kSliceSize; ++j) {
        const double value = slice_(i, j);
        const int a = unknown_[at(first[at(i / 3)] + i % 3)];
        const int b = unknown_[at(first[at(j / 3)] + j % 3)];
        if (std::abs(value) < kNothing) continue;
        if (a >= 0 && b >= 0 && a >= b) {
          entries.emplace_back(a, b, value);
        } else if (a >= 0 && b < 0) {
          loads(a, j % 3) -= value * share[at(j / 3)];
        } else if (a < 0 && b < 0) {
          held_energy(i % 3, j % 3) += value * share[at(i / 3)] * share[at(j / 3)];
        }
      }
    }
  }

  int cells_;
  int columns_;
  int rim_column_;
  Plate plate_;
  double shear_ = 0.0;
  Vec3 plate_scale_;  // motion for which W0 h is 1/2
  SliceHessian slice_;
  std::vector<int> unknown_;  // per node and axis; -1: held
  int count_ = 0;
  Matrix6 compliance_;
  Motions gap_;
  Eigen::Matrix3d free_excess_;
};

// Springs of the law where the plate ends `depth` spacings outside the rim column.
inline RimSprings springsAt(const RimLaw& law, double depth) {
  const std::array<RimMode, 3> modes{law.across, law.along, law.normal};
  RimSprings springs;
  for (int i = 0; i < 6; ++i) springs[i] = rimStiffness(modes[at(i % 3)], depth - i / 3);
  return springs;
}

inline RimSprings rigidRim() {
  RimSprings springs = RimSprings::Zero();
  springs.head<3>().setConstant(std::numeric_limits<double>::infinity());
  return springs;
}

// Two heights tell it: how far beyond the rim column the plate seems to end. fine has twice
// coarse's cells.
inline Eigen::Matrix3d seemingDepth(const Strip& coarse, const Strip& fine,
                                    const RimSprings& springs) {
  return 2.0 * coarse.excess(springs) - fine.excess(springs);
}

}  // namespace robot_tissue
