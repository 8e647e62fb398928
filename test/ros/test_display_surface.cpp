// The drawn surface: the shape that tools touch, smooth where it bends, without a gap; its colors.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "robot_tissue/core/tissue.h"
#include "robot_tissue/ros/display_surface.h"
#include "robot_tissue/ros/surface_colors.h"

namespace robot_tissue::test_display_surface {
namespace {

constexpr double kWidth = 0.1, kSpacing = 0.01;  // m

Tissue block() {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(kWidth, kWidth, 0.05);
  tissue.spacing = kSpacing;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return {tissue, SolverConfig()};
}

// The middle of the top goes down by that much.
void press(Tissue& tissue, double depth) {
  PatchConfig patch;
  patch.name = "pressed";
  patch.box = {Vec3(0.035, 0.035, 0.049), Vec3(0.065, 0.065, 0.051)};
  patch.displacement = {{0.0, 0.0, -depth}};
  LoadStep step;
  step.patches = {patch};
  tissue.load(step);
}

std::vector<Vec3> drawn(const Tissue& tissue) {
  DisplaySurface display;
  display.bind(tissue.surface());
  display.fit(tissue.vertices());
  DrawnTriangles triangles;
  for (const bool opened : {false, true}) display.draw(opened, nullptr, triangles);
  return triangles.points;
}

double volumeWithin(const std::vector<Vec3>& corners) {
  double volume = 0.0;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    volume += corners[i].dot(corners[i + 1].cross(corners[i + 2])) / 6.0;
  }
  return volume;
}

struct Segment {
  Vec3 from, to;
};

// Those that no other triangle has the other way round.
std::vector<Segment> loneEdges(const std::vector<Vec3>& corners) {
  using Point = std::tuple<long, long, long>;
  const auto place = [](const Vec3& point) {
    return Point{std::lround(1e9 * point.x()), std::lround(1e9 * point.y()),
                 std::lround(1e9 * point.z())};
  };
  std::map<std::pair<Point, Point>, std::vector<Segment>> edges;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 &from = corners[i + k], &to = corners[i + (k + 1) % 3];
      const auto back = edges.find({place(to), place(from)});
      if (back == edges.end()) {
        edges[{place(from), place(to)}].push_back({from, to});
      } else {
        back->second.pop_back();
        if (back->second.empty()) edges.erase(back);
      }
    }
  }
  std::vector<Segment> lone;
  for (const auto& [key, each] : edges) lone.insert(lone.end(), each.begin(), each.end());
  return lone;
}

double distanceTo(const Segment& segment, const Vec3& point) {
  const Vec3 way = segment.to - segment.from;
  const double share = std::clamp((point - segment.from).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (segment.from + share * way - point).norm();
}

// Where a triangle is drawn finer than its neighbor its edges lie on the neighbor's.
bool isWithoutAGap(const std::vector<Vec3>& corners) {
  const std::vector<Segment> lone = loneEdges(corners);
  return std::all_of(lone.begin(), lone.end(), [&](const Segment& edge) {
    const Vec3 middle = 0.5 * (edge.from + edge.to);
    return std::any_of(lone.begin(), lone.end(), [&](const Segment& other) {
      const bool goes_back = (other.to - other.from).dot(edge.to - edge.from) < 0.0;
      return goes_back && distanceTo(other, middle) < 1e-8;
    });
  });
}

TEST(DisplaySurface, OfABlockAtRestIsItsOwnTriangles) {
  const Tissue tissue = block();
  const std::vector<Vec3> corners = drawn(tissue);
  EXPECT_EQ(corners.size(), 3 * tissue.surface().triangles.size());
  EXPECT_NEAR(volumeWithin(corners), kWidth * kWidth * 0.05, 1e-12);
}

TEST(DisplaySurface, IsFinerWhereItBendsAndHoldsTheSameVolume) {
  Tissue tissue = block();
  press(tissue, 0.008);
  const std::vector<Vec3> corners = drawn(tissue);
  EXPECT_GT(corners.size(), 3 * tissue.surface().triangles.size());
  EXPECT_TRUE(isWithoutAGap(corners));
  std::vector<Vec3> one_less(corners.begin() + 3, corners.end());
  EXPECT_FALSE(isWithoutAGap(one_less));
  const double volume = enclosedVolume(tissue.surface(), tissue.vertices());
  EXPECT_NEAR(volumeWithin(corners) / volume, 1.0, 2e-3);
  Box drawn_bounds;
  for (const Vec3& corner : corners) drawn_bounds.extend(corner);
  EXPECT_NEAR((drawn_bounds.max() - tissue.bounds().max()).norm(), 0.0, 0.3 * kSpacing);
  EXPECT_NEAR((drawn_bounds.min() - tissue.bounds().min()).norm(), 0.0, 0.3 * kSpacing);
}

TEST(DisplaySurface, ShowsTheLipsOfAWoundThatIsShut) {
  Tissue tissue = block();
  tissue.cut({Vec3(0.02, 0.053, 0.06), Vec3(0.08, 0.053, 0.06), Vec3(0.08, 0.053, 0.03),
              Vec3(0.02, 0.053, 0.03)});
  DisplaySurface display;
  display.bind(tissue.surface());
  display.fit(tissue.vertices());
  std::vector<Vec3> ends;
  display.drawLips(ends);
  ASSERT_FALSE(ends.empty());
  for (const Vec3& end : ends) EXPECT_NEAR(end.z(), 0.05, 1e-9);
  EXPECT_NEAR(volumeWithin(drawn(tissue)), kWidth * kWidth * 0.05, 1e-12);
}

TEST(SurfaceColors, AreNamedAndNothingElseIs) {
  for (const ColorBy color :
       {ColorBy::kNone, ColorBy::kDisplacement, ColorBy::kStrain, ColorBy::kPressure}) {
    EXPECT_EQ(colorByName(meaningOf(color).name), color);
  }
  EXPECT_FALSE(colorByName("temperature"));
  EXPECT_EQ(colorNames(), (std::vector<std::string>{"none", "displacement", "strain", "pressure"}));
}

TEST(SurfaceColors, HaveARoundScaleThatStaysWhileItIsInUse) {
  EXPECT_DOUBLE_EQ(scaleFor({0.3, 3.4}, 0.0), 5.0);
  EXPECT_DOUBLE_EQ(scaleFor({12.0}, 5.0), 20.0);
  EXPECT_DOUBLE_EQ(scaleFor({4.5}, 20.0), 20.0);
  EXPECT_DOUBLE_EQ(scaleFor({1.5}, 20.0), 2.0);
  EXPECT_GT(scaleFor({}, 0.0), 0.0);
}

TEST(SurfaceColors, TellTheDisplacementInMillimeters) {
  Pipeline pipeline(
      [] {
        TissueConfig tissue;
        tissue.shape.max() = Vec3(kWidth, kWidth, 0.05);
        tissue.spacing = kSpacing;
        tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
        return tissue;
      }(),
      SolverConfig(), {});
  PatchConfig patch;
  patch.name = "top";
  patch.box = {Vec3(-1.0, -1.0, 0.049), Vec3(1.0, 1.0, 0.051)};
  patch.displacement = {{0.0, 0.0, 0.005}};
  LoadStep step;
  step.patches = {patch};
  pipeline.load(step);
  const std::vector<double> moved = surfaceValues(ColorBy::kDisplacement, pipeline);
  EXPECT_NEAR(*std::max_element(moved.begin(), moved.end()), 5.0, 1e-6);
  const std::vector<double> strain = surfaceValues(ColorBy::kStrain, pipeline);
  EXPECT_GT(*std::max_element(strain.begin(), strain.end()), 5.0);
  EXPECT_LT(*std::max_element(strain.begin(), strain.end()), 40.0);
  EXPECT_TRUE(surfaceValues(ColorBy::kNone, pipeline).empty());
}

}  // namespace
}  // namespace robot_tissue::test_display_surface
