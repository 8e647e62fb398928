#include "geometry/mesh_points.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

// Spacings (1) that the search for a point on a bent plane may be off it, and its steps. Rounding.
constexpr double kFound = 1e-13;
constexpr int kMostSteps = 60;
// Points along an edge at which bent planes are looked for. More: finer turns are found; less: tips
// of a wound stand out of the skin. Chosen.
constexpr int kSamples = 7;

Vec3 ontoPlanes(Vec3 point) {
  for (double& along : point) {
    const double nearest = 0.5 * std::round(2.0 * along);
    if (std::abs(along - nearest) < MeshPoints::kOnPlane) along = nearest;
  }
  return point;
}

}  // namespace

MeshPoints::MeshPoints(std::vector<Vec3> vertices, const HalfIndex& octants, const BentGrid& grid)
    : grid_(grid), octants_(octants), places_(std::move(vertices)) {
  straight_.reserve(places_.size());
  for (const Vec3& place : places_) straight_.push_back(ontoPlanes(grid_.straightened(place)));
}

int MeshPoints::add(const Vec3& straight, const Vec3& place) {
  straight_.push_back(straight);
  places_.push_back(place);
  return static_cast<int>(straight_.size()) - 1;
}

int MeshPoints::addMiddle(const std::vector<int>& points) {
  Vec3 straight = Vec3::Zero(), place = Vec3::Zero();
  for (const int point : points) {
    straight += straight_[at(point)];
    place += places_[at(point)];
  }
  const auto count = static_cast<double>(points.size());
  return add(straight / count, place / count);
}

// The border planes of the grid cut nothing: what stands out there belongs to the octants inside.
HalfIndex MeshPoints::octantOf(const Vec3& point) const {
  HalfIndex octant{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = std::floor(2.0 * point[static_cast<Eigen::Index>(axis)]);
    octant[axis] = std::clamp(static_cast<int>(half), 0, octants_[axis] - 1);
  }
  return octant;
}

// How far along the edge it meets the plane, of its length (1). Planes of nodes are straight; a
// bent plane is found by false position (Illinois: Dowell and Jarratt 1971).
double MeshPoints::alongEdge(int from, int to, int axis, int plane) const {
  const double height = 0.5 * plane;
  const Vec3 &a = places_[at(from)], &b = places_[at(to)];
  if (plane % 2 == 0) return (height - a[axis]) / (b[axis] - a[axis]);
  double low = 0.0, high = 1.0;
  double at_low = straight_[at(from)][axis] - height, at_high = straight_[at(to)][axis] - height;
  double along = at_low / (at_low - at_high);
  for (int step = 0; step < kMostSteps; ++step) {
    const double above = grid_.straightened(a + along * (b - a))[axis] - height;
    if (std::abs(above) < kFound) break;
    const bool is_low = (above < 0.0) == (at_low < 0.0);
    (is_low ? low : high) = along;
    (is_low ? at_low : at_high) = above;
    (is_low ? at_high : at_low) *= 0.5;
    along = low + at_low / (at_low - at_high) * (high - low);
  }
  return along;
}

// An end that is on the plane is the point. Else it is in the cell that the edge is in, and along
// the axes that it has been cut along already in the same octant.
int MeshPoints::crossing(int from, int to, int axis, int plane) {
  for (const int end : {from, to}) {
    if (straight_[at(end)][axis] == 0.5 * plane) return end;
  }
  const auto [low, high] = std::minmax(from, to);
  const auto [known, is_new] =
      crossings_.try_emplace(std::array<int, 4>{low, high, axis, plane}, 0);
  if (!is_new) return known->second;
  const Vec3 a = places_[at(low)], b = places_[at(high)];
  Vec3 place = a + alongEdge(low, high, axis, plane) * (b - a);
  place = place.cwiseMax(a.cwiseMin(b)).cwiseMin(a.cwiseMax(b));
  const bool at_nodes = plane % 2 == 0;
  if (at_nodes) place[axis] = 0.5 * plane;
  Vec3 straight = ontoPlanes(grid_.straightened(place));
  for (int other = 0; other < 3; ++other) {
    const double at_low = straight_[at(low)][other], at_high = straight_[at(high)][other];
    const double start = std::min(at_low, at_high);
    if (at_low == at_high) {
      straight[other] = start;  // in a plane
    } else if (other < axis || !at_nodes) {
      const double step = at_nodes || other > axis ? 1.0 : 0.5;
      const double first = step * std::floor(start / step);
      straight[other] = std::clamp(straight[other], first, std::nextafter(first + step, 0.0));
    }
  }
  straight[axis] = 0.5 * plane;
  known->second = add(straight, place);
  return known->second;
}

// Along an edge in one cell a bent plane may come and go again. Where it does, a point between; in
// order, from the lower number to the higher one.
std::vector<int> MeshPoints::findTurns(int low, int high, int cut) {
  std::array<Vec3, kSamples> straight;
  for (int i = 0; i < kSamples; ++i) {
    straight[at(i)] = straightBetween(low, high, cut, (i + 1.0) / (kSamples + 1.0));
  }
  std::array<bool, kSamples> is_turn{};
  for (int axis = cut; axis < 3; ++axis) {
    const double start = straight_[at(low)][axis], end = straight_[at(high)][axis];
    const double plane = std::floor(std::min(start, end)) + 0.5;
    if (start == end && start == plane - 0.5) continue;  // in a plane of nodes
    int farthest = -1;  // of those since the plane was crossed, the first run left out
    bool is_above = start >= plane;
    for (int i = 0; i <= kSamples; ++i) {
      const double here = (i < kSamples ? straight[at(i)][axis] : end) - plane;
      if ((here >= 0.0) != is_above) {
        if (farthest >= 0) is_turn[at(farthest)] = true;
        is_above = !is_above;
        farthest = i < kSamples ? i : -1;
      } else if (farthest >= 0 && i < kSamples &&
                 std::abs(here) > std::abs(straight[at(farthest)][axis] - plane)) {
        farthest = i;
      }
    }
  }
  std::vector<int> turns;
  for (int i = 0; i < kSamples; ++i) {
    if (!is_turn[at(i)]) continue;
    const double share = (i + 1.0) / (kSamples + 1.0);
    const Vec3& from = places_[at(low)];
    turns.push_back(add(straight[at(i)], from + share * (places_[at(high)] - from)));
  }
  return turns;
}

// Of a point on an edge that is in one cell, and stays there, and in one octant along the axes that
// it has been cut along.
Vec3 MeshPoints::straightBetween(int low, int high, int cut, double share) const {
  const Vec3 &from = places_[at(low)], &to = places_[at(high)];
  Vec3 straight = ontoPlanes(grid_.straightened(from + share * (to - from)));
  for (int axis = 0; axis < 3; ++axis) {
    const double start = straight_[at(low)][axis], end = straight_[at(high)][axis];
    const double step = axis < cut ? 0.5 : 1.0,
                 first = step * std::floor(std::min(start, end) / step);
    straight[axis] = start == end && start == first
                         ? start
                         : std::clamp(straight[axis], first, std::nextafter(first + step, 0.0));
  }
  return straight;
}

std::vector<int> MeshPoints::turns(int from, int to, int cut) {
  const auto [low, high] = std::minmax(from, to);
  const auto [known, is_new] = turns_.try_emplace(std::array<int, 3>{low, high, cut});
  if (is_new) known->second = findTurns(low, high, cut);
  std::vector<int> turns = known->second;
  if (from == high) std::reverse(turns.begin(), turns.end());
  return turns;
}

// In order. From below to above, as the pieces are cut, so that the points are the same.
std::vector<int> MeshPoints::crossingsBetween(int from, int to, int axis, bool at_nodes) {
  const int start = octantOf(straight_[at(from)])[at(axis)];
  const int end = octantOf(straight_[at(to)])[at(axis)];
  int lower = start < end ? from : to;
  const int upper = start < end ? to : from;
  std::vector<int> between;
  for (int plane = std::min(start, end) + 1; plane <= std::max(start, end); ++plane) {
    if ((plane % 2 == 0) != at_nodes) continue;
    const int point = crossing(lower, upper, axis, plane);
    if (point == upper || point == lower) continue;
    between.push_back(lower = point);
  }
  if (start > end) std::reverse(between.begin(), between.end());
  return between;
}

std::vector<int> MeshPoints::subdivided(int from, int to) {
  std::vector<int> points = {from, to};
  const auto refine = [&](const auto& between) {
    std::vector<int> finer = {points.front()};
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      for (const int point : between(points[i], points[i + 1])) finer.push_back(point);
      finer.push_back(points[i + 1]);
    }
    points.swap(finer);
  };
  for (int axis = 0; axis < 3; ++axis) {
    refine([&](int a, int b) { return crossingsBetween(a, b, axis, true); });
  }
  for (int axis = 0; axis < 3; ++axis) {
    for (int round = 0; round < kMostTurns; ++round) {
      refine([&](int a, int b) { return isBeside(a, b) ? turns(a, b, axis) : std::vector<int>(); });
    }
    refine([&](int a, int b) { return crossingsBetween(a, b, axis, false); });
  }
  return points;
}

// The edge, which is in one cell or between some, is in one that is bent, or beside it.
bool MeshPoints::isBeside(int from, int to) const {
  const Vec3 low = straight_[at(from)].cwiseMin(straight_[at(to)]);
  for (int around = 0; around < 8; ++around) {
    HalfIndex octant{};
    bool is_around = true;
    for (int axis = 0; axis < 3; ++axis) {
      const bool below = (around >> axis & 1) != 0;
      const double first = std::floor(low[axis]);
      const bool is_in_plane =
          straight_[at(from)][axis] == first && straight_[at(to)][axis] == first;
      is_around = is_around && (!below || is_in_plane);
      octant[at(axis)] = 2 * static_cast<int>(first) - (below ? 2 : 0);
    }
    if (is_around && grid_.isBent(octant)) return true;
  }
  return false;
}

}  // namespace robot_tissue
