#include "material/fill_law.h"

#include <algorithm>
#include <cmath>

#include "config/material.h"
#include "material/elastic_law.h"

namespace robot_tissue {

namespace {

// What q_ij is of the second derivatives by the grid's axes.
SecondSlopes alongOwnAxes(const Eigen::Matrix3d& axes, int i, int j) {
  SecondSlopes of;
  for (int a = 0; a < 3; ++a) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    of[a] = axes(a, i) * axes(a, j);
    of[3 + a] = axes(b, i) * axes(c, j) + axes(c, i) * axes(b, j);
  }
  return of;
}

// Half way to what lends, in ratio.
double raised(double spread, double lent) { return std::max(spread, std::sqrt(spread * lent)); }

// W_ij. Across a slice, axis 0, and along it the strain's change counts that is a bending of the
// slice, with E / 2 = mu (1 + nu); what is left to hold the other second derivatives is taken from
// that, as bending has those, too. Of a full cell all are 1/12. From a slice to that, bending goes
// evenly: what the other terms lack there is `between`, none of a rod, whose two normals are alike.
Eigen::Matrix3d ownWeights(const CellFill& fill, double bulk_by_shear) {
  constexpr double kLeast = elastic_law::kLeastBending / 12.0;
  const double spread = raised(fill.spread[0], fill.lent);
  const double firm = 1.0 + poissonRatio({1.0, bulk_by_shear});
  const Vec3 thin = (fill.spread[0] * fill.spread.cwiseInverse()).cwiseAbs2();
  const double both_long = thin[1] * thin[2];
  const double flat = thin[2] < 1.0 ? (1.0 - thin[1]) / (1.0 - thin[2]) : 0.0;
  Eigen::Matrix3d weights;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double both = thin[i] * thin[j], sum = thin[i] + thin[j];
      const double between = (i == 0) == (j == 0) ? 0.0 : (1.0 - both_long) * flat * both;
      const double bending = spread * (firm * (sum - 2.0 * both) + both_long * both + between) -
                             (i == j ? 0.0 : 0.5 * kLeast * std::abs(thin[i] - thin[j]));
      weights(i, j) = std::max(bending, kLeast);
    }
  }
  return weights;
}

}  // namespace

FillLaw fillLaw(const CellFill& fill, double bulk_by_shear) {
  FillLaw law;
  law.centroid = fill.centroid;
  law.pairs = {fill.products(1, 2), fill.products(0, 2), fill.products(0, 1)};
  const Eigen::Matrix3d weights = ownWeights(fill, bulk_by_shear);
  law.bending.setZero();
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const SecondSlopes of = alongOwnAxes(fill.axes, i, j);
      law.bending += (i == j ? 1.0 : 2.0) * weights(i, j) * of * of.transpose();
    }
  }
  if (fill.lent > 0.0) {
    const double held = raised(raised(fill.spread[0], fill.lent), fill.lent);
    auto pairs = law.bending.diagonal().tail<3>();
    pairs = pairs.cwiseMax(2.0 * held);
  }
  const Vec3 spread = fill.spread.cwiseMax(fill.lent);
  law.twisting = std::max(3.0 * spread[0] * spread[1], elastic_law::kLeastBending / 48.0);
  // Of a box that reaches r to both sides the variance is r^2 / 3.
  const Vec3 reach = (3.0 * fill.covariance().diagonal()).cwiseMax(0.0).cwiseSqrt();
  law.low = (fill.centroid - reach).cwiseMax(-0.5);
  law.high = (fill.centroid + reach).cwiseMin(0.5);
  return law;
}

std::array<CornerSlopes, kMostReached> cornerSlopes(const CellFill& fill, const CellReach* reach) {
  std::array<CornerSlopes, kMostReached> slopes;
  const ReachedSlopes reached = reachedSlopes(fill, reach);
  for (std::size_t node = 0; node < kMostReached; ++node) {
    slopes[node].strain = reached.strain[node];
    slopes[node].bending.head<3>() = reached.squares[node];
    slopes[node].uneven = reached.uneven[node];
  }
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 side;
    for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
    CornerSlopes& of = slopes[at(corner)];
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      of.bending[3 + a] = side[b] * side[c] * (0.5 + side[a] * fill.centroid[a]);
    }
    of.twisting = side.prod();
  }
  return slopes;
}

double invariantBetween(const FillLaw& law, const CornerSlopes& a, const CornerSlopes& b) {
  const Vec3 along = law.bending.diagonal().head<3>();
  return a.strain.dot(b.strain) + a.bending.dot(law.bending * b.bending) +
         a.uneven.dot(along.cwiseProduct(b.uneven)) + law.twisting * a.twisting * b.twisting;
}

}  // namespace robot_tissue
