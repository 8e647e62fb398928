#include "solvers/multigrid/level/woodbury_update.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace robot_tissue {
namespace {

int leastNode(const WoodburyUpdate::Spring& spring) {
  int least = spring.parts.front().node;
  for (const WoodburyUpdate::Part& part : spring.parts) least = std::min(least, part.node);
  return least;
}

}  // namespace

void WoodburyUpdate::join(std::vector<Spring> springs,
                          const std::vector<Eigen::Matrix3d>& inverses) {
  if (springs.empty() && springs_.empty()) return;
  springs_ = std::move(springs);
  std::stable_sort(springs_.begin(), springs_.end(),
                   [](const Spring& a, const Spring& b) { return leastNode(a) < leastNode(b); });
  for (std::vector<int>& springs_there : springs_at_) springs_there.clear();
  springs_at_.resize(inverses.size());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (const Part& part : springs_[spring].parts) {
      springs_at_[at(part.node)].push_back(static_cast<int>(spring));
    }
  }
  std::vector<int> of_springs = envelopeOfSprings(), of_nodes = envelopeOfNodes();
  by_nodes_ = SkylineCholesky::workOf(of_nodes) < SkylineCholesky::workOf(of_springs);
  matrix_.reset(std::move(by_nodes_ ? of_nodes : of_springs));
  columns_.resize(springs_.size());
  if (by_nodes_) {
    fillForNodes(inverses);
  } else {
    fillForSprings(inverses);
  }
  matrix_.factorize();
}

std::vector<int> WoodburyUpdate::envelopeOfSprings() const {
  std::vector<int> first;
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    first.push_back(static_cast<int>(spring));
    for (const Part& part : springs_[spring].parts) {
      first.back() = std::min(first.back(), springs_at_[at(part.node)].front());
    }
  }
  return first;
}

// Three rows a node, in the order of the nodes.
std::vector<int> WoodburyUpdate::envelopeOfNodes() {
  joined_.clear();
  row_of_.assign(springs_at_.size(), -1);
  std::vector<int> first;
  for (std::size_t node = 0; node < springs_at_.size(); ++node) {
    if (springs_at_[node].empty()) continue;
    row_of_[node] = 3 * static_cast<int>(joined_.size());
    joined_.push_back(static_cast<int>(node));
    first.insert(first.end(), 3, row_of_[node]);
  }
  for (const Spring& spring : springs_) {
    const int least = row_of_[at(leastNode(spring))];
    for (const Part& part : spring.parts) {
      const auto row = first.begin() + row_of_[at(part.node)];
      std::fill(row, row + 3, std::min(*row, least));
    }
  }
  return first;
}

void WoodburyUpdate::fillForSprings(const std::vector<Eigen::Matrix3d>& inverses) {
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    columns_[spring].clear();
    for (const Part& part : springs_[spring].parts) {
      columns_[spring].push_back(inverses[at(part.node)] * part.along);
    }
    const int row = static_cast<int>(spring);
    double* values = matrix_.rowOf(row);
    values[row] = 1.0 / springs_[spring].stiffness;
    for (const Part& part : springs_[spring].parts) {
      for (const int other : springs_at_[at(part.node)]) {
        if (other > row) break;
        const std::vector<Part>& theirs = springs_[at(other)].parts;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
          if (theirs[i].node != part.node) continue;
          values[other] += part.along.dot(columns_[at(other)][i]);
        }
      }
    }
  }
}

void WoodburyUpdate::fillForNodes(const std::vector<Eigen::Matrix3d>& inverses) {
  roots_.clear();
  for (const int node : joined_) {
    roots_.emplace_back(inverses[at(node)].llt().matrixL());
    for (int axis = 0; axis < 3; ++axis) {
      const int row = row_of_[at(node)] + axis;
      matrix_.rowOf(row)[row] = 1.0;
    }
  }
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const std::vector<Part>& parts = springs_[spring].parts;
    columns_[spring].clear();
    for (const Part& part : parts) {
      const Eigen::Matrix3d& root = roots_[at(row_of_[at(part.node)] / 3)];
      columns_[spring].push_back(root.transpose() * part.along);
    }
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Vec3 stiff = springs_[spring].stiffness * columns_[spring][i];
      const int row = row_of_[at(parts[i].node)];
      for (int a = 0; a < 3; ++a) {
        double* values = matrix_.rowOf(row + a);
        for (std::size_t j = 0; j < parts.size(); ++j) {
          const int column = row_of_[at(parts[j].node)];
          for (int b = 0; b < 3 && column + b <= row + a; ++b) {
            values[column + b] += stiff[a] * columns_[spring][j][b];
          }
        }
      }
    }
  }
}

double WoodburyUpdate::lengthening(const Spring& spring, const std::vector<Vec3>& motions) const {
  double along = 0.0;
  for (const Part& part : spring.parts) along += part.along.dot(motions[at(part.node)]);
  return along;
}

void WoodburyUpdate::apply(std::vector<Vec3>& motions) const {
  if (by_nodes_) {
    applyByNodes(motions);
  } else {
    applyBySprings(motions);
  }
}

void WoodburyUpdate::applyBySprings(std::vector<Vec3>& motions) const {
  unknowns_.resize(matrix_.rows());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    unknowns_[static_cast<int>(spring)] = lengthening(springs_[spring], motions);
  }
  matrix_.solve(unknowns_);
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (std::size_t i = 0; i < springs_[spring].parts.size(); ++i) {
      motions[at(springs_[spring].parts[i].node)] -=
          unknowns_[static_cast<int>(spring)] * columns_[spring][i];
    }
  }
}

void WoodburyUpdate::applyByNodes(std::vector<Vec3>& motions) const {
  unknowns_.setZero(matrix_.rows());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const double force = springs_[spring].stiffness * lengthening(springs_[spring], motions);
    for (std::size_t i = 0; i < springs_[spring].parts.size(); ++i) {
      unknowns_.segment<3>(row_of_[at(springs_[spring].parts[i].node)]) +=
          force * columns_[spring][i];
    }
  }
  matrix_.solve(unknowns_);
  for (std::size_t i = 0; i < joined_.size(); ++i) {
    motions[at(joined_[i])] -= roots_[i] * unknowns_.segment<3>(3 * static_cast<int>(i));
  }
}

void WoodburyUpdate::addForces(const std::vector<Vec3>& motions, std::vector<Vec3>& forces) const {
  for (const Spring& spring : springs_) {
    const double along = lengthening(spring, motions);
    for (const Part& part : spring.parts) {
      forces[at(part.node)] += spring.stiffness * along * part.along;
    }
  }
}

}  // namespace robot_tissue
