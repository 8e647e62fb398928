// Polygons that are not flat and swept surfaces: which springs they sever.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "block_fixtures.h"
#include "cutting/blade_surface.h"
#include "cutting/cut.h"
#include "lattice/connectivity.h"

namespace robot_tissue::test_blade_surface {
namespace {

constexpr double kSpacing = 0.01;

using Corners = std::vector<Vec3>;
using Triangles = std::vector<BladeSurface::Corners>;

// A sheet y(x) over z from end to end, in strips.
Triangles sheet(const std::vector<Vec3>& profile, double from_z, double to_z) {
  Triangles triangles;
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const Vec3 a(profile[i].x(), profile[i].y(), from_z), b(profile[i].x(), profile[i].y(), to_z);
    const Vec3 c(profile[i + 1].x(), profile[i + 1].y(), from_z);
    const Vec3 d(profile[i + 1].x(), profile[i + 1].y(), to_z);
    triangles.push_back({a, c, d});
    triangles.push_back({a, d, b});
  }
  return triangles;
}

// A saddle over the whole block parts it, whichever way round its corners are told.
TEST(WarpedPolygon, SeversOneSpringOfEveryRowAndParts) {
  const Lattice lattice(blockOf(6, 6, 6));
  const double z = 3.3 * kSpacing, warp = 1.2 * kSpacing;
  Corners saddle = {{-0.01, -0.01, z - warp},
                    {0.07, -0.01, z + warp},
                    {0.07, 0.07, z - warp},
                    {-0.01, 0.07, z + warp}};
  std::set<int> first;
  for (int turn = 0; turn < 8; ++turn) {
    LatticeState state = lattice.restState();
    const std::vector<int> crossing = springsOf(springsAcross(lattice, state, saddle));
    const std::set<int> once(crossing.begin(), crossing.end());
    EXPECT_EQ(once.size(), crossing.size());
    std::set<std::array<int, 2>> columns;
    for (const int spring : crossing) {
      const Spring cut = lattice.springs()[at(spring)];
      if (cut.axis != 2) continue;
      const auto index = lattice.gridIndex(cut.a);
      EXPECT_TRUE(columns.insert({index[0], index[1]}).second);
    }
    EXPECT_EQ(columns.size(), 49u);
    sever(lattice, halfWay(crossing), state);
    EXPECT_EQ(countPieces(lattice, state), 2);
    if (turn == 0) first = once;
    EXPECT_EQ(once, first);
    std::rotate(saddle.begin(), saddle.begin() + 1, saddle.end());
    if (turn == 3) std::reverse(saddle.begin(), saddle.end());
  }
}

// Two faces at right angles through nodes, along two lattice planes and their common edge.
TEST(WarpedPolygon, FoldAlongLatticePlanesParts) {
  const Lattice lattice(blockOf(4, 4, 4));
  LatticeState state = lattice.restState();
  const Corners fold = {{0.02, -0.01, -0.01}, {0.02, 0.02, -0.01}, {0.05, 0.02, -0.01},
                        {0.05, 0.02, 0.05},   {0.02, 0.02, 0.05},  {0.02, -0.01, 0.05}};
  const BladeSurface surface(
      sheet({Vec3(0.02, -0.01, 0.0), Vec3(0.02, 0.02, 0.0), Vec3(0.05, 0.02, 0.0)}, -0.01, 0.05),
      kSpacing);
  const std::vector<int> crossing = springsOf(surface.crossings(lattice, state));
  EXPECT_EQ(crossing.size(), 5u * 5u);  // round the 2 x 3 columns of nodes in the corner
  sever(lattice, halfWay(crossing), state);
  EXPECT_EQ(countPieces(lattice, state), 2);
  LatticeState again = lattice.restState();
  sever(lattice, springsAcross(lattice, again, fold), again);
  EXPECT_EQ(countPieces(lattice, again), 2);
}

// An L that is bent out of its plane: the corner that it leaves out stays whole.
TEST(WarpedPolygon, NotchIsSpared) {
  const Lattice lattice(blockOf(5, 5, 2));
  const double z = 0.5 * kSpacing, bend = 0.1 * kSpacing;
  Corners ell = {{-0.005, -0.005, z}, {0.035, -0.005, z + bend}, {0.035, 0.005, z + bend},
                 {0.015, 0.005, z},   {0.015, 0.025, z + bend},  {-0.005, 0.025, z}};
  for (const bool turned : {false, true}) {
    if (turned) std::reverse(ell.begin(), ell.end());
    std::set<std::array<int, 3>> below;
    for (const Crossing& each : springsAcross(lattice, lattice.restState(), ell)) {
      below.insert(lattice.gridIndex(lattice.springs()[at(each.spring)].a));
    }
    EXPECT_EQ(below, (std::set<std::array<int, 3>>{{0, 0, 0},
                                                   {1, 0, 0},
                                                   {2, 0, 0},
                                                   {3, 0, 0},
                                                   {0, 1, 0},
                                                   {1, 1, 0},
                                                   {0, 2, 0},
                                                   {1, 2, 0}}));
  }
}

TEST(WarpedPolygon, BesideTheBlockSeversNothing) {
  const Lattice lattice(blockOf(3, 3, 3));
  EXPECT_TRUE(springsAcross(lattice, lattice.restState(),
                            {{0.1, 0.0, 0.0}, {0.2, 0.0, 0.03}, {0.2, 0.1, 0.0}, {0.1, 0.1, 0.05}})
                  .empty());
}

// What is cut does not hang on where the surface is divided.
TEST(BladeSurface, SameSpringsHoweverItIsDivided) {
  const Lattice lattice(blockOf(6, 6, 3));
  const LatticeState state = lattice.restState();
  for (const double y : {0.02, 0.0217, 0.03}) {
    const Vec3 from(-0.01, y, 0.0), to(0.047, y + 0.02, 0.0);
    const std::vector<int> whole = springsOf(
        BladeSurface(sheet({from, to}, -0.01, 0.025), kSpacing).crossings(lattice, state));
    EXPECT_FALSE(whole.empty());
    for (const int parts : {3, 10, 97}) {
      std::vector<Vec3> profile;
      for (int i = 0; i <= parts; ++i) profile.push_back(from + (to - from) * i / parts);
      const BladeSurface divided(sheet(profile, -0.01, 0.025), kSpacing);
      EXPECT_EQ(springsOf(divided.crossings(lattice, state)), whole);
    }
  }
}

// No path of springs leads from one side of a wavy sheet to the other.
TEST(BladeSurface, NothingSlipsThrough) {
  const Lattice lattice(blockOf(8, 8, 4));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(0.02, 0.06);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Vec3> profile;
    for (int i = 0; i <= 10; ++i) profile.emplace_back(-0.005 + 0.009 * i, any(random), 0.0);
    if (trial % 2 == 0) {
      for (Vec3& point : profile) point.y() = kSpacing * std::round(point.y() / kSpacing);
    }
    LatticeState state = lattice.restState();
    const BladeSurface surface(sheet(profile, -0.01, 0.05), kSpacing);
    sever(lattice, surface.crossings(lattice, state), state);
    const std::vector<int> pieces = pieceOfNodes(lattice, state);
    EXPECT_NE(pieces[at(lattice.node(0, 0, 0))], pieces[at(lattice.node(0, 8, 0))]);
    for (const int x : {0, 4, 8}) {
      EXPECT_EQ(pieces[at(lattice.node(x, 0, 0))], pieces[at(lattice.node(0, 0, 4))]);
      EXPECT_EQ(pieces[at(lattice.node(x, 8, 4))], pieces[at(lattice.node(0, 8, 0))]);
    }
  }
}

TEST(BladeSurface, NewSurfaceIsTheAreaOfTheSection) {
  const Lattice lattice(blockOf(8, 6, 5));
  const LatticeState state = lattice.restState();
  const double depth = 0.05;
  const BladeSurface across(sheet({Vec3(-1.0, 0.027, 0.0), Vec3(1.0, 0.027, 0.0)}, -1.0, 1.0),
                            kSpacing);
  EXPECT_NEAR(newSurface(lattice, across.crossings(lattice, state)), 0.08 * depth, 1e-9);
  // At 26.6 degrees, from side to side.
  const BladeSurface tilted(sheet({Vec3(-0.02, 0.0031, 0.0), Vec3(0.1, 0.0631, 0.0)}, -1.0, 1.0),
                            kSpacing);
  const double section = std::hypot(0.08, 0.04) * depth;
  EXPECT_NEAR(newSurface(lattice, tilted.crossings(lattice, state)), section, 0.05 * section);
}

}  // namespace
}  // namespace robot_tissue::test_blade_surface
