#include "robot_tissue/core/indenter.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "robot_tissue/core/triangle_point.h"

namespace robot_tissue {
namespace {

// More: more exact; 32 levels: to 0.3 %.
constexpr int kLevels = 32;
// Of the highest level (1): the lowest one. Lower contacts count as flat.
constexpr double kLowestLevel = 1e-3;
// How much higher (1), of the standard deviation of heights over their best plane, a shape is in
// the mean under a flat punch's pressure than in the mean of its area: 0.577 (sphere), 0.501
// (cone), 0.559 (lying cylinder), 0.474 (edge).
constexpr double kHigherUnderPressure = 0.53;
// Of the cosine with the way a shape presses: walls that are steeper do not count.
constexpr double kSteepest = 1e-6;
// Of the longer axis, squared: the shorter one is no less. Of what is a line.
constexpr double kThinnest = 1e-8;

// Moments of points (x, y, height) over an area, as seen along the way.
struct Moments {
  double area = 0.0;  // m^2
  Vec3 first = Vec3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();

  void addTriangle(const std::array<Vec3, 3>& corners) {
    const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[0];
    const double piece = 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
    const Vec3 sum = corners[0] + corners[1] + corners[2];
    Eigen::Matrix3d squares = sum * sum.transpose();
    for (const Vec3& corner : corners) squares += corner * corner.transpose();
    area += piece;
    first += piece / 3.0 * sum;
    second += piece / 12.0 * squares;
  }
  void add(const Moments& other) {
    area += other.area;
    first += other.first;
    second += other.second;
  }
};

Vec3 atLevel(const Vec3& low, const Vec3& high, double level) {
  return low + (level - low.z()) / (high.z() - low.z()) * (high - low);
}

// Of the triangle, what is below the level; corners from low to high.
void addBelow(const std::array<Vec3, 3>& corners, double level, Moments& moments) {
  const auto& [low, middle, high] = corners;
  if (level >= high.z()) {
    moments.addTriangle(corners);
  } else if (level > middle.z()) {
    const Vec3 left = atLevel(low, high, level), right = atLevel(middle, high, level);
    moments.addTriangle({low, middle, right});
    moments.addTriangle({low, right, left});
  } else if (level > low.z()) {
    moments.addTriangle({low, atLevel(low, middle, level), atLevel(low, high, level)});
  }
}

// From low to high (m).
std::array<double, kLevels> levelsUpTo(double up_to) {
  std::array<double, kLevels> heights{};
  for (int level = 0; level < kLevels; ++level) {
    heights[at(level)] = up_to * std::pow(kLowestLevel, 1.0 - (level + 1.0) / kLevels);
  }
  return heights;
}

// What is below each level, of triangles that are added one by one.
class Levels {
 public:
  explicit Levels(double up_to) : heights_(levelsUpTo(up_to)) {}

  void add(std::array<Vec3, 3> corners) {
    std::sort(corners.begin(), corners.end(),
              [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
    int level = 0;
    while (level < kLevels && heights_[at(level)] <= corners[0].z()) ++level;
    for (; level < kLevels && heights_[at(level)] < corners[2].z(); ++level) {
      addBelow(corners, heights_[at(level)], partly_[at(level)]);
    }
    if (level < kLevels) whole_[at(level)].addTriangle(corners);
  }

  std::vector<Moments> all() const {
    std::vector<Moments> all;
    Moments whole;
    for (int level = 0; level < kLevels; ++level) {
      whole.add(whole_[at(level)]);
      all.push_back(whole);
      all.back().add(partly_[at(level)]);
    }
    return all;
  }

 private:
  std::array<double, kLevels> heights_;  // m
  std::array<Moments, kLevels> partly_;  // of triangles across the level
  std::array<Moments, kLevels> whole_;   // of triangles that are below it and across the last
};

// Of half-axes that have its second moments, made less where its area is less than theirs, as that
// of a ring or of two pieces, by the mean of both. Of rectangles up to 8:1, triangles and rings
// that is right to 2 %.
PunchLevel punchOf(const Moments& moments) {
  const Vec3 mean = moments.first / moments.area;
  const Eigen::Matrix3d spread = moments.second / moments.area - mean * mean.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spread.topLeftCorner<2, 2>());
  const double most = axes.eigenvalues()[1];
  PunchLevel punch;
  if (!(most > 0.0)) return punch;
  const double least = std::max(axes.eigenvalues()[0], kThinnest * most);
  const double of_ellipse = 4.0 * M_PI * std::sqrt(least * most);
  const double less = std::pow(std::min(1.0, moments.area / of_ellipse), 0.25);
  const double half_length = 2.0 * less * std::sqrt(most),
               half_width = 2.0 * less * std::sqrt(least);
  const Eigen::Vector2d sheared = axes.eigenvectors().transpose() * spread.topRightCorner<2, 1>();
  const double off_plane =
      spread(2, 2) - sheared[0] * sheared[0] / least - sheared[1] * sheared[1] / most;
  punch.give = giveOfEllipse(half_length, half_width);
  punch.height = mean.z() + kHigherUnderPressure * std::sqrt(std::max(0.0, off_plane));
  punch.middle.head<2>() = mean.head<2>();
  punch.long_axis.head<2>() = half_length * axes.eigenvectors().col(1);
  punch.short_axis.head<2>() = half_width * axes.eigenvectors().col(0);
  return punch;
}

}  // namespace

double giveOfEllipse(double longer, double shorter) {
  const double ratio = shorter / longer;
  return std::comp_ellint_1(std::sqrt(1.0 - ratio * ratio)) / (M_PI * longer);
}

Indenter::Indenter(TriangleMesh mesh) : mesh_(std::move(mesh)) {
  triangles_.take(mesh_.triangles, mesh_.vertices.size());
  for (const MeshTriangle& triangle : mesh_.triangles) {
    areas_.push_back(doubleArea(mesh_.vertices, triangle));
  }
}

Indenter Indenter::ball(double radius) {
  Indenter ball;
  ball.radius_ = radius;
  return ball;
}

Vec3 Indenter::nearestOn(const IndenterPart& part, const Vec3& point) const {
  if (radius_ > 0.0) return radius_ * point.stableNormalized();
  Nearest nearest{-1, point};
  for (const int triangle : part.triangles) takeIfNearer(triangle, point, nearest);
  return nearest.place;
}

int Indenter::nearestFacing(const Vec3& facing, const Vec3& point) const {
  if (radius_ > 0.0) return 0;
  Nearest nearest;
  for (int triangle = 0; triangle < static_cast<int>(areas_.size()); ++triangle) {
    if (faces(triangle, facing)) takeIfNearer(triangle, point, nearest);
  }
  return nearest.triangle;
}

void Indenter::takeIfNearer(int triangle, const Vec3& point, Nearest& nearest) const {
  const Corners corners = cornersOf(triangle);
  const Vec3 place = pointOf(corners, nearestInTriangle(point, corners));
  const double square = (place - point).squaredNorm();
  if (square < nearest.square) nearest = {triangle, place, square};
}

IndenterPart Indenter::partAround(int triangle, const Vec3& facing, double up_to) const {
  if (radius_ > 0.0) return partOfBall(facing, up_to);
  IndenterPart part;
  part.triangles = hangingTogether(triangle, facing, up_to);
  double deepest = -kInfinity;
  for (const int one : part.triangles) {
    for (const Vec3& corner : cornersOf(one)) {
      part.bounds.extend(corner);
      if (facing.dot(corner) <= deepest) continue;
      deepest = facing.dot(corner);
      part.lowest = corner;
    }
  }
  Eigen::Matrix3d basis;  // rows: across the way, and against it
  basis.row(0) = facing.unitOrthogonal();
  basis.row(1) = facing.cross(Vec3(basis.row(0)));
  basis.row(2) = -facing;
  Levels levels(up_to);
  for (const int one : part.triangles) {
    std::array<Vec3, 3> corners = cornersOf(one);
    for (Vec3& corner : corners) corner = basis * (corner - part.lowest);
    levels.add(corners);
  }
  for (const Moments& moments : levels.all()) {
    PunchLevel punch = punchOf(moments);
    if (!(punch.give > 0.0)) continue;
    punch.middle = part.lowest + basis.transpose() * punch.middle;
    punch.long_axis = basis.transpose() * punch.long_axis;
    punch.short_axis = basis.transpose() * punch.short_axis;
    part.levels.push_back(punch);
  }
  return part;
}

// Discs: a cap of radius a and height R - sqrt(R^2 - a^2) is 1 / 2a of depth under a force, and its
// mean height under a flat punch's pressure, r / (a sqrt(a^2 - r^2)), has that integral (Sneddon
// 1965).
IndenterPart Indenter::partOfBall(const Vec3& facing, double up_to) const {
  IndenterPart part;
  part.lowest = radius_ * facing;
  part.bounds = Box(Vec3::Constant(-radius_), Vec3::Constant(radius_));
  const Vec3 across = facing.unitOrthogonal();
  for (const double height : levelsUpTo(up_to)) {
    if (height >= radius_) break;
    const double disc = std::sqrt(height * (2.0 * radius_ - height));
    const double above = radius_ - height;  // the disc is so far from the middle
    PunchLevel punch;
    punch.give = 0.5 / disc;
    punch.height = 0.5 * (radius_ - above * above / disc * std::atanh(disc / radius_));
    punch.middle = part.lowest;
    punch.long_axis = disc * across;
    punch.short_axis = disc * facing.cross(across);
    part.levels.push_back(punch);
  }
  return part;
}

// By vertices in common, over what faces the tissue.
std::vector<int> Indenter::hangingTogether(int triangle, const Vec3& facing, double up_to) const {
  const auto depthOf = [&](int one) {
    double depth = -kInfinity;
    for (const Vec3& corner : cornersOf(one)) depth = std::max(depth, facing.dot(corner));
    return depth;
  };
  const double least = depthOf(triangle) - up_to;
  std::vector<std::uint8_t> is_seen(mesh_.triangles.size(), 0);
  std::vector<int> found = {triangle};
  is_seen[at(triangle)] = 1;
  for (std::size_t next = 0; next < found.size(); ++next) {
    for (const int vertex : mesh_.triangles[at(found[next])]) {
      for (const int other : triangles_.around(vertex)) {
        if (is_seen[at(other)] != 0) continue;
        is_seen[at(other)] = 1;
        if (faces(other, facing) && depthOf(other) > least) found.push_back(other);
      }
    }
  }
  return found;
}

bool Indenter::faces(int triangle, const Vec3& facing) const {
  return areas_[at(triangle)].dot(facing) > kSteepest * areas_[at(triangle)].norm();
}

std::array<Vec3, 3> Indenter::cornersOf(int triangle) const {
  const auto& [a, b, c] = mesh_.triangles[at(triangle)];
  return {mesh_.vertices[at(a)], mesh_.vertices[at(b)], mesh_.vertices[at(c)]};
}

}  // namespace robot_tissue
