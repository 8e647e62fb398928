#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "solvers/multigrid/level/woodbury_update.h"

namespace robot_tissue::test_woodbury_update {
namespace {

using Springs = WoodburyUpdate::Springs;

class RandomSprings {
 public:
  explicit RandomSprings(unsigned seed) : random_(seed) {}

  std::vector<Eigen::Matrix3d> stiffness(int nodes) {
    std::vector<Eigen::Matrix3d> all;
    for (int node = 0; node < nodes; ++node) {
      const Eigen::Matrix3d root = Eigen::Matrix3d::NullaryExpr([&] { return number(); });
      all.push_back(root * root.transpose() + Eigen::Matrix3d::Identity());
    }
    return all;
  }

  // On up to three neighbors each, as those of a surface's triangles are.
  Springs springs(int nodes, int count) {
    Springs all;
    for (int i = 0; i < count; ++i) {
      const double stiffness = 10.0 * (1.5 + number());
      const int first = static_cast<int>(random_() % static_cast<unsigned>(nodes - 2));
      const int parts = 3 - i % 3;
      all.add(stiffness, at(parts));
      for (int part = 0; part < parts; ++part) {
        all.partOfLast(at(part)) = {first + 2 - part, Vec3(number(), number(), number())};
      }
    }
    return all;
  }

  std::vector<Vec3> forces(int nodes) {
    std::vector<Vec3> all;
    for (int node = 0; node < nodes; ++node) all.emplace_back(number(), number(), number());
    return all;
  }

 private:
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(random_); }
  std::mt19937 random_;
};

// With the whole matrix.
Eigen::VectorXd exactMotion(const std::vector<Eigen::Matrix3d>& stiffness, const Springs& springs,
                            const std::vector<Vec3>& forces) {
  const auto size = static_cast<Eigen::Index>(3 * forces.size());
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd force(size);
  for (std::size_t node = 0; node < forces.size(); ++node) {
    const auto row = static_cast<Eigen::Index>(3 * node);
    whole.block<3, 3>(row, row) = stiffness[node];
    force.segment<3>(row) = forces[node];
  }
  for (std::size_t spring = 0; spring < springs.size(); ++spring) {
    Eigen::VectorXd along = Eigen::VectorXd::Zero(size);
    for (std::size_t i = springs.first(spring); i < springs.first(spring + 1); ++i) {
      along.segment<3>(3 * springs.part(i).node) = springs.part(i).along;
    }
    whole += springs.stiffness(spring) * along * along.transpose();
  }
  return whole.llt().solve(force);
}

// Few springs a node, and many: by the springs' matrix and by the nodes'.
TEST(WoodburyUpdate, MoveAsTheWholeMatrixSays) {
  constexpr int kNodes = 12;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    RandomSprings random(seed);
    const std::vector<Eigen::Matrix3d> stiffness = random.stiffness(kNodes);
    const Springs springs = random.springs(kNodes, seed < 6 ? 3 * static_cast<int>(seed) : 200);
    const std::vector<Vec3> forces = random.forces(kNodes);
    std::vector<Eigen::Matrix3d> inverses;
    std::vector<Vec3> motions;
    for (std::size_t node = 0; node < forces.size(); ++node) {
      inverses.push_back(stiffness[node].inverse());
      motions.push_back(inverses.back() * forces[node]);
    }
    WoodburyUpdate joined;
    joined.join(springs, inverses);
    joined.apply(motions);
    const Eigen::VectorXd exact = exactMotion(stiffness, springs, forces);
    for (int node = 0; node < kNodes; ++node) {
      EXPECT_LT((motions[at(node)] - exact.segment<3>(3 * node)).norm(), 1e-12 * exact.norm());
    }
    std::vector<Vec3> balanced;
    for (std::size_t node = 0; node < forces.size(); ++node) {
      balanced.push_back(stiffness[node] * motions[node]);
    }
    joined.addForces(motions, balanced);
    for (std::size_t node = 0; node < forces.size(); ++node) {
      EXPECT_LT((balanced[node] - forces[node]).norm(), 1e-11);
    }
  }
}

TEST(WoodburyUpdate, AreAloneWithoutSprings) {
  RandomSprings random(1);
  std::vector<Vec3> motions = random.forces(4);
  const std::vector<Vec3> before = motions;
  WoodburyUpdate joined;
  joined.join(random.springs(4, 5), random.stiffness(4));
  joined.join({}, random.stiffness(4));
  joined.apply(motions);
  EXPECT_EQ(motions, before);
}

}  // namespace
}  // namespace robot_tissue::test_woodbury_update
