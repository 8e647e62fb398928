#include "loads/narrow_contact.h"

#include <algorithm>
#include <cmath>

#include "loads/footprint.h"

namespace robot_tissue {
namespace {

// Spacings: a contact of half that width is narrow, and one of the other is wide. At 1.5 the
// lattice is right to 2 %. More: more rounds, for less.
constexpr double kNarrow = 1.1;
constexpr double kWide = 1.4;
// The same of what is round and shallow: there the half-space's holds so wide.
constexpr double kNarrowIfShallow = 1.65;
constexpr double kWideIfShallow = 2.1;
// Mean height of what touches over half its width (1): shallow is up to the first, and not from the
// second on: a ball to 0.3 and 0.45 of its radius. More: one of 10 mm pressed in by 8 feels 9 %
// more than on a fine lattice; less, or less wide: one of 20 mm, 1 mm deep at 2.5 mm spacing, feels
// 4 % more at one place than at another, for 1.
constexpr double kShallow = 0.115;
constexpr double kNotShallow = 0.17;
// The same over the depth (1): round is from the second on (a ball: 1/3), flat up to the first.
constexpr double kFlat = 0.1;
constexpr double kRound = 0.25;
// Spacings: recessed down to a dent of so much, and not at all from kNoRecessFrom on. More: right
// farther down; less: where the tissue's walls stand beside a flat end it is drawn in that by as
// much as it is recessed, and more. Chosen.
constexpr double kDown = 0.6;
// Spacings: the deepest recess. More: right farther down; less: tissue is drawn in the tool less
// deep. Chosen.
constexpr double kMostOfSpacing = 0.2;
// Of Newton's step (1), as touches come and go. More: it goes to and fro, 1.0 takes 1.1 times the
// cycles; less: more rounds. Chosen.
constexpr double kOfNewtonsStep = 0.75;

// 1 up to the first, none from the second on.
double fadeOut(double value, double first, double second) {
  return std::max(0.0, std::min(1.0, (second - value) / (second - first)));
}

double between(double from, double to, double share) { return from + share * (to - from); }

double planeModulus(const SurfaceModuli& moduli) {
  return 2.0 * moduli.shear / (1.0 - moduli.poisson_ratio);
}

// Of its force, or of its depth where there is none.
struct Press {
  double force = 0.0;  // N
  Footprint footprint;

  Press(const NarrowPress& press, const SurfaceModuli& moduli, double curvature) {
    const Bulge tissue = {std::max(0.0, curvature), press.apex};
    const double modulus = planeModulus(moduli);
    force = press.force > 0.0 ? press.force : modulus * loadAt(press.depth, *press.part, tissue);
    if (force > 0.0) footprint = footprintOf(*press.part, force / modulus, tissue);
  }

  // How far the law counts (1).
  double share(double spacing) const {
    if (!(force > 0.0)) return 0.0;
    const double half_width = 0.5 * footprint.width;
    const double shallow = fadeOut(footprint.height / half_width, kShallow, kNotShallow) *
                           (1.0 - fadeOut(footprint.height / footprint.depth, kFlat, kRound));
    return fadeOut(half_width / spacing, between(kNarrow, kNarrowIfShallow, shallow),
                   between(kWide, kWideIfShallow, shallow)) *
           fadeOut(footprint.depth / spacing, kDown, kNoRecessFrom);
  }
};

}  // namespace

bool isNarrow(const NarrowPress& press, const PressedSurface& surface) {
  return Press(press, surface.moduli, surface.curvature).share(surface.spacing) > 0.0;
}

Recess recessUnder(const NarrowPress& press, const PressedSurface& surface) {
  const Press here(press, surface.moduli, surface.curvature);
  const Footprint& footprint = here.footprint;
  const double share = here.share(surface.spacing);
  if (!(share > 0.0)) return {};
  const double of_lattice = here.force * surface.compliance + press.height +
                            0.5 * std::max(0.0, surface.curvature) * press.off_apex;
  const double most = kMostOfSpacing * surface.spacing;
  Recess recess;
  recess.depth = std::clamp(share * (footprint.depth - of_lattice), -most, most);
  recess.step = kOfNewtonsStep * std::clamp(of_lattice / footprint.growth, 0.0, 2.0);
  return recess;
}

}  // namespace robot_tissue
