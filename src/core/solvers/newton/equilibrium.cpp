#include "solvers/newton/equilibrium.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "membrane/membrane.h"

namespace robot_tissue {
namespace {

using Share = DofMap::Share;
using Shares = DofMap::Shares;

// The nearest matrix without a negative eigenvalue.
CellHessian positivePart(const CellHessian& hessian) {
  const Eigen::SelfAdjointEigenSolver<CellHessian> solver(hessian);
  if (solver.eigenvalues().minCoeff() >= 0.0) return hessian;
  const auto values = solver.eigenvalues().cwiseMax(0.0);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

class Assembly {
 public:
  Assembly(const EnergyModel& model, const DofMap& unknowns, const ConstrainedState& shape)
      : model_(model), unknowns_(unknowns), shape_(shape) {}

  TangentStiffness assemble(const std::vector<Vec3>& moved, bool convex) {
    TangentStiffness curvature;
    curvature.carried = Eigen::VectorXd::Zero(unknowns_.count());
    addCells(moved, convex, curvature.carried);
    if (model_.membrane() != nullptr) addMembrane(moved, convex, curvature.carried);
    for (std::size_t patch = 0; patch < shape_.patches.size(); ++patch) {
      for (const RimSpring& spring : shape_.patches[patch].rim) addSpring(patch, spring, convex);
      for (const ContactSpring& spring : shape_.patches[patch].contacts) addContact(spring);
      if (!convex) addTurnedForces(patch);
    }
    // An entry on every diagonal place, for what a method adds there.
    for (int unknown = 0; unknown < unknowns_.count(); ++unknown) {
      entries_.emplace_back(unknown, unknown, 0.0);
    }
    curvature.matrix.resize(unknowns_.count(), unknowns_.count());
    curvature.matrix.setFromTriplets(entries_.begin(), entries_.end());
    return curvature;
  }

 private:
  void add(const Share& row, const Share& column, double value) {
    if (row.unknown < column.unknown) return;
    entries_.emplace_back(row.unknown, column.unknown, row.weight * value * column.weight);
  }

  // `rows` and `columns` may share unknowns: each pair of them is met once.
  void add(const std::array<Shares, 3>& rows, const std::array<Shares, 3>& columns,
           const Eigen::Matrix3d& block) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        for (const Share& row : rows[at(i)]) {
          for (const Share& column : columns[at(j)]) add(row, column, block(i, j));
        }
      }
    }
  }

  std::array<Shares, 3> sharesOf(int node) const {
    return {unknowns_.sharesOf(shape_, node, 0), unknowns_.sharesOf(shape_, node, 1),
            unknowns_.sharesOf(shape_, node, 2)};
  }

  void addCells(const std::vector<Vec3>& moved, bool convex, Eigen::VectorXd& carried) {
    model_.visitHessians(shape_.state, [&](const auto& nodes, const CellHessian& exact) {
      const CellHessian hessian = convex ? positivePart(exact) : exact;
      const int count = static_cast<int>(hessian.rows()) / 3;
      std::array<std::array<Shares, 3>, kMostReached> shares;
      CellVector motion = CellVector::Zero(hessian.rows());
      for (int i = 0; i < count; ++i) {
        if (nodes[at(i)] < 0) continue;
        shares[at(i)] = sharesOf(nodes[at(i)]);
        motion.segment<3>(3 * i) = moved[at(nodes[at(i)])];
      }
      const CellVector force = hessian * motion;
      for (int i = 0; i < count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
          for (const Share& row : shares[at(i)][at(axis)]) {
            carried[row.unknown] += row.weight * force[3 * i + axis];
          }
        }
        for (int j = 0; j < count; ++j) {
          add(shares[at(i)], shares[at(j)], hessian.block<3, 3>(3 * i, 3 * j));
        }
      }
    });
  }

  void addMembrane(const std::vector<Vec3>& moved, bool convex, Eigen::VectorXd& carried) {
    const Membrane& membrane = *model_.membrane();
    NodeBlocks of_vertices = membrane.stiffnessPattern();
    membrane.findStiffness(membrane.ofNodes(shape_.state.displacement),
                           convex ? Curvature::kConvex : Curvature::kExact, of_vertices);
    const NodeBlocks stiffness = membrane.carriers().stiffness(of_vertices);
    const std::vector<Vec3> force = stiffness.times(membrane.ofNodes(moved));
    std::vector<std::array<Shares, 3>> shares;
    for (const int node : membrane.nodes()) shares.push_back(sharesOf(node));
    for (int row = 0; row < stiffness.rows(); ++row) {
      for (int i = stiffness.first(row); i < stiffness.last(row); ++i) {
        add(shares[at(row)], shares[at(stiffness.column(i))], stiffness.block(i));
      }
      for (int axis = 0; axis < 3; ++axis) {
        for (const Share& share : shares[at(row)][at(axis)]) {
          carried[share.unknown] += share.weight * force[at(row)][axis];
        }
      }
    }
  }

  // A rim spring: energy 1/2 (a - x).K(a - x) of the node's displacement x and the patch's end a.
  // As the patch moves and turns, a and K go with it as a point of the patch at the node does.
  void addSpring(std::size_t patch, const RimSpring& spring, bool convex) {
    const Eigen::Matrix3d stiffness = stiffnessOf(shape_.patches[patch], spring);
    const Vec3 position = unknowns_.position(shape_, spring.node);
    const std::array<Shares, 3> node = sharesOf(spring.node);
    std::array<Shares, 3> end;
    for (int axis = 0; axis < 3; ++axis) {
      end[at(axis)] = unknowns_.sharesOf(shape_, patch, position, axis);
    }
    add(node, node, stiffness);
    add(end, end, stiffness);
    add(node, end, -stiffness);
    add(end, node, -stiffness);
    if (convex) return;
    const Vec3 slope =
        -stiffness * (spring.anchor - shape_.state.displacement[at(spring.node)]);  // dE/dx
    addTurn(patch, position, slope);
    std::array<Shares, 3> translation, turn;
    for (int axis = 0; axis < 3; ++axis) {
      if (end[at(axis)].count > 0) translation[at(axis)].add(end[at(axis)].begin()->unknown, 1.0);
      const Share share = unknowns_.turnOf(patch, axis);
      if (share.unknown != DofMap::kHeld) turn[at(axis)].add(share.unknown, share.weight);
    }
    const Eigen::Matrix3d cross = crossMatrix(slope);
    add(turn, node, cross);
    add(node, turn, cross.transpose());
    add(turn, translation, -cross);
    add(translation, turn, -cross.transpose());
  }

  void addContact(const ContactSpring& spring) {
    const Eigen::Matrix3d stiffness = stiffnessOf(spring, shape_.state.displacement);
    for (const NodeWeight& row : spring.carriers) {
      for (const NodeWeight& column : spring.carriers) {
        add(sharesOf(row.node), sharesOf(column.node), row.weight * column.weight * stiffness);
      }
    }
  }

  // Hard nodes of a patch that turns: where a force acts at an arm r, its energy has a second
  // derivative in the turn, though the node's own is in the cells' (addTurn).
  void addTurnedForces(std::size_t patch) {
    if (unknowns_.turnOf(patch, 0).unknown == DofMap::kHeld) return;
    if (contact_forces_.empty()) {
      contact_forces_.assign(shape_.state.displacement.size(), Vec3::Zero());
      for (const LoadingPatch& other : shape_.patches) {
        addContactForces(other, shape_.state.displacement, contact_forces_);
      }
    }
    for (const int node : hardNodes(shape_.patches[patch])) {
      const Vec3 force = model_.nodeForce(shape_.state, node) + contact_forces_[at(node)];
      addTurn(patch, unknowns_.position(shape_, node), -force);
    }
  }

  // A turn w moves a point at arm r by w x r + w x (w x r) / 2 + ..., so an energy with the slope g
  // there gets the second-order term g.(w x (w x r)) / 2 = w.[(g r^T + r g^T) / 2 - g.r] w / 2.
  void addTurn(std::size_t patch, const Vec3& position, const Vec3& slope) {
    const Vec3 arm = position - centerOf(shape_.patches[patch]);
    Eigen::Matrix3d block = 0.5 * (slope * arm.transpose() + arm * slope.transpose());
    block.diagonal().array() -= slope.dot(arm);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Share row = unknowns_.turnOf(patch, i), column = unknowns_.turnOf(patch, j);
        if (row.unknown != DofMap::kHeld) add(row, column, block(i, j));
      }
    }
  }

  const EnergyModel& model_;
  const DofMap& unknowns_;
  const ConstrainedState& shape_;
  std::vector<Eigen::Triplet<double>> entries_;
  std::vector<Vec3> contact_forces_;  // per node (N), when asked for
};

}  // namespace

double potentialOf(const EnergyModel& model, const ConstrainedState& shape) {
  double potential = model.energy(shape.state);
  for (const LoadingPatch& patch : shape.patches) {
    potential += rimEnergy(patch, shape.state.displacement);
    potential += contactEnergy(patch, shape.state.displacement);
    if (byForce(patch)) potential -= patch.force.dot(patch.place.displacement);
  }
  return potential;
}

Balance balanceOf(const EnergyModel& model, const DofMap& unknowns, const ConstrainedState& shape) {
  Balance balance;
  balance.potential = potentialOf(model, shape);
  std::vector<Vec3> forces = model.nodeForces(shape.state);
  double held_squared = std::pow(unknowns.heldNorm(forces), 2);
  double pushed = 0.0;
  Eigen::VectorXd on_patches = Eigen::VectorXd::Zero(unknowns.count());
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const RimSpring& spring : patch.rim) {
      const Vec3& displacement = shape.state.displacement[at(spring.node)];
      const Vec3 pull = stiffnessOf(patch, spring) * (spring.anchor - displacement);
      forces[at(spring.node)] += pull;
      const Vec3 position = unknowns.position(shape, spring.node);
      for (int axis = 0; axis < 3; ++axis) {
        for (const Share& share : unknowns.sharesOf(shape, index, position, axis)) {
          on_patches[share.unknown] -= share.weight * pull[axis];
        }
      }
      if (!byForce(patch)) held_squared += pull.squaredNorm();
    }
    addContactForces(patch, shape.state.displacement, forces);
    for (const ContactSpring& spring : patch.contacts) {
      held_squared += forceOf(spring, shape.state.displacement).squaredNorm();
    }
    if (!byForce(patch)) continue;
    pushed = std::max(pushed, patch.force.norm());
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 center = centerOf(patch);
      on_patches[unknowns.sharesOf(shape, index, center, axis).begin()->unknown] +=
          patch.force[axis];
    }
  }
  balance.unbalanced = unknowns.gather(shape, forces) + on_patches;
  balance.holding = std::max({std::sqrt(held_squared), pushed, model.freeForceNorm(shape.state)});
  return balance;
}

TangentStiffness tangentStiffnessOf(const EnergyModel& model, const DofMap& unknowns,
                                    const ConstrainedState& shape, const std::vector<Vec3>& moved,
                                    bool convex) {
  return Assembly(model, unknowns, shape).assemble(moved, convex);
}

}  // namespace robot_tissue
