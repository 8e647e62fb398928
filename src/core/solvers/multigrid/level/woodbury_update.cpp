#include "solvers/multigrid/level/woodbury_update.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <numeric>
#include <utility>

namespace robot_tissue {

void WoodburyUpdate::Springs::clear() {
  parts_.clear();
  first_.assign(1, 0);
  stiffness_.clear();
}

void WoodburyUpdate::Springs::add(double stiffness, std::size_t parts) {
  stiffness_.push_back(stiffness);
  parts_.resize(parts_.size() + parts);
  first_.push_back(parts_.size());
}

int WoodburyUpdate::Springs::leastNode(std::size_t spring) const {
  int least = parts_[first_[spring]].node;
  for (std::size_t i = first_[spring]; i < first_[spring + 1]; ++i) {
    least = std::min(least, parts_[i].node);
  }
  return least;
}

void WoodburyUpdate::join(const Springs& springs, const std::vector<Eigen::Matrix3d>& inverses) {
  if (springs.size() == 0 && springs_.size() == 0) return;
  sortByNodes(springs);
  findSpringsOfNodes(inverses.size());
  std::vector<int> of_springs = envelopeOfSprings(), of_nodes = envelopeOfNodes();
  by_nodes_ = SkylineCholesky::workOf(of_nodes) < SkylineCholesky::workOf(of_springs);
  matrix_.reset(std::move(by_nodes_ ? of_nodes : of_springs));
  columns_.resize(springs_.partCount());
  if (by_nodes_) {
    fillForNodes(inverses);
  } else {
    fillForSprings(inverses);
  }
  matrix_.factorize();
}

void WoodburyUpdate::sortByNodes(const Springs& springs) {
  std::vector<std::pair<int, std::size_t>> order;  // least node, spring
  order.reserve(springs.size());
  for (std::size_t spring = 0; spring < springs.size(); ++spring) {
    order.emplace_back(springs.leastNode(spring), spring);
  }
  std::sort(order.begin(), order.end());
  springs_.clear();
  for (const auto& [least, spring] : order) {
    const std::size_t first = springs.first(spring), parts = springs.first(spring + 1) - first;
    springs_.add(springs.stiffness(spring), parts);
    for (std::size_t i = 0; i < parts; ++i) springs_.partOfLast(i) = springs.part(first + i);
  }
}

void WoodburyUpdate::findSpringsOfNodes(std::size_t nodes) {
  first_joint_.assign(nodes + 1, 0);
  for (std::size_t part = 0; part < springs_.partCount(); ++part) {
    ++first_joint_[at(springs_.part(part).node) + 1];
  }
  std::partial_sum(first_joint_.begin(), first_joint_.end(), first_joint_.begin());
  std::vector<std::size_t> next(first_joint_.begin(), first_joint_.end() - 1);
  joints_.resize(springs_.partCount());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (std::size_t part = springs_.first(spring); part < springs_.first(spring + 1); ++part) {
      joints_[next[at(springs_.part(part).node)]++] = {static_cast<int>(spring), part};
    }
  }
}

std::vector<int> WoodburyUpdate::envelopeOfSprings() const {
  std::vector<int> first;
  first.reserve(springs_.size());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    first.push_back(static_cast<int>(spring));
    for (std::size_t part = springs_.first(spring); part < springs_.first(spring + 1); ++part) {
      const Joint& joint = joints_[first_joint_[at(springs_.part(part).node)]];
      first.back() = std::min(first.back(), joint.spring);
    }
  }
  return first;
}

// Three rows a node, in the order of the nodes.
std::vector<int> WoodburyUpdate::envelopeOfNodes() {
  const std::size_t nodes = first_joint_.size() - 1;
  joined_.clear();
  row_of_.assign(nodes, -1);
  std::vector<int> first;
  for (std::size_t node = 0; node < nodes; ++node) {
    if (first_joint_[node] == first_joint_[node + 1]) continue;
    row_of_[node] = 3 * static_cast<int>(joined_.size());
    joined_.push_back(static_cast<int>(node));
    first.insert(first.end(), 3, row_of_[node]);
  }
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const int least = row_of_[at(springs_.leastNode(spring))];
    for (std::size_t part = springs_.first(spring); part < springs_.first(spring + 1); ++part) {
      const auto row = first.begin() + row_of_[at(springs_.part(part).node)];
      std::fill(row, row + 3, std::min(*row, least));
    }
  }
  return first;
}

void WoodburyUpdate::fillForSprings(const std::vector<Eigen::Matrix3d>& inverses) {
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const int row = static_cast<int>(spring);
    double* values = matrix_.rowOf(row);
    values[row] = 1.0 / springs_.stiffness(spring);
    for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
      const Part& part = springs_.part(i);
      columns_[i] = inverses[at(part.node)] * part.along;
    }
    for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
      const Part& part = springs_.part(i);
      const std::size_t end = first_joint_[at(part.node) + 1];
      for (std::size_t j = first_joint_[at(part.node)]; j < end && joints_[j].spring <= row; ++j) {
        values[joints_[j].spring] += part.along.dot(columns_[joints_[j].part]);
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
  for (std::size_t i = 0; i < springs_.partCount(); ++i) {
    const Part& part = springs_.part(i);
    columns_[i] = roots_[at(row_of_[at(part.node)] / 3)].transpose() * part.along;
  }
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const std::size_t first = springs_.first(spring), end = springs_.first(spring + 1);
    for (std::size_t i = first; i < end; ++i) {
      const Vec3 stiff = springs_.stiffness(spring) * columns_[i];
      const int row = row_of_[at(springs_.part(i).node)];
      for (int a = 0; a < 3; ++a) {
        double* values = matrix_.rowOf(row + a);
        for (std::size_t j = first; j < end; ++j) {
          const int column = row_of_[at(springs_.part(j).node)];
          for (int b = 0; b < 3 && column + b <= row + a; ++b) {
            values[column + b] += stiff[a] * columns_[j][b];
          }
        }
      }
    }
  }
}

double WoodburyUpdate::lengthening(std::size_t spring, const std::vector<Vec3>& motions) const {
  double along = 0.0;
  for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
    along += springs_.part(i).along.dot(motions[at(springs_.part(i).node)]);
  }
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
    unknowns_[static_cast<int>(spring)] = lengthening(spring, motions);
  }
  matrix_.solve(unknowns_);
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
      motions[at(springs_.part(i).node)] -= unknowns_[static_cast<int>(spring)] * columns_[i];
    }
  }
}

void WoodburyUpdate::applyByNodes(std::vector<Vec3>& motions) const {
  unknowns_.setZero(matrix_.rows());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const double force = springs_.stiffness(spring) * lengthening(spring, motions);
    for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
      unknowns_.segment<3>(row_of_[at(springs_.part(i).node)]) += force * columns_[i];
    }
  }
  matrix_.solve(unknowns_);
  for (std::size_t i = 0; i < joined_.size(); ++i) {
    motions[at(joined_[i])] -= roots_[i] * unknowns_.segment<3>(3 * static_cast<int>(i));
  }
}

void WoodburyUpdate::addForces(const std::vector<Vec3>& motions, std::vector<Vec3>& forces) const {
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const double along = lengthening(spring, motions);
    for (std::size_t i = springs_.first(spring); i < springs_.first(spring + 1); ++i) {
      const Part& part = springs_.part(i);
      forces[at(part.node)] += springs_.stiffness(spring) * along * part.along;
    }
  }
}

}  // namespace robot_tissue
