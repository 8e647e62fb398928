#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "mesh_fixtures.h"
#include "solvers/multigrid/level/conjugate_gradients.h"

namespace robot_tissue::test_conjugate_gradients {
namespace {

constexpr int kNodes = 6;
using Vector = Eigen::Matrix<double, 3 * kNodes, 1>;
using Matrix = Eigen::Matrix<double, 3 * kNodes, 3 * kNodes>;

std::vector<Vec3> nodesOf(const Vector& vector) {
  std::vector<Vec3> nodes;
  for (int node = 0; node < kNodes; ++node) nodes.emplace_back(vector.segment<3>(3 * node));
  return nodes;
}

Vector vectorOf(const std::vector<Vec3>& nodes) {
  Vector vector;
  for (int node = 0; node < kNodes; ++node) vector.segment<3>(3 * node) = nodes[at(node)];
  return vector;
}

// Cut short they go a part of the way, downhill, to the least energy along what they found; after
// as many steps as there are unknowns they are there.
TEST(ConjugateGradients, GoDownhillHoweverSoonTheyEnd) {
  Random random;
  const Matrix root = Matrix::NullaryExpr([&] { return random.between(-1.0, 1.0); });
  const Matrix matrix = root * root.transpose() + 0.1 * Matrix::Identity();
  const Vector force = Vector::NullaryExpr([&] { return random.between(-1.0, 1.0); });
  const Vector exact = matrix.llt().solve(force);
  const auto times = [&](const std::vector<Vec3>& motion) {
    return nodesOf(matrix * vectorOf(motion));
  };
  const auto divided = [&](const std::vector<Vec3>& left) {
    return nodesOf(vectorOf(left).cwiseQuotient(matrix.diagonal()));
  };
  double before = 0.0;
  for (const int steps : {1, 3, 6, 30}) {
    const Vector found = vectorOf(conjugateGradients(nodesOf(force), {0.0, steps}, times, divided));
    const double energy = 0.5 * found.dot(matrix * found) - force.dot(found);
    EXPECT_NEAR(force.dot(found), found.dot(matrix * found), 1e-9 * force.dot(found));
    EXPECT_LT(energy, before);
    before = energy;
  }
  const Vector found = vectorOf(conjugateGradients(nodesOf(force), {1e-20, 40}, times, divided));
  EXPECT_LT((found - exact).norm(), 1e-6 * exact.norm());
  const std::vector<Vec3> none(kNodes, Vec3::Zero());
  EXPECT_EQ(conjugateGradients(none, {0.01, 12}, times, divided), none);
}

}  // namespace
}  // namespace robot_tissue::test_conjugate_gradients
