// Damping in time steps: of the rate of strain, which takes energy from whatever moves.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>

#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_viscosity {
namespace {

constexpr double kSpacing = 0.005;
const Moduli kElastic{4e3, 2e4, 0.0}, kViscous{8e4, 4e5, 0.0};

// A cell that is squeezed, sheared and bent.
ElasticCell::Corners squeezed(unsigned seed) {
  Shaker shaker(seed);
  ElasticCell::Corners corners;
  for (int corner = 0; corner < kCorners; ++corner) {
    const Vec3 place(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    corners[at(corner)] = kSpacing * (Vec3(0.1 * place.z(), 0.05 * place.x(), -0.3 * place.z()) +
                                      shaker.displacement(0.05));
  }
  return corners;
}

// What damping adds to the cell at `now`.
struct Damped {
  Damped(const ElasticCell::Corners& from, const ElasticCell::Corners& now)
      : elastic(kElastic, kSpacing, now), both(kElastic, kSpacing, now) {
    both.damp(kViscous, ElasticCell(kElastic, kSpacing, from));
  }
  double energy() const { return both.energy() - elastic.energy(); }
  Vec3 gradient(int corner) const { return both.gradient(corner) - elastic.gradient(corner); }

  ElasticCell elastic, both;
};

TEST(ViscousCell, GradientsAreThoseOfItsEnergy) {
  const ElasticCell::Corners from = squeezed(1), now = squeezed(2);
  const Damped here(from, now);
  const CellHessian hessian = here.both.hessian() - here.elastic.hessian();
  constexpr double kStep = 1e-6 * kSpacing;
  const double scale = kViscous.bulk * kSpacing * kSpacing;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      ElasticCell::Corners low = now, high = now;
      low[at(corner)][axis] -= kStep;
      high[at(corner)][axis] += kStep;
      const Damped below(from, low), above(from, high);
      EXPECT_NEAR((above.energy() - below.energy()) / (2.0 * kStep), here.gradient(corner)[axis],
                  1e-6 * scale);
      for (int other = 0; other < kCorners; ++other) {
        const Vec3 slope = (above.gradient(other) - below.gradient(other)) / (2.0 * kStep);
        const Vec3 expected = hessian.block<3, 1>(3 * other, 3 * corner + axis);
        EXPECT_LT((slope - expected).norm(), 1e-6 * scale / kSpacing);
      }
      const Eigen::Matrix3d own = here.both.block(corner) - here.elastic.block(corner);
      EXPECT_LT((own - hessian.block<3, 3>(3 * corner, 3 * corner)).norm(),
                1e-9 * scale / kSpacing);
    }
  }
}

TEST(ViscousCell, TakesEnergyFromAnyMotion) {
  const Damped here(squeezed(3), squeezed(4));
  const CellHessian hessian = here.both.hessian() - here.elastic.hessian();
  const Eigen::MatrixXd whole = hessian;
  const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(whole).eigenvalues()[0];
  EXPECT_GT(least, -1e-9 * kViscous.bulk * kSpacing);
  EXPECT_GT(here.energy(), 0.0);
}

// A homogeneous strain, turned: to first order in the angle nothing is damped, however squeezed.
TEST(ViscousCell, LetsWhatIsStrainedTurn) {
  ElasticCell::Corners from, turned, sheared;
  constexpr double kAngle = 1e-4;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(kAngle, Vec3(1, 2, 3).normalized()).matrix();
  for (int corner = 0; corner < kCorners; ++corner) {
    const Vec3 rest = kSpacing * Vec3(corner & 1, corner >> 1 & 1, corner >> 2 & 1);
    const Vec3 place(1.2 * rest.x(), 1.1 * rest.y(), 0.6 * rest.z());
    from[at(corner)] = place - rest;
    turned[at(corner)] = turn * place - rest;
    sheared[at(corner)] = place + kAngle * Vec3(place.z(), 0, 0) - rest;
  }
  EXPECT_LT(Damped(from, turned).energy(), 1e-6 * Damped(from, sheared).energy());
}

TissueConfig barInTime(int wide, int high, double poisson_ratio, double damping_time) {
  TissueConfig config = withFixedBottom(blockOf(wide, wide, high, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = poisson_ratio;
  config.time = TimeConfig{damping_time};
  return config;
}

// A bar that is squeezed by a quarter, far beyond where it buckles, and let go. Damped by 0.1 s it
// creeps back straight.
TEST(SqueezedBar, CreepsBackStraight) {
  const TissueConfig config = barInTime(4, 16, 0.45, 0.1);
  const Box top = nodeBox(config, {0, 0, 16}, {4, 4, 16});
  const double way = -0.02;
  double last = way;
  Tissue tissue(config, {});
  tissue.load(loadOf({displacedPatch("top", top, Vec3(0, 0, way))}));
  tissue.release({"top"});
  const int middle = tissue.lattice().node(2, 2, 16);
  for (int wait = 1; wait <= 4; ++wait) {
    EXPECT_EQ(tissue.wait(0.05).status, SolveStatus::kOk);
    const Vec3 moved = tissue.state().displacement[at(middle)];
    EXPECT_LT(moved.head<2>().norm(), 1e-4);
    EXPECT_GT(moved.z() / last, 0.5) << wait;
    EXPECT_LT(moved.z() / last, 0.75) << wait;
    last = moved.z();
  }
}

TEST(SqueezedBar, DoesByLayeredWhatItDoesByNewton) {
  const TissueConfig config = barInTime(3, 8, 0.4, 0.02);
  const Box top = nodeBox(config, {0, 0, 8}, {3, 3, 8});
  SolverConfig layered, newton;
  layered.tolerance = newton.tolerance = 1e-3;
  newton.method = "newton";
  Tissue one(config, layered), other(config, newton);
  for (Tissue* tissue : {&one, &other}) {
    tissue->load(loadOf({displacedPatch("top", top, Vec3(0.004, 0, -0.008))}));
    tissue->release({"top"});
    const SolveReport report = tissue->wait(0.02);
    EXPECT_TRUE(report.status == SolveStatus::kOk || tissue == &other);  // rounding, in short steps
    EXPECT_LT(report.residual, 1e-4);
  }
  double off = 0.0, greatest = 0.0;
  for (std::size_t node = 0; node < one.state().displacement.size(); ++node) {
    const Vec3& right = other.state().displacement[node];
    off = std::max(off, (one.state().displacement[node] - right).norm());
    greatest = std::max(greatest, right.norm());
  }
  EXPECT_LT(off, 0.01 * greatest);
}

}  // namespace
}  // namespace robot_tissue::test_viscosity
