// Cells of model `elastic` that are filled in part: the energy, and what it does in a tissue.
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "elastic_fixtures.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_partial_cell {
namespace {

constexpr double kSpacing = 0.01;
const Moduli kModuli = {3448.0, 33333.0};  // Pa: 10 kPa, Poisson's ratio 0.45

using Corners = ElasticCell::Corners;
using Reached = ElasticCell::Reached;

Vec3 restOf(int corner) { return kSpacing * Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1); }

Corners deformedBy(const Eigen::Matrix3d& gradient) {
  Corners displacement;
  for (int c = 0; c < kCorners; ++c) displacement[at(c)] = gradient * restOf(c) - restOf(c);
  return displacement;
}

Corners shaken(Corners displacement, double size, unsigned seed) {
  Shaker shaker(seed);
  for (Vec3& corner : displacement) corner += shaker.displacement(size);
  return displacement;
}

// A wall along no axis, a rod, an edge's chip, half a cell, one octant, and three of a wall whose
// strain is taken elsewhere.
CellFill fillNumber(int number) {
  FillIntegrals fill;
  Random random;
  for (int i = 0; i < 4000 && number < 3; ++i) {
    const Vec3 point = random.offset(0.5);
    const Vec3 from = point - Vec3(0.1, -0.15, 0.2);
    const double across = from.dot(Vec3(1, 2, 3).normalized());
    const bool in_wall = std::abs(across) < 0.1;
    const bool in_rod = (from - across * Vec3(1, 2, 3).normalized()).norm() < 0.15;
    const bool in_chip = point.x() + point.z() > 0.7;
    if (number == 0 ? in_wall : number == 1 ? in_rod : in_chip) fill.add(point, 1.0 / 4000.0);
  }
  if (number == 3) return fillOf(octantIntegrals(0x0f));
  if (number == 4) return fillOf(octantIntegrals(0x20));
  return fillOf(number == 5 ? octantIntegrals(0x13) : fill);
}
constexpr int kFills = 6;

class PartialCell : public testing::TestWithParam<std::tuple<int, double>> {
 protected:
  PartialCell() : fill_(fillNumber(std::get<0>(GetParam()))) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    gradient(2, 2) = std::get<1>(GetParam());
    gradient(0, 2) = 0.2;
    reach_.weigh(0, 0.7, 0.0, 0.5);
    reach_.weigh(1, 0.2, 0.3, 0.0);
    reach_.weigh(2, 0.4, 0.2, 0.7);
    const Corners corners = shaken(deformedBy(gradient), 0.1 * kSpacing, 7);
    Shaker shaker(8);
    for (int node = 0; node < kMostReached; ++node) {
      if (node < kCorners) {
        shape_[at(node)] = corners[at(node)];
      } else {
        shape_[at(node)] = (gradient - Eigen::Matrix3d::Identity()) * placeOf(node) +
                           shaker.displacement(0.1 * kSpacing);
      }
    }
  }
  ElasticCell cellAt(const Reached& shape) const {
    return {kModuli, kSpacing, shape, &fill_, &reach_};
  }
  bool isThere(int node) const {
    return node < kCorners || reach_.has((node - kCorners) / kFaceNodes);
  }
  // At rest.
  Vec3 placeOf(int node) const {
    if (node < kCorners) return restOf(node);
    const int side = (node - kCorners) / kFaceNodes;
    return restOf(faceCorner(side, node % kFaceNodes)) +
           (side % 2 == 0 ? -kSpacing : kSpacing) * Vec3::Unit(side / 2);
  }

  CellFill fill_;
  CellReach reach_;  // up along x, down along y, both ways along z
  Reached shape_;
};

TEST_P(PartialCell, GradientIsTheEnergysSlope) {
  const ElasticCell cell = cellAt(shape_);
  constexpr double kStep = 1e-5 * kSpacing;
  for (int corner = 0; corner < kMostReached; ++corner) {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      Reached ahead = shape_, behind = shape_;
      ahead[at(corner)][axis] += kStep;
      behind[at(corner)][axis] -= kStep;
      slope[axis] = (cellAt(ahead).energy() - cellAt(behind).energy()) / (2.0 * kStep);
    }
    EXPECT_EQ(slope.norm() > 1e-5 * kModuli.shear * kSpacing * kSpacing, isThere(corner));
    EXPECT_LT((cell.gradient(corner) - slope).norm(),
              1e-6 * slope.norm() + 1e-9 * kModuli.bulk * kSpacing * kSpacing)
        << corner;
  }
}

// Twisted, so that J is 1: what bends a thin fill hangs on its Poisson's ratio.
TEST(StrainOfAPartialCell, IsThatOfItsEnergy) {
  Corners twisted;
  for (int c = 0; c < kCorners; ++c) {
    const Vec3 place = restOf(c);
    twisted[at(c)] = Vec3(0.3 / kSpacing * place.y() * place.z(), 0.0, 0.0);
  }
  for (int number = 0; number < kFills; ++number) {
    const CellFill fill = fillNumber(number);
    const ElasticCell cell(kModuli, kSpacing, twisted, &fill);
    const double whole = 0.5 * kModuli.shear * std::pow(kSpacing, 3);
    EXPECT_GT(cell.shapeStrain(), 1e-3) << number;
    EXPECT_NEAR(cell.shapeStrain(), cell.energy() / whole, 1e-9) << number;
  }
}

TEST_P(PartialCell, HessianIsTheGradientsSlope) {
  const CellHessian hessian = cellAt(shape_).hessian();
  constexpr double kStep = 1e-6 * kSpacing;
  for (int column = 0; column < 3 * kMostReached; ++column) {
    Reached ahead = shape_, behind = shape_;
    ahead[at(column / 3)][column % 3] += kStep;
    behind[at(column / 3)][column % 3] -= kStep;
    const ElasticCell after = cellAt(ahead), before = cellAt(behind);
    Eigen::Matrix<double, 3 * kMostReached, 1> slope;
    for (int c = 0; c < kMostReached; ++c) {
      slope.segment<3>(3 * c) = (after.gradient(c) - before.gradient(c)) / (2.0 * kStep);
    }
    EXPECT_EQ(slope.norm() > 1e-4 * kModuli.shear * kSpacing, isThere(column / 3));
    EXPECT_LT((hessian.col(column) - slope).norm(), 1e-6 * hessian.norm() / 5.0) << column;
  }
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
  for (int c = 0; c < kMostReached; ++c) {
    const Eigen::Matrix3d block = hessian.block<3, 3>(3 * c, 3 * c);
    EXPECT_LT((cellAt(shape_).block(c) - block).norm(), 1e-12 * hessian.norm());
  }
}

TEST_P(PartialCell, TurningChangesNothing) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).matrix();
  Reached turned;
  for (int c = 0; c < kMostReached; ++c) {
    turned[at(c)] = turn * (placeOf(c) + shape_[at(c)]) - placeOf(c);
  }
  const double energy = cellAt(shape_).energy();
  ASSERT_GT(energy, 0.0);
  EXPECT_NEAR(cellAt(turned).energy(), energy, 1e-12 * energy);
}

INSTANTIATE_TEST_SUITE_P(Fills, PartialCell,
                         testing::Combine(testing::Range(0, kFills),
                                          testing::Values(0.9, 0.35, 0.07, -0.3)));

// Wherever in the cell the material is.
TEST(PartialCells, HomogeneousDeformationHasTheMaterialsEnergy) {
  Eigen::Matrix3d gradient;
  gradient << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, 0.0, -0.15, 0.9;
  const double full = ElasticCell(kModuli, kSpacing, deformedBy(gradient)).energy();
  ASSERT_GT(full, 0.0);
  for (int number = 0; number < kFills; ++number) {
    const CellFill fill = fillNumber(number);
    const ElasticCell cell(kModuli, kSpacing, deformedBy(gradient), &fill);
    EXPECT_NEAR(cell.energy(), full, 1e-12 * full) << number;
  }
}

TEST(PartialCells, OneThatIsFullIsAFullCell) {
  const Corners shape = shaken(deformedBy(Eigen::Matrix3d::Identity()), 0.2 * kSpacing, 3);
  const CellFill fill;
  const ElasticCell full(kModuli, kSpacing, shape), same(kModuli, kSpacing, shape, &fill);
  ASSERT_GT(full.energy(), 0.0);
  EXPECT_NEAR(same.energy(), full.energy(), 1e-13 * full.energy());
  EXPECT_LT((same.hessian() - full.hessian()).norm(), 1e-13 * full.hessian().norm());
  for (int c = 0; c < kCorners; ++c) {
    EXPECT_LT((same.gradient(c) - full.gradient(c)).norm(), 1e-13 * full.gradient(0).norm());
  }
}

// A bar along no axis, stretched along itself and thinner by Poisson's ratio: its sides bear no
// stress, so that no node away from its ends feels a force, however the bar fills the cells there.
// Of stress that is taken where the fill is, forces of a tenth of it go to other nodes than they
// would, in sum none.
TEST(PartialCells, StretchedBarAlongNoAxisIsInBalance) {
  constexpr double kStrain = 1e-6;
  Random random;
  for (int trial = 0; trial < 5; ++trial) {
    const Vec3 half(0.1, random.between(0.003, 0.02), random.between(0.003, 0.02));
    const Pose pose = random.pose(0.01);
    TissueConfig config;
    config.mesh = std::make_shared<const TriangleMesh>(moved(boxMesh(-half, half), pose));
    config.spacing = kSpacing;
    config.material.young_modulus = 1e4;
    config.material.poisson_ratio = 0.3;
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    LatticeState state = lattice.restState();
    const Vec3 stretch = kStrain * Vec3(1.0, -0.3, -0.3);
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      const Vec3 in_bar = pose.inverse() * lattice.restPosition(node);
      state.displacement[at(node)] = pose.linear() * stretch.cwiseProduct(in_bar);
    }
    const double stress = 1e4 * kStrain;
    int beside = 0;
    Vec3 across = Vec3::Zero();
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      const Vec3 in_bar = pose.inverse() * lattice.restPosition(node);
      const Vec3 force = model.nodeForce(state, node);
      if (in_bar.x() > 0.0) across += force;
      if (std::abs(in_bar.x()) > half.x() - 2.0 * kSpacing) continue;
      ++beside;
      EXPECT_LT(force.norm(), 0.12 * stress * kSpacing * kSpacing);
    }
    EXPECT_GT(beside, 50);
    const double force = stress * 4.0 * half.y() * half.z();
    // Stress in the middle is partly on nodes beyond it.
    EXPECT_LT((across + force * pose.linear().col(0)).norm(), 0.02 * force);
  }
}

// Masses of the corners are those of where the material is: their center is the mesh's.
TEST(PartialCells, WeighWhereTheyAreFilled) {
  TissueConfig config;
  const TriangleMesh box =
      moved(boxMesh(Vec3(-0.03, -0.012, -0.004), Vec3(0.031, 0.013, 0.0035)), Random().pose(0.02));
  config.mesh = std::make_shared<const TriangleMesh>(box);
  config.spacing = kSpacing;
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  const std::vector<double> masses = model.nodeMasses(*lattice.restState().cells);
  Vec3 center = Vec3::Zero(), middle = Vec3::Zero();
  double mass = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    EXPECT_GE(masses[at(node)], 0.0);
    EXPECT_NEAR(lattice.mass(node), masses[at(node)], 1e-12 * lattice.mass(0) + 1e-18);
    mass += masses[at(node)];
    center += masses[at(node)] * lattice.restPosition(node);
  }
  for (const Vec3& vertex : box.vertices) middle += vertex / 8.0;
  // Cells that the surface only grazes hold a thousandth.
  EXPECT_NEAR(mass, 1000.0 * volumeOf(box), 2e-3 * mass);
  EXPECT_LT((center / mass - middle).norm(), 2e-3 * kSpacing);
}

}  // namespace
}  // namespace robot_tissue::test_partial_cell
