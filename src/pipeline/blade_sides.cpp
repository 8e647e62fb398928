#include "blade_sides.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/triangle_mesh.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

double widthAlong(const Vec3& direction, const std::vector<Vec3>& points) {
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& point : points) {
    low = std::min(low, direction.dot(point));
    high = std::max(high, direction.dot(point));
  }
  return high - low;
}

// Unit, square to the axis (unit).
Vec3 narrowestAcross(const Vec3& axis, const std::vector<Vec3>& points) {
  const Vec3 one = axis.unitOrthogonal(), other = axis.cross(one);
  const auto towards = [&](double angle) -> Vec3 {
    return std::cos(angle) * one + std::sin(angle) * other;
  };
  double best = 0.0, least = kInfinity;
  const auto look = [&](double angle) {
    const double width = widthAlong(towards(angle), points);
    if (width < least) {
      least = width;
      best = angle;
    }
  };
  double step = M_PI / tuning::kSideDirections;
  for (int i = 0; i < tuning::kSideDirections; ++i) look(i * step);
  while (step > tuning::kSideTurn) {
    step *= 0.5;
    const double from = best;
    look(from - step);
    look(from + step);
  }
  return towards(best);
}

}  // namespace

// A blade is flat: it goes from its edge to the middle of its shapes. Where that is on its edge, as
// of one with two edges of which one is told, it is flat where it is narrowest.
BladeSides sidesOf(const std::vector<Vec3>& edge, const std::vector<Vec3>& points) {
  if (edge.empty() || points.empty()) return {};
  const Vec3 middle = 0.5 * (edge.front() + edge.back());
  const Vec3 along = edge.back() - edge.front();
  const Vec3 axis = along.normalized();
  const auto offLine = [&](const Vec3& point) { return axis.cross(point - middle).norm(); };
  double farthest = 0.0;
  for (const Vec3& point : points) farthest = std::max(farthest, offLine(point));
  const Vec3 center = boundsOf(points).center();
  if (offLine(center) < tuning::kEdgeInMiddle * farthest) {
    return {middle, narrowestAcross(axis, points)};
  }
  return {middle, along.cross(center - middle).normalized()};
}

}  // namespace robot_tissue
