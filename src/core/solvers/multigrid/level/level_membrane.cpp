#include "solvers/multigrid/level/level_membrane.h"

#include <algorithm>
#include <utility>

#include "base/steady_numbers.h"
#include "solvers/multigrid/level/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = level_tuning;

}  // namespace

template <typename Real>
LevelMembrane<Real>::LevelMembrane(std::shared_ptr<const Membrane> membrane,
                                   const std::vector<int>& entries, double spacing, double modulus)
    : membrane_(std::move(membrane)),
      spacing_(spacing),
      modulus_(modulus),
      of_vertices_(std::make_shared<NodeBlocks>(membrane_->stiffnessPattern())),
      carriers_(membrane_->carriers()) {
  for (const int node : membrane_->nodes()) entries_.push_back(entries[at(node)]);
}

template <typename Real>
LevelMembrane<Real>::LevelMembrane(const LevelMembrane& fine,
                                   const std::vector<NodeShares>& carriers)
    : membrane_(fine.membrane_),
      spacing_(2.0 * fine.spacing_),
      modulus_(fine.modulus_),
      of_vertices_(fine.of_vertices_) {
  for (const int entry : fine.entries_) {
    for (const NodeWeight& share : carriers[at(entry)]) entries_.push_back(share.node);
  }
  std::sort(entries_.begin(), entries_.end());
  entries_.erase(std::unique(entries_.begin(), entries_.end()), entries_.end());
  for (const int entry : fine.entries_) {
    shares_.emplace_back();
    for (const NodeWeight& share : carriers[at(entry)]) {
      const auto own = std::lower_bound(entries_.begin(), entries_.end(), share.node);
      shares_.back().push_back({static_cast<int>(own - entries_.begin()), share.weight});
    }
  }
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
  if (!shares_.empty()) return;
  std::vector<Vec3> moved = gather(displacement);
  for (Vec3& motion : moved) motion *= spacing_;
  membrane_->findStiffness(moved, Curvature::kConvex, *of_vertices_);
}

template <typename Real>
void LevelMembrane<Real>::bind(const LevelMembrane& fine, const std::vector<std::uint8_t>& held) {
  std::vector<VertexCarriers::Shares> free = shares_;
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (held[at(fine.entries_[i])] == kAllAxes) free[i].clear();
  }
  carriers_ = VertexCarriers(fine.carriers_, static_cast<int>(entries_.size()), free);
}

template <typename Real>
void LevelMembrane<Real>::startAt(const Field<Real>& displacement) {
  start_ = gather(displacement);
}

template <typename Real>
std::vector<Vec3> LevelMembrane<Real>::timesStiffness(const std::vector<Vec3>& motion) const {
  std::vector<Vec3> product =
      carriers_.toCarriers(of_vertices_->times(carriers_.toVertices(motion)));
  for (Vec3& force : product) force /= modulus_ * spacing_;
  return product;
}

template <typename Real>
void LevelMembrane<Real>::addForces(const Field<Real>& displacement, Field<Real>& forces) const {
  std::vector<Vec3> moved = gather(displacement);
  double unit = -1.0;
  if (shares_.empty()) {
    for (Vec3& motion : moved) motion *= spacing_;
    moved = membrane_->forces(moved);
    unit = 1.0 / (modulus_ * spacing_ * spacing_);
  } else {
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] -= start_[i];
    moved = timesStiffness(moved);
  }
  for (std::size_t i = 0; i < moved.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      forces[at(axis)][at(entries_[i])] += static_cast<Real>(unit * moved[i][axis]);
    }
  }
}

// The power method starts from numbers that are the same each time.
template <typename Real>
std::vector<Eigen::Matrix3d> LevelMembrane<Real>::diagonal(double greatest) {
  int steps = tuning::kPowerStepsAgain;
  if (stiffest_.empty()) {
    steps = tuning::kPowerSteps;
    SteadyNumbers numbers;
    stiffest_.assign(entries_.size(), Vec3::Zero());
    for (Vec3& motion : stiffest_) {
      for (double& value : motion) value = numbers.nextReal();
    }
  }
  std::vector<Eigen::Matrix3d> diagonal = carriers_.diagonal(*of_vertices_);
  for (Eigen::Matrix3d& own : diagonal) own /= modulus_ * spacing_;
  const auto times = [this](const std::vector<Vec3>& motion) { return timesStiffness(motion); };
  const double found =
      tuning::kStiffnessMargin * greatestOverDiagonal(times, diagonal, steps, stiffest_);
  for (Eigen::Matrix3d& own : diagonal) own *= std::max(1.0, found / greatest);
  return diagonal;
}

template class LevelMembrane<float>;
template class LevelMembrane<double>;

}  // namespace robot_tissue
