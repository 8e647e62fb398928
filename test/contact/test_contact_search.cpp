// What FCL's trees and traversals find beside what all triangles, asked one by one, do.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

#include "broad_phase.h"
#include "contact_fixtures.h"
#include "surface_traversal.h"

namespace robot_tissue::test_contact_search {
namespace {

constexpr double kCell = 0.005;
const Eigen::Vector3i kCells(12, 10, 6);

Vec3 somewhere(std::mt19937& random, double low, double high) {
  std::uniform_real_distribution<double> number(low, high);
  return {number(random), number(random), number(random)};
}

std::vector<Vec3> shaken(const std::vector<Vec3>& vertices, std::mt19937& random) {
  std::vector<Vec3> moved = vertices;
  for (Vec3& vertex : moved) vertex += somewhere(random, -0.4 * kCell, 0.4 * kCell);
  return moved;
}

Corners cornersOf(const Sheet& sheet, const std::vector<Vec3>& vertices, std::size_t triangle) {
  const auto& [a, b, c] = sheet.surface.triangles[triangle];
  return {vertices[at(a)], vertices[at(b)], vertices[at(c)]};
}

double nearestOfAll(const Sheet& sheet, const std::vector<Vec3>& vertices, const Vec3& point) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < sheet.surface.triangles.size(); ++k) {
    const Corners corners = cornersOf(sheet, vertices, k);
    const double distance = (pointOf(corners, nearestInTriangle(point, corners)) - point).norm();
    if (distance < least) least = distance;  // false where it is not a number
  }
  return least;
}

std::vector<CollisionShape> shapesOf(const ToolShape& shape) {
  std::vector<std::string> warnings;
  std::vector<CollisionShape> shapes;
  shapes.emplace_back(shape, "probe", warnings);
  return shapes;
}

TEST(TriangleBvh, FindsTheNearestOfAllTrianglesWhereverTheyMove) {
  std::mt19937 random(1);
  const Sheet block = makeBlock(kCells, kCell);
  TriangleBvh tree(block.vertices, block.surface.triangles);
  for (int move = 0; move < 3; ++move) {
    const std::vector<Vec3> vertices = shaken(block.vertices, random);
    EXPECT_TRUE(tree.moveTo(vertices));
    for (int i = 0; i < 60; ++i) {
      const Vec3 point = somewhere(random, -0.04, 0.07);
      const auto nearest = tree.nearest(point, 1.0);
      ASSERT_TRUE(nearest);
      EXPECT_NEAR(nearest->distance, nearestOfAll(block, vertices, point), 1e-12);
      EXPECT_FALSE(tree.nearest(point, 0.99 * nearest->distance));
    }
  }
}

// Parts of the tree are split up when a search first comes there, by the shape that it was made of.
TEST(TriangleBvh, IsTheSameWhereverTheFirstSearchCame) {
  std::mt19937 random(6);
  const Sheet block = makeBlock(kCells, kCell);
  TriangleBvh early(block.vertices, block.surface.triangles);
  for (int i = 0; i < 60; ++i) early.nearest(somewhere(random, -0.04, 0.07), 1.0);
  TriangleBvh late(block.vertices, block.surface.triangles);
  const std::vector<Vec3> vertices = shaken(block.vertices, random);
  EXPECT_TRUE(early.moveTo(vertices));
  EXPECT_TRUE(late.moveTo(vertices));
  for (int i = 0; i < 60; ++i) {
    const Vec3 point = somewhere(random, -0.04, 0.07);
    const auto one = early.nearest(point, 1.0), other = late.nearest(point, 1.0);
    ASSERT_TRUE(one && other);
    EXPECT_EQ(one->triangle, other->triangle);
    EXPECT_EQ(one->distance, other->distance);
    EXPECT_EQ(early.isInside(point), late.isInside(point));
  }
}

TEST(TriangleBvh, TellsWhetherAnythingMoved) {
  std::mt19937 random(2);
  const Sheet block = makeBlock(kCells, kCell);
  TriangleBvh tree(block.vertices, block.surface.triangles);
  EXPECT_FALSE(tree.moveTo(block.vertices));
  std::vector<Vec3> vertices = block.vertices;
  vertices[17].x() += 1e-9;
  EXPECT_TRUE(tree.moveTo(vertices));
  EXPECT_FALSE(tree.moveTo(vertices));
}

TEST(TriangleBvh, KnowsInsideFromOutside) {
  std::mt19937 random(3);
  const Sheet block = makeBlock(kCells, kCell);
  const TriangleBvh tree(block.vertices, block.surface.triangles);
  const Box inside = tree.bounds();
  EXPECT_TRUE(inside.sizes().isApprox(kCell * kCells.cast<double>()));
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = somewhere(random, -0.04, 0.07);
    EXPECT_EQ(tree.isInside(point), inside.contains(point)) << point.transpose();
  }
}

TEST(TriangleBvh, LeavesOutTrianglesWithACornerThatIsNoNumber) {
  std::mt19937 random(4);
  const Sheet block = makeBlock(kCells, kCell);
  TriangleBvh tree(block.vertices, block.surface.triangles);
  std::vector<Vec3> vertices = block.vertices;
  vertices[5] = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  vertices[40].y() = std::numeric_limits<double>::infinity();
  tree.moveTo(vertices);
  for (int i = 0; i < 60; ++i) {
    const Vec3 point = somewhere(random, -0.04, 0.07);
    const auto nearest = tree.nearest(point, 1.0);
    ASSERT_TRUE(nearest);
    EXPECT_NEAR(nearest->distance, nearestOfAll(block, vertices, point), 1e-12);
  }
}

TEST(SurfaceTraversal, MissesNoTriangleThatIsNear) {
  constexpr double kMargin = 0.3 * kCell;
  std::mt19937 random(5);
  const Sheet block = makeBlock(kCells, kCell);
  const std::vector<Vec3> vertices = shaken(block.vertices, random);
  TriangleBvh tree(block.vertices, block.surface.triangles);
  tree.moveTo(vertices);
  int near_ones = 0, found_ones = 0;
  for (const ToolShape& shape :
       {sphere(0.008), box(Vec3(0.01, 0.02, 0.03)), cylinder(0.002, 0.05), plane()}) {
    const std::vector<CollisionShape> shapes = shapesOf(shape);
    for (int i = 0; i < 10; ++i) {
      const Pose pose = makePose(somewhere(random, -0.02, 0.05), 2.0, somewhere(random, 0.1, 1.0));
      const PlacedLink link = placed(shapes, pose);
      const std::vector<int> found = trianglesNear(link.front(), tree, kMargin);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      found_ones += static_cast<int>(found.size());
      for (std::size_t k = 0; k < block.surface.triangles.size(); ++k) {
        const Corners corners = cornersOf(block, vertices, k);
        const Vec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
        const bool is_near = std::any_of(corners.begin(), corners.end(), [&](const Vec3& corner) {
          return wayOut(link, corner, kMargin).has_value();
        });
        if (!is_near && !wayOut(link, middle, kMargin)) continue;
        ++near_ones;
        EXPECT_TRUE(std::binary_search(found.begin(), found.end(), static_cast<int>(k)));
      }
    }
  }
  EXPECT_GT(near_ones, 200);
  EXPECT_LT(found_ones, 3 * near_ones);
}

TEST(SurfaceTraversal, PairsEachTriangleWithTheFacesBesideIt) {
  constexpr double kMargin = 0.002;
  const Sheet block = makeBlock(kCells, kCell);
  const TriangleBvh tree(block.vertices, block.surface.triangles);
  const std::vector<CollisionShape> shapes =
      shapesOf(mesh(writeStl("pairs.stl", forkTriangles(0.004, 0.004, 0.02, 0.01))));
  const PlacedLink link =
      placed(shapes, makePose(Vec3(0.03, 0.025, -0.001), 0.4, Vec3(1.0, 0.5, 0.2)));
  const FacePairs pairs(link.front(), tree, kMargin);
  const ToolMesh& tool = link.front().shape->mesh();
  int near_ones = 0;
  std::vector<int> faces;
  for (std::size_t k = 0; k < block.surface.triangles.size(); ++k) {
    Corners corners = cornersOf(block, block.vertices, k);
    for (Vec3& corner : corners) corner = link.front().shape_T_tissue * corner;
    pairs.facesNear(static_cast<int>(k), faces);
    for (int face = 0; face < static_cast<int>(tool.triangles().size()); ++face) {
      const Corners of_face = tool.corners(face);
      const auto meets = [&](const Vec3& point) {
        return (pointOf(of_face, nearestInTriangle(point, of_face)) - point).norm() < kMargin;
      };
      if (std::none_of(corners.begin(), corners.end(), meets)) continue;
      ++near_ones;
      EXPECT_TRUE(std::binary_search(faces.begin(), faces.end(), face));
    }
  }
  EXPECT_GT(near_ones, 10);
}

TEST(BroadPhase, TellsTheShapesThatComeNearAndNoOthers) {
  std::vector<CollisionShape> two = shapesOf(sphere(0.01));
  two.push_back(shapesOf(placedAt(makePose(Vec3(0.5, 0.0, 0.0)), sphere(0.01))).front());
  const std::vector<CollisionShape> one = shapesOf(box(Vec3::Constant(0.02))), none,
                                    below = shapesOf(plane());
  BroadPhase phase;
  phase.addLink(two);
  phase.addLink(none);
  phase.addLink(one);
  phase.addLink(below);
  const Box tissue(Vec3::Zero(), Vec3(0.1, 0.1, 0.05));
  const auto near = [&](const Vec3& first, const Vec3& third, double floor) {
    std::vector<PlacedLink> links = {placed(two, makePose(first)),
                                     {},
                                     placed(one, makePose(third)),
                                     placed(below, makePose(Vec3(0.0, 0.0, floor)))};
    std::vector<std::pair<std::size_t, std::size_t>> found;
    for (const auto& [link, shape] : phase.nearTo(tissue, links, 0.001)) {
      found.emplace_back(link, shape);
    }
    return found;
  };
  using Found = std::vector<std::pair<std::size_t, std::size_t>>;
  const Vec3 far(3.0, 3.0, 3.0), there(0.05, 0.05, 0.055);
  EXPECT_EQ(near(far, far, -1.0), Found());
  EXPECT_EQ(near(there, far, -1.0), (Found{{0, 0}}));
  EXPECT_EQ(near(there - Vec3(0.5, 0.0, 0.0), there, -1.0), (Found{{0, 1}, {2, 0}}));
  EXPECT_EQ(near(far, far, 0.0), (Found{{3, 0}}));
  EXPECT_EQ(near(Vec3(0.05, 0.05, 0.0605), far, -1.0), (Found{{0, 0}})) << "within the margin";
  EXPECT_EQ(near(Vec3(0.05, 0.05, 0.0615), far, -1.0), Found()) << "beyond it";
}

}  // namespace
}  // namespace robot_tissue::test_contact_search
