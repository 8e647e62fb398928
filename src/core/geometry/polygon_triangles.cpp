#include "geometry/polygon_triangles.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace robot_tissue {
namespace {

// Fullness below zero (1) that is none. Rounding.
constexpr double kTurnedOver = -1e-9;

using Point = Eigen::Vector2d;

std::vector<Point> flattened(const std::vector<Vec3>& corners, const Vec3& normal) {
  const Vec3 along = normal.unitOrthogonal(), across = normal.normalized().cross(along);
  std::vector<Point> points;
  for (const Vec3& corner : corners) {
    const Vec3 from_first = corner - corners.front();
    points.emplace_back(along.dot(from_first), across.dot(from_first));
  }
  return points;
}

// `area`: twice the triangle's.
template <typename Place>
double overLongestSide(double area, const Place& a, const Place& b, const Place& c) {
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0.0 ? area / longest : 0.0;
}

// Below zero: turned over.
double signedFullness(const Point& a, const Point& b, const Point& c) {
  const double area = (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
  return overLongestSide(area, a, b, c);
}

// Of each part of the polygon from one corner on to another, cut off by the line between them: how
// thin its thinnest triangle is at best, and the corner that the triangle on that line has then.
class BestTriangles {
 public:
  explicit BestTriangles(std::vector<Point> points)
      : points_(std::move(points)),
        count_(static_cast<int>(points_.size())),
        parts_(at(count_ * count_)) {
    for (int length = 2; length < count_; ++length) {
      for (int first = 0; first + length < count_; ++first) find(first, first + length);
    }
  }

  double thinnest() const { return part(0, count_ - 1).thinnest; }

  void add(int first, int last, std::vector<MeshTriangle>& to) const {
    if (last - first < 2) return;
    const int tip = part(first, last).tip;
    to.push_back({first, tip, last});
    add(first, tip, to);
    add(tip, last, to);
  }

 private:
  struct Part {
    double thinnest = std::numeric_limits<double>::infinity();
    int tip = -1;
  };

  const Part& part(int first, int last) const { return parts_[at(first * count_ + last)]; }

  void find(int first, int last) {
    Part best;
    for (int tip = first + 1; tip < last; ++tip) {
      const double thinnest =
          std::min({signedFullness(points_[at(first)], points_[at(tip)], points_[at(last)]),
                    part(first, tip).thinnest, part(tip, last).thinnest});
      if (best.tip < 0 || thinnest > best.thinnest) best = {thinnest, tip};
    }
    parts_[at(first * count_ + last)] = best;
  }

  std::vector<Point> points_;
  int count_;
  std::vector<Part> parts_;
};

}  // namespace

double fullness(const Vec3& a, const Vec3& b, const Vec3& c) {
  return overLongestSide((b - a).cross(c - a).norm(), a, b, c);
}

// Triangles that are all turned as the polygon do not overlap.
PolygonTriangles polygonTriangles(const std::vector<Vec3>& corners, const Vec3& normal) {
  PolygonTriangles found;
  if (corners.size() < 3) return found;
  const BestTriangles best(flattened(corners, normal));
  found.thinnest = best.thinnest();
  if (found.thinnest >= kTurnedOver) {
    best.add(0, static_cast<int>(corners.size()) - 1, found.triangles);
  }
  return found;
}

}  // namespace robot_tissue
