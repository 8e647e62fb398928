// The part of a surface around a point up to where it folds, and what is told by it.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "robot_tissue/core/surface.h"
#include "surface/mean_curvature.h"
#include "surface/smooth_part.h"

namespace robot_tissue::test_smooth_part {
namespace {

constexpr int kCells = 12;                 // along each side
constexpr double kSpacing = 0.005;         // m
constexpr double kReach = 2.1 * kSpacing;  // m

// Squares, each of two triangles, below that height; beyond `fold` their cells turn down.
void addSquare(double height, int fold, TissueSurface& surface) {
  const int first = static_cast<int>(surface.rest.size());
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const int along = std::min(i, fold);
      surface.rest.push_back(kSpacing * Vec3(along, j, along - i) + height * Vec3::UnitZ());
    }
  }
  const auto vertex = [&](int i, int j) { return first + i + (kCells + 1) * j; };
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      surface.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      surface.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
}

// In the middle of the first triangle of a cell.
SurfacePoint pointIn(int i, int j) { return {2 * (i + kCells * j), Vec3::Constant(1.0 / 3.0)}; }

SmoothPart partAround(const TissueSurface& surface, int i, int j, double reach) {
  SmoothParts parts;
  parts.take(surface);
  return parts.around(pointIn(i, j), kSpacing * Vec3(i, j, 0.0), reach);
}

std::vector<int> allWithin(const TissueSurface& surface, const Vec3& middle) {
  std::vector<int> all;
  for (int vertex = 0; vertex < static_cast<int>(surface.rest.size()); ++vertex) {
    if ((surface.rest[at(vertex)] - middle).norm() <= kReach) all.push_back(vertex);
  }
  return all;
}

// A flat top beside a wall is flat; with the vertices of the wall it would seem to bulge.
TEST(SmoothPart, EndsAtASharpFold) {
  TissueSurface surface;
  addSquare(0.0, 7, surface);
  const Vec3 middle = kSpacing * Vec3(6, 6, 0);
  const SmoothPart part = partAround(surface, 6, 6, kReach);
  EXPECT_EQ(part.vertices.size(), 12u) << "of the 13 on a whole plane, all but the one beyond it";
  const auto curvature = [&](const std::vector<int>& vertices) {
    return meanCurvature(surface.rest, vertices, middle, Vec3::UnitZ(), kReach);
  };
  EXPECT_NEAR(curvature(part.vertices), 0.0, 1e-9);
  EXPECT_GT(curvature(allWithin(surface, middle)), 0.02 / kSpacing);
}

// What lies beside it and looks the same way, as the lobe of another organ, is none of it.
TEST(SmoothPart, HangsTogether) {
  TissueSurface surface;
  addSquare(0.0, kCells, surface);
  const std::vector<int> alone = partAround(surface, 6, 6, kReach).vertices;
  EXPECT_EQ(alone.size(), 13u);
  addSquare(-0.3 * kSpacing, kCells, surface);
  EXPECT_EQ(partAround(surface, 6, 6, kReach).vertices, alone);
}

TEST(SmoothPart, TellsTheWayInwardsWhateverDentsIt) {
  TissueSurface surface;
  addSquare(0.0, 7, surface);
  std::vector<Vec3> vertices = surface.rest;
  for (Vec3& vertex : vertices) {
    const Vec3 off = vertex - kSpacing * Vec3(5.3, 5.8, 0.0);
    if (off.norm() < 1.6 * kSpacing) vertex.z() -= 0.4 * kSpacing * (2.0 + off.x() / kSpacing);
  }
  const SmoothPart part = partAround(surface, 6, 6, 1.5 * kReach);
  EXPECT_LT((inwardsAroundDent(surface, vertices, part) + Vec3::UnitZ()).norm(), 1e-9);
}

}  // namespace
}  // namespace robot_tissue::test_smooth_part
