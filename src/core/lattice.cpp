#include "robot_tissue/core/lattice.h"

#include <cmath>
#include <sstream>

#include "robot_tissue/core/material.h"

namespace robot_tissue {
namespace {

Grid makeGrid(const Box& shape, double spacing) {
  const Vec3 extent = shape.max - shape.min;
  if (!spacingFits(extent, spacing)) {
    std::ostringstream line;
    line << "tissue.spacing: " << spacing << ": the shape is " << extent.x() << " x " << extent.y()
         << " x " << extent.z() << " m; allowed: a whole number of spacings along each axis";
    throw InputError(line.str());
  }
  return Grid(shape, spacing);
}

// What the four cells round a spring give it: moduli add up, E h / 4 a cell, so that a bar of any
// cross section has the stiffness E A / L; a spring constant is the paper's, the same on a face.
class SpringStiffness {
 public:
  void add(const Material& material, double spacing) {
    if (material.spring_stiffness) {
      sum_ += *material.spring_stiffness;
      ++constants_;
    } else {
      sum_ += material.young_modulus * spacing / 4.0;
    }
  }
  double value() const { return constants_ > 0 ? sum_ / constants_ : sum_; }

 private:
  double sum_ = 0.0;
  int constants_ = 0;
};

}  // namespace

const char* toString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kOk:
      return "OK";
    case SolveStatus::kLate:
      return "LATE";
    case SolveStatus::kUnconverged:
      return "UNCONVERGED";
    case SolveStatus::kInverted:
      return "INVERTED";
  }
  return "UNCONVERGED";
}

Lattice::Lattice(const TissueConfig& config) : grid_(makeGrid(config.shape, config.spacing)) {
  const auto count = static_cast<std::size_t>(size()[0]) * static_cast<std::size_t>(size()[1]) *
                     static_cast<std::size_t>(size()[2]);
  fixed_.assign(count, 0);
  mass_.assign(count, 0.0);
  buildSprings(config);
  for (std::size_t box = 0; box < config.fixed.size(); ++box) {
    const std::vector<int> nodes = nodesIn(config.fixed[box]);
    if (nodes.empty()) {
      throw InputError("tissue.fixed[" + std::to_string(box) +
                       "]: no node in this box; allowed: a box that holds one node or more");
    }
    for (const int node : nodes) fixed_[static_cast<std::size_t>(node)] = 1;
  }
}

void Lattice::buildSprings(const TissueConfig& config) {
  std::array<int, kNeighbors> none{};
  none.fill(-1);
  springs_of_node_.assign(fixed_.size(), none);
  std::vector<SpringStiffness> stiffness;
  for (int node = 0; node < nodeCount(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      auto index = gridIndex(node);
      if (++index[static_cast<std::size_t>(axis)] == size()[static_cast<std::size_t>(axis)])
        continue;
      const int upper = this->node(index[0], index[1], index[2]);
      const int spring = static_cast<int>(springs_.size());
      springs_.push_back({node, upper, axis, 0.0});
      springs_of_node_[static_cast<std::size_t>(node)][static_cast<std::size_t>(2 * axis + 1)] =
          spring;
      springs_of_node_[static_cast<std::size_t>(upper)][static_cast<std::size_t>(2 * axis)] =
          spring;
    }
  }
  stiffness.resize(springs_.size());
  const double corner_volume = std::pow(spacing(), 3) / 8.0;
  for (int k = 0; k + 1 < size()[2]; ++k) {
    for (int j = 0; j + 1 < size()[1]; ++j) {
      for (int i = 0; i + 1 < size()[0]; ++i) {
        const Material& material =
            materialAt(config, restPosition(node(i, j, k)) + Vec3::Constant(0.5 * spacing()));
        for (int corner = 0; corner < 8; ++corner) {
          const int at = node(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
          mass_[static_cast<std::size_t>(at)] += material.density * corner_volume;
          for (int axis = 0; axis < 3; ++axis) {
            if (corner >> axis & 1) continue;
            const int spring = springOf(at, 2 * axis + 1);
            stiffness[static_cast<std::size_t>(spring)].add(material, spacing());
          }
        }
      }
    }
  }
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    springs_[spring].stiffness = stiffness[spring].value();
  }
}

std::array<int, 3> Lattice::gridIndex(int node) const {
  const int row = node / size()[0];
  return {node % size()[0], row % size()[1], row / size()[1]};
}

Vec3 Lattice::restPosition(int node) const {
  const auto index = gridIndex(node);
  return grid_.shape().min + spacing() * Vec3(index[0], index[1], index[2]);
}

int Lattice::neighbor(int node, int direction) const {
  const int spring = springOf(node, direction);
  if (spring < 0) return -1;
  const Spring& joined = springs_[static_cast<std::size_t>(spring)];
  return direction % 2 == 1 ? joined.b : joined.a;
}

std::vector<int> Lattice::nodesIn(const Box& box) const {
  const NodeRange range = grid_.nodesIn(box);
  std::vector<int> nodes;
  for (int k = range.first[2]; k <= range.last[2]; ++k) {
    for (int j = range.first[1]; j <= range.last[1]; ++j) {
      for (int i = range.first[0]; i <= range.last[0]; ++i) nodes.push_back(node(i, j, k));
    }
  }
  return nodes;
}

LatticeState Lattice::restState() const {
  LatticeState state;
  state.displacement.assign(fixed_.size(), Vec3::Zero());
  state.severed.assign(springs_.size(), 0);
  return state;
}

}  // namespace robot_tissue
