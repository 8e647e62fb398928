#include "loads/narrow_contact.h"

#include <algorithm>
#include <cmath>

#include "loads/footprint.h"

namespace robot_tissue {
namespace {

// Spacings: a contact of that radius, by Hertz, is narrow, and one of the other is wide. At 1.5 the
// lattice is right to 2 %. More: more rounds, for less.
constexpr double kNarrow = 1.25;
constexpr double kWide = 1.5;
// The same of a shallow contact, whose radius is up to the first, and none of the second, of the
// ball's (1): there Hertz's holds so wide. More of the ball: one of 10 mm pressed in by 8 feels 9 %
// more than on a fine lattice; less, or less wide: one of 20 mm, 1 mm deep at 2.5 mm spacing, feels
// 4 % more at one place than at another, for 1.
constexpr double kNarrowIfShallow = 1.9;
constexpr double kWideIfShallow = 2.4;
constexpr double kShallow = 0.3;
constexpr double kNotShallow = 0.45;
// The same where the surface is not flat, and C less sure, of forces spread wide above all.
constexpr double kNarrowIfBent = 0.5;
constexpr double kWideIfBent = 1.1;
// Of the ball's radius (1), likewise: Hertz's contact is not wider than the ball. Less: light
// touches of small balls hang on where nodes are; more: forces jump by a fifth where a ball is
// nearly two radii deep. Chosen.
constexpr double kWideAsBall = 1.15;
constexpr double kWiderThanBall = 1.4;
// Spacings: smaller balls have none. More: light touches of small balls hang on where nodes are: of
// 2 mm at 5 mm spacing, half a millimeter deep, 0.024 to 0.032 N for 0.0084, but dragged 3 mm deep
// their force jumps by 13 to 15 % for 11 to 22. Less: it is as large as they are. Chosen.
constexpr double kLeastRadius = 0.2;
// Of the radius (1): the deepest recess. More: tissue comes past a ball's middle. Chosen.
constexpr double kMostOfRadius = 0.25;
// Spacings: boxes and cylinders are recessed down to a dent of the first, and not at all from the
// second on. More: right farther down; less: where the tissue's walls stand beside a flat end it is
// drawn in that by as much as it is recessed, and more. Chosen.
constexpr double kFlatEndsDown = 0.6;
constexpr double kNoFlatEnds = 1.2;
// Spacings: the deepest recess of a box or a cylinder. More: right farther down; less: tissue is
// drawn in the tool less deep. Chosen.
constexpr double kMostOfSpacing = 0.2;
// Of the depth of a box or a cylinder (1): what is not known of it, as tissue bulges under it.
// More: faces and long edges on organs are recessed by what they are not; less: fewer are. Chosen.
constexpr double kLittleBulge = 0.1;
constexpr double kMuchBulge = 0.3;
// Spacings: so far from where it touches the surface may face a box's face. Chosen.
constexpr double kPressedAround = 1.0;
// Of Newton's step of a box or a cylinder (1), whose touches come and go. More: it goes to and fro,
// 1.0 takes 1.1 times the cycles; less: more rounds. Chosen.
constexpr double kOfNewtonsStep = 0.75;
// Of the force (1): so much more tells how the depth of a box or a cylinder grows with it.
constexpr double kMoreForce = 0.01;
// Of the ball's curvature (1): that of both is no less. Less: where tissue is hollow, as wide as
// the ball, contacts count as wide. Chosen.
constexpr double kLeastCurvature = 0.25;

// 1 up to the first, none from the second on.
double fadeOut(double value, double first, double second) {
  return std::max(0.0, std::min(1.0, (second - value) / (second - first)));
}

double between(double from, double to, double share) { return from + share * (to - from); }

// Hertz's, of a force, or of a depth where there is none.
struct HalfSpace {
  double radius = 0.0;   // R* (m)
  double contact = 0.0;  // a (m)
  double force = 0.0;    // F (N)

  HalfSpace(const NarrowPress& press, const SurfaceModuli& moduli, double curvature) {
    const double of_ball = 1.0 / press.radius;
    radius = 1.0 / std::max(of_ball + curvature, kLeastCurvature * of_ball);
    const double plane_modulus = 2.0 * moduli.shear / (1.0 - moduli.poisson_ratio);
    contact = press.force > 0.0 ? std::cbrt(0.75 * press.force * radius / plane_modulus)
                                : std::sqrt(std::max(0.0, press.depth) * radius);
    force = 4.0 / 3.0 * plane_modulus * contact * contact * contact / radius;
  }

  // How far the law counts (1).
  double share(const NarrowPress& press, double spacing, bool is_flat) const {
    if (!(force > 0.0) || press.radius < kLeastRadius * spacing) return 0.0;
    const double width = contact / spacing, of_ball = contact / press.radius;
    const double shallow = fadeOut(of_ball, kShallow, kNotShallow);
    const double of_width = is_flat ? fadeOut(width, between(kNarrow, kNarrowIfShallow, shallow),
                                              between(kWide, kWideIfShallow, shallow))
                                    : fadeOut(width, kNarrowIfBent, kWideIfBent);
    return of_width * fadeOut(of_ball, kWideAsBall, kWiderThanBall);
  }
};

double planeModulus(const SurfaceModuli& moduli) {
  return 2.0 * moduli.shear / (1.0 - moduli.poisson_ratio);
}

// How far the law counts of a box or a cylinder (1).
double shareOf(const Footprint& footprint, double spacing) {
  return fadeOut(0.5 * footprint.width / spacing, kNarrow, kWide) *
         fadeOut(footprint.depth / spacing, kFlatEndsDown, kNoFlatEnds) *
         fadeOut(footprint.bulge / footprint.depth, kLittleBulge, kMuchBulge);
}

Recess recessUnderBody(const NarrowPress& press, const PressedSurface& surface) {
  if (press.force <= 0.0) return {};
  const auto under = [&](double force) {
    return footprintOf(*press.body, press.facing, force, planeModulus(surface.moduli),
                       {surface.curvature, kPressedAround * surface.spacing});
  };
  const Footprint here = under(press.force), more = under((1.0 + kMoreForce) * press.force);
  const double share = shareOf(here, surface.spacing);
  if (!(share > 0.0)) return {};
  const double of_lattice = press.force * surface.compliance + press.height;
  const double growth = (more.depth - here.depth) / kMoreForce;
  const double most = kMostOfSpacing * surface.spacing;
  Recess recess;
  recess.depth = std::clamp(share * (here.depth - of_lattice), -most, most);
  recess.step = growth > 0.0 ? kOfNewtonsStep * std::clamp(of_lattice / growth, 0.0, 2.0) : 1.0;
  return recess;
}

}  // namespace

bool isNarrow(const NarrowPress& press, double spacing, const SurfaceModuli& moduli) {
  if (press.body) {
    return press.force > 0.0 &&
           shareOf(footprintOf(*press.body, press.facing, press.force, planeModulus(moduli)),
                   spacing) > 0.0;
  }
  return HalfSpace(press, moduli, 0.0).share(press, spacing, true) > 0.0;
}

Recess recessUnder(const NarrowPress& press, const PressedSurface& surface) {
  if (press.body) return recessUnderBody(press, surface);
  const HalfSpace half_space(press, surface.moduli, surface.curvature);
  const double share = half_space.share(press, surface.spacing, surface.is_flat);
  if (!(share > 0.0)) return {};
  const double of_half_space = half_space.contact * half_space.contact / half_space.radius;
  const double of_lattice = half_space.force * surface.compliance;
  const double height = press.height * press.radius / half_space.radius;
  Recess recess;
  recess.depth =
      std::min(share * (of_half_space - of_lattice - height), kMostOfRadius * press.radius);
  recess.step = std::max(0.0, std::min(2.0, 1.5 * of_lattice / of_half_space));
  return recess;
}

}  // namespace robot_tissue
