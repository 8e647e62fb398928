#include "material/six_spring_model.h"

namespace robot_tissue {
namespace {

// Of the spacing (1): two nodes that are closer have no direction of their own, and push along the
// spring's at rest. Rounding.
constexpr double kShortest = 1e-9;

}  // namespace

SixSpringModel::SixSpringModel(const Lattice& lattice, const Vec3& gravity)
    : lattice_(lattice), gravity_(gravity) {
  stiffness_.reserve(lattice.springs().size());
  for (const Spring spring : lattice.springs()) {
    stiffness_.push_back(lattice.springStiffness(spring));
  }
  mass_.reserve(at(lattice.nodeCount()));
  for (int node = 0; node < lattice.nodeCount(); ++node) mass_.push_back(lattice.mass(node));
}

// Force of one spring on the node: F = -k x (paper, section 4.3), x = length - rest length, along
// the spring; a stretched spring pulls the node towards its neighbor.
Vec3 SixSpringModel::springForce(const LatticeState& state, int node, int direction) const {
  const int index = lattice_.springOf(node, direction);
  if (index < 0 || state.severed[static_cast<std::size_t>(index)] != 0) return Vec3::Zero();
  const double stiffness = stiffness_[at(index)];
  const bool upwards = direction % 2 == 1;
  const int other = lattice_.neighbor(node, direction);
  const double rest_length = lattice_.spacing();
  Vec3 rest = Vec3::Zero();
  rest[direction / 2] = upwards ? rest_length : -rest_length;
  const Vec3 to_other = rest + (state.displacement[static_cast<std::size_t>(other)] -
                                state.displacement[static_cast<std::size_t>(node)]);
  const double length = to_other.norm();
  if (length < kShortest * rest_length) return -stiffness * rest;
  return stiffness * (length - rest_length) / length * to_other;
}

// Springs of one axis are added first, so that the sum is the same in the lattice's mirror image,
// to the last bit.
Vec3 SixSpringModel::nodeForce(const LatticeState& state, int node) const {
  const Vec3 along_x = springForce(state, node, 0) + springForce(state, node, 1);
  const Vec3 along_y = springForce(state, node, 2) + springForce(state, node, 3);
  const Vec3 along_z = springForce(state, node, 4) + springForce(state, node, 5);
  return (along_x + along_y) + along_z + nodeWeight(state, node);
}

Vec3 SixSpringModel::nodeWeight(const LatticeState& state, int node) const {
  return shareLeft(state, node) * mass_[at(node)] * gravity_;
}

Vec3 SixSpringModel::weight(const LatticeState& state) const {
  Vec3 weight = Vec3::Zero();
  for (int node = 0; node < lattice_.nodeCount(); ++node) weight += nodeWeight(state, node);
  return weight;
}

Vec3 SixSpringModel::nodeStiffness(const LatticeState& state, int node) const {
  Vec3 stiffness = Vec3::Zero();
  for (int direction = 0; direction < kNeighbors; ++direction) {
    const int index = lattice_.springOf(node, direction);
    if (index < 0 || state.severed[static_cast<std::size_t>(index)] != 0) continue;
    stiffness[direction / 2] += stiffness_[at(index)];
  }
  return stiffness;
}

}  // namespace robot_tissue
