// Surfaces of cut tissue, checked by a library (exact_surface.h).
#include <gtest/gtest.h>

#include <vector>

#include "../random_polygons.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/core/triangle_mesh.h"
#ifdef ROBOT_TISSUE_HAS_CGAL
#include "exact_surface.h"
#include "sound_surface.h"
#endif
#include "robot_tissue/scene/scene_parser.h"

namespace robot_tissue::test_cut_surfaces {
namespace {

#ifdef ROBOT_TISSUE_HAS_CGAL

// Of the spacing (1): how far the vertices are moved inwards. Parts are as thin as a thousandth.
constexpr double kInwards = 1e-5;

// m: places along oblique wounds are rounded.
constexpr double kRounding = 1e-13;

// Each vertex against the mean direction of its triangles, so that sides along a cut part and what
// only touched does so no longer; what still crosses then does.
std::vector<Vec3> movedInwards(const TissueSurface& surface, double way) {
  std::vector<Vec3> normals(surface.rest.size(), Vec3::Zero());
  for (const MeshTriangle& triangle : surface.triangles) {
    const Vec3 area = doubleArea(surface.rest, triangle);
    for (const int vertex : triangle) normals[at(vertex)] += area;
  }
  std::vector<Vec3> moved = surface.rest;
  for (std::size_t vertex = 0; vertex < moved.size(); ++vertex) {
    const double length = normals[vertex].norm();
    if (length > 0.0) moved[vertex] -= way / length * normals[vertex];
  }
  return moved;
}

// `volume`: that its pieces enclose together (m^3).
void expectSound(const Tissue& tissue, double volume, double rounding = 0.0) {
  EXPECT_EQ(faultOf(tissue, volume, rounding), "");
}

// With the sides along cuts moved apart, too. Not of meshes and of oblique cuts: their triangles
// and wedges may be slivers that any move turns over.
void expectSoundWithSidesApart(const Tissue& tissue, double volume) {
  expectSound(tissue, volume);
  const TissueSurface& surface = tissue.surface();
  const double way = kInwards * tissue.lattice().spacing();
  EXPECT_EQ(crossingsOf(movedInwards(surface, way), surface.triangles).pairs, 0);
}

TissueConfig block() {
  TissueConfig config;
  config.shape.max() = Vec3(0.06, 0.05, 0.03);
  config.spacing = 0.005;
  config.material.young_modulus = 1e4;
  config.fixed.push_back(Box(Vec3(-1, -1, -1), Vec3(1, 1, 0)));
  return config;
}

TEST(CheckOfSurfaces, FindsWhatCrossesAndWhatIsOpen) {
  const std::vector<Vec3> corners = {{0, 0, 0},        {1, 0, 0},        {0, 1, 0},
                                     {0, 0, 1},        {0.2, 0.2, -0.5}, {1.2, 0.2, -0.5},
                                     {0.2, 1.2, -0.5}, {0.2, 0.2, 0.5}};
  std::vector<MeshTriangle> triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  EXPECT_TRUE(isClosedAndManifold(corners, triangles));
  EXPECT_NEAR(volumeInside(corners, triangles), 1.0 / 6.0, 1e-15);
  EXPECT_EQ(crossingsOf(corners, triangles).pairs, 0);
  for (const MeshTriangle& triangle : std::vector<MeshTriangle>(triangles)) {
    triangles.push_back({triangle[0] + 4, triangle[1] + 4, triangle[2] + 4});
  }
  EXPECT_GT(crossingsOf(corners, triangles).pairs, 0);
  triangles.pop_back();
  EXPECT_FALSE(isClosedAndManifold(corners, triangles));
}

TEST(CheckOfSurfaces, TellsCrossingsFromCommonCorners) {
  const std::vector<Vec3> corners = {{0, 0, 0},         {1, 0, 0},         {0, 1, 0},
                                     {0.4, 0.3, 0.5},   {0.4, 0.3, -0.5},  // through the first one
                                     {-0.4, -0.3, 0.5}, {-0.4, -0.3, -0.5}};  // beside it
  EXPECT_EQ(crossingsOf(corners, {{0, 1, 2}, {0, 3, 4}}).pairs, 1);
  EXPECT_EQ(crossingsOf(corners, {{1, 2, 0}, {4, 0, 3}}).pairs, 1);
  EXPECT_EQ(crossingsOf(corners, {{0, 1, 2}, {0, 5, 6}}).pairs, 0);
}

TEST(CutSurfaces, OfALoadedBlockCutAtRandomAreSound) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  const double volume = volumeOf(tissue);
  PatchConfig punch;
  punch.name = "punch";
  punch.box = Box(Vec3(0.02, 0.015, 0.03), Vec3(0.04, 0.035, 0.03));
  punch.displacement = {{0.0, 0.0, -0.002}};
  LoadStep press;
  press.patches.push_back(punch);
  tissue.load(press);
  RandomPolygons polygons(config.shape, 0.02);
  for (int cut = 1; cut <= 20; ++cut) {
    tissue.cut(polygons.next());
    if (cut % 10 == 0) expectSound(tissue, volume);
  }
  EXPECT_GT(tissue.state().springs_cut, 200);
  const RemoveReport removed = tissue.remove(Sphere{Vec3(0.03, 0.03, 0.02), 0.011});
  EXPECT_GT(removed.volume, 0.0);
  expectSound(tissue, volume - removed.volume);
}

TEST(CutSurfaces, OfCutsThatCrossOlderOnesAreSound) {
  Tissue tissue(block(), {});
  const double volume = volumeOf(tissue);
  tissue.cut({{0.0225, -1, 0.01}, {0.0225, 1, 0.01}, {0.0225, 1, 1}, {0.0225, -1, 1}});
  tissue.cut({{-1, 0.0225, 0.005}, {1, 0.0225, 0.005}, {1, 0.0225, 1}, {-1, 0.0225, 1}});
  expectSoundWithSidesApart(tissue, volume);
  tissue.cut({{-1, -1, 0.0175}, {1, -1, 0.0175}, {1, 1, 0.0175}, {-1, 1, 0.0175}});
  tissue.cut({{0.0, 0.0, -1}, {0.06, 0.05, -1}, {0.06, 0.05, 1}, {0.0, 0.0, 1}});
  expectSoundWithSidesApart(tissue, volume);
}

TEST(CutSurfaces, OfALiverCutAtRandomAreSound) {
  Scene scene = loadScene(std::string(ROBOT_TISSUE_SOURCE_DIR) + "/config/liver.yaml", {});
  scene.solver.tolerance = 0.05;
  Tissue tissue(scene.tissue, scene.solver);
  const double volume = volumeOf(tissue);
  RandomPolygons polygons(tissue.lattice().bounds(), 0.06);
  for (int cut = 1; cut <= 10; ++cut) {
    tissue.cut(polygons.next());
    if (cut == 3 || cut == 6) expectSound(tissue, volume);  // 6: where the mesh passes by a node
  }
  EXPECT_GT(tissue.state().springs_cut, 100);
  expectSound(tissue, volume);
}

// Wounds on flat blades, and on two that cross.
TEST(CutSurfaces, OfALiverCutByFlatBladesAreSound) {
  Scene scene = loadScene(std::string(ROBOT_TISSUE_SOURCE_DIR) + "/config/liver.yaml", {});
  scene.solver.tolerance = 0.05;
  Tissue tissue(scene.tissue, scene.solver);
  const double volume = volumeOf(tissue);
  const Vec3 middle = tissue.lattice().bounds().center();
  for (const Vec3& normal : {Vec3(1.0, 0.2, 0.1), Vec3(-0.3, 1.0, 0.4), Vec3(0.1, 0.5, 1.0)}) {
    const Vec3 along = 0.3 * normal.unitOrthogonal(), across = normal.normalized().cross(along);
    tissue.cut({middle - along - across, middle + along - across, middle + along + across,
                middle - along + across});
    expectSound(tissue, volume, kRounding);
  }
  EXPECT_EQ(tissue.pieces().size(), 8U);
}

#else

TEST(CutSurfaces, AreCheckedByCgal) {
  GTEST_SKIP() << "CGAL was not found when the build was configured (Debian: libcgal-dev)";
}

#endif

}  // namespace
}  // namespace robot_tissue::test_cut_surfaces
