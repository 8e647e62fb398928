#include "solvers/multigrid/level/cell_relief.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "simd/field_kernel.h"
#include "solvers/multigrid/level/cell_strain.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = level_tuning;

// R of the polar decomposition, by Newton's method (Higham 1986); det F > 0.
Eigen::Matrix3d rotationOf(const Eigen::Matrix3d& strain) {
  Eigen::Matrix3d rotation = strain;
  for (int step = 0; step < tuning::kStepsOfRotation; ++step) {
    const Eigen::Matrix3d before = rotation;
    rotation = 0.5 * (before + before.inverse().transpose());
    if ((rotation - before).squaredNorm() < tuning::kSameRotation) break;
  }
  return rotation;
}

// Of F - 1, from the m_a that relief adds.
template <typename NumberAt>
Eigen::Matrix3d strainOf(NumberAt number_at) {
  Eigen::Matrix3d strain;
  for (std::size_t i = 0; i < kNine; ++i) {
    strain(static_cast<int>(i % 3), static_cast<int>(i / 3)) = -static_cast<double>(number_at(i));
  }
  return strain;
}

}  // namespace

StretchMeans::StretchMeans(const LevelGrid& finer)
    : size_{finer.size[0] / 2 + 1, finer.size[1] / 2 + 1, finer.size[2] / 2 + 1} {
  weights_.assign(indexOf({0, 0, size_[2]}), 0.0);
  sums_.assign(weights_.size(), Eigen::Matrix3d::Zero());
}

std::size_t StretchMeans::indexOf(const std::array<int, 3>& coarse_place) const {
  return at(coarse_place[0] + size_[0] * (coarse_place[1] + size_[1] * coarse_place[2]));
}

void StretchMeans::add(const std::array<int, 3>& place, const Eigen::Matrix3d& strain,
                       double weight) {
  const std::size_t here = indexOf({place[0] / 2, place[1] / 2, place[2] / 2});
  sums_[here] += weight * (strain.transpose() * strain);
  weights_[here] += weight;
}

Eigen::Matrix3d StretchMeans::squareAt(const std::array<int, 3>& coarse_place) const {
  const std::size_t here = indexOf(coarse_place);
  if (!(weights_[here] > 0.0)) return Eigen::Matrix3d::Zero();
  return sums_[here] / weights_[here];
}

Eigen::Matrix3d relievedStrain(const Eigen::Matrix3d& strain, const Eigen::Matrix3d& mean_square) {
  if (!(strain.determinant() > tuning::kFlattestRelieved)) return strain;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> square;
  square.computeDirect(mean_square);
  if (!(square.eigenvalues()[0] > 0.0)) return strain;
  return rotationOf(strain) * square.operatorSqrt();
}

template <typename Real>
void CellOperator<Real>::addStretches(const Field<Real>& displacement, StretchMeans& means) const {
  Field<Real> since;
  for (std::size_t axis = 0; hasRelief() && axis < 3; ++axis) {
    since[axis].resize(at(count_));
    subtract(displacement[axis].data(), relieved_at_[axis].data(), Real(1), since[axis].data(),
             count_);
  }
  const Field<Real>& moved = hasRelief() ? since : displacement;
  for (int cell = 0; cell < grid_.beside; ++cell) {
    if (!(shear_[at(cell)] > Real(0))) continue;
    Eigen::Matrix3d strain = meanStrain(moved, nodesOf(cell));
    if (hasRelief()) strain += strainOf([&](std::size_t i) { return relief_[i][at(cell)]; });
    means.add(grid_.placeOf(cell), strain, static_cast<double>(shear_[at(cell)]));
  }
  const auto add = [&](const LooseCell<Real>& cell, Eigen::Matrix3d strain) {
    if (hasRelief()) strain += strainOf([&](std::size_t i) { return cell.relief[i]; });
    means.add(placeOf(cell.nodes[0]), strain, static_cast<double>(cell.shear));
  };
  for (const LooseCell<Real>& cell : loose_) add(cell, meanStrain(moved, cell.nodes));
  for (const FilledCell<Real>& cell : filled_) add(cell, meanStrain(moved, cell));
}

template <typename Real>
std::array<Real, kNine> CellOperator<Real>::reliefOf(const Eigen::Matrix3d& strain, int lowest,
                                                     const StretchMeans& of_finer) const {
  const Eigen::Matrix3d relief =
      Eigen::Matrix3d::Identity() - relievedStrain(strain, of_finer.squareAt(placeOf(lowest)));
  std::array<Real, kNine> numbers;
  for (std::size_t i = 0; i < kNine; ++i) {
    numbers[i] = static_cast<Real>(relief(static_cast<int>(i % 3), static_cast<int>(i / 3)));
  }
  return numbers;
}

template <typename Real>
void CellOperator<Real>::relieve(const Field<Real>& displacement, const StretchMeans& of_finer) {
  relieved_at_ = displacement;
  motion_ = displacement;
  for (auto& values : relief_) values.resize(at(count_), Real(0));
  for (int cell = 0; cell < grid_.beside; ++cell) {
    if (!(shear_[at(cell)] > Real(0))) continue;
    const std::array<Real, kNine> relief =
        reliefOf(meanStrain(displacement, nodesOf(cell)), cell, of_finer);
    for (std::size_t i = 0; i < kNine; ++i) relief_[i][at(cell)] = relief[i];
  }
  const auto take = [&](const Eigen::Matrix3d& strain, LooseCell<Real>& cell) {
    cell.relief = reliefOf(strain, cell.nodes[0], of_finer);
  };
  for (LooseCell<Real>& cell : loose_) take(meanStrain(displacement, cell.nodes), cell);
  for (FilledCell<Real>& cell : filled_) take(meanStrain(displacement, cell), cell);
}

template <typename Real>
void CellOperator<Real>::endRelief() {
  for (auto& values : relief_) values.clear();
}

template void CellOperator<float>::addStretches(const Field<float>&, StretchMeans&) const;
template void CellOperator<double>::addStretches(const Field<double>&, StretchMeans&) const;
template void CellOperator<float>::relieve(const Field<float>&, const StretchMeans&);
template void CellOperator<double>::relieve(const Field<double>&, const StretchMeans&);
template void CellOperator<float>::endRelief();
template void CellOperator<double>::endRelief();

}  // namespace robot_tissue
