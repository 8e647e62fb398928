#include "loads/narrow_contact.h"

#include <algorithm>
#include <cmath>

#include "loads/point_loads.h"

namespace robot_tissue {
namespace {

// Spacings: a contact of that radius, by Hertz, is narrow, and one of the other is wide. At 1.5 the
// lattice is right to 2 %. More: more rounds, for less.
constexpr double kNarrow = 1.25;
constexpr double kWide = 1.5;
// Of the ball's radius (1), likewise: Hertz's contact is not wider than the ball. Less: light
// touches of small balls hang on where nodes are; more: forces jump by a fifth where a ball is
// nearly two radii deep. Chosen.
constexpr double kWideAsBall = 1.15;
constexpr double kWiderThanBall = 1.4;
// Spacings: of smaller balls the recess is as large as they are, and tissue goes around them (0.2:
// lost in a press by 1 to 3 mm; 0.4: forces jump by 24 % at one of five places).
constexpr double kLeastRadius = 0.5;
// Of the radius (1): the deepest recess. More: tissue comes past a ball's middle. Chosen.
constexpr double kMostOfRadius = 0.25;

// Of the force of 1 N that nodes share (m/N).
double sharedCompliance(const Lattice& lattice, const SurfaceModuli& moduli,
                        const std::vector<NodeWeight>& shares) {
  const double spacing = lattice.spacing();
  double sum = 0.0;
  for (const NodeWeight& one : shares) {
    const Vec3 place = lattice.restPosition(one.node);
    for (const NodeWeight& other : shares) {
      const double squared = (lattice.restPosition(other.node) - place).squaredNorm();
      sum += one.weight * other.weight *
             pointCompliance(moduli.poisson_ratio, squared / (spacing * spacing));
    }
  }
  return sum / (moduli.shear * spacing);
}

}  // namespace

Recess recessUnder(const BallPress& press, const Lattice& lattice, const SurfaceModuli& moduli) {
  const double plane_modulus = 2.0 * moduli.shear / (1.0 - moduli.poisson_ratio);
  const double contact = press.force > 0.0
                             ? std::cbrt(0.75 * press.force * press.radius / plane_modulus)
                             : std::sqrt(std::max(0.0, press.depth) * press.radius);
  const double force = 4.0 / 3.0 * plane_modulus * contact * contact * contact / press.radius;
  const double width = contact / lattice.spacing();
  const bool is_thin = press.radius < kLeastRadius * lattice.spacing();
  const double of_ball = contact / press.radius;
  if (!(force > 0.0) || width >= kWide || of_ball >= kWiderThanBall || is_thin) return {};
  const double share = std::min(1.0, (kWide - width) / (kWide - kNarrow)) *
                       std::min(1.0, (kWiderThanBall - of_ball) / (kWiderThanBall - kWideAsBall));
  const double of_half_space = contact * contact / press.radius;
  const double of_lattice = force * sharedCompliance(lattice, moduli, press.shares);
  Recess recess;
  recess.depth =
      std::min(share * (of_half_space - of_lattice - press.height), kMostOfRadius * press.radius);
  recess.step = std::max(0.0, std::min(2.0, 1.5 * of_lattice / of_half_space));
  return recess;
}

}  // namespace robot_tissue
