// Model `elastic` against formulas: what the tests assert and the program analytic_checks prints.
#pragma once

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A free bar pulled by 0.1 % along an axis (its ends slide sideways), by method newton.
struct PulledBar {
  double young_modulus_error = 0.0;  // relative
  double poisson_ratio_error = 0.0;  // relative
};
PulledBar pulledBar(int axis, double poisson_ratio);

// The homogeneous state of uniaxial stress along any direction, at a strain of 0.1 %: the energy of
// a block of the lattice, least over all strains that leave that one alone.
PulledBar uniaxialStress(const Vec3& direction, double poisson_ratio);

// Greatest node force of a block turned by an angle (rad), over mu h^2.
double forceAfterTurn(double angle, double poisson_ratio);

// Greatest difference inside a block from the linear field on its border, over the greatest
// displacement.
double patchTestError(double poisson_ratio);

// A bar clamped at one end that hangs by its own weight.
struct HangingBar {
  double deflection = 0.0;  // of the tip, over the length
  double elastica = 0.0;    // the same of an inextensible slender bar (own, by shooting)
};
HangingBar hangingBar(int cells_thick, double poisson_ratio);

// Volume ratio of a block pressed by a fifth of its height, bonded bottom; by its whole face, or by
// a punch of a fifth of its width.
double volumeRatioUnderPress(bool by_punch, double spacing, double poisson_ratio);

}  // namespace robot_tissue
