#include "robot_tissue/core/elastic_model.h"

#include <algorithm>

#include "robot_tissue/core/material.h"

namespace robot_tissue {

ElasticModel::ElasticModel(const Lattice& lattice, const TissueConfig& config)
    : lattice_(lattice), gravity_(config.gravity) {
  for (std::size_t axis = 0; axis < 3; ++axis) cells_[axis] = lattice.size()[axis] - 1;
  const Vec3 to_center = Vec3::Constant(0.5 * lattice.spacing());
  for (int k = 0; k < cells_[2]; ++k) {
    for (int j = 0; j < cells_[1]; ++j) {
      for (int i = 0; i < cells_[0]; ++i) {
        const Vec3 center = lattice.restPosition(lattice.node(i, j, k)) + to_center;
        const Material& material = materialAt(config, center);
        moduli_.push_back({shearModulus(material), bulkModulus(material)});
      }
    }
  }
}

ElasticModel::CellAt ElasticModel::cellAt(const CellIndex& index) const {
  const int number = index[0] + cells_[0] * (index[1] + cells_[1] * index[2]);
  return {moduli_[at(number)], cellCorners(lattice_, index[0], index[1], index[2])};
}

bool ElasticModel::isWhole(const LatticeState& state, const CellAt& cell) const {
  if (state.springs_cut == 0) return true;
  const auto parts = cellParts(lattice_, state, cell.corners);
  return std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; });
}

ElasticCell ElasticModel::shaped(const LatticeState& state, const CellAt& cell) const {
  ElasticCell::Corners displacement;
  for (int corner = 0; corner < kCorners; ++corner) {
    displacement[at(corner)] = state.displacement[at(cell.corners[at(corner)])];
  }
  return {cell.moduli, lattice_.spacing(), displacement};
}

template <typename Visit>
void ElasticModel::visitWholeCells(const LatticeState& state, const Visit& visit) const {
  for (int k = 0; k < cells_[2]; ++k) {
    for (int j = 0; j < cells_[1]; ++j) {
      for (int i = 0; i < cells_[0]; ++i) {
        const CellAt cell = cellAt({i, j, k});
        if (isWhole(state, cell)) visit(cell);
      }
    }
  }
}

template <typename Visit>
void ElasticModel::visitWholeCellsAt(const LatticeState& state, int node,
                                     const Visit& visit) const {
  const auto node_index = lattice_.gridIndex(node);
  for (int corner = 0; corner < kCorners; ++corner) {
    CellIndex index = node_index;
    bool exists = true;
    for (int axis = 0; axis < 3; ++axis) {
      index[at(axis)] -= corner >> axis & 1;
      exists = exists && index[at(axis)] >= 0 && index[at(axis)] < cells_[at(axis)];
    }
    if (!exists) continue;
    const CellAt cell = cellAt(index);
    if (isWhole(state, cell)) visit(cell, corner);
  }
}

Vec3 ElasticModel::nodeForce(const LatticeState& state, int node) const {
  Vec3 force = Vec3::Zero();
  bool loose = true;
  visitWholeCellsAt(state, node, [&](const CellAt& cell, int corner) {
    force -= shaped(state, cell).gradient(corner);
    loose = false;
  });
  if (loose) return Vec3::Zero();
  return force + lattice_.mass(node) * gravity_;
}

// The diagonal of ElasticCell::block at rest: h [mu / 3 + (K + mu / 3) / 16] along every axis.
Vec3 ElasticModel::nodeStiffness(const LatticeState& state, int node) const {
  double stiffness = 0.0;
  visitWholeCellsAt(state, node, [&](const CellAt& cell, int) {
    const double third = cell.moduli.shear / 3.0;
    stiffness += lattice_.spacing() * (third + (cell.moduli.bulk + third) / 16.0);
  });
  return Vec3::Constant(stiffness);
}

Eigen::Matrix3d ElasticModel::nodeBlock(const LatticeState& state, int node) const {
  Eigen::Matrix3d block = Eigen::Matrix3d::Zero();
  visitWholeCellsAt(state, node, [&](const CellAt& cell, int corner) {
    block += shaped(state, cell).block(corner);
  });
  return block;
}

double ElasticModel::energy(const LatticeState& state) const {
  double energy = 0.0;
  std::vector<char> held(at(lattice_.nodeCount()), 0);
  visitWholeCells(state, [&](const CellAt& cell) {
    energy += shaped(state, cell).energy();
    for (const int node : cell.corners) held[at(node)] = 1;
  });
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    if (held[at(node)] == 0) continue;
    energy -= lattice_.mass(node) * gravity_.dot(state.displacement[at(node)]);
  }
  return energy;
}

std::vector<Vec3> ElasticModel::nodeForces(const LatticeState& state) const {
  std::vector<Vec3> forces(at(lattice_.nodeCount()), Vec3::Zero());
  std::vector<char> held(forces.size(), 0);
  visitWholeCells(state, [&](const CellAt& cell) {
    const ElasticCell shape = shaped(state, cell);
    for (int corner = 0; corner < kCorners; ++corner) {
      const int node = cell.corners[at(corner)];
      forces[at(node)] -= shape.gradient(corner);
      held[at(node)] = 1;
    }
  });
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    if (held[at(node)] != 0) forces[at(node)] += lattice_.mass(node) * gravity_;
  }
  return forces;
}

void ElasticModel::visitHessians(const LatticeState& state, const VisitHessian& visit) const {
  visitWholeCells(state,
                  [&](const CellAt& cell) { visit(cell.corners, shaped(state, cell).hessian()); });
}

}  // namespace robot_tissue
