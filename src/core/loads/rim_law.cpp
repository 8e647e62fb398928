#include "loads/rim_law.h"

#include <limits>

#include "loads/ratio_table.h"
#include "robot_tissue/core/loading_patch.h"

namespace robot_tissue {
namespace {

struct Measured {
  double poisson_ratio;
  RimMode across;
  RimMode normal;
};

// Shift in spacings, stiffness in shear moduli, a unit of the edge's length. More shift: larger
// patches; more stiffness: harder edges. Measured: rim_shift and rim_stiffness of
// doc/data/rim_strip.csv, cells "limit".
constexpr Measured kMeasured[] = {
    {0.25, {0.241, 4.41}, {0.155, 6.18}},  {0.30, {0.243, 4.63}, {0.148, 6.74}},
    {0.35, {0.247, 4.86}, {0.141, 7.42}},  {0.40, {0.255, 5.10}, {0.135, 8.24}},
    {0.45, {0.271, 5.34}, {0.128, 9.22}},  {0.47, {0.282, 5.42}, {0.127, 9.65}},
    {0.49, {0.300, 5.48}, {0.126, 10.08}},
};
constexpr RimMode kAlong = {0.204, 3.54};  // shear alone: the same for all ratios

struct Sliding {
  double poisson_ratio;
  RimMode normal;
};

// Likewise: sliding_shift and sliding_stiffness.
constexpr Sliding kSliding[] = {
    {0.25, {0.1695, 5.39}}, {0.30, {0.1595, 6.06}}, {0.35, {0.1496, 6.87}},  {0.40, {0.1396, 7.85}},
    {0.45, {0.1300, 9.07}}, {0.47, {0.1263, 9.61}}, {0.49, {0.1220, 10.18}},
};

RimMode between(const RimMode& low, const RimMode& high, double share) {
  return {low.shift + share * (high.shift - low.shift),
          low.stiffness + share * (high.stiffness - low.stiffness)};
}

}  // namespace

RimLaw rimLaw(double poisson_ratio) {
  const auto [low, high, share] = placeIn(kMeasured, poisson_ratio);
  return {kAlong, between(low.across, high.across, share), between(low.normal, high.normal, share)};
}

RimMode slidingRim(double poisson_ratio) {
  const auto [low, high, share] = placeIn(kSliding, poisson_ratio);
  return between(low.normal, high.normal, share);
}

double rimStiffness(const RimMode& mode, double depth) {
  if (depth >= mode.shift) return std::numeric_limits<double>::infinity();
  if (depth <= mode.shift - 1.0) return 0.0;
  return mode.stiffness * (depth + 1.0 - mode.shift) / (1.0 - mode.shift) * mode.shift /
         (mode.shift - depth);
}

RimCompliance rimCompliance(const RimModuli& moduli, double depth) {
  const RimLaw law = rimLaw(moduli.poisson_ratio);
  const auto compliance = [&](const RimMode& mode) {
    return 1.0 / (moduli.stiffness * rimStiffness(mode, depth));
  };
  return {compliance(law.across), compliance(law.along), compliance(law.normal)};
}

}  // namespace robot_tissue
