#include "robot_tissue/core/loading_patch.h"

#include <algorithm>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"

namespace robot_tissue {
namespace {

const RimSpring* rimSpringOf(const LoadingPatch& patch, int node) {
  const auto found =
      std::lower_bound(patch.rim.begin(), patch.rim.end(), node,
                       [](const RimSpring& spring, int other) { return spring.node < other; });
  return found != patch.rim.end() && found->node == node ? &*found : nullptr;
}

// From the node to its anchor (m). Along a free axis the stiffness is zero.
Vec3 stretch(const RimSpring& spring, const std::vector<Vec3>& displacement) {
  return spring.anchor - displacement[at(spring.node)];
}

}  // namespace

bool byForce(const LoadingPatch& patch) { return patch.drive == LoadingPatch::Drive::kForce; }

bool holds(const LoadingPatch& patch, std::size_t axis) {
  return byForce(patch) || !patch.free_axis[axis];
}

std::vector<int> hardNodes(const LoadingPatch& patch) {
  std::vector<int> hard;
  for (const int node : patch.nodes) {
    if (rimSpringOf(patch, node) == nullptr) hard.push_back(node);
  }
  return hard;
}

std::vector<Vec3> ownDisplacement(const LoadingPatch& patch,
                                  const std::vector<Vec3>& displacement) {
  std::vector<Vec3> own;
  for (const int node : patch.nodes) {
    own.push_back(displacement[at(node)]);
    const RimSpring* spring = rimSpringOf(patch, node);
    if (spring == nullptr) continue;
    for (int axis = 0; axis < 3; ++axis) {
      if (holds(patch, at(axis))) own.back()[axis] = spring->anchor[axis];
    }
  }
  return own;
}

// Mean as the first node's plus the mean difference to it: exact for a patch that moved as one.
Vec3 meanDisplacement(const LoadingPatch& patch, const std::vector<Vec3>& displacement) {
  if (patch.nodes.empty()) return Vec3::Zero();
  const std::vector<Vec3> own = ownDisplacement(patch, displacement);
  Vec3 difference = Vec3::Zero();
  for (const Vec3& moved : own) difference += moved - own.front();
  return own.front() + difference / static_cast<double>(own.size());
}

Eigen::Matrix3d stiffnessOf(const LoadingPatch& patch, const RimSpring& spring) {
  const Eigen::Matrix3d& turned = patch.place.rotation;
  return turned * spring.stiffness.asDiagonal() * turned.transpose();
}

void addRimForces(const LoadingPatch& patch, const std::vector<Vec3>& displacement,
                  std::vector<Vec3>& forces) {
  for (const RimSpring& spring : patch.rim) {
    forces[at(spring.node)] += stiffnessOf(patch, spring) * stretch(spring, displacement);
  }
}

double rimEnergy(const LoadingPatch& patch, const std::vector<Vec3>& displacement) {
  double energy = 0.0;
  for (const RimSpring& spring : patch.rim) {
    const Vec3 stretched = stretch(spring, displacement);
    energy += 0.5 * stretched.dot(stiffnessOf(patch, spring) * stretched);
  }
  return energy;
}

void movePatch(const Lattice& lattice, LoadingPatch& patch, const Vec3& translation,
               const Vec3& turn, LatticeState& state) {
  const Vec3 center = patch.center + patch.place.displacement;
  const double angle = turn.norm();
  const bool turns = angle > 0.0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  if (turns) rotation = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  const auto move = [&](int node, Vec3& displacement) {
    if (turns) {
      const Vec3 arm = restPosition(lattice, *state.cells, node) + displacement - center;
      displacement += rotation * arm - arm;
    }
    displacement += translation;
  };
  for (const int node : hardNodes(patch)) move(node, state.displacement[at(node)]);
  for (RimSpring& spring : patch.rim) move(spring.node, spring.anchor);
  patch.place.displacement += translation;
  if (turns) patch.place.rotation = rotation * patch.place.rotation;
}

void addContactForces(const LoadingPatch& patch, const std::vector<Vec3>& displacement,
                      std::vector<Vec3>& forces) {
  for (const ContactSpring& spring : patch.contacts) {
    const Vec3 force = forceOf(spring, displacement);
    if (force.isZero(0.0)) continue;
    for (const NodeWeight& carrier : spring.carriers) {
      forces[at(carrier.node)] += carrier.weight * force;
    }
  }
}

double contactEnergy(const LoadingPatch& patch, const std::vector<Vec3>& displacement) {
  double energy = 0.0;
  for (const ContactSpring& spring : patch.contacts) energy += energyOf(spring, displacement);
  return energy;
}

std::vector<Vec3> onHardNodes(const LoadingPatch& patch, const std::vector<Vec3>& forces) {
  std::vector<Vec3> on_hard_nodes;
  for (const int node : hardNodes(patch)) on_hard_nodes.push_back(forces[at(node)]);
  return on_hard_nodes;
}

PatchAnswer answerOf(const Lattice& lattice, const LatticeState& state, const LoadingPatch& patch,
                     const std::vector<Vec3>& on_hard_nodes) {
  PatchAnswer answer;
  const std::vector<Vec3>& displacement = state.displacement;
  answer.displacement = meanDisplacement(patch, displacement);
  const auto add = [&](const Vec3& point, Vec3 force) {
    for (int axis = 0; axis < 3; ++axis) {
      if (!holds(patch, at(axis))) force[axis] = 0.0;
    }
    answer.force += force;
    answer.torque += point.cross(force);
  };
  const auto position = [&](int node) -> Vec3 {
    return restPosition(lattice, *state.cells, node) + displacement[at(node)];
  };
  const std::vector<int> hard = hardNodes(patch);
  for (std::size_t i = 0; i < hard.size(); ++i) add(position(hard[i]), -on_hard_nodes[i]);
  for (const RimSpring& spring : patch.rim) {
    add(position(spring.node), stiffnessOf(patch, spring) * stretch(spring, displacement));
  }
  for (const ContactSpring& spring : patch.contacts) {
    add(pointOf(spring, displacement), forceOf(spring, displacement));
  }
  return answer;
}

}  // namespace robot_tissue
