#include "robot_tissue/core/lattice_level.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "robot_tissue/core/unknowns.h"

namespace robot_tissue {
namespace {

constexpr int kProbes = 20;            // steps of the power method
constexpr double kProbe = 1e-3;        // its motion, in spacings
constexpr double kMargin = 1.1;        // on what it finds
constexpr double kLongestStep = 0.25;  // of a node along an axis, in spacings
constexpr double kBothEnds = 2.0;      // weights of a spring to a group, summed

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Jacobian = Eigen::Matrix<double, 3, 6>;

// Of a point's motion by the group's.
Jacobian motionAt(const Vec3& arm, bool turns) {
  Jacobian jacobian = Jacobian::Zero();
  jacobian.leftCols<3>().setIdentity();
  if (turns) jacobian.rightCols<3>() = -crossMatrix(arm);
  return jacobian;
}

}  // namespace

template <typename Real>
LatticeLevel<Real>::LatticeLevel(const LevelGrid& grid, int beside,
                                 const std::vector<LevelCell>& cells, bool is_coarse)
    : grid_(grid),
      count_((grid.beside + beside + kLanes - 1) / kLanes * kLanes),
      is_coarse_(is_coarse) {
  const auto clear = [this](std::vector<Real>& values) { values.assign(at(count_), Real(0)); };
  for (Field<Real>* field : {&displacement, &load, &force, &lower_, &upper_, &way_}) {
    for (auto& values : *field) clear(values);
  }
  for (auto* values :
       {&shear_, &bulk_, &inverse_, &rest_stiffness_, &lower_stiffness_, &upper_stiffness_}) {
    clear(*values);
  }
  held_.assign(at(count_), 0);
  beside_places_.assign(at(count_ - grid.beside), {});
  for (std::size_t axis = 0; axis < 3; ++axis) box_.high[axis] = grid.size[axis] - 1;
  placeCells(cells);
  layBlocks();
  bind();
  findForces(true);
  for (std::size_t node = 0; node < rest_stiffness_.size(); ++node) {
    rest_stiffness_[node] = lower_stiffness_[node] + upper_stiffness_[node];
  }
  measureSteps();
}

template <typename Real>
void LatticeLevel<Real>::placeCells(const std::vector<LevelCell>& cells) {
  for (const LevelCell& cell : cells) {
    const int lowest = grid_.index(cell.place[0], cell.place[1], cell.place[2]);
    bool regular = true;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.nodes[at(corner)];
      if (node >= grid_.beside) {
        beside_places_[at(node - grid_.beside)] = {cell.place[0] + (corner & 1),
                                                   cell.place[1] + (corner >> 1 & 1),
                                                   cell.place[2] + (corner >> 2 & 1)};
      }
      const int there =
          lowest + (corner & 1) + (corner >> 1 & 1) * grid_.row + (corner >> 2 & 1) * grid_.plane;
      regular = regular && node == there;
    }
    const Real shear = static_cast<Real>(cell.shear), bulk = static_cast<Real>(cell.bulk);
    if (regular) {
      shear_[at(lowest)] += shear;
      bulk_[at(lowest)] += bulk;
    } else {
      loose_.push_back({cell.nodes, shear, bulk});
    }
  }
}

template <typename Real>
void LatticeLevel<Real>::layBlocks() {
  blocks_.clear();
  for (int k = 0; k + 1 < grid_.size[2]; ++k) {
    for (int first = k * grid_.plane; first < (k + 1) * grid_.plane; first += kLanes) {
      const auto cell = shear_.begin() + first;
      if (std::any_of(cell, cell + kLanes, [](Real shear) { return shear > Real(0); })) {
        blocks_.push_back(first);
      }
    }
  }
}

// The power method from rest, its start any numbers that are the same each time.
template <typename Real>
void LatticeLevel<Real>::measureSteps() {
  std::uint32_t number = 1;
  for (auto& values : displacement) {
    for (std::size_t node = 0; node < values.size(); ++node) {
      number = 1664525U * number + 1013904223U;
      values[node] =
          exists(static_cast<int>(node)) ? Real(number >> 8) / Real(1 << 24) - Real(0.5) : Real(0);
    }
  }
  double greatest = 1.0;
  for (int probe = 0; probe < kProbes; ++probe) {
    double squared = 0.0;
    for (const auto& values : displacement) {
      for (const Real value : values) squared += static_cast<double>(value * value);
    }
    if (squared == 0.0) break;
    const double entries = static_cast<double>(count_);
    const Real scale = static_cast<Real>(kProbe * std::sqrt(entries / squared));
    for (auto& values : displacement) {
      for (Real& value : values) value *= scale;
    }
    findForces(false);
    double product = 0.0, length = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t node = 0; node < inverse_.size(); ++node) {
        Real& moved = displacement[axis][node];
        if (inverse_[node] == Real(0)) continue;
        const double stiffness = 1.0 / static_cast<double>(inverse_[node]);
        product -= static_cast<double>(moved * force[axis][node]);
        length += stiffness * static_cast<double>(moved * moved);
        moved = -inverse_[node] * force[axis][node];
      }
    }
    greatest = std::max(greatest, product / length);
  }
  step_ = 1.0 / (kMargin * greatest);
  for (auto& values : displacement) std::fill(values.begin(), values.end(), Real(0));
}

template <typename Real>
void LatticeLevel<Real>::freeAll() {
  std::fill(held_.begin(), held_.end(), std::uint8_t{0});
  springs.clear();
  groups.clear();
}

template <typename Real>
void LatticeLevel<Real>::setUnits(double spacing, double modulus) {
  spacing_ = spacing;
  modulus_ = modulus;
}

template <typename Real>
int LatticeLevel<Real>::firmAt(int node) const {
  const auto before = [](const Firm& firm, int other) { return firm.node < other; };
  const auto found = std::lower_bound(firm_.begin(), firm_.end(), node, before);
  return static_cast<int>(found - firm_.begin());
}

template <typename Real>
void LatticeLevel<Real>::bind() {
  findFirm();
  for (LevelSpring& spring : springs) {
    for (LevelSpring::Carrier& carrier : spring.carriers) carrier.firm = firmAt(carrier.node);
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (std::size_t i = 0; i < groups[group].nodes.size(); ++i) {
      Firm& firm = firm_[at(firmAt(groups[group].nodes[i]))];
      firm.group = static_cast<int>(group);
      firm.arm = groups[group].arms[i];
    }
  }
  group_inverse_.assign(groups.size(), Matrix6::Zero());
  for (auto* vectors : {&group_load, &group_force, &group_motion, &group_way_}) {
    vectors->assign(groups.size(), GroupVector::Zero());
  }
}

template <typename Real>
void LatticeLevel<Real>::findFirm() {
  std::vector<int> nodes;
  for (const LevelSpring& spring : springs) {
    for (const LevelSpring::Carrier& carrier : spring.carriers) nodes.push_back(carrier.node);
  }
  for (const LevelGroup& group : groups) {
    nodes.insert(nodes.end(), group.nodes.begin(), group.nodes.end());
  }
  for (std::size_t node = 0; node < held_.size(); ++node) {
    if (held_[node] != 0 && held_[node] != 7) nodes.push_back(static_cast<int>(node));
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  firm_.clear();
  for (const int node : nodes) {
    firm_.emplace_back();
    firm_.back().node = node;
  }
}

template <typename Real>
CellGrid<Real> LatticeLevel<Real>::cellGrid(bool with_stiffness) {
  CellGrid<Real> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells.displacement[axis] = displacement[axis].data();
    cells.lower[axis] = lower_[axis].data();
    cells.upper[axis] = upper_[axis].data();
  }
  cells.shear = shear_.data();
  cells.bulk = bulk_.data();
  cells.row = grid_.row;
  cells.plane = grid_.plane;
  cells.is_coarse = is_coarse_;
  cells.lower_stiffness = with_stiffness ? lower_stiffness_.data() : nullptr;
  cells.upper_stiffness = with_stiffness ? upper_stiffness_.data() : nullptr;
  return cells;
}

template <typename Real>
void LatticeLevel<Real>::findForces(bool with_steps) {
  for (Field<Real>* field : {&lower_, &upper_}) {
    for (auto& values : *field) std::fill(values.begin(), values.end(), Real(0));
  }
  if (with_steps) {
    std::fill(lower_stiffness_.begin(), lower_stiffness_.end(), Real(0));
    std::fill(upper_stiffness_.begin(), upper_stiffness_.end(), Real(0));
  }
  const CellGrid<Real> cells = cellGrid(with_steps);
  addBlocks(cells, blocks_.data(), static_cast<int>(blocks_.size()));
  addLoose(cells, loose_.data(), static_cast<int>(loose_.size()));
  if (with_steps) renewSteps();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sumForces(lower_[axis].data(), upper_[axis].data(), load[axis].data(), inverse_.data(),
              force[axis].data(), count_);
  }
  addSprings(with_steps);
}

template <typename Real>
void LatticeLevel<Real>::renewSteps() {
  std::fill(inverse_.begin(), inverse_.end(), Real(0));
  const auto renew = [this](int node) {
    const Real stiffness = lower_stiffness_[at(node)] + upper_stiffness_[at(node)];
    if (stiffness > Real(0) && held_[at(node)] == 0) inverse_[at(node)] = Real(1) / stiffness;
  };
  for (int k = box_.low[2]; k <= box_.high[2]; ++k) {
    for (int j = box_.low[1]; j <= box_.high[1]; ++j) {
      const int row = grid_.index(0, j, k);
      for (int i = box_.low[0]; i <= box_.high[0]; ++i) renew(row + i);
    }
  }
  for (int node = grid_.beside; node < count_; ++node) {
    if (box_.has(placeOf(node))) renew(node);
  }
  for (const Firm& firm : firm_) inverse_[at(firm.node)] = Real(0);
}

template <typename Real>
Vec3 LatticeLevel<Real>::vectorAt(const Field<Real>& field, int node) const {
  return {static_cast<double>(field[0][at(node)]), static_cast<double>(field[1][at(node)]),
          static_cast<double>(field[2][at(node)])};
}

template <typename Real>
Vec3 LatticeLevel<Real>::meanOf(const LevelSpring& spring) const {
  Vec3 mean = Vec3::Zero();
  for (const LevelSpring::Carrier& carrier : spring.carriers) {
    mean += carrier.weight * vectorAt(displacement, carrier.node);
  }
  if (spring.group >= 0) {
    mean -= motionAt(spring.arm, groups[at(spring.group)].turns) * group_motion[at(spring.group)];
  }
  return mean;
}

template <typename Real>
Vec3 LatticeLevel<Real>::springForce(const LevelSpring& spring) const {
  const Vec3 mean = meanOf(spring);
  if (spring.contact == nullptr) return spring.stiffness * (spring.anchor - mean);
  const Vec3 point = spring.contact->rest + spacing_ * mean;
  return forceAt(*spring.contact, point) / (modulus_ * spacing_ * spacing_);
}

// Springs on firm nodes and groups. A spring's stiffness counts by its weights' sum, so that no
// motion is stiffer than the step allows (l1-Jacobi: Baker, Falgout, Kolev, Yang 2011).
template <typename Real>
void LatticeLevel<Real>::addSprings(bool with_steps) {
  for (Firm& firm : firm_) {
    firm.force =
        vectorAt(lower_, firm.node) + vectorAt(upper_, firm.node) + vectorAt(load, firm.node);
    if (!with_steps) continue;
    const Real stiffness = lower_stiffness_[at(firm.node)] + upper_stiffness_[at(firm.node)];
    firm.stiffness = static_cast<double>(stiffness) * Eigen::Matrix3d::Identity();
  }
  group_force = group_load;
  std::vector<Matrix6> group_stiffness(with_steps ? groups.size() : 0, Matrix6::Zero());
  for (LevelSpring& spring : springs) {
    if (with_steps && spring.contact != nullptr) {
      const Vec3 point = spring.contact->rest + spacing_ * meanOf(spring);
      spring.stiffness = stiffnessAt(*spring.contact, point) / (modulus_ * spacing_);
    }
    const Vec3 on_nodes = springForce(spring);
    const double both = spring.group >= 0 ? kBothEnds : 1.0;
    for (const LevelSpring::Carrier& carrier : spring.carriers) {
      Firm& firm = firm_[at(carrier.firm)];
      firm.force += carrier.weight * on_nodes;
      if (with_steps) firm.stiffness += both * carrier.weight * spring.stiffness;
    }
    if (spring.group < 0) continue;
    const Jacobian jacobian = motionAt(spring.arm, groups[at(spring.group)].turns);
    group_force[at(spring.group)] -= jacobian.transpose() * on_nodes;
    if (!with_steps) continue;
    group_stiffness[at(spring.group)] += both * jacobian.transpose() * spring.stiffness * jacobian;
  }
  for (Firm& firm : firm_) {
    if (firm.group >= 0) {
      const Jacobian jacobian = motionAt(firm.arm, groups[at(firm.group)].turns);
      group_force[at(firm.group)] += jacobian.transpose() * firm.force;
      if (with_steps) {
        group_stiffness[at(firm.group)] += jacobian.transpose() * firm.stiffness * jacobian;
      }
    }
    const unsigned held = firm.group >= 0 ? 7U : held_[at(firm.node)];
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_held = (held >> axis & 1U) != 0;
      force[at(axis)][at(firm.node)] = is_held ? Real(0) : static_cast<Real>(firm.force[axis]);
      if (!with_steps || !is_held) continue;
      firm.stiffness.row(axis).setZero();
      firm.stiffness.col(axis).setZero();
      firm.stiffness(axis, axis) = 1.0;
    }
    if (with_steps) firm.inverse = firm.stiffness.inverse();
  }
  for (std::size_t group = 0; group < group_stiffness.size(); ++group) {
    Matrix6& stiffness = group_stiffness[group];
    const double scale = stiffness.diagonal().maxCoeff();
    for (int axis = 0; axis < 6; ++axis) {
      if (stiffness(axis, axis) <= 1e-12 * scale) stiffness(axis, axis) = std::max(scale, 1.0);
    }
    group_inverse_[group] = stiffness.inverse();
    if (!groups[group].turns) group_inverse_[group].bottomRightCorner<3, 3>().setZero();
  }
}

// Chebyshev's polynomials of the fourth kind, that smooth whatever is rough (Lottes 2022).
template <typename Real>
void LatticeLevel<Real>::smooth(int steps, bool forces_at_end) {
  calm();
  for (int k = 1; k <= steps; ++k) {
    const double keep = k == 1 ? 0.0 : (2.0 * k - 3.0) / (2.0 * k + 1.0);
    step(keep, (8.0 * k - 4.0) / (2.0 * k + 1.0) * step_);
    if (k < steps) findForces(false);
  }
  if (forces_at_end) findForces(true);
}

template <typename Real>
void LatticeLevel<Real>::calm() {
  for (auto& values : way_) std::fill(values.begin(), values.end(), Real(0));
  for (Firm& firm : firm_) firm.step.setZero();
  for (GroupVector& way : group_way_) way.setZero();
}

template <typename Real>
void LatticeLevel<Real>::step(double keep, double share) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    stepAlong(inverse_.data(), force[axis].data(), static_cast<Real>(keep),
              static_cast<Real>(share), static_cast<Real>(kLongestStep), way_[axis].data(),
              displacement[axis].data(), count_);
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    GroupVector& way = group_way_[group];
    way = keep * way + share * group_inverse_[group] * group_force[group];
    const double longest = way.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) way *= kLongestStep / longest;
    group_motion[group] += way;
  }
  for (Firm& firm : firm_) {
    if (firm.group >= 0) {
      const Jacobian jacobian = motionAt(firm.arm, groups[at(firm.group)].turns);
      firm.step = jacobian * group_way_[at(firm.group)];
    } else {
      const Vec3 free = vectorAt(force, firm.node);
      firm.step = keep * firm.step + share * (firm.inverse * free);
      const double longest = firm.step.cwiseAbs().maxCoeff();
      if (longest > kLongestStep) firm.step *= kLongestStep / longest;
    }
    for (int axis = 0; axis < 3; ++axis) {
      displacement[at(axis)][at(firm.node)] += static_cast<Real>(firm.step[axis]);
    }
  }
}

template <typename Real>
void LatticeLevel<Real>::clearLoad() {
  for (auto& values : load) std::fill(values.begin(), values.end(), Real(0));
  std::fill(group_load.begin(), group_load.end(), GroupVector::Zero());
}

template <typename Real>
void LatticeLevel<Real>::loadFor(const Field<Real>& wanted,
                                 const std::vector<GroupVector>& wanted_of_groups) {
  clearLoad();
  findForces(true);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t node = 0; node < inverse_.size(); ++node) {
      if (inverse_[node] == Real(0)) continue;
      load[axis][node] = wanted[axis][node] - force[axis][node];
      force[axis][node] = wanted[axis][node];
    }
    for (const Firm& firm : firm_) {
      const std::size_t node = at(firm.node);
      if (firm.group >= 0 || (held_[node] >> axis & 1) != 0) continue;
      load[axis][node] = wanted[axis][node] - force[axis][node];
      force[axis][node] = wanted[axis][node];
    }
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    group_load[group] = wanted_of_groups[group] - group_force[group];
    group_force[group] = wanted_of_groups[group];
  }
}

template <typename Real>
void LatticeLevel<Real>::moveBy(const Field<Real>& motion,
                                const std::vector<GroupVector>& of_groups, double share) {
  const Real part = static_cast<Real>(share);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Real* along = motion[axis].data();
    Real* moved = displacement[axis].data();
    for (std::size_t node = 0; node < inverse_.size(); ++node) {
      moved[node] += inverse_[node] != Real(0) ? part * along[node] : Real(0);
    }
  }
  for (const Firm& firm : firm_) {
    Vec3 step = share * vectorAt(motion, firm.node);
    if (firm.group >= 0) {
      step = share * (motionAt(firm.arm, groups[at(firm.group)].turns) * of_groups[at(firm.group)]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_held = firm.group < 0 && (held_[at(firm.node)] >> axis & 1) != 0;
      if (!is_held) displacement[at(axis)][at(firm.node)] += static_cast<Real>(step[axis]);
    }
  }
  for (std::size_t group = 0; group < groups.size(); ++group) {
    group_motion[group] += share * of_groups[group];
  }
}

template <typename Real>
double LatticeLevel<Real>::squaredLocalMotion() const {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Real sum = 0;
    const Real* on = force[axis].data();
    for (std::size_t node = 0; node < inverse_.size(); ++node) {
      const Real motion = inverse_[node] * on[node];
      sum += motion * motion;
    }
    squared += static_cast<double>(sum);
  }
  for (const Firm& firm : firm_) {
    if (firm.group < 0) squared += (firm.inverse * vectorAt(force, firm.node)).squaredNorm();
  }
  std::vector<GroupVector> of_groups;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    of_groups.push_back(group_inverse_[group] * group_force[group]);
  }
  return squared + squaredMotionOf(of_groups);
}

template <typename Real>
std::vector<int> LatticeLevel<Real>::nodesOutOfBalance(double motion) const {
  std::vector<int> nodes;
  for (std::size_t node = 0; node < inverse_.size(); ++node) {
    if (inverse_[node] == Real(0)) continue;
    Real squared = 0;
    for (const auto& values : force) squared += values[node] * values[node];
    const Real still = static_cast<Real>(motion) / inverse_[node];
    if (squared > still * still) nodes.push_back(static_cast<int>(node));
  }
  return nodes;
}

template <typename Real>
double LatticeLevel<Real>::squaredMotionOf(const std::vector<GroupVector>& of_groups) const {
  double squared = 0.0;
  for (std::size_t group = 0; group < groups.size(); ++group) {
    for (const Vec3& arm : groups[group].arms) {
      squared += (motionAt(arm, groups[group].turns) * of_groups[group]).squaredNorm();
    }
  }
  return squared;
}

template <typename Real>
Vec3 LatticeLevel<Real>::wholeForce(int node) const {
  const std::size_t firm = at(firmAt(node));
  if (firm < firm_.size() && firm_[firm].node == node) return firm_[firm].force;
  return vectorAt(lower_, node) + vectorAt(upper_, node) + vectorAt(load, node);
}

template class LatticeLevel<float>;
template class LatticeLevel<double>;

}  // namespace robot_tissue
