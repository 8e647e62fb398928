#include "robot_tissue/core/lattice_level.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr int kProbes = 20;            // steps of the power method
constexpr double kProbe = 1e-3;        // its motion, in spacings
constexpr double kMargin = 1.1;        // on what it finds
constexpr double kLongestStep = 0.25;  // of a node along an axis, in spacings

}  // namespace

template <typename Real>
LatticeLevel<Real>::LatticeLevel(const LevelGrid& grid, int beside,
                                 const std::vector<LevelCell>& cells, bool is_coarse)
    : cells_(grid, beside, cells, is_coarse) {
  for (Field<Real>* field : {&displacement, &load, &force, &way_}) {
    for (auto& values : *field) values.assign(at(count()), Real(0));
  }
  for (auto* values : {&inverse_, &free_, &rest_stiffness_}) values->assign(at(count()), Real(0));
  held_.assign(at(count()), 0);
  cells_.findForces({displacement, load, free_, force, inverse_}, true);
  rest_stiffness_ = cells_.stiffness;
  bind();
  measureSteps();
}

// The power method from rest, its start any numbers that are the same each time.
template <typename Real>
void LatticeLevel<Real>::measureSteps() {
  findForces(true);
  std::uint32_t number = 1;
  for (auto& values : displacement) {
    for (std::size_t node = 0; node < values.size(); ++node) {
      number = 1664525U * number + 1013904223U;
      values[node] = free_[node] * (Real(number >> 8) / Real(1 << 24) - Real(0.5));
    }
  }
  double greatest = 1.0;
  for (int probe = 0; probe < kProbes; ++probe) {
    double squared = 0.0;
    for (const auto& values : displacement) {
      squared += dotOf(values.data(), values.data(), count());
    }
    if (squared == 0.0) break;
    const Real scale = static_cast<Real>(kProbe * std::sqrt(count() / squared));
    for (auto& values : displacement) {
      for (Real& value : values) value *= scale;
    }
    findForces(false);
    double product = 0.0, length = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t node = 0; node < inverse_.size(); ++node) {
        Real& moved = displacement[axis][node];
        product -= static_cast<double>(moved * force[axis][node]);
        length += static_cast<double>(rest_stiffness_[node] * moved * moved);
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
  firm.springs.clear();
  firm.groups.clear();
}

template <typename Real>
void LatticeLevel<Real>::bind() {
  firm.bind(held_);
  findFree();
}

template <typename Real>
void LatticeLevel<Real>::confine(const LevelBox& box) {
  cells_.confine(box);
  for (Field<Real>* forces : {&force, &cells_.whole}) {
    for (auto& values : *forces) std::fill(values.begin(), values.end(), Real(0));
  }
  findFree();
}

template <typename Real>
void LatticeLevel<Real>::findFree() {
  for (const Span& span : spans()) {
    std::fill_n(free_.begin() + span.first, span.count, Real(0));
  }
  const auto look = [this](int node) {
    if (held_[at(node)] == 0 && exists(node)) free_[at(node)] = Real(1);
  };
  const LevelBox& within = box();
  for (int k = within.low[2]; k <= within.high[2]; ++k) {
    for (int j = within.low[1]; j <= within.high[1]; ++j) {
      const int row = grid().index(0, j, k);
      for (int i = within.low[0]; i <= within.high[0]; ++i) look(row + i);
    }
  }
  for (int node = grid().beside; node < count(); ++node) {
    if (within.has(placeOf(node))) look(node);
  }
  for (const int node : firm.nodes()) free_[at(node)] = Real(0);
}

template <typename Real>
void LatticeLevel<Real>::findForces(bool with_steps) {
  cells_.findForces({displacement, load, free_, force, inverse_}, with_steps);
  firm.findForces(cells_, displacement, with_steps, force);
}

// Chebyshev's polynomials of the fourth kind, that smooth whatever is rough (Lottes 2022).
template <typename Real>
void LatticeLevel<Real>::smooth(int steps, bool forces_at_end) {
  calm();
  for (int k = 1; k <= steps; ++k) {
    const double keep = k == 1 ? 0.0 : (2.0 * k - 3.0) / (2.0 * k + 1.0);
    const double share = (8.0 * k - 4.0) / (2.0 * k + 1.0) * step_;
    for (const Span& span : spans()) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        stepAlong(inverse_.data() + span.first, force[axis].data() + span.first,
                  static_cast<Real>(keep), static_cast<Real>(share),
                  static_cast<Real>(kLongestStep), way_[axis].data() + span.first,
                  displacement[axis].data() + span.first, span.count);
      }
    }
    firm.step(keep, share, kLongestStep, displacement);
    if (k < steps) findForces(false);
  }
  if (forces_at_end) findForces(true);
}

template <typename Real>
void LatticeLevel<Real>::calm() {
  for (const Span& span : spans()) {
    for (auto& values : way_) std::fill_n(values.begin() + span.first, span.count, Real(0));
  }
  firm.calm();
}

template <typename Real>
void LatticeLevel<Real>::clearLoad() {
  for (auto& values : load) std::fill(values.begin(), values.end(), Real(0));
  std::fill(firm.load.begin(), firm.load.end(), GroupVector::Zero());
}

template <typename Real>
void LatticeLevel<Real>::loadFor(const Field<Real>& wanted,
                                 const std::vector<GroupVector>& wanted_of_groups) {
  for (const Span& span : spans()) {
    for (auto& values : load) std::fill_n(values.begin() + span.first, span.count, Real(0));
  }
  std::fill(firm.load.begin(), firm.load.end(), GroupVector::Zero());
  findForces(true);
  const std::vector<int> firm_nodes = firm.nodes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Span& span : spans()) {
      makeLoad(wanted[axis].data() + span.first, free_.data() + span.first,
               load[axis].data() + span.first, force[axis].data() + span.first, span.count);
    }
    for (std::size_t i = 0; i < firm_nodes.size(); ++i) {
      const std::size_t node = at(firm_nodes[i]);
      if (!firm.isFree(static_cast<int>(i), static_cast<int>(axis))) continue;
      const Real here = box().has(placeOf(firm_nodes[i])) ? wanted[axis][node] : Real(0);
      load[axis][node] = here - force[axis][node];
      force[axis][node] = here;
    }
  }
  for (std::size_t group = 0; group < firm.groups.size(); ++group) {
    firm.load[group] = wanted_of_groups[group] - firm.force[group];
    firm.force[group] = wanted_of_groups[group];
  }
  firm.takeForces(force);
}

template <typename Real>
void LatticeLevel<Real>::moveBy(const Field<Real>& motion,
                                const std::vector<GroupVector>& of_groups, double share) {
  for (const Span& span : spans()) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      addWhereFree(motion[axis].data() + span.first, free_.data() + span.first,
                   static_cast<Real>(share), displacement[axis].data() + span.first, span.count);
    }
  }
  firm.moveBy(motion, of_groups, share, displacement);
}

template <typename Real>
double LatticeLevel<Real>::squaredLocalMotion() const {
  double squared = firm.squaredLocalMotion();
  for (const Span& span : spans()) {
    for (const auto& values : force) {
      squared +=
          squaredProduct(inverse_.data() + span.first, values.data() + span.first, span.count);
    }
  }
  return squared;
}

template <typename Real>
std::vector<int> LatticeLevel<Real>::nodesOutOfBalance(double motion) const {
  std::vector<int> nodes;
  const Real still = static_cast<Real>(motion * motion);
  for (const Span& span : spans()) {
    for (int node = span.first; node < span.first + span.count; ++node) {
      Real squared = 0;
      for (const auto& values : force) squared += values[at(node)] * values[at(node)];
      if (squared * inverse_[at(node)] * inverse_[at(node)] > still) nodes.push_back(node);
    }
  }
  return nodes;
}

template <typename Real>
Vec3 LatticeLevel<Real>::wholeForce(int node) const {
  if (const Vec3* whole = firm.wholeForce(node)) return *whole;
  return vectorAt(cells_.whole, node);
}

template class LatticeLevel<float>;
template class LatticeLevel<double>;

}  // namespace robot_tissue
