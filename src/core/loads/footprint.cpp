#include "loads/footprint.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/golden_section.h"

namespace robot_tissue {
namespace {

// Loads that are looked for, of what the widest punch has at that depth (1).
constexpr double kLeastOfMost = 1e-6;
constexpr int kHalvings = 24;  // to 1e-5
// Where a part's reach is looked for: it is no less (1) than that of a disc.
constexpr double kNearerThanDisc = 0.9;
constexpr int kSections = 14;  // to a thousandth

// What of a punch touches tissue that bulges: a part as near to the apex as there is one, no longer
// and no wider than its reach.
class PartOfPunch {
 public:
  PartOfPunch(const PunchLevel& punch, const Bulge& tissue)
      : curvature_(tissue.curvature),
        axes_(punch.long_axis.norm(), punch.short_axis.norm()),
        apex_(off(tissue.apex - punch.middle, punch.long_axis),
              off(tissue.apex - punch.middle, punch.short_axis)),
        nearest_(apex_ / std::max(1.0, apex_.cwiseQuotient(axes_).norm())) {}

  double halfWidth(double reach) const { return axes_.cwiseMin(reach).minCoeff(); }
  double give(double reach) const {
    const Eigen::Vector2d part = axes_.cwiseMin(reach);
    return giveOfEllipse(part.maxCoeff(), part.minCoeff());
  }
  // How far it goes in by its load and by how far the tissue has fallen off from the apex, in the
  // mean under its pressure (m).
  double depth(double load, double reach) const {
    const Eigen::Vector2d part = axes_.cwiseMin(reach);
    const Eigen::Vector2d most_off = axes_ - part;
    const Eigen::Vector2d middle = nearest_.cwiseMin(most_off).cwiseMax(-most_off);
    return load * give(reach) +
           0.5 * curvature_ * (part.squaredNorm() / 3.0 + (apex_ - middle).squaredNorm());
  }

  // Where that is least: no nearer than a disc's, by golden sections in its logarithm.
  double bestReach(double load) const {
    const double of_disc = std::cbrt(0.75 * load / curvature_);
    if (!(of_disc < axes_.maxCoeff())) return axes_.maxCoeff();
    return std::exp(lowestBetween(std::log(kNearerThanDisc * of_disc), std::log(axes_.maxCoeff()),
                                  kSections,
                                  [&](double log) { return depth(load, std::exp(log)); }));
  }

 private:
  static double off(const Vec3& way, const Vec3& axis) { return way.dot(axis.normalized()); }

  double curvature_;         // 1/m
  Eigen::Vector2d axes_;     // half of them (m)
  Eigen::Vector2d apex_;     // from the punch's middle, along them (m)
  Eigen::Vector2d nearest_;  // likewise, of the punch
};

}  // namespace

Footprint footprintOf(const IndenterPart& part, double load, const Bulge& tissue) {
  Footprint footprint;
  footprint.depth = kInfinity;
  for (const PunchLevel& punch : part.levels) {
    const PartOfPunch touching(punch, tissue);
    const double reach = tissue.curvature > 0.0 ? touching.bestReach(load) : kInfinity;
    const double depth = punch.height + touching.depth(load, reach);
    if (depth >= footprint.depth) continue;
    footprint.depth = depth;
    footprint.height = punch.height;
    footprint.growth = load * touching.give(reach);
    footprint.width = std::sqrt(3.0) * touching.halfWidth(reach);
  }
  return footprint;
}

// By halving in the logarithm: the depth grows with it.
double loadAt(double depth, const IndenterPart& part, const Bulge& tissue) {
  if (!(depth > 0.0)) return 0.0;
  const double most = depth / part.levels.back().give;
  double low = kLeastOfMost * most, high = most / kLeastOfMost;
  if (footprintOf(part, low, tissue).depth > depth) return 0.0;
  for (int half = 0; half < kHalvings; ++half) {
    const double middle = std::sqrt(low * high);
    (footprintOf(part, middle, tissue).depth > depth ? high : low) = middle;
  }
  return low;
}

}  // namespace robot_tissue
