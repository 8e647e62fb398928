// Tissue whose shape is a mesh.
#include <gtest/gtest.h>

#include <map>
#include <numeric>

#include "cutting/cut.h"
#include "elastic_fixtures.h"
#include "mesh_fixtures.h"
#include "surface/mesh_surface.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_mesh_tissue {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig tissueOf(const TriangleMesh& mesh, const std::string& model = "elastic") {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(mesh);
  config.spacing = kSpacing;
  config.model = model;
  config.material.young_modulus = 1e4;
  return config;
}

TissueConfig ball(const std::string& model = "elastic", double radius = 0.033) {
  TissueConfig config = tissueOf(sphereMesh(radius, 4), model);
  config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -0.019)});
  return config;
}

SolverConfig methodFor(const std::string& model) {
  SolverConfig solver;
  solver.method = model == "elastic" ? "newton" : "paper";
  return solver;
}

std::size_t countOpenEdges(const TissueSurface& surface) {
  std::map<std::pair<int, int>, int> surplus;
  for (const MeshTriangle& triangle : surface.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const int from = triangle[i], to = triangle[(i + 1) % 3];
      surplus[std::minmax(from, to)] += from < to ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(std::count_if(surplus.begin(), surplus.end(),
                                                [](const auto& edge) { return edge.second != 0; }));
}

double openedArea(const TissueSurface& surface, int axis) {
  double area = 0.0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (surface.opened[i] == 0) continue;
    const auto [a, b, c] = surface.triangles[i];
    const Vec3 twice = (surface.rest[at(b)] - surface.rest[at(a)])
                           .cross(surface.rest[at(c)] - surface.rest[at(a)]);
    area += 0.5 * std::abs(twice[axis]);
  }
  return area;
}

std::vector<Vec3> cutPlane(double x, double z_from) {
  return {Vec3(x, -1.0, z_from), Vec3(x, 1.0, z_from), Vec3(x, 1.0, 1.0), Vec3(x, -1.0, 1.0)};
}

class BothModels : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(MeshTissue, BothModels, ::testing::Values("six_spring", "elastic"));

TEST_P(BothModels, BoxAsAMeshIsTheSameTissue) {
  const Vec3 min(0.01, -0.02, 0.03), max(0.07, 0.02, 0.06);
  TissueConfig as_mesh = tissueOf(boxMesh(min, max), GetParam());
  as_mesh.fixed.push_back({Vec3(-1, -1, -1), Vec3(1, 1, 0.0301)});
  TissueConfig as_box = as_mesh;
  as_box.mesh = nullptr;
  as_box.shape = {min, max};
  Tissue mesh(as_mesh, methodFor(GetParam())), box(as_box, methodFor(GetParam()));
  const Box top{Vec3(0.025, -0.011, 0.0599), Vec3(0.055, 0.011, 0.0601)};
  const LoadStep press = loadOf({displacedPatch("press", top, {0.001, 0.0, -0.005})});
  const PatchAnswer from_mesh = reportsOf(mesh, press).back().patches.front();
  const PatchAnswer from_box = reportsOf(box, press).back().patches.front();
  EXPECT_GT(from_box.force.norm(), 0.1);
  EXPECT_NEAR((from_mesh.force - from_box.force).norm(), 0.0, 1e-12 * from_box.force.norm());
  ASSERT_EQ(mesh.state().displacement.size(), box.state().displacement.size());
  for (std::size_t node = 0; node < mesh.state().displacement.size(); ++node) {
    const Vec3 difference = mesh.state().displacement[node] - box.state().displacement[node];
    EXPECT_NEAR(difference.norm(), 0.0, 1e-12 * 0.005);
  }
  // The mesh's surface is round where the box's is straight from node to node.
  EXPECT_NEAR(mesh.lastReport().volume_ratio, box.lastReport().volume_ratio, 0.006);
}

TEST(MeshTissue, SurfaceFollowsALinearDeformationExactly) {
  const TriangleMesh mesh = sphereMesh(0.033, 3);
  const Lattice lattice(tissueOf(mesh));
  const TissueSurface surface = meshSurface(lattice, lattice.restState(), mesh);
  EXPECT_EQ(countOpenEdges(surface), 0U);
  EXPECT_NEAR(enclosedVolume(surface, surface.rest), volumeOf(mesh), 1e-15);
  Eigen::Matrix3d gradient;
  gradient << 1.1, 0.2, -0.1, 0.05, 0.9, 0.3, 0.1, -0.2, 1.2;
  std::vector<Vec3> displacement, vertices;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    displacement.push_back(gradient * rest - rest);
  }
  deform(surface, displacement, vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_NEAR((vertices[i] - gradient * mesh.vertices[i]).norm(), 0.0, 1e-15);
  }
}

// Between nodes, too: a dent is quadratic, and points that lag behind it are dented too far.
TEST(MeshTissue, SurfaceFollowsAQuadraticDeformationExactly) {
  const TriangleMesh block = boxMesh(Vec3(0.003, -0.021, 0.0), Vec3(0.051, 0.022, 0.037));
  const TissueConfig config = tissueOf(block);
  const Lattice lattice(config);
  const TriangleMesh mesh = refined(block, kSpacing);
  const TissueSurface surface = meshSurface(lattice, lattice.restState(), mesh);
  const auto moved = [](const Vec3& x) -> Vec3 {
    return {3.0 * x.x() * x.x() + x.y() * x.z(), 2.0 * x.z() * x.z() - x.x() * x.y(),
            x.x() * x.x() - 4.0 * x.y() * x.y()};
  };
  std::vector<Vec3> displacement, vertices;
  for (const int node : nodesOf(lattice)) displacement.push_back(moved(lattice.restPosition(node)));
  deform(surface, displacement, vertices);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    EXPECT_NEAR((vertices[i] - surface.rest[i] - moved(surface.rest[i])).norm(), 0.0, 1e-15);
  }
}

// A bar that lies in the grid anyhow (what is far off shifts the grid), stretched along x and
// thinner by Poisson's ratio: in balance inside, and across every section the force E A strain.
TEST(MeshTissue, StretchedBarIsAsStiffAsItsCrossSectionIsLarge) {
  constexpr double kStrain = 1e-4;
  Random random;
  for (int trial = 0; trial < 10; ++trial) {
    const Vec3 size(0.12, random.between(0.012, 0.035), random.between(0.012, 0.035));
    const Vec3 far = Vec3::Constant(0.2) + random.offset(0.01);
    const TissueConfig config =
        tissueOf(joined(boxMesh(Vec3::Zero(), size), boxMesh(far, far + Vec3::Constant(0.012))));
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    LatticeState state = lattice.restState();
    EXPECT_EQ(state.pieces, 2);
    const double thinner = -config.material.poisson_ratio;
    for (const int node : nodesOf(lattice)) {
      state.displacement[at(node)] =
          kStrain * Vec3(1.0, thinner, thinner).cwiseProduct(lattice.restPosition(node));
    }
    const double force = 1e4 * size.y() * size.z() * kStrain;
    Vec3 above_middle = Vec3::Zero();
    for (const int node : nodesOf(lattice)) {
      const double x = lattice.restPosition(node).x();
      if (x > 0.15) continue;  // of the other box
      const Vec3 on_node = model.nodeForce(state, node);
      if (x > 0.021 && x < 0.099) {  // cells at the ends reach a cell further
        EXPECT_LT(on_node.norm(), 0.001 * force);
      }
      if (x > 0.06) above_middle += on_node;
    }
    EXPECT_NEAR((above_middle + Vec3(force, 0.0, 0.0)).norm(), 0.0, 0.001 * force);
  }
}

// Springs severed at random, with the surface through the middle of cells, on planes of nodes and
// half way between them.
TEST_P(BothModels, AnyCutLeavesTheSurfaceClosed) {
  const std::vector<TriangleMesh> meshes = {
      sphereMesh(0.0227, 2), sphereMesh(0.025, 3),
      boxMesh(Vec3::Constant(-0.02), Vec3(0.02, 0.02, 0.01)),
      joined(boxMesh(Vec3::Constant(-0.02), Vec3::Constant(0.01)),
             boxMesh(Vec3(0.015, 0.0, 0.0), Vec3(0.02, 0.02, 0.02)))};
  std::mt19937 random(3);
  for (const TriangleMesh& coarse : meshes) {
    const TriangleMesh mesh = refined(coarse, kSpacing);
    const TissueConfig config = tissueOf(mesh, GetParam());
    const Lattice lattice(config);
    const auto split = config.model == "elastic" ? SplitCells::kParted : SplitCells::kLost;
    LatticeState state = lattice.restState();
    std::vector<int> springs(lattice.springs().size());
    std::iota(springs.begin(), springs.end(), 0);
    std::shuffle(springs.begin(), springs.end(), random);
    for (std::size_t first = 0; first < springs.size(); first += 30) {
      const std::size_t last = std::min(first + 30, springs.size());
      sever(lattice,
            halfWay({springs.begin() + static_cast<std::ptrdiff_t>(first),
                     springs.begin() + static_cast<std::ptrdiff_t>(last)}),
            state, split);
      const TissueSurface surface = meshSurface(lattice, state, mesh);
      ASSERT_EQ(countOpenEdges(surface), 0U);
      ASSERT_NEAR(enclosedVolume(surface, surface.rest), volumeOf(mesh), 1e-12 * volumeOf(mesh));
      for (const CarrierRange carriers : surface.carriers) {
        double sum = 0.0;
        for (const NodeWeight& carrier : carriers) {
          ASSERT_LT(at(carrier.node), state.displacement.size());
          sum += carrier.weight;
        }
        ASSERT_NEAR(sum, 1.0, 1e-12);
      }
    }
  }
}

TEST_P(BothModels, PressCutReleaseResetOfABall) {
  Tissue tissue(ball(GetParam()), methodFor(GetParam()));
  const TissueSurface uncut = tissue.surface();
  const double volume = enclosedVolume(uncut, uncut.rest);
  const Box top{Vec3(-0.012, -0.012, 0.02), Vec3(0.012, 0.012, 0.05)};
  tissue.load(loadOf({displacedPatch("press", top, {0.0, 0.0, -0.004})}));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_LT(tissue.lastReport().volume_ratio, 1.0);
  tissue.release({"press"});
  expectAtRest(tissue);

  const CutReport cut = tissue.cut(cutPlane(0.0031, 0.0));
  EXPECT_GT(cut.springs_cut, 0);
  EXPECT_EQ(cut.pieces, 1);
  EXPECT_EQ(countOpenEdges(tissue.surface()), 0U);
  EXPECT_NEAR(enclosedVolume(tissue.surface(), tissue.surface().rest), volume, 1e-12 * volume);
  const Box left{Vec3(-0.05, -0.05, 0.01), Vec3(-0.011, 0.05, 0.05)};
  tissue.load(loadOf({displacedPatch("pull", left, {-0.004, 0.0, 0.0})}));
  EXPECT_TRUE(isDeformed(tissue));
  EXPECT_GT(tissue.lastReport().volume_ratio, 0.9);
  tissue.reset();
  expectAtRest(tissue);
  EXPECT_EQ(tissue.surface().triangles, uncut.triangles);
}

// A wall of 0.4 or 0.8 spacings, most of it oblique, dented by a spacing: light corners of its
// cells snap through on the way.
TEST(MeshTissue, ThinShellsAreBalancedByCyclesAsByNewton) {
  for (const double wall : {0.002, 0.004}) {
    const TriangleMesh shell = joined(sphereMesh(0.03, 4), insideOut(sphereMesh(0.03 - wall, 4)));
    TissueConfig config = tissueOf(shell);
    config.spacing = 0.005;
    config.material.poisson_ratio = 0.45;
    config.fixed.push_back({Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, -0.015)});
    const Box top{Vec3(-0.012, -0.012, 0.024), Vec3(0.012, 0.012, 1.0)};
    double force[2];
    for (const bool by_newton : {false, true}) {
      SolverConfig solver;
      if (by_newton) solver.method = "newton";
      Tissue tissue(config, solver);
      tissue.load(loadOf({displacedPatch("press", top, {0.0, 0.0, -0.005})}));
      EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk) << wall << ' ' << by_newton;
      force[by_newton ? 1 : 0] = tissue.lastReport().patches.front().force.z();
    }
    EXPECT_NEAR(force[0] / force[1], 1.0, 0.015) << wall;
  }
}

// A ball of radius r cut in two: each half is closed, and opened by the disk where the blade
// passed.
TEST_P(BothModels, BallCutThroughHasTwoClosedHalves) {
  const double radius = 0.0333;
  TissueConfig config = ball(GetParam(), radius);
  config.mesh = std::make_shared<const TriangleMesh>(sphereMesh(radius, 5));
  Tissue tissue(config, methodFor(GetParam()));
  constexpr double kBlade = 0.0112;
  ASSERT_EQ(tissue.cut(cutPlane(kBlade, -1.0)).pieces, 2);
  const TissueSurface& surface = tissue.surface();
  EXPECT_EQ(countOpenEdges(surface), 0U);
  const double disk = M_PI * (radius * radius - kBlade * kBlade);
  EXPECT_NEAR(openedArea(surface, 0), 2.0 * disk, 0.005 * disk);
  EXPECT_NEAR(openedArea(surface, 1), 0.0, 1e-9 * disk);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    if (surface.opened[i] == 0) continue;
    for (const int vertex : surface.triangles[i]) {
      EXPECT_NEAR(surface.rest[at(vertex)].x(), kBlade, 1e-9);
    }
  }
  // Moved apart by 1 m, the halves enclose what they did.
  const CellSet& cells = *tissue.state().cells;
  std::vector<Vec3> displacement(at(cells.nodeCount()), Vec3::Zero()), apart;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    const bool stands_right = restPosition(tissue.lattice(), cells, node).x() > 0.01;
    if (stands_right != cells.isGhost(node)) displacement[at(node)].x() = 1.0;
  }
  deform(surface, displacement, apart);
  const double volume = enclosedVolume(surface, surface.rest);
  EXPECT_NEAR(enclosedVolume(surface, apart), volume, 1e-9 * volume);
}

// Of a plane that is oblique to the grid, too; but for a thousandth of a spacing, which springs
// keep at their ends.
TEST(MeshTissue, WoundsLieOnTheBlade) {
  Random random;
  for (int blade = 0; blade < 5; ++blade) {
    Tissue tissue(ball(), methodFor("elastic"));
    const double volume = enclosedVolume(tissue.surface(), tissue.surface().rest);
    const std::size_t triangles = tissue.surface().triangles.size();
    const Pose pose = random.pose(0.01);
    const Vec3 normal = pose.linear().col(2);
    std::vector<Vec3> corners;
    for (const auto& [x, y] : {std::pair(-1, -1), {1, -1}, {1, 1}, {-1, 1}}) {
      corners.push_back(pose * Vec3(x, y, 0.0));
    }
    ASSERT_EQ(tissue.cut(corners).pieces, 2);
    const TissueSurface& surface = tissue.surface();
    EXPECT_EQ(countOpenEdges(surface), 0U);
    EXPECT_NEAR(enclosedVolume(surface, surface.rest), volume, 1e-12 * volume);
    std::size_t opened = 0, off_blade = 0;
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      if (surface.opened[i] == 0) continue;
      ++opened;
      for (const int vertex : surface.triangles[i]) {
        const double off = std::abs(normal.dot(surface.rest[at(vertex)] - pose.translation()));
        EXPECT_LT(off, 0.05 * kSpacing);
        off_blade += off > 1.1e-3 * kSpacing ? 1 : 0;
      }
    }
    EXPECT_GT(opened, 100U);
    EXPECT_LT(off_blade, 3 * opened / 50);
    // The skin has those of the mesh and what the wound's outline asks for.
    EXPECT_LT(surface.triangles.size() - opened, triangles + 8 * triangles / 10);
  }
}

}  // namespace
}  // namespace robot_tissue::test_mesh_tissue
