// Nodes of a mesh's cells that have no tissue around them: no piece is left of such nodes alone.
#include <gtest/gtest.h>

#include <set>

#include "../random_polygons.h"
#include "cutting/crumbs.h"
#include "cutting/cut.h"
#include "cutting/tear.h"
#include "lattice/connectivity.h"
#include "mesh_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_crumbs {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kRadius = 0.033;
constexpr double kInside = 0.98;  // of the radius: flat triangles are so far inside

TissueConfig ball() {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(kRadius, 3));
  config.spacing = kSpacing;
  config.material.young_modulus = 1e4;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -0.019)});
  return config;
}

bool hasTissue(const Lattice& lattice, int node) {
  for (const Cell& cell : lattice.cells()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      if (cell.nodes[at(corner)] == node && lattice.hasTissueAt(cell.place, corner)) return true;
    }
  }
  return false;
}

std::vector<int> springsOf(const Lattice& lattice, int node) {
  std::vector<int> springs;
  for (int direction = 0; direction < kNeighbors; ++direction) {
    if (lattice.springOf(node, direction) >= 0) {
      springs.push_back(lattice.springOf(node, direction));
    }
  }
  return springs;
}

// Every piece has a triangle that is shown.
void expectAllShown(const Tissue& tissue) {
  std::set<int> shown;
  for (const MeshTriangle& triangle : tissue.surface().triangles) {
    const int node = tissue.surface().carriers[at(triangle.front())].front().node;
    shown.insert(tissue.pieceOfNodes()[at(node)]);
  }
  EXPECT_EQ(shown.size(), tissue.pieces().size());
}

double volumeOfPieces(const Tissue& tissue) {
  double volume = 0.0;
  for (const TissuePiece& piece : tissue.pieces()) volume += piece.volume;
  return volume;
}

// Of a ball's lattice some nodes are half a spacing and more outside.
TEST(Crumbs, AreNeverPartedFromAllThatIsBesideThem) {
  const Lattice lattice(ball());
  int without_tissue = 0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    LatticeState state = lattice.restState();
    const std::vector<int> around = springsOf(lattice, node);
    const std::vector<Crossing> severed = sparingCrumbs(lattice, state, halfWay(around));
    if (hasTissue(lattice, node)) {
      const bool is_inside = lattice.restPosition(node).norm() < kInside * kRadius;
      if (is_inside) {
        EXPECT_EQ(severed.size(), around.size());
      }
      continue;  // else: as much as counts, or not
    }
    ++without_tissue;
    EXPECT_LT(severed.size(), around.size());
    sever(lattice, severed, state);
    EXPECT_EQ(state.pieces, 1);
    std::vector<int> kept;
    for (const int spring : around) {
      if (state.severed[at(spring)] == 0) kept.push_back(spring);
    }
    EXPECT_TRUE(sparingCrumbs(lattice, state, halfWay(kept)).empty());
  }
  EXPECT_GT(without_tissue, 10);
}

TEST(Crumbs, ABlockHasNone) {
  TissueConfig config = withFixedBottom(blockOf(3, 3, 3, kSpacing));
  const Lattice lattice(config);
  const std::vector<int> around = springsOf(lattice, 0);
  EXPECT_EQ(sparingCrumbs(lattice, lattice.restState(), halfWay(around)).size(), around.size());
}

TEST(Crumbs, OfABallCutAtRandomAndRemovedInPartThereAreNone) {
  SolverConfig solver;
  solver.tolerance = 0.05;
  Tissue tissue(ball(), solver);
  const double volume = volumeOfPieces(tissue);
  RandomPolygons polygons(tissue.lattice().bounds(), 0.05);
  for (int cut = 0; cut < 40; ++cut) tissue.cut(polygons.next());
  EXPECT_GT(tissue.state().pieces, 5);
  expectAllShown(tissue);
  EXPECT_NEAR(volumeOfPieces(tissue), volume, 1e-9 * volume);
  double removed = 0.0;
  for (const Vec3& middle : {Vec3(0.02, 0.01, 0.025), Vec3(-0.02, -0.02, 0.015)}) {
    removed += tissue.remove(Sphere{middle, 0.009}).volume;
    expectAllShown(tissue);
  }
  EXPECT_GT(removed, 0.0);
  EXPECT_NEAR(volumeOfPieces(tissue) + removed, volume, 1e-9 * volume);
}

// Stretched alike everywhere, and held so: all goes that may.
TEST(Crumbs, OfABallThatTearsThereAreNone) {
  TissueConfig config = ball();
  config.material.tear_stretch = 1.2;
  const Lattice lattice(config);
  LatticeState state = lattice.restState();
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    state.displacement[at(node)] = 0.5 * lattice.restPosition(node);
  }
  const std::vector<double> strains = tearStrains(lattice, config);
  std::vector<Crossing> torn = tearingNext(lattice, state, strains);
  ASSERT_FALSE(torn.empty());
  for (; !torn.empty(); torn = tearingNext(lattice, state, strains)) sever(lattice, torn, state);
  EXPECT_GT(state.pieces, 5);
  const std::vector<int> pieces = pieceOfNodes(lattice, state);
  std::set<int> with_tissue;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (hasTissue(lattice, node)) with_tissue.insert(pieces[at(node)]);
  }
  EXPECT_EQ(static_cast<int>(with_tissue.size()), state.pieces);
}

}  // namespace
}  // namespace robot_tissue::test_crumbs
