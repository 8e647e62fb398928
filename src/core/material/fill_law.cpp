#include "material/fill_law.h"

#include <algorithm>

#include "material/elastic_law.h"

namespace robot_tissue {

FillLaw fillLaw(const CellFill& fill) {
  FillLaw law;
  law.centroid = fill.centroid;
  law.places = fill.strain_places;
  law.pairs = {fill.products(1, 2), fill.products(0, 2), fill.products(0, 1)};
  law.pairs = law.pairs.cwiseProduct(law.places);
  const double least = fill.spread[0], middle = fill.spread[1];
  law.bending = Vec3::Constant(std::max(2.0 * least, elastic_law::kLeastBending / 6.0));
  law.twisting = std::max(3.0 * least * middle, elastic_law::kLeastBending / 48.0);
  // Of a box that reaches r to both sides the variance is r^2 / 3.
  const Vec3 reach = (3.0 * fill.covariance().diagonal()).cwiseMax(0.0).cwiseSqrt();
  law.low = (fill.centroid - reach).cwiseMax(-0.5);
  law.high = (fill.centroid + reach).cwiseMin(0.5);
  return law;
}

// The shape function is the product over the axes of (1/2 + s_a x_a), s_a = 1 at the high end, else
// -1.
std::array<CornerSlopes, kCorners> cornerSlopes(const FillLaw& law) {
  std::array<CornerSlopes, kCorners> slopes;
  for (int corner = 0; corner < kCorners; ++corner) {
    Vec3 side;
    for (int axis = 0; axis < 3; ++axis) side[axis] = (corner >> axis & 1) != 0 ? 1.0 : -1.0;
    CornerSlopes& of = slopes[at(corner)];
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const double beside = side[b] * law.centroid[b] + side[c] * law.centroid[c];
      of.strain[a] =
          side[a] * (0.25 + 0.5 * law.places[a] * beside + side[b] * side[c] * law.pairs[a]);
      of.bending[a] = side[b] * side[c] * (0.5 + side[a] * law.centroid[a]);
    }
    of.twisting = side.prod();
  }
  return slopes;
}

double invariantBetween(const FillLaw& law, const CornerSlopes& a, const CornerSlopes& b) {
  return a.strain.dot(b.strain) + law.bending.dot(a.bending.cwiseProduct(b.bending)) +
         law.twisting * a.twisting * b.twisting;
}

}  // namespace robot_tissue
