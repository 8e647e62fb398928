#include "solvers/multigrid/level/level_membrane.h"

#include <algorithm>
#include <utility>

#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = level_tuning;

}  // namespace

template <typename Real>
LevelMembrane<Real>::LevelMembrane(std::shared_ptr<const Membrane> membrane,
                                   std::vector<int> entries, double spacing, double modulus)
    : membrane_(std::move(membrane)),
      spacing_(spacing),
      modulus_(modulus),
      entries_(std::move(entries)),
      stiffness_(membrane_->stiffnessPattern()) {}

template <typename Real>
LevelMembrane<Real>::LevelMembrane(const LevelMembrane& fine,
                                   const std::vector<NodeShares>& carriers) {
  const auto own = [this](int entry) {
    return static_cast<int>(std::lower_bound(entries_.begin(), entries_.end(), entry) -
                            entries_.begin());
  };
  for (const int entry : fine.entries_) {
    for (const NodeShare& share : carriers[at(entry)]) entries_.push_back(share.node);
  }
  std::sort(entries_.begin(), entries_.end());
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  const auto for_parts = [&](auto visit) {
    for (int row = 0; row < fine.stiffness_.rows(); ++row) {
      for (int i = fine.stiffness_.first(row); i < fine.stiffness_.last(row); ++i) {
        for (const NodeShare& one : carriers[at(fine.entries_[at(row)])]) {
          for (const NodeShare& other :
               carriers[at(fine.entries_[at(fine.stiffness_.column(i))])]) {
            visit(i, own(one.node), own(other.node), one.weight * other.weight);
          }
        }
      }
    }
  };
  std::vector<std::pair<int, int>> pairs;
  for_parts([&](int, int row, int column, double) { pairs.emplace_back(row, column); });
  stiffness_ = NodeBlocks(static_cast<int>(entries_.size()), std::move(pairs));
  for_parts([&](int fine_block, int row, int column, double weight) {
    while (static_cast<int>(first_part_.size()) <= fine_block) {
      first_part_.push_back(static_cast<int>(parts_.size()));
    }
    parts_.push_back({stiffness_.place(row, column), weight});
  });
  first_part_.push_back(static_cast<int>(parts_.size()));
  start_.assign(entries_.size(), Vec3::Zero());
}

template <typename Real>
std::vector<Vec3> LevelMembrane<Real>::gather(const Field<Real>& displacement) const {
  std::vector<Vec3> moved;
  moved.reserve(entries_.size());
  for (const int entry : entries_) {
    moved.emplace_back(static_cast<double>(displacement[0][at(entry)]),
                       static_cast<double>(displacement[1][at(entry)]),
                       static_cast<double>(displacement[2][at(entry)]));
  }
  return moved;
}

template <typename Real>
void LevelMembrane<Real>::renew(const Field<Real>& displacement) {
  std::vector<Vec3> moved = gather(displacement);
  for (Vec3& motion : moved) motion *= spacing_;
  membrane_->findStiffness(moved, Curvature::kConvex, stiffness_);
  stiffness_ *= 1.0 / (modulus_ * spacing_);
}

// In units of this level's E0 h: half the number.
template <typename Real>
void LevelMembrane<Real>::renew(const LevelMembrane& fine, const std::vector<std::uint8_t>& held) {
  stiffness_.clear();
  const NodeBlocks& of_fine = fine.stiffness_;
  const auto stands = [&](int row) { return held[at(fine.entries_[at(row)])] == kAllAxes; };
  for (int row = 0; row < of_fine.rows(); ++row) {
    if (stands(row)) continue;
    for (int i = of_fine.first(row); i < of_fine.last(row); ++i) {
      if (stands(of_fine.column(i))) continue;
      for (int part = first_part_[at(i)]; part < first_part_[at(i) + 1]; ++part) {
        stiffness_.block(parts_[at(part)].to) += 0.5 * parts_[at(part)].weight * of_fine.block(i);
      }
    }
  }
}

template <typename Real>
void LevelMembrane<Real>::startAt(const Field<Real>& displacement) {
  start_ = gather(displacement);
}

template <typename Real>
void LevelMembrane<Real>::addForces(const Field<Real>& displacement, Field<Real>& forces) const {
  std::vector<Vec3> moved = gather(displacement);
  double unit = -1.0;
  if (membrane_ != nullptr) {
    for (Vec3& motion : moved) motion *= spacing_;
    moved = membrane_->forces(moved);
    unit = 1.0 / (modulus_ * spacing_ * spacing_);
  } else {
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= start_[i];
    moved = stiffness_.times(moved);
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      forces[at(axis)][at(entries_[i])] += static_cast<Real>(unit * moved[i][axis]);
    }
  }
}

// The power method starts from numbers that are the same each time (a linear congruential
// generator: Numerical Recipes).
template <typename Real>
std::vector<Eigen::Matrix3d> LevelMembrane<Real>::diagonal(double greatest) {
  int steps = tuning::kPowerStepsAgain;
  if (stiffest_.empty()) {
    steps = tuning::kPowerSteps;
    std::uint32_t number = 1;
    stiffest_.assign(entries_.size(), Vec3::Zero());
    for (Vec3& motion : stiffest_) {
      for (double& value : motion) {
        number = 1664525U * number + 1013904223U;
        value = static_cast<double>(number >> 8) / (1 << 24) - 0.5;
      }
    }
  }
  const double found =
      tuning::kStiffnessMargin * greatestOverDiagonal(stiffness_, steps, stiffest_);
  std::vector<Eigen::Matrix3d> diagonal;
  for (int row = 0; row < stiffness_.rows(); ++row) {
    diagonal.emplace_back(std::max(1.0, found / greatest) * stiffness_.diagonal(row));
  }
  return diagonal;
}

template class LevelMembrane<float>;
template class LevelMembrane<double>;

}  // namespace robot_tissue
