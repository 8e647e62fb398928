#include "material/elastic_model.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "config/material.h"
#include "material/cell_modes.h"
#include "material/elastic_law.h"
#include "material/reached_displacements.h"
#include "membrane/membrane.h"

namespace robot_tissue {
namespace {

void addGradients(const ElasticCell& shape, const Cell& cell, std::vector<Vec3>& forces) {
  const std::array<int, kMostReached> reached = reachedNodes(cell);
  for (int corner = 0; corner < shape.nodeCount(); ++corner) {
    if (reached[at(corner)] >= 0) forces[at(reached[at(corner)])] -= shape.gradient(corner);
  }
}

}  // namespace

ElasticModel::ElasticModel(const Lattice& lattice, const TissueConfig& config)
    : lattice_(lattice),
      moves_in_time_(config.time.has_value()),
      has_membranes_(!config.membranes.empty()) {
  const double corner_volume = std::pow(lattice.spacing(), 3) / kCorners;
  for (const Composition& composition : lattice.compositions()) {
    std::vector<std::pair<Moduli, double>> parts;
    for (const MaterialShare& part : composition) {
      parts.emplace_back(moduliOf(materialOf(config, part.region)), part.share);
    }
    const double corner_mass = densityOf(config, composition) * corner_volume;
    substances_.push_back({mixed(parts), corner_mass * config.gravity, corner_mass});
  }
}

// A cell that is filled in part answers in part.
Moduli ElasticModel::cellModuli(const Cell& cell) const {
  const Moduli& full = substanceOf(cell).moduli;
  const double share = cell.stiffnessShare();
  return {share * full.shear, share * full.bulk, full.stiffening};
}

Vec3 ElasticModel::cornerWeight(const Cell& cell, int corner) const {
  return cell.eighthsAt(corner) * substanceOf(cell).corner_weight;
}

double ElasticModel::cornerMass(const Cell& cell, int corner) const {
  return cell.eighthsAt(corner) * substanceOf(cell).corner_mass;
}

std::vector<double> ElasticModel::nodeMasses(const CellSet& cells) const {
  std::vector<double> masses(at(cells.nodeCount()), 0.0);
  for (const Cell& cell : cells.all()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      masses[at(cell.nodes[at(corner)])] += cornerMass(cell, corner);
    }
  }
  return masses;
}

int ElasticModel::cellsBeyondLaw(const LatticeState& state) const {
  const bool stiffens =
      std::any_of(substances_.begin(), substances_.end(),
                  [](const Substance& substance) { return substance.moduli.stiffening > 0.0; });
  if (!stiffens) return 0;
  const auto is_beyond = [&](const Cell& cell) {
    const Moduli moduli = cellModuli(cell);
    if (!(moduli.stiffening > 0.0)) return false;
    const ElasticCell shape(moduli, lattice_.spacing(), reachedOf(state.displacement, cell),
                            cell.fill.get(), cell.reach.get());
    return moduli.stiffening * shape.shapeStrain() > elastic_law::kMostExponent;
  };
  const std::vector<Cell>& cells = state.cells->all();
  return static_cast<int>(std::count_if(cells.begin(), cells.end(), is_beyond));
}

Moduli ElasticModel::stepModuli(const Cell& cell) const {
  const Moduli moduli = cellModuli(cell);
  if (inertia_ == nullptr || dampsStrain()) return moduli;
  return {inertia_->elastic_scale * moduli.shear, inertia_->elastic_scale * moduli.bulk,
          moduli.stiffening};
}

double ElasticModel::freeForceNorm(const LatticeState& state) const {
  const double pressed =
      membrane_ ? membrane_->pressureNorm(membrane_->ofNodes(state.displacement)) : 0.0;
  if (inertia_ == nullptr) return pressed;
  const std::vector<double> masses = nodeMasses(*state.cells);
  double squared = pressed * pressed;
  for (std::size_t node = 0; node < masses.size(); ++node) {
    const Vec3 held = inertia_->per_mass * masses[node] * state.displacement[node];
    squared += (inertia_->force[node] - held).squaredNorm();
  }
  return std::sqrt(squared);
}

ElasticCell ElasticModel::shaped(const LatticeState& state, const Cell& cell) const {
  ElasticCell shape(stepModuli(cell), lattice_.spacing(), reachedOf(state.displacement, cell),
                    cell.fill.get(), cell.reach.get());
  if (dampsStrain()) damp(cell, shape);
  return shape;
}

// On one of the cell's nodes (reachedNodes), at this displacement.
Vec3 ElasticModel::forceOf(const Cell& cell, const ElasticCell& shape, int corner,
                           const Vec3& displacement) const {
  if (corner >= kCorners) return -shape.gradient(corner);
  return cornerWeight(cell, corner) - shape.gradient(corner) -
         cornerInertia(cell, corner) * displacement;
}

Vec3 ElasticModel::nodeForce(const LatticeState& state, int node) const {
  const CellSet& cells = *state.cells;
  Vec3 force = inertialForce(node);
  cells.visitAround(node, [&](const CellSet::Meeting& met) {
    const Cell& cell = cells.all()[met.cell];
    const int corner = static_cast<int>(met.corner);
    force += forceOf(cell, shaped(state, cell), corner, state.displacement[at(node)]);
  });
  if (membrane_) force += membrane_->force(state.displacement, node);
  return force;
}

// A cell once, however many of the nodes it has. To the bit as nodeForce: a node's cells follow
// each other as their numbers do.
std::vector<Vec3> ElasticModel::forcesOn(const LatticeState& state,
                                         const std::vector<int>& nodes) const {
  const CellSet& cells = *state.cells;
  std::vector<Vec3> forces;
  std::vector<int> place_of(at(cells.nodeCount()), -1), around;
  for (const int node : nodes) {
    place_of[at(node)] = static_cast<int>(forces.size());
    forces.push_back(inertialForce(node));
    cells.visitAround(node, [&around](const CellSet::Meeting& met) {
      around.push_back(static_cast<int>(met.cell));
    });
  }
  std::sort(around.begin(), around.end());
  around.erase(std::unique(around.begin(), around.end()), around.end());
  for (const int number : around) {
    const Cell& cell = cells.all()[at(number)];
    const ElasticCell shape = shaped(state, cell);
    const std::array<int, kMostReached> reached = reachedNodes(cell);
    for (int corner = 0; corner < shape.nodeCount(); ++corner) {
      const int node = reached[at(corner)];
      if (node < 0 || place_of[at(node)] < 0) continue;
      forces[at(place_of[at(node)])] += forceOf(cell, shape, corner, state.displacement[at(node)]);
    }
  }
  for (std::size_t i = 0; membrane_ && i < nodes.size(); ++i) {
    forces[i] += membrane_->force(state.displacement, nodes[i]);
  }
  return forces;
}

Vec3 ElasticModel::weight(const LatticeState& state) const {
  Vec3 weight = Vec3::Zero();
  for (const Cell& cell : state.cells->all()) {
    weight += kCorners * cell.share() * substanceOf(cell).corner_weight;
  }
  return weight;
}

// The diagonal of ElasticCell::block at rest: h [mu / 3 + (K + mu / 3) / 16] along every axis; in a
// cell filled in part the greatest of the three.
CellHessian ElasticModel::stiffnessAtRest(const Cell& cell) const {
  ElasticCell::Reached at_rest;
  at_rest.fill(Vec3::Zero());
  return ElasticCell(cellModuli(cell), lattice_.spacing(), at_rest, cell.fill.get(),
                     cell.reach.get())
      .hessian();
}

double ElasticModel::stiffnessAtRest(const CellSet& cells, int node) const {
  double stiffness = 0.0;
  cells.visitAround(node, [&](const CellSet::Meeting& met) {
    const Cell& cell = cells.all()[met.cell];
    const Moduli moduli = cellModuli(cell);
    const double third = moduli.shear / 3.0;
    double invariant = 1.0 / 3.0, widest = 1.0 / 16.0;
    if (cell.fill != nullptr) {
      const FillLaw law = fillLaw(*cell.fill, moduli.bulk / moduli.shear);
      const CornerSlopes slopes = cornerSlopes(*cell.fill, cell.reach.get())[met.corner];
      invariant = invariantBetween(law, slopes, slopes);
      widest = slopes.strain.cwiseAbs2().maxCoeff();
    }
    stiffness += lattice_.spacing() * (moduli.shear * invariant + (moduli.bulk + third) * widest);
  });
  if (membrane_) stiffness += membrane_->restStiffness(node);
  return stiffness;
}

Vec3 ElasticModel::nodeStiffness(const LatticeState& state, int node) const {
  if (node_stiffness_of_ != state.cells) {
    node_stiffness_of_ = state.cells;
    node_stiffness_.clearFor(at(state.cells->nodeCount()));
  }
  const double* known = node_stiffness_.find(node);
  if (known == nullptr) {
    const double found = stiffnessAtRest(*state.cells, node);
    known = &(node_stiffness_.add(node) = found);
  }
  return Vec3::Constant(*known);
}

Moduli ElasticModel::moduliAt(const LatticeState& state, int node) const {
  const CellSet& cells = *state.cells;
  Moduli sum;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    const Cell& cell = cells.all()[at(met.cell)];
    const Moduli& full = substanceOf(cell).moduli;
    const double eighths = cell.eighthsAt(static_cast<int>(met.corner));
    sum.shear += eighths * full.shear / 4.0;
    sum.bulk += eighths * full.bulk / 4.0;
  }
  return sum;
}

Eigen::Matrix3d ElasticModel::nodeBlock(const LatticeState& state, int node) const {
  const CellSet& cells = *state.cells;
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  cells.visitAround(node, [&](const CellSet::Meeting& met) {
    const Cell& cell = cells.all()[met.cell];
    block += shaped(state, cell).block(static_cast<int>(met.corner));
    block.diagonal().array() += cornerInertia(cell, static_cast<int>(met.corner));
  });
  return block;
}

double ElasticModel::energy(const LatticeState& state) const {
  double energy = 0.0;
  for (const Cell& cell : state.cells->all()) {
    energy += shaped(state, cell).energy();
    for (int corner = 0; corner < kCorners; ++corner) {
      const Vec3& moved = state.displacement[at(cell.nodes[at(corner)])];
      energy += 0.5 * cornerInertia(cell, corner) * moved.squaredNorm() -
                cornerWeight(cell, corner).dot(moved);
    }
  }
  if (membrane_) energy += membrane_->energy(membrane_->ofNodes(state.displacement));
  if (inertia_ == nullptr) return energy;
  for (std::size_t node = 0; node < inertia_->force.size(); ++node) {
    energy -= inertia_->force[node].dot(state.displacement[node]);
  }
  return energy;
}

std::vector<Vec3> ElasticModel::nodeForces(const LatticeState& state) const {
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  if (inertia_ != nullptr) forces = inertia_->force;
  for (const Cell& cell : state.cells->all()) {
    const ElasticCell shape = shaped(state, cell);
    const std::array<int, kMostReached> reached = reachedNodes(cell);
    for (int corner = 0; corner < shape.nodeCount(); ++corner) {
      if (reached[at(corner)] < 0) continue;
      const std::size_t node = at(reached[at(corner)]);
      forces[node] += forceOf(cell, shape, corner, state.displacement[node]);
    }
  }
  if (!membrane_) return forces;
  const std::vector<Vec3> of_membrane = membrane_->forces(membrane_->ofNodes(state.displacement));
  for (std::size_t i = 0; i < of_membrane.size(); ++i) {
    forces[at(membrane_->nodes()[i])] += of_membrane[i];
  }
  return forces;
}

std::vector<Vec3> ElasticModel::cellForces(const LatticeState& state) const {
  std::vector<Vec3> forces(state.displacement.size(), Vec3::Zero());
  std::vector<int> all(state.cells->all().size());
  std::iota(all.begin(), all.end(), 0);
  addElasticForces(state, all, forces);
  return forces;
}

NodeBalance ElasticModel::nodeBalance(const LatticeState& state, int node) const {
  const CellSet& cells = *state.cells;
  NodeBalance balance;
  balance.force = inertialForce(node);
  const CellSet::Meetings around = cells.meetings(node);
  for (auto first = around.begin(); first != around.end();) {
    const auto end = std::min(around.end(), first + CellModes::kMost);
    CellModes modes(lattice_.spacing());
    for (auto met = first; met != end; ++met) {
      const Cell& cell = cells.all()[at(met->cell)];
      const int corner = static_cast<int>(met->corner);
      const double inertia = cornerInertia(cell, corner);
      balance.force += cornerWeight(cell, corner) - inertia * state.displacement[at(node)];
      balance.block.diagonal().array() += inertia;
      modes.add(stepModuli(cell), cell.nodes, corner, state.displacement, cell.fill == nullptr);
    }
    modes.solve();
    balance.force -= modes.gradient();
    balance.block += modes.block();
    for (auto met = first; met != end; ++met) {
      if (!modes.suffices(static_cast<int>(met - first))) addShaped(state, *met, balance);
    }
    first = end;
  }
  for (const CellSet::Meeting& met : cells.reaching(node)) {
    addShaped(state, met, balance);
  }
  return balance;
}

void ElasticModel::addShaped(const LatticeState& state, const CellSet::Meeting& met,
                             NodeBalance& balance) const {
  const ElasticCell shape = shaped(state, state.cells->all()[met.cell]);
  balance.force -= shape.gradient(static_cast<int>(met.corner));
  balance.block += shape.block(static_cast<int>(met.corner));
}

void ElasticModel::addForces(const LatticeState& state, const std::vector<int>& cells,
                             std::vector<Vec3>& forces) const {
  for (std::size_t first = 0; first < cells.size(); first += CellModes::kMost) {
    const std::size_t end = std::min(cells.size(), first + CellModes::kMost);
    CellModes modes(lattice_.spacing());
    for (std::size_t i = first; i < end; ++i) {
      const Cell& cell = state.cells->all()[at(cells[i])];
      modes.add(stepModuli(cell), cell.nodes, 0, state.displacement, cell.fill == nullptr);
    }
    modes.solve();
    modes.findGradients();
    for (std::size_t i = first; i < end; ++i) {
      const Cell& cell = state.cells->all()[at(cells[i])];
      const int lane = static_cast<int>(i - first);
      for (int corner = 0; corner < kCorners; ++corner) {
        const std::size_t node = at(cell.nodes[at(corner)]);
        forces[node] += cornerWeight(cell, corner) - modes.gradient(lane, corner) -
                        cornerInertia(cell, corner) * state.displacement[node];
      }
      if (!modes.suffices(lane)) addGradients(shaped(state, cell), cell, forces);
    }
  }
}

void ElasticModel::addElasticForces(const LatticeState& state, const std::vector<int>& cells,
                                    std::vector<Vec3>& forces) const {
  for (const int index : cells) {
    const Cell& cell = state.cells->all()[at(index)];
    addGradients(
        ElasticCell(cellModuli(cell), lattice_.spacing(), reachedOf(state.displacement, cell),
                    cell.fill.get(), cell.reach.get()),
        cell, forces);
  }
}

void ElasticModel::visitHessians(const LatticeState& state, const VisitHessian& visit) const {
  for (const Cell& cell : state.cells->all()) {
    CellHessian hessian = shaped(state, cell).hessian();
    addInertia(cell, hessian);
    visit(reachedNodes(cell), hessian);
  }
}

}  // namespace robot_tissue
