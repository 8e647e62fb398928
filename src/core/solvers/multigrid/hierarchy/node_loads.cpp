#include "solvers/multigrid/hierarchy/node_loads.h"

#include <utility>

namespace robot_tissue {

template <typename Real>
void NodeLoads<Real>::find(const ElasticModel& model, const CellSet& cells,
                           const WholeLevels<Real>& on) {
  findWeight(model, cells, on);
  if (model.movesInTime()) findMasses(model, cells, on);
}

template <typename Real>
void NodeLoads<Real>::findWeight(const ElasticModel& model, const CellSet& cells,
                                 const WholeLevels<Real>& on) {
  const double unit = on.modulus * on.spacing * on.spacing;
  for (const Cell& cell : cells.all()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const Vec3 weight = model.cornerWeight(cell, corner) / unit;
      if (weight.isZero(0.0)) continue;
      for (auto& values : weight_) values.resize(at(on.levels.front().count()), Real(0));
      const int entry = on.entries[at(cell.nodes[at(corner)])];
      for (int axis = 0; axis < 3; ++axis) {
        weight_[at(axis)][at(entry)] += static_cast<Real>(weight[axis]);
      }
    }
  }
}

// A coarse node has the shares of P in the masses of the nodes that it carries: P^T M P with its
// rows summed up.
template <typename Real>
void NodeLoads<Real>::findMasses(const ElasticModel& model, const CellSet& cells,
                                 const WholeLevels<Real>& on) {
  const std::vector<double> of_nodes = model.nodeMasses(cells);
  masses_.resize(on.levels.size());
  masses_.front().assign(at(on.levels.front().count()), 0.0);
  for (std::size_t node = 0; node < of_nodes.size(); ++node) {
    masses_.front()[at(on.entries[node])] = of_nodes[node];
  }
  for (std::size_t level = 1; level < on.levels.size(); ++level) {
    masses_[level].assign(at(on.levels[level].count()), 0.0);
    for (int fine = 0; fine < on.levels[level - 1].count(); ++fine) {
      const double mass = masses_[level - 1][at(fine)];
      if (mass == 0.0) continue;
      for (const NodeWeight& carrier : on.transfers[level - 1].carriersOf(fine)) {
        masses_[level][at(carrier.node)] += carrier.weight * mass;
      }
    }
  }
}

template <typename Real>
bool NodeLoads<Real>::takeTimeStep(const InertialTerm* inertia, const WholeLevels<Real>& on) {
  if (inertia == nullptr && !is_in_step_) return false;
  is_in_step_ = inertia != nullptr;
  scale_ = is_in_step_ ? inertia->elastic_scale : 1.0;
  double spacing = on.spacing;
  for (std::size_t level = 0; level < on.levels.size(); ++level, spacing *= 2.0) {
    Numbers<Real> stiffness;
    const double unit = scale_ * on.modulus * spacing;
    for (std::size_t i = 0; is_in_step_ && i < masses_[level].size(); ++i) {
      stiffness.push_back(static_cast<Real>(inertia->per_mass * masses_[level][i] / unit));
    }
    on.levels[level].setInertia(std::move(stiffness));
  }
  const bool damps = is_in_step_ && inertia->dampsStrain();
  if (damps) findRateFrom(*inertia, on);
  for (std::size_t level = 0; level < on.levels.size(); ++level) {
    const double share = damps ? inertia->viscosity() / inertia->elastic_scale : 0.0;
    if (damps || damps_) on.levels[level].setViscosity(share, rate_from_[level]);
  }
  damps_ = damps;
  if (is_in_step_) {
    findLoadOfStep(*inertia, on);
  } else {
    on.levels.front().clearRightHandSide();
  }
  if (!onFinest().front().empty()) on.levels.front().right_hand_side = onFinest();
  return true;
}

// Coarse levels have the shape as the solver restricts it.
template <typename Real>
void NodeLoads<Real>::findRateFrom(const InertialTerm& inertia, const WholeLevels<Real>& on) {
  rate_from_.resize(on.levels.size());
  for (std::size_t level = 0; level < on.levels.size(); ++level) {
    for (auto& values : rate_from_[level]) values.assign(at(on.levels[level].count()), Real(0));
  }
  for (std::size_t node = 0; node < on.entries.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      rate_from_.front()[at(axis)][at(on.entries[node])] =
          static_cast<Real>(inertia.rate_from[node][axis] / on.spacing);
    }
  }
  for (std::size_t level = 1; level < on.levels.size(); ++level) {
    on.transfers[level - 1].restrictDisplacement(
        rate_from_[level - 1], on.levels[level].part().covered, rate_from_[level]);
  }
}

template <typename Real>
void NodeLoads<Real>::findLoadOfStep(const InertialTerm& inertia, const WholeLevels<Real>& on) {
  const double unit = scale_ * on.modulus * on.spacing * on.spacing;
  for (auto& values : load_of_step_) values.assign(at(on.levels.front().count()), Real(0));
  for (std::size_t node = 0; node < on.entries.size(); ++node) {
    const Vec3 force = inertia.force[node] / unit;
    for (int axis = 0; axis < 3; ++axis) {
      Real& load = load_of_step_[at(axis)][at(on.entries[node])];
      load = static_cast<Real>(force[axis]);
      if (!weight_.front().empty()) {
        load += weight_[at(axis)][at(on.entries[node])] / static_cast<Real>(scale_);
      }
    }
  }
  if (!damps_) return;
  const Field<Real> viscous = on.levels.front().viscousForces(rate_from_.front());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t entry = 0; entry < viscous[axis].size(); ++entry) {
      load_of_step_[axis][entry] -= viscous[axis][entry];
    }
  }
}

template class NodeLoads<float>;
template class NodeLoads<double>;

}  // namespace robot_tissue
