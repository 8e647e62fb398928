// The smooth surface through the vertices of a triangulated one.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "robot_tissue/core/curved_surface.h"
#include "robot_tissue/core/surface_strain.h"
#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue::test_curved_surface {
namespace {

constexpr int kCells = 10;          // along each side
constexpr double kSpacing = 0.005;  // m

// A square of triangles at rest in the plane z = 0 or, beyond `fold`, upright.
TissueSurface square(int fold = kCells) {
  TissueSurface surface;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const int along = std::min(i, fold);
      surface.rest.push_back(kSpacing * Vec3(along, j, along - i));
    }
  }
  const auto vertex = [](int i, int j) { return i + (kCells + 1) * j; };
  for (int j = 0; j < kCells; ++j) {
    for (int i = 0; i < kCells; ++i) {
      surface.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
      surface.triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  }
  surface.revision = 1;
  return surface;
}

constexpr double kRadius = 0.03;  // m

// Lifted onto a ball, or pressed into a bowl (sign -1), of kRadius around the square's middle.
std::vector<Vec3> onBall(const TissueSurface& surface, double sign) {
  std::vector<Vec3> vertices = surface.rest;
  const Vec3 middle(0.5 * kCells * kSpacing, 0.5 * kCells * kSpacing, 0.0);
  for (Vec3& vertex : vertices) {
    const double off = (vertex - middle).norm();
    vertex.z() = sign * std::sqrt(kRadius * kRadius - std::min(off * off, 0.9 * kRadius * kRadius));
  }
  return vertices;
}

struct Place {
  SurfacePoint point;
  Vec3 flat;  // of the triangle (m)
};

void forEachInnerPlace(const TissueSurface& surface, const std::vector<Vec3>& vertices,
                       const std::function<void(const Place&)>& look) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  for (int j = 3; j < kCells - 3; ++j) {
    for (int i = 3; i < kCells - 3; ++i) {
      const int triangle = 2 * (i + kCells * j) + static_cast<int>(random() % 2);
      double u = share(random), v = share(random);
      if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
      const MeshTriangle& corners = surface.triangles[at(triangle)];
      const Vec3 weights(1.0 - u - v, u, v);
      Vec3 flat = Vec3::Zero();
      for (int k = 0; k < 3; ++k) flat += weights[k] * vertices[at(corners[at(k)])];
      look({{triangle, weights}, flat});
    }
  }
}

TEST(CurvedSurface, OfABallIsNearlyTheBall) {
  const TissueSurface surface = square();
  CurvedSurface curved;
  const Vec3 center(0.5 * kCells * kSpacing, 0.5 * kCells * kSpacing, 0.0);
  for (const double sign : {1.0, -1.0}) {
    const std::vector<Vec3> vertices = onBall(surface, sign);
    curved.take(surface, vertices);
    double off = 0.0, flat_off = 0.0, turned = 0.0;
    forEachInnerPlace(surface, vertices, [&](const Place& place) {
      const Vec3 point = place.flat + curved.bulgeAt(place.point);
      off = std::max(off, std::abs((point - center).norm() - kRadius));
      flat_off = std::max(flat_off, std::abs((place.flat - center).norm() - kRadius));
      const Vec3 normal = sign * (point - center).normalized();
      turned = std::max(turned, (curved.normalAt(place.point) - normal).norm());
    });
    EXPECT_GT(flat_off, 5e-5);
    EXPECT_LT(off, 0.1 * flat_off);
    EXPECT_LT(turned, 0.02);
  }
}

TEST(CurvedSurface, SlopesOfItsBulgeAreThoseOfFiniteDifferences) {
  constexpr double kStep = 1e-6;  // of a weight
  const TissueSurface surface = square();
  const std::vector<Vec3> vertices = onBall(surface, 1.0);
  CurvedSurface curved;
  curved.take(surface, vertices);
  forEachInnerPlace(surface, vertices, [&](const Place& place) {
    const Eigen::Matrix3d slopes = curved.bulgeSlopesAt(place.point);
    for (int k = 0; k < 3; ++k) {
      SurfacePoint less = place.point, more = place.point;
      less.barycentric[k] -= kStep;
      more.barycentric[k] += kStep;
      const Vec3 slope = (curved.bulgeAt(more) - curved.bulgeAt(less)) / (2.0 * kStep);
      EXPECT_LT((slopes.col(k) - slope).norm(), 1e-9);
    }
  });
}

TEST(CurvedSurface, OfAPlaneIsThePlaneAlsoWhereItIsStretched) {
  const TissueSurface surface = square();
  std::vector<Vec3> vertices = surface.rest;
  for (Vec3& vertex : vertices) vertex.x() += 5.0 * vertex.x() * vertex.x();
  CurvedSurface curved;
  curved.take(surface, vertices);
  forEachInnerPlace(surface, vertices, [&](const Place& place) {
    EXPECT_LT(curved.bulgeAt(place.point).norm(), 1e-15);
    EXPECT_LT(curved.hollowAt(place.point).norm(), 1e-9);
  });
}

TEST(CurvedSurface, IsSharpWhereTheSurfaceAtRestIs) {
  const int fold = kCells / 2;
  const TissueSurface surface = square(fold);
  CurvedSurface curved;
  curved.take(surface, surface.rest);
  forEachInnerPlace(surface, surface.rest, [&](const Place& place) {
    EXPECT_LT(curved.bulgeAt(place.point).norm(), 1e-15);
  });
}

// A bowl turns its normal by its curvature a way, in each direction along it; a ball is not hollow.
TEST(CurvedSurface, IsAsHollowAsABowl) {
  const TissueSurface surface = square();
  CurvedSurface curved;
  const std::vector<Vec3> bowl = onBall(surface, -1.0), ball = onBall(surface, 1.0);
  forEachInnerPlace(surface, bowl, [&](const Place& place) {
    curved.take(surface, bowl);
    const Eigen::Matrix3d hollow = curved.hollowAt(place.point);
    EXPECT_LT((hollow - hollow.transpose()).norm(), 1e-9);
    const Vec3 normal = doubleArea(bowl, surface.triangles[at(place.point.triangle)]).normalized();
    EXPECT_LT((hollow * normal).norm(), 1e-9);
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    EXPECT_NEAR(along.dot(hollow * along) * kRadius, 1.0, 0.05);
    EXPECT_NEAR(across.dot(hollow * across) * kRadius, 1.0, 0.05);
    curved.take(surface, ball);
    EXPECT_LT(curved.hollowAt(place.point).norm() * kRadius, 0.01);
  });
}

TEST(CurvedSurface, IsNotHollowWhereATriangleHasCollapsed) {
  const TissueSurface surface = square();
  std::vector<Vec3> collapsed = onBall(surface, -1.0);
  const MeshTriangle& corners = surface.triangles[surface.triangles.size() / 2];
  for (const std::size_t corner : {1U, 2U})
    collapsed[at(corners[corner])] = collapsed[at(corners[0])];
  CurvedSurface curved;
  curved.take(surface, collapsed);
  for (int triangle = 0; triangle < static_cast<int>(surface.triangles.size()); ++triangle) {
    EXPECT_TRUE(curved.hollowAt({triangle, Vec3::Constant(1.0 / 3.0)}).allFinite()) << triangle;
  }
}

// What is kept of the shape before, or of another surface, leaves no trace.
TEST(CurvedSurface, IsOfTheShapeThatWasTakenLast) {
  const TissueSurface flat = square();
  TissueSurface folded = square(kCells / 2);
  folded.revision = flat.revision + 1;
  CurvedSurface curved;
  const auto expectTaken = [&](const TissueSurface& surface, const std::vector<Vec3>& vertices) {
    curved.take(surface, vertices);
    CurvedSurface fresh;
    fresh.take(surface, vertices);
    forEachInnerPlace(surface, vertices, [&](const Place& place) {
      EXPECT_EQ(curved.bulgeAt(place.point), fresh.bulgeAt(place.point));
      EXPECT_EQ(curved.normalAt(place.point), fresh.normalAt(place.point));
      EXPECT_EQ(curved.hollowAt(place.point), fresh.hollowAt(place.point));
    });
    for (int vertex = 0; vertex < static_cast<int>(vertices.size()); ++vertex) {
      EXPECT_EQ(curved.doubleAreaAt(vertex), fresh.doubleAreaAt(vertex));
    }
  };
  const std::vector<Vec3> ball = onBall(flat, 1.0), bowl = onBall(flat, -1.0);
  expectTaken(flat, ball);
  expectTaken(flat, bowl);
  expectTaken(flat, bowl);
  std::vector<Vec3> dented = bowl;
  dented[dented.size() / 2].z() -= 1e-4;
  expectTaken(flat, dented);
  expectTaken(folded, folded.rest);
  expectTaken(flat, ball);
}

// Sheared by s, a plane's principal stretches are l and 1/l with l - 1/l = s, whatever the
// rotation.
TEST(SurfaceStrain, IsTheGreatestPrincipalStretchLessOne) {
  const TissueSurface flat = square();
  for (const double strain : surfaceStrains(flat, flat.rest)) EXPECT_NEAR(strain, 0.0, 1e-7);
  constexpr double kShear = 0.4;
  Eigen::Matrix3d sheared = Eigen::Matrix3d::Identity();
  sheared(0, 1) = kShear;
  const Eigen::Matrix3d turned =
      Eigen::AngleAxisd(1.1, Vec3(1.0, 2.0, -1.0).normalized()) * sheared;
  std::vector<Vec3> vertices;
  for (const Vec3& rest : flat.rest) vertices.push_back(turned * rest + Vec3(0.1, 0.0, -0.2));
  const double stretch = 0.5 * kShear + std::sqrt(0.25 * kShear * kShear + 1.0);
  for (const double strain : surfaceStrains(flat, vertices)) {
    EXPECT_NEAR(strain, stretch - 1.0, 1e-12);
  }
}

}  // namespace
}  // namespace robot_tissue::test_curved_surface
