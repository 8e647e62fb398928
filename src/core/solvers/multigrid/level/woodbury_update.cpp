#include "solvers/multigrid/level/woodbury_update.h"

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
  springs_ = std::move(springs);
  std::stable_sort(springs_.begin(), springs_.end(),
                   [](const Spring& a, const Spring& b) { return leastNode(a) < leastNode(b); });
  answers_.resize(springs_.size());
  springs_at_.assign(inverses.size(), {});
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    answers_[spring].clear();
    for (const Part& part : springs_[spring].parts) {
      answers_[spring].push_back(inverses[at(part.node)] * part.along);
      springs_at_[at(part.node)].push_back(static_cast<int>(spring));
    }
  }
  findEnvelope();
  fillMatrix();
  matrix_.factorize();
}

void WoodburyUpdate::findEnvelope() {
  std::vector<int> first;
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    first.push_back(static_cast<int>(spring));
    for (const Part& part : springs_[spring].parts) {
      first.back() = std::min(first.back(), springs_at_[at(part.node)].front());
    }
  }
  matrix_.reset(std::move(first));
}

void WoodburyUpdate::fillMatrix() {
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    const int row = static_cast<int>(spring);
    matrix_.at(row, row) = 1.0 / springs_[spring].stiffness;
    for (const Part& part : springs_[spring].parts) {
      for (const int other : springs_at_[at(part.node)]) {
        if (other > row) break;
        const std::vector<Part>& theirs = springs_[at(other)].parts;
        for (std::size_t i = 0; i < theirs.size(); ++i) {
          if (theirs[i].node != part.node) continue;
          matrix_.at(row, other) += part.along.dot(answers_[at(other)][i]);
        }
      }
    }
  }
}

void WoodburyUpdate::apply(std::vector<Vec3>& motions) const {
  forces_.setZero(matrix_.rows());
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (const Part& part : springs_[spring].parts) {
      forces_[static_cast<int>(spring)] += part.along.dot(motions[at(part.node)]);
    }
  }
  matrix_.solve(forces_);
  for (std::size_t spring = 0; spring < springs_.size(); ++spring) {
    for (std::size_t i = 0; i < springs_[spring].parts.size(); ++i) {
      motions[at(springs_[spring].parts[i].node)] -=
          forces_[static_cast<int>(spring)] * answers_[spring][i];
    }
  }
}

void WoodburyUpdate::addForces(const std::vector<Vec3>& motions, std::vector<Vec3>& forces) const {
  for (const Spring& spring : springs_) {
    double along = 0.0;
    for (const Part& part : spring.parts) along += part.along.dot(motions[at(part.node)]);
    for (const Part& part : spring.parts) {
      forces[at(part.node)] += spring.stiffness * along * part.along;
    }
  }
}

}  // namespace robot_tissue
