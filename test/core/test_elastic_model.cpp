#include <gtest/gtest.h>

#include <cmath>

#include "cutting/cut.h"
#include "elastic_fixtures.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_elastic_model {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig twoMaterials() {
  TissueConfig config = elasticBlockOf(3, 2, 2, 0.4);
  Region stiff;
  stiff.box = {Vec3::Zero(), Vec3::Constant(0.9 * kSpacing)};
  stiff.material = config.material;
  stiff.material.young_modulus = 1e5;
  config.regions.push_back(stiff);
  return config;
}

TissueConfig obliquePlate() {
  TissueConfig config = twoMaterials();
  config.mesh = std::make_shared<const TriangleMesh>(
      moved(boxMesh(Vec3::Zero(), kSpacing * Vec3(3.3, 2.6, 0.9)),
            Pose(Eigen::AngleAxisd(0.5, Vec3(0.2, 1.0, 0.3).normalized()))));
  return config;
}

void expectForceIsSlope(TissueConfig config) {
  config.gravity = Vec3(1.0, 2.0, -9.81);
  ElasticBlock block(config);
  shake(block.state, 0.2 * kSpacing);
  constexpr double kStep = 1e-5 * kSpacing;
  const std::vector<Vec3> forces = block.model.nodeForces(block.state);
  const double greatest = greatestForce(forces);
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      LatticeState ahead = block.state, behind = block.state;
      ahead.displacement[at(node)][axis] += kStep;
      behind.displacement[at(node)][axis] -= kStep;
      slope[axis] = (block.model.energy(ahead) - block.model.energy(behind)) / (2.0 * kStep);
    }
    EXPECT_LT((forces[at(node)] + slope).norm(), 1e-6 * greatest) << node;
    EXPECT_LT((block.model.nodeForce(block.state, node) - forces[at(node)]).norm(),
              1e-12 * greatest);
    const NodeBalance balance = block.model.nodeBalance(block.state, node);
    EXPECT_LT((balance.force - forces[at(node)]).norm(), 1e-6 * greatest);
  }
}

TEST(ElasticModel, ForceIsTheEnergysNegativeSlope) { expectForceIsSlope(twoMaterials()); }

TEST(ElasticModel, ForceOnAMeshIsTheEnergysNegativeSlope) { expectForceIsSlope(obliquePlate()); }

// The state's sum of forces is told so: no cell is asked once for each of its nodes.
void expectForcesOfEachNode(TissueConfig config) {
  config.gravity = Vec3(1.0, 2.0, -9.81);
  ElasticBlock block(config);
  shake(block.state, 0.2 * kSpacing);
  std::vector<int> nodes;
  for (int node = block.lattice.nodeCount() - 1; node >= 0; node -= 3) nodes.push_back(node);
  const std::vector<Vec3> forces = block.model.forcesOn(block.state, nodes);
  ASSERT_EQ(forces.size(), nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    EXPECT_EQ(forces[i], block.model.nodeForce(block.state, nodes[i])) << nodes[i];
  }
}

TEST(ElasticModel, ForcesOnSomeNodesAreThoseOfEachToTheBit) {
  expectForcesOfEachNode(twoMaterials());
  expectForcesOfEachNode(obliquePlate());
}

void expectHessiansAddUp(const TissueConfig& config) {
  ElasticBlock block(config);
  shake(block.state, 0.2 * kSpacing);
  const int count = 3 * block.lattice.nodeCount();
  const Eigen::MatrixXd hessian = hessianOf(block);
  constexpr double kStep = 1e-6 * kSpacing;
  const double greatest = hessian.colwise().norm().maxCoeff();
  for (int column = 0; column < count; ++column) {
    LatticeState ahead = block.state, behind = block.state;
    ahead.displacement[at(column / 3)][column % 3] += kStep;
    behind.displacement[at(column / 3)][column % 3] -= kStep;
    const auto after = block.model.nodeForces(ahead), before = block.model.nodeForces(behind);
    Eigen::VectorXd slope(count);
    for (int node = 0; node < block.lattice.nodeCount(); ++node) {
      slope.segment<3>(3 * node) = (before[at(node)] - after[at(node)]) / (2.0 * kStep);
    }
    ASSERT_GT(slope.norm(), 1e-5);
    EXPECT_LT((hessian.col(column) - slope).norm(), 1e-6 * greatest) << column;
  }
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    const Eigen::Matrix3d expected = hessian.block<3, 3>(3 * node, 3 * node);
    EXPECT_LT((block.model.nodeBlock(block.state, node) - expected).norm(), 1e-12 * greatest);
  }
}

TEST(ElasticModel, HessiansAddUpToTheForcesSlope) { expectHessiansAddUp(twoMaterials()); }

// Cells that are filled in part, and what they reach.
TEST(ElasticModel, HessiansOfAMeshAddUp) { expectHessiansAddUp(obliquePlate()); }

TEST(ElasticModel, NodeStiffnessIsTheBlocksDiagonalAtRest) {
  const ElasticBlock block(twoMaterials());
  for (int node = 0; node < block.lattice.nodeCount(); ++node) {
    const Vec3 expected = block.model.nodeBlock(block.state, node).diagonal();
    ASSERT_GT(expected.minCoeff(), 0.0);
    EXPECT_LT((block.model.nodeStiffness(block.state, node) - expected).norm(),
              1e-12 * expected.norm());
  }
}

TEST(ElasticModel, TurnedAndCarriedBlockHasNoForce) {
  for (const double angle : {0.1, 1.0, 2.0, 3.1}) {
    ElasticBlock block(elasticBlockOf(4, 3, 2, 0.49));
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3(1, 2, -1).normalized()).matrix();
    deformBy(block.lattice, turn, block.state);
    for (Vec3& displacement : block.state.displacement) displacement += Vec3(0.3, -0.2, 0.1);
    ASSERT_GT(block.state.displacement.front().norm(), 0.1);
    // Of the force E h^2 on the face of one cell.
    EXPECT_LT(greatestForce(block.model.nodeForces(block.state)), 1e-11);
    EXPECT_LT(std::abs(block.model.energy(block.state)), 1e-15);
  }
}

TEST(ElasticModel, RegionIsStiffByItsCellsCenters) {
  const TissueConfig config = twoMaterials();  // region: only the cell at the origin is inside
  ElasticBlock block(config);
  TissueConfig plain = config;
  plain.regions.clear();
  const ElasticBlock soft(plain);
  const auto ratio = [&](int i, int j, int k) {
    const int node = block.lattice.node(i, j, k);
    return block.model.nodeStiffness(block.state, node).x() /
           soft.model.nodeStiffness(soft.state, node).x();
  };
  EXPECT_NEAR(ratio(0, 0, 0), 10.0, 1e-12);        // one cell: stiff
  EXPECT_NEAR(ratio(1, 0, 0), 11.0 / 2.0, 1e-12);  // one stiff, one soft
  EXPECT_NEAR(ratio(1, 1, 1), (10.0 + 7.0) / 8.0, 1e-12);
  EXPECT_NEAR(ratio(2, 0, 0), 1.0, 1e-12);
}

TEST(ElasticModel, GravityAddsTheNodesWeight) {
  TissueConfig config = elasticBlockOf(2, 2, 2, 0.3);
  config.gravity = Vec3(0.0, 0.0, -9.81);
  const ElasticBlock block(config);
  Vec3 weight = Vec3::Zero();
  for (const Vec3& force : block.model.nodeForces(block.state)) weight += force;
  const double mass = 1000.0 * std::pow(2.0 * kSpacing, 3);
  EXPECT_NEAR(weight.z(), -9.81 * mass, 1e-12);
}

// A cut that leaves the cell in one piece takes nothing from it.
TEST(ElasticModel, CellThatHangsTogetherIsWhole) {
  ElasticBlock block(elasticBlockOf(1, 1, 1, 0.3));
  shake(block.state, 0.1 * kSpacing);
  const double before = block.model.energy(block.state);
  ASSERT_GT(before, 0.0);
  sever(block.lattice, halfWay({block.lattice.springOf(0, 1)}), block.state, SplitCells::kParted);
  EXPECT_TRUE(block.state.cells->ghosts().empty());
  EXPECT_EQ(block.model.energy(block.state), before);
}

}  // namespace
}  // namespace robot_tissue::test_elastic_model
