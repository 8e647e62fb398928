#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include "elastic_fixtures.h"

namespace robot_tissue::test_elastic_cell {
namespace {

constexpr double kSpacing = 0.01;
const Moduli kModuli = {3448.0, 33333.0};  // Pa: 10 kPa, Poisson's ratio 0.45

using Corners = ElasticCell::Corners;

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

Eigen::Matrix3d meanGradient(const Corners& displacement) {
  Eigen::Matrix3d mean = Eigen::Matrix3d::Identity();
  for (int c = 0; c < kCorners; ++c) {
    for (int axis = 0; axis < 3; ++axis) {
      mean.col(axis) += ((c >> axis & 1) != 0 ? 0.25 : -0.25) / kSpacing * displacement[at(c)];
    }
  }
  return mean;
}

double energyOf(const Corners& displacement) {
  return ElasticCell(kModuli, kSpacing, displacement).energy();
}

// Energy of the material itself in a homogeneous deformation.
double materialEnergy(const Eigen::Matrix3d& gradient) {
  const double j = gradient.determinant();
  return std::pow(kSpacing, 3) *
         (0.5 * kModuli.shear * (std::pow(j, -2.0 / 3.0) * gradient.squaredNorm() - 3.0) +
          0.5 * kModuli.bulk * (j - 1.0) * (j - 1.0));
}

// Mild, squeezed so that the barrier rises, flatter than 0.1, and turned inside out.
class CellDerivatives : public testing::TestWithParam<double> {
 protected:
  CellDerivatives() {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    gradient(2, 2) = GetParam();
    gradient(0, 2) = 0.2;
    shape_ = shaken(deformedBy(gradient), 0.1 * kSpacing, 7);
  }

  Corners shape_;
};

TEST_P(CellDerivatives, GradientIsTheEnergysSlope) {
  const ElasticCell cell(kModuli, kSpacing, shape_);
  constexpr double kStep = 1e-5 * kSpacing;
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 slope;
    for (int axis = 0; axis < 3; ++axis) {
      Corners ahead = shape_, behind = shape_;
      ahead[at(corner)][axis] += kStep;
      behind[at(corner)][axis] -= kStep;
      slope[axis] = (energyOf(ahead) - energyOf(behind)) / (2.0 * kStep);
    }
    ASSERT_GT(slope.norm(), 1e-3 * kModuli.shear * kSpacing * kSpacing);
    EXPECT_LT((cell.gradient(corner) - slope).norm(), 1e-6 * slope.norm()) << corner;
  }
}

TEST_P(CellDerivatives, HessianIsTheGradientsSlope) {
  const CellHessian hessian = ElasticCell(kModuli, kSpacing, shape_).hessian();
  constexpr double kStep = 1e-6 * kSpacing;
  for (int column = 0; column < 3 * kCorners; ++column) {
    Corners ahead = shape_, behind = shape_;
    ahead[at(column / 3)][column % 3] += kStep;
    behind[at(column / 3)][column % 3] -= kStep;
    const ElasticCell after(kModuli, kSpacing, ahead), before(kModuli, kSpacing, behind);
    Eigen::Matrix<double, 3 * kCorners, 1> slope;
    for (int c = 0; c < kCorners; ++c) {
      slope.segment<3>(3 * c) = (after.gradient(c) - before.gradient(c)) / (2.0 * kStep);
    }
    ASSERT_GT(slope.norm(), 0.1 * kModuli.shear * kSpacing);
    EXPECT_LT((hessian.col(column) - slope).norm(), 1e-6 * slope.norm()) << column;
  }
  EXPECT_LT((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
}

TEST_P(CellDerivatives, BlockIsThatOfTheHessian) {
  const ElasticCell cell(kModuli, kSpacing, shape_);
  const CellHessian hessian = cell.hessian();
  for (int c = 0; c < kCorners; ++c) {
    const Eigen::Matrix3d block = hessian.block<3, 3>(3 * c, 3 * c);
    ASSERT_GT(block.norm(), 0.1 * kModuli.shear * kSpacing);
    EXPECT_LT((cell.block(c) - block).norm(), 1e-12 * block.norm());
  }
}

INSTANTIATE_TEST_SUITE_P(Heights, CellDerivatives, testing::Values(0.9, 0.35, 0.07, -0.3));

TEST(ElasticCell, RestHasNeitherEnergyNorForce) {
  const ElasticCell cell(kModuli, kSpacing, deformedBy(Eigen::Matrix3d::Identity()));
  EXPECT_NEAR(cell.energy(), 0.0, 1e-15 * kModuli.bulk * std::pow(kSpacing, 3));
  for (int c = 0; c < kCorners; ++c) {
    EXPECT_LT(cell.gradient(c).norm(), 1e-14 * kModuli.bulk * kSpacing * kSpacing);
  }
}

TEST(ElasticCell, HomogeneousDeformationHasTheMaterialsEnergy) {
  Eigen::Matrix3d gradient;
  gradient << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, 0.0, -0.15, 0.9;
  ASSERT_GT(materialEnergy(gradient), 0.0);
  EXPECT_NEAR(energyOf(deformedBy(gradient)), materialEnergy(gradient),
              1e-12 * materialEnergy(gradient));
}

// The same stretch along any direction costs the same.
TEST(ElasticCell, IsIsotropicAtLargeStrain) {
  Eigen::Matrix3d stretch = Eigen::Vector3d(1.5, 0.8, 0.9).asDiagonal();
  const double along_axes = energyOf(deformedBy(stretch));
  ASSERT_GT(along_axes, 0.0);
  for (const Vec3& axis : {Vec3(1.0, 1.0, 0.0), Vec3(1.0, 1.0, 1.0), Vec3(0.3, -0.7, 0.2)}) {
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.9, axis.normalized()).toRotationMatrix();
    EXPECT_NEAR(energyOf(deformedBy(turn * stretch * turn.transpose())), along_axes,
                1e-12 * along_axes);
  }
}

TEST(ElasticCell, TurningChangesNothing) {
  const Corners shape = shaken(deformedBy(Eigen::Matrix3d::Identity()), 0.2 * kSpacing, 3);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.5, Vec3(1, -2, 0.5).normalized()).matrix();
  Corners turned;
  for (int c = 0; c < kCorners; ++c) {
    turned[at(c)] = turn * (restOf(c) + shape[at(c)]) - restOf(c);
  }
  const ElasticCell cell(kModuli, kSpacing, shape), same(kModuli, kSpacing, turned);
  ASSERT_GT(cell.energy(), 0.0);
  EXPECT_NEAR(same.energy(), cell.energy(), 1e-12 * cell.energy());
  for (int c = 0; c < kCorners; ++c) {
    ASSERT_GT(cell.gradient(c).norm(), 0.0);
    EXPECT_LT((same.gradient(c) - turn * cell.gradient(c)).norm(), 1e-12 * cell.gradient(c).norm());
  }
}

// Relaxing one node at a time lowers the energy, unless the cell is flatter than 0.1.
TEST(ElasticCell, BlockIsPositiveDefiniteInAnyShapeThatIsNotFlat) {
  double softest = std::numeric_limits<double>::max();
  int distorted = 0;
  for (unsigned seed = 0; seed < 5000; ++seed) {
    const Corners shape = shaken(deformedBy(Eigen::Matrix3d::Identity()), 1.5 * kSpacing, seed);
    if (meanGradient(shape).determinant() < 0.1) continue;
    ++distorted;
    const ElasticCell cell(kModuli, kSpacing, shape);
    for (int c = 0; c < kCorners; ++c) {
      const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(cell.block(c));
      softest = std::min(softest, solver.eigenvalues().minCoeff());
    }
  }
  ASSERT_GT(distorted, 1000);
  EXPECT_GT(softest, 1e-3 * kModuli.shear * kSpacing);
}

TEST(ElasticCell, FlatAndInvertedCellsPushBack) {
  double earlier = 0.0;
  for (const double height : {0.5, 0.3, 0.1, 0.0, -0.3}) {
    Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
    gradient(2, 2) = height;
    const ElasticCell cell(kModuli, kSpacing, deformedBy(gradient));
    const double push = -cell.gradient(7).z();
    EXPECT_GT(push, earlier) << height;
    earlier = push;
  }
}

}  // namespace
}  // namespace robot_tissue::test_elastic_cell
