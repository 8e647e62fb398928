#include "triangle_minimum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace robot_tissue {
namespace {

struct Cut {
  Vec3 point;
  SignedDistance distance;

  double heightAt(const Vec3& other) const {
    return distance.value + distance.slope.dot(other - point);
  }
  Vec3 cornerValues(const Corners& corners) const {
    return {heightAt(corners[0]), heightAt(corners[1]), heightAt(corners[2])};
  }
};

// Of a triangle, which is asked for many of its parts.
struct Measures {
  explicit Measures(const Corners& corners)
      : twice_area((corners[1] - corners[0]).cross(corners[2] - corners[0]).norm()) {
    for (std::size_t k = 0; k < 3; ++k) {
      across[k] = (corners[(k + 2) % 3] - corners[(k + 1) % 3]).norm();
    }
  }
  double twice_area;             // m^2
  std::array<double, 3> across;  // m: lengths of the edges, each by the corner across it
};

// A smaller triangle of the same form around a point of the triangle, as the weights of its
// corners. It reaches `radius` (m) from the point towards each edge, but not out of the triangle.
std::array<Vec3, 3> partAround(const Measures& triangle, const Vec3& weights, double radius) {
  Vec3 least;
  for (std::size_t k = 0; k < 3; ++k) {
    const double share =
        triangle.twice_area > 0.0 ? radius * triangle.across[k] / triangle.twice_area : 1.0;
    least[static_cast<int>(k)] = std::max(0.0, weights[static_cast<int>(k)] - share);
  }
  const double rest = 1.0 - least.sum();
  std::array<Vec3, 3> part = {least, least, least};
  for (std::size_t k = 0; k < 3; ++k) part[k][static_cast<int>(k)] += rest;
  return part;
}

// What the cuts foretell in a part of the triangle.
struct Forecast {
  double least = 0.0;
  Vec3 weights = Vec3::Zero();
};

Forecast forecast(const std::vector<Cut>& cuts, const Corners& corners,
                  const std::array<Vec3, 3>& part) {
  const Corners part_corners = {pointOf(corners, part[0]), pointOf(corners, part[1]),
                                pointOf(corners, part[2])};
  HighestPlane bound;
  for (const Cut& cut : cuts) bound.add(cut.cornerValues(part_corners));
  const Vec3& w = bound.leastWeights();
  return {bound.least(), w[0] * part[0] + w[1] * part[1] + w[2] * part[2]};
}

}  // namespace

double boundAfter(double distance, double way) {
  return (std::abs(distance) + way) * (1.0 + tuning::kBeyondRounding) + tuning::kRounding;
}

double longestEdge(const Corners& corners) {
  return std::sqrt(
      std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                (corners[0] - corners[2]).squaredNorm()}));
}

double accuracyFor(const CollisionShape& shape, const Corners& corners) {
  const double edge = longestEdge(corners);
  const double accuracy =
      std::min(tuning::kAccuracyOfEdge * edge, tuning::kAccuracyOfThickness * shape.thickness());
  return std::max(tuning::kFinestOfEdge * edge, accuracy);
}

// The least point of the maximum of all planes is a vertex of that polyhedron. It stays when the
// new plane is not above it; otherwise it is where the new plane meets two others, one other on an
// edge of the triangle, or at a corner.
void HighestPlane::add(const Vec3& corner_values) {
  planes_[count_++] = corner_values;
  if (count_ > 1 && corner_values.dot(weights_) <= least_) return;
  least_ = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) tryOnEdge(k, (k + 1) % 3, 1.0);
  for (std::size_t i = 0; i + 1 < count_; ++i) {
    const Vec3 difference = corner_values - planes_[i];
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3;
      if ((difference[a] < 0.0) == (difference[b] < 0.0)) continue;
      tryOnEdge(a, b, difference[b] / (difference[b] - difference[a]));
    }
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 cross = difference.cross(corner_values - planes_[j]);
      const double sum = cross.sum();
      // Where they meet off the triangle, which is mostly so, nothing need be divided.
      const bool is_on = sum > 0.0 ? cross.minCoeff() >= 0.0 : sum < 0.0 && cross.maxCoeff() <= 0.0;
      if (is_on) tryPoint(cross / sum);
    }
  }
}

// The point of the edge from corner a to b with this weight of a: as tryPoint.
void HighestPlane::tryOnEdge(int a, int b, double weight) {
  const double other = 1.0 - weight;
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = count_; i-- > 0;) {
    highest = std::max(highest, planes_[i][a] * weight + planes_[i][b] * other);
    if (highest >= least_) return;
  }
  least_ = highest;
  weights_.setZero();
  weights_[a] = weight;
  weights_[b] = other;
}

void HighestPlane::tryPoint(const Vec3& weights) {
  double highest = -std::numeric_limits<double>::infinity();
  for (std::size_t i = count_; i-- > 0;) {
    highest = std::max(highest, planes_[i].dot(weights));
    if (highest >= least_) return;
  }
  least_ = highest;
  weights_ = weights;
}

TriangleMinimum convexMinimum(const CollisionShape& shape, const Corners& corners,
                              const std::array<SignedDistance, 3>& at_corners, double accuracy,
                              double limit) {
  TriangleMinimum best;
  HighestPlane bound;
  for (std::size_t k = 0; k < 3; ++k) {
    bound.add(Cut{corners[k], at_corners[k]}.cornerValues(corners));
    if (k > 0 && at_corners[k].value >= best.distance.value) continue;
    best = {Vec3::Unit(static_cast<int>(k)), at_corners[k]};
  }
  // The foot of the center is the least point for a sphere, and a good one for round shapes.
  bool foot_asked = false;
  while (bound.size() < HighestPlane::kMost && bound.least() < limit) {
    const double open = best.distance.value - bound.least();
    if (open <= accuracy * (best.distance.value < limit ? 1.0 : tuning::kAccuracyAtLimit)) break;
    const Vec3 weights =
        foot_asked ? bound.leastWeights() : nearestInTriangle(Vec3::Zero(), corners);
    foot_asked = true;
    const Vec3 point = pointOf(corners, weights);
    const SignedDistance distance = shape.distance(point);
    if (distance.value < best.distance.value) best = {weights, distance};
    bound.add(Cut{point, distance}.cornerValues(corners));
  }
  return best;
}

TriangleMinimum localMinimum(const CollisionShape& shape, const Corners& corners,
                             const TriangleMinimum& seed, double accuracy) {
  TriangleMinimum best = seed;
  const Measures measures(corners);
  std::vector<Cut> cuts;
  cuts.reserve(tuning::kMostLocalSteps + 1);
  cuts.push_back({pointOf(corners, seed.weights), best.distance});
  double radius = std::max(tuning::kFirstPart * longestEdge(corners), -best.distance.value);
  for (std::size_t step = 0; step < tuning::kMostLocalSteps; ++step) {
    const Forecast next = forecast(cuts, corners, partAround(measures, best.weights, radius));
    const double gain = best.distance.value - next.least;
    if (gain <= accuracy) break;
    const Vec3 point = pointOf(corners, next.weights);
    const double way = (point - pointOf(corners, best.weights)).norm();
    const Cut cut{point, shape.distanceWithin(point, boundAfter(best.distance.value, way))};
    cuts.push_back(cut);
    if (cut.distance.value < best.distance.value) {
      if (cut.distance.value < best.distance.value - tuning::kGoodShare * gain) radius *= 2.0;
      best = {next.weights, cut.distance};
    } else if (cut.heightAt(pointOf(corners, best.weights)) >
               best.distance.value + tuning::kRounding) {
      radius *= 0.5;
    }
    // A plane above a value that was asked for belongs to another part of the shape.
    const Vec3 best_point = pointOf(corners, best.weights);
    cuts.erase(std::remove_if(cuts.begin(), cuts.end(),
                              [&](const Cut& old) {
                                return old.heightAt(best_point) >
                                       best.distance.value + tuning::kRounding;
                              }),
               cuts.end());
  }
  return best;
}

}  // namespace robot_tissue
