#include "cutting/blade_surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "cutting/cell_division.h"
#include "robot_tissue/core/triangle_point.h"

namespace robot_tissue {
namespace {

// Of the spacing (1): what is nearer to a triangle is on it, and so far the surface is shifted.
// More: more springs are severed along the outline; less: nodes on the surface fall to either side
// by rounding. Chosen, as for flat polygons.
constexpr double kOnSurface = 1e-3;
// To which side: a direction that no surface of a plan is along, so that nodes on it are off it by
// a third of the shift at least where it is a plane of the lattice. Chosen.
const Vec3 kShift(0.5257, 0.3712, 0.7654);
// Of the spacing (1), likewise along edges of two triangles: rounding.
constexpr double kOnEdge = 1e-9;
// Of the square of the spacing (1): a triangle of less area is none.
constexpr double kNoArea = 1e-9;

using Corners = BladeSurface::Corners;
using Point = Eigen::Vector2d;

double distanceToEdge(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 edge = to - from;
  const double length = std::max(edge.squaredNorm(), std::numeric_limits<double>::min());
  const double share = std::clamp((point - from).dot(edge) / length, 0.0, 1.0);
  return (from + share * edge - point).norm();
}

// Twice the signed area of a triangle (m^2).
double area(const Point& a, const Point& b, const Point& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool holds(const Point& a, const Point& b, const Point& c, const Point& point) {
  return area(a, b, point) >= 0.0 && area(b, c, point) >= 0.0 && area(c, a, point) >= 0.0;
}

// The polygon's corners, anticlockwise, seen along its mean normal.
std::vector<Point> seenAlong(const Vec3& normal, const std::vector<Vec3>& corners) {
  const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
  std::vector<Point> seen;
  for (const Vec3& corner : corners) seen.emplace_back(along.dot(corner), across.dot(corner));
  return seen;
}

bool isEar(const std::vector<Point>& outline, const std::vector<std::size_t>& left,
           std::size_t tip) {
  const std::size_t count = left.size();
  const std::size_t before = left[(tip + count - 1) % count], after = left[(tip + 1) % count];
  const Point &a = outline[before], &b = outline[left[tip]], &c = outline[after];
  if (!(area(a, b, c) > 0.0)) return false;
  return std::none_of(left.begin(), left.end(), [&](std::size_t other) {
    const bool is_corner = other == before || other == left[tip] || other == after;
    return !is_corner && holds(a, b, c, outline[other]);
  });
}

// Numbers of corners; empty when the outline crosses itself.
std::vector<std::array<std::size_t, 3>> clipEars(const std::vector<Point>& outline) {
  std::vector<std::size_t> left(outline.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<std::array<std::size_t, 3>> ears;
  while (left.size() > 3) {
    std::size_t tip = 0;
    while (tip < left.size() && !isEar(outline, left, tip)) ++tip;
    if (tip == left.size()) return {};
    const std::size_t count = left.size();
    ears.push_back({left[(tip + count - 1) % count], left[tip], left[(tip + 1) % count]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
  }
  ears.push_back({left[0], left[1], left[2]});
  return ears;
}

using Edge = std::array<double, 6>;  // the coordinates of its ends, the lower one's first

Edge edgeOf(const Vec3& from, const Vec3& to) {
  const std::array<double, 3> a = {from.x(), from.y(), from.z()}, b = {to.x(), to.y(), to.z()};
  const auto [low, high] = std::minmax({a, b});
  return {low[0], low[1], low[2], high[0], high[1], high[2]};
}

// On which sides of the box the point is, a bit each.
std::uint8_t sidesOf(const Box& box, const Vec3& point) {
  unsigned sides = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (point[axis] < box.min()[axis]) sides |= 1U << (2 * axis);
    if (point[axis] > box.max()[axis]) sides |= 2U << (2 * axis);
  }
  return static_cast<std::uint8_t>(sides);
}

}  // namespace

BladeSurface::BladeSurface(const std::vector<Corners>& triangles, double spacing)
    : slack_(kOnSurface * spacing) {
  std::map<Edge, int> faces;  // of each edge
  for (const Corners& corners : triangles) {
    if (!(doubleArea(corners).norm() > kNoArea * spacing * spacing)) continue;
    for (std::size_t i = 0; i < 3; ++i) ++faces[edgeOf(corners[i], corners[(i + 1) % 3])];
  }
  for (const Corners& corners : triangles) {
    const Vec3 twice_area = doubleArea(corners);
    if (!(twice_area.norm() > kNoArea * spacing * spacing)) continue;
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const bool is_outline = faces[edgeOf(corners[i], corners[(i + 1) % 3])] == 1;
      triangle.slack[i] = is_outline ? slack_ : kOnEdge * spacing;
      triangle.corners[i] = corners[i] + slack_ * kShift;
      triangle.box.extend(triangle.corners[i]);
    }
    triangle.normal = twice_area.normalized();
    triangle.shift = slack_ * triangle.normal.dot(kShift);
    triangle.box = grownBy(slack_, triangle.box);
    bounds_.extend(triangle.box);
    triangles_.push_back(triangle);
  }
}

BladeSurface BladeSurface::of(const std::vector<Vec3>& corners, double spacing) {
  Vec3 center = Vec3::Zero(), normal = Vec3::Zero();
  const std::size_t count = corners.size();
  for (const Vec3& corner : corners) center += corner / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) {
    normal += (corners[i] - center).cross(corners[(i + 1) % count] - center);
  }
  std::vector<Vec3> from_center;
  for (const Vec3& corner : corners) from_center.push_back(corner - center);
  const std::vector<Point> outline = seenAlong(normal.normalized(), from_center);
  bool is_star = true;
  std::vector<Corners> round_center, ears;
  for (std::size_t i = 0; i < count; ++i) {
    is_star = is_star && area(Point::Zero(), outline[i], outline[(i + 1) % count]) >= 0.0;
    round_center.push_back({center, corners[i], corners[(i + 1) % count]});
  }
  if (is_star) return {round_center, spacing};
  for (const auto& ear : clipEars(outline)) {
    ears.push_back({corners[ear[0]], corners[ear[1]], corners[ear[2]]});
  }
  return {ears.empty() ? round_center : ears, spacing};
}

std::optional<Crossing> BladeSurface::crossing(const Vec3& from, const Vec3& to) const {
  const Box segment(from.cwiseMin(to), from.cwiseMax(to));
  for (const Triangle& triangle : triangles_) {
    if (!triangle.box.intersects(segment)) continue;
    const auto& [a, b, c] = triangle.corners;
    const double height_from = triangle.normal.dot(from - a);
    const double height_to = triangle.normal.dot(to - a);
    if ((height_from >= 0.0) == (height_to >= 0.0)) continue;
    const double share = height_from / (height_from - height_to);
    const Vec3 point = from + share * (to - from);
    const bool inside = triangle.normal.dot((b - a).cross(point - a)) >= 0.0 &&
                        triangle.normal.dot((c - b).cross(point - b)) >= 0.0 &&
                        triangle.normal.dot((a - c).cross(point - c)) >= 0.0;
    if (!inside && distanceToEdge(point, a, b) > triangle.slack[0] &&
        distanceToEdge(point, b, c) > triangle.slack[1] &&
        distanceToEdge(point, c, a) > triangle.slack[2]) {
      continue;
    }
    const double along = share + triangle.shift / (height_from - height_to);
    return Crossing{-1, along, point, std::abs(triangle.normal.dot((to - from).normalized()))};
  }
  return std::nullopt;
}

BladeSurface::Nearest BladeSurface::nearestTo(const Vec3& point) const {
  const Vec3 shifted = point + slack_ * kShift;
  Nearest nearest;
  double least = kInfinity;
  for (const Triangle& triangle : triangles_) {
    const Vec3 weights = nearestInTriangle(shifted, triangle.corners);
    const auto& [a, b, c] = triangle.corners;
    const Vec3 found = weights[0] * a + weights[1] * b + weights[2] * c;
    const double distance = (found - shifted).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = {found - slack_ * kShift, triangle.normal};
  }
  return nearest;
}

std::vector<Crossing> BladeSurface::crossings(const Lattice& lattice,
                                              const LatticeState& state) const {
  if (triangles_.empty()) return {};
  const auto position = [&](int node) -> Vec3 {
    return lattice.restPosition(node) + state.displacement[at(node)];
  };
  std::vector<std::uint8_t> sides(at(lattice.nodeCount()));
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    sides[at(node)] = sidesOf(bounds_, position(node));
  }
  std::vector<Crossing> all;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const int spring = lattice.springOf(node, 2 * axis + 1);
      if (spring < 0 || state.severed[at(spring)] != 0) continue;
      const int other = lattice.neighbor(node, 2 * axis + 1);
      if ((sides[at(node)] & sides[at(other)]) != 0) continue;
      std::optional<Crossing> found = crossing(position(node), position(other));
      if (!found) continue;
      found->spring = spring;
      all.push_back(*found);
    }
  }
  return all;
}

double newSurface(const Lattice& lattice, const std::vector<Crossing>& crossings) {
  double surface = 0.0;
  for (const Crossing& each : crossings) {
    double filled = 0.0;
    for (const int cell : cellsAround(lattice, lattice.springs()[at(each.spring)])) {
      if (cell >= 0) filled += lattice.cells()[at(cell)].share();
    }
    surface += each.cosine * filled / 4.0 * lattice.spacing() * lattice.spacing();
  }
  return surface;
}

}  // namespace robot_tissue
