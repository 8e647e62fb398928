// What is chosen in the law of model `elastic` (doc/model.md), for all that computes it: the cell,
// the lean way, the kernels.
#pragma once

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace elastic_law {

// J below which a(J) is its quadratic Taylor form: greater, a flat cell is softer.
constexpr double kFlattest = 0.1;
// Corner determinant where the barrier begins: greater, it is felt in milder presses.
constexpr double kSqueezed = 0.3;
// Its height, in shear moduli, at a flat corner: greater, corners turn inside out later.
constexpr double kBarrier = 10.0 / 3.0;
// Of a full cell's stiffness against bending and twisting: a cell filled in part has no less. 0: of
// 28 plates oblique to the grid 7 did not converge; 0.02 and 0.1: all did, and deflections moved by
// at most 0.03. Greater: thin slices in a cell are too stiff.
constexpr double kLeastBending = 0.1;
// Exponent b x beyond which the law `fung` goes on as its quadratic Taylor form, 22,000 times as
// stiff as at rest: greater, single precision no longer holds such cells beside others.
constexpr double kMostExponent = 10.0;

// The energy's density is mu / 2 g(x) + K / 2 (J - 1)^2 with x = I1bar - 3 (Fung 1967; Demiray
// 1972 for isotropic tissue): g(x) = (exp(b x) - 1) / b. Beyond kMostExponent its quadratic Taylor
// form; below x = 0, where only cells flatter than kFlattest can be, g(x) = x. So g is convex, it
// and its slope are continuous. With b = 0, neo-Hookean, g(x) = x.
struct Stiffening {
  double value = 0.0;      // g(x)
  double slope = 1.0;      // g'
  double curvature = 0.0;  // g''
};

inline Stiffening stiffeningAt(double b, double x) {
  if (!(b > 0.0 && x > 0.0)) return {x, 1.0, 0.0};
  const double exponent = std::min(b * x, kMostExponent);
  const double beyond = b * x - exponent;
  const double growth = std::expm1(exponent), slope = 1.0 + growth;
  return {(growth + slope * beyond * (1.0 + 0.5 * beyond)) / b, slope * (1.0 + beyond), b * slope};
}

}  // namespace elastic_law
}  // namespace robot_tissue
