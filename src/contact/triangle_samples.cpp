#include "triangle_samples.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {
namespace {

constexpr double kSameWeights = 1e-6;
constexpr double kSpeck = 1e-3;  // of the samples' spacing: a triangle that is but a point

int subdivisions(double length, const SampleGrid& grid) {
  if (!(length > kSpeck * grid.spacing)) return 1;
  const double needed = std::min<double>(kMaxSubdivisions, std::ceil(length / grid.spacing));
  return std::max(grid.least_subdivisions, static_cast<int>(needed));
}

// Adds a foot unless it is a vertex, lies on an edge (`least` weight zero) or is a sample already.
void addFoot(const Vec3& weights, double least, std::vector<Vec3>& samples) {
  if (least < kSameWeights) return;
  for (const Vec3& sample : samples) {
    if ((sample - weights).cwiseAbs().maxCoeff() < kSameWeights) return;
  }
  samples.push_back(weights);
}

void sampleEdge(int from, const Vec3& a, const Vec3& b, const SampleGrid& sample_grid,
                const std::vector<Vec3>& centers, std::vector<Vec3>& samples) {
  const int to = (from + 1) % 3;
  const auto weights = [&](double t) {
    Vec3 at = Vec3::Zero();
    at[from] = 1.0 - t;
    at[to] = t;
    return at;
  };
  const double length = (b - a).norm();
  if (!(length > 0.0)) return;
  const int grid = subdivisions(length, sample_grid);
  for (int k = 1; k < grid; ++k) samples.push_back(weights(static_cast<double>(k) / grid));
  for (const Vec3& center : centers) {
    const double t = (center - a).dot(b - a) / (length * length);
    addFoot(weights(t), std::min(t, 1.0 - t), samples);
  }
}

void sampleInterior(const std::array<Vec3, 3>& corners, int grid, const std::vector<Vec3>& centers,
                    std::vector<Vec3>& samples) {
  for (int i = 1; i < grid - 1; ++i) {
    for (int j = 1; j < grid - i; ++j) {
      samples.push_back(Vec3(i, j, grid - i - j) / grid);
    }
  }
  for (const Vec3& center : centers) {
    const Vec3 foot = nearestInTriangle(center, corners[0], corners[1], corners[2]);
    addFoot(foot, foot.minCoeff(), samples);
  }
}

}  // namespace

// Ericson, "Real-Time Collision Detection", section 5.1.5: Voronoi regions of the triangle.
Vec3 nearestInTriangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const double d1 = ab.dot(p - a);
  const double d2 = ac.dot(p - a);
  if (d1 <= 0.0 && d2 <= 0.0) return Vec3(1.0, 0.0, 0.0);
  const double d3 = ab.dot(p - b);
  const double d4 = ac.dot(p - b);
  if (d3 >= 0.0 && d4 <= d3) return Vec3(0.0, 1.0, 0.0);
  const double area_c = d1 * d4 - d3 * d2;
  if (area_c <= 0.0 && d1 >= 0.0 && d3 <= 0.0) {
    const double t = d1 / (d1 - d3);
    return Vec3(1.0 - t, t, 0.0);
  }
  const double d5 = ab.dot(p - c);
  const double d6 = ac.dot(p - c);
  if (d6 >= 0.0 && d5 <= d6) return Vec3(0.0, 0.0, 1.0);
  const double area_b = d5 * d2 - d1 * d6;
  if (area_b <= 0.0 && d2 >= 0.0 && d6 <= 0.0) {
    const double t = d2 / (d2 - d6);
    return Vec3(1.0 - t, 0.0, t);
  }
  const double area_a = d3 * d6 - d5 * d4;
  if (area_a <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    const double t = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return Vec3(0.0, 1.0 - t, t);
  }
  return Vec3(area_a, area_b, area_c) / (area_a + area_b + area_c);
}

void sampleTriangle(const std::array<int, 3>& triangle, const std::vector<Vec3>& vertices,
                    const SampleGrid& grid, const std::vector<Vec3>& centers,
                    std::vector<Vec3>& samples) {
  samples.clear();
  std::array<Vec3, 3> corners;
  for (std::size_t k = 0; k < 3; ++k) corners[k] = vertices[static_cast<std::size_t>(triangle[k])];
  double longest = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    longest = std::max(longest, (corners[next] - corners[k]).norm());
    if (triangle[k] < triangle[next]) {
      sampleEdge(static_cast<int>(k), corners[k], corners[next], grid, centers, samples);
    }
  }
  sampleInterior(corners, subdivisions(longest, grid), centers, samples);
}

}  // namespace robot_tissue
