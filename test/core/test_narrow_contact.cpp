// Point loads on the lattice, and what a ball's contact is recessed by that is narrower than that
// tells apart.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "loads/half_space.h"
#include "loads/local_lattice.h"
#include "loads/narrow_contact.h"
#include "loads/point_loads.h"
#include "mesh_fixtures.h"
#include "surface/mean_curvature.h"
#include "surface/mesh_surface.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_narrow_contact {
namespace {

constexpr double kSpacing = 0.005;    // m
constexpr double kPoisson = 0.4;      // between two of the table
constexpr double kShear = 1e4 / 2.8;  // Pa, of 1e4 Pa
constexpr int kCells = 24, kMiddle = kCells / 2;

TissueConfig cube() {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = kSpacing * Vec3(kCells, kCells, kMiddle);
  config.spacing = kSpacing;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = kPoisson;
  Box bottom = config.shape;
  bottom.max().z() = 0.0;
  config.fixed.push_back(bottom);
  return config;
}

SolverConfig exact() {
  SolverConfig solver;
  solver.tolerance = 1e-5;
  return solver;
}

Vec3 topAt(double i, double j) { return kSpacing * Vec3(kMiddle + i, kMiddle + j, kMiddle); }

// Nodes near to each other go by differences that no ground takes part in.
TEST(PointLoads, NodesNearAForceGoAsTheTableHasIt) {
  Tissue tissue(cube(), exact());
  PatchConfig patch;
  patch.name = "point";
  const Vec3 place = topAt(0, 0), reach = Vec3::Constant(1e-4);
  patch.box = {place - reach, place + reach};
  patch.displacement = {0.0, 0.0, -1e-5};
  LoadStep step;
  step.increments = 1;
  step.patches.push_back(patch);
  tissue.load(step);
  const double force = std::abs(tissue.lastReport().patches.front().force.z());
  const auto wayOf = [&](int i, int j) {
    const int node = tissue.lattice().node(kMiddle + i, kMiddle + j, kMiddle);
    return -tissue.state().displacement[at(node)].z() * kShear * kSpacing / force;
  };
  const double of_force = pointCompliance(kPoisson, 0.0);
  for (const auto& [i, j] :
       std::vector<std::array<int, 2>>{{1, 0}, {1, 1}, {2, 0}, {2, 1}, {3, 0}}) {
    const double told = of_force - pointCompliance(kPoisson, i * i + j * j);
    EXPECT_NEAR(wayOf(0, 0) - wayOf(i, j), told, 0.01 * told) << i << ", " << j;
  }
}

TEST(PointLoads, FarOffTheyAreAHalfSpaces) {
  for (const double ratio : {0.25, 0.4, 0.49}) {
    EXPECT_DOUBLE_EQ(pointCompliance(ratio, 16.0), (1.0 - ratio) / (8.0 * M_PI));
    EXPECT_NEAR(pointCompliance(ratio, 9.0), (1.0 - ratio) / (6.0 * M_PI), 0.012);
  }
}

TEST(HalfSpace, GoesAsBoussinesqHasItOnTheSurfaceAndBelowTheForce) {
  const SurfaceModuli moduli = {kShear, kPoisson};
  const Vec3 down = -Vec3::UnitZ();
  const double unit = kShear * kSpacing;
  const Vec3 beside = unit * halfSpaceMotion(4.0 * kSpacing * Vec3::UnitX(), down, moduli);
  EXPECT_NEAR(beside.dot(down), pointCompliance(kPoisson, 16.0), 1e-12);
  EXPECT_NEAR(beside.x(), -(1.0 - 2.0 * kPoisson) / (16.0 * M_PI), 1e-12) << "to the force";
  EXPECT_EQ(beside.y(), 0.0);
  const Vec3 below = unit * halfSpaceMotion(2.0 * kSpacing * down, down, moduli);
  EXPECT_LT((below - (3.0 - 2.0 * kPoisson) / (8.0 * M_PI) * down).norm(), 1e-12);
}

// Around a force on it the lattice is looked at where no table is of it: here there is.
TEST(LocalLattice, OfAFlatSurfaceGivesWayAsTheTableHasIt) {
  for (const double ratio : {0.25, 0.35, 0.45, 0.49}) {
    TissueConfig config = cube();
    config.material.poisson_ratio = ratio;
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    const LatticeState rest = lattice.restState();
    const double unit = 1e4 / 2.0 / (1.0 + ratio) * kSpacing;
    const auto node = [&](int i, int j) { return lattice.node(kMiddle + i, kMiddle + j, kMiddle); };
    const auto compliance = [&](const std::vector<NodeWeight>& shares) {
      LocalLattice around;
      const auto moduli = LocalLattice::moduliUnder(shares, *rest.cells, model);
      EXPECT_TRUE(around.take(shares, Vec3::UnitZ(), *moduli, {}, lattice, rest, model));
      EXPECT_FALSE(around.isDeep(lattice)) << "outwards";
      EXPECT_TRUE(around.take(shares, -Vec3::UnitZ(), *moduli, {}, lattice, rest, model));
      EXPECT_TRUE(around.isDeep(lattice));
      return unit * around.compliance(shares);
    };
    const double own = pointCompliance(ratio, 0.0), beside = pointCompliance(ratio, 1.0),
                 across = pointCompliance(ratio, 2.0);
    EXPECT_NEAR(compliance({{node(0, 0), 1.0}}), own, 0.021) << ratio;
    EXPECT_NEAR(compliance({{node(0, 0), 0.5}, {node(1, 0), 0.5}}), 0.5 * (own + beside), 0.009);
    EXPECT_NEAR(
        compliance(
            {{node(0, 0), 0.25}, {node(1, 0), 0.25}, {node(0, 1), 0.25}, {node(1, 1), 0.25}}),
        0.25 * (own + 2.0 * beside + across), 0.002);
  }
}

// Of a thin wall there are nodes as deep as of a solid ball, on its other side: that it is thin is
// told by what its cells hold. As a half-space a dome felt 9 to 23 % more.
TEST(LocalLattice, AThinWallIsNotDeep) {
  constexpr double kBall = 5.8 * kSpacing;
  const TriangleMesh ball = sphereMesh(kBall, 3);
  for (const double wall : {0.0, 0.6, 1.0}) {
    TissueConfig config = cube();
    config.mesh = std::make_shared<const TriangleMesh>(
        wall > 0.0 ? joined(ball, insideOut(sphereMesh(kBall - wall * kSpacing, 3))) : ball);
    config.fixed.clear();
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    const LatticeState rest = lattice.restState();
    const TissueSurface surface = meshSurface(lattice, rest, *config.mesh);
    for (std::size_t i = 0; i < ball.vertices.size(); ++i) {  // the outer side's come first
      const std::vector<NodeWeight> shares(surface.carriers[i].begin(), surface.carriers[i].end());
      const auto moduli = LocalLattice::moduliUnder(shares, *rest.cells, model);
      LocalLattice around;
      ASSERT_TRUE(
          around.take(shares, -ball.vertices[i].normalized(), *moduli, {}, lattice, rest, model));
      EXPECT_EQ(around.isDeep(lattice), wall == 0.0) << wall << ' ' << i;
    }
  }
}

// A wall two spacings thick gave way up to twice as much as all of the tissue, as if nothing were
// behind it: on a support a ball was told nearly twice its force, at its edge eight times.
TEST(LocalLattice, DoesNotHangOnWhatIsBehindAWall) {
  const auto complianceOf = [](int thickness, bool is_fixed) {
    TissueConfig config = cube();
    config.shape.max().z() = kSpacing * thickness;
    if (!is_fixed) config.fixed.clear();
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    const LatticeState rest = lattice.restState();
    const std::vector<NodeWeight> shares = {{lattice.node(kMiddle, 0, thickness), 0.7},
                                            {lattice.node(kMiddle, 1, thickness), 0.3}};
    LocalLattice around;
    const auto moduli = LocalLattice::moduliUnder(shares, *rest.cells, model);
    EXPECT_TRUE(around.take(shares, -Vec3::UnitZ(), *moduli, {}, lattice, rest, model));
    EXPECT_TRUE(around.isDeep(lattice));
    return around.compliance(shares);
  };
  const double expected = complianceOf(kMiddle, true);
  for (const int thickness : {2, 3}) {
    for (const bool is_fixed : {false, true}) {
      EXPECT_NEAR(complianceOf(thickness, is_fixed), expected, 1e-9 * expected) << thickness;
    }
  }
}

TEST(LocalLattice, TurnsWithTheTissueAndKnowsItsMaterial) {
  TissueConfig config = cube();
  Region stiff;
  stiff.name = "stiff";
  stiff.box = {Vec3::Zero(), kSpacing * Vec3(kCells, kCells, kMiddle - 2)};
  stiff.material = config.material;
  stiff.material.young_modulus = 1e5;
  for (const bool is_layered : {false, true}) {
    if (is_layered) config.regions.push_back(stiff);
    const Lattice lattice(config);
    const ElasticModel model(lattice, config);
    LatticeState state = lattice.restState();
    const std::vector<NodeWeight> shares = {{lattice.node(kMiddle, kMiddle, kMiddle), 1.0}};
    LocalLattice around;
    const auto moduli = LocalLattice::moduliUnder(shares, *state.cells, model);
    EXPECT_NEAR(moduli->shear, kShear, 1e-6 * kShear);
    EXPECT_EQ(around.take(shares, -Vec3::UnitZ(), *moduli, {}, lattice, state, model), !is_layered);
    if (is_layered) continue;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.2, Vec3(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      const Vec3 place = lattice.restPosition(node);
      state.displacement[at(node)] = turn * (1.1 * place) + Vec3(0.1, 0.2, 0.3) - place;
    }
    EXPECT_LT((around.turn(state.displacement) - turn).norm(), 1e-12);
  }
}

// A plane in which the nodes slide is one of mirror symmetry: half of a force does as much there as
// all of it in the whole. What is around the piece goes as in a half-space, wherever.
TEST(LocalLattice, OfNodesThatAPatchLetsSlideIsHalfOfTheWhole) {
  const TissueConfig config = cube();
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  const LatticeState rest = lattice.restState();
  LoadingPatch plane;
  plane.free_axis = {{false, true, true}};
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    if (lattice.restPosition(node).x() < 0.5 * kSpacing) plane.nodes.push_back(node);
  }
  const auto spread = [&](int i, const std::vector<LoadingPatch>& held) {
    const auto compliance = [&](const std::vector<NodeWeight>& shares) {
      LocalLattice around;
      const auto moduli = LocalLattice::moduliUnder(shares, *rest.cells, model);
      EXPECT_TRUE(around.take(shares, -Vec3::UnitZ(), *moduli, held, lattice, rest, model));
      return around.compliance(shares);
    };
    const int own = lattice.node(i, kMiddle, kMiddle);
    const int beside = lattice.node(i, kMiddle + 1, kMiddle);
    return compliance({{own, 1.0}}) - compliance({{own, 0.6}, {beside, 0.4}});
  };
  const double whole = spread(kMiddle, {});
  EXPECT_NEAR(spread(0, {plane}), 2.0 * whole, 0.005 * whole);
}

double curvatureAt(const Vec3& place, const std::vector<Vec3>& places, const Vec3& outwards) {
  constexpr double kReach = 0.01;  // m
  std::vector<int> near;
  for (int vertex = 0; vertex < static_cast<int>(places.size()); ++vertex) {
    if ((places[at(vertex)] - place).norm() <= kReach) near.push_back(vertex);
  }
  return meanCurvature(places, near, place, outwards, kReach);
}

TEST(MeanCurvature, IsThatOfABallAndOfACylinder) {
  const Vec3 top(0.0, 0.0, 0.04);
  const std::vector<Vec3> ball = sphereMesh(0.04, 4).vertices;
  EXPECT_NEAR(curvatureAt(top, ball, Vec3::UnitZ()), 25.0, 1.0);
  EXPECT_NEAR(curvatureAt(top, ball, -Vec3::UnitZ()), -25.0, 1.0) << "from inside";
  EXPECT_EQ(curvatureAt(2.0 * top, ball, Vec3::UnitZ()), 0.0) << "nothing there";
  std::vector<Vec3> flat, rod;
  for (int i = -5; i <= 5; ++i) {
    for (int j = -5; j <= 5; ++j) {
      flat.emplace_back(0.002 * i, 0.002 * j, 0.04);
      rod.emplace_back(0.04 * std::sin(0.05 * i), 0.002 * j, 0.04 * std::cos(0.05 * i));
    }
  }
  EXPECT_NEAR(curvatureAt(top, flat, Vec3::UnitZ()), 0.0, 1e-9);
  EXPECT_NEAR(curvatureAt(top, rod, Vec3::UnitZ()), 12.5, 1.0);
}

// Under a force on one node.
PressedSurface flatUnderOneNode() {
  return {kSpacing, {kShear, kPoisson}, 0.0, pointCompliance(kPoisson, 0.0) / (kShear * kSpacing)};
}

// What lies under a ball, as seen straight down.
NarrowPress underBall(double radius) {
  NarrowPress press;
  const auto part = Indenter::ball(radius).partAround(0, -Vec3::UnitZ(), 1.2 * kSpacing);
  press.part = std::make_shared<const IndenterPart>(part);
  press.apex = part.lowest;
  press.axis = -Vec3::UnitZ();
  return press;
}

const double kPlaneModulus = 2.0 * kShear / (1.0 - kPoisson);  // Pa

// Hertz's force of a contact of that radius (N).
double forceOfWidth(double contact, double radius) {
  return 4.0 / 3.0 * kPlaneModulus * std::pow(contact, 3) / radius;
}

// What is missing to a half-space's dent is the recess. Levels are right to 0.3 % of the depth.
TEST(NarrowContact, WithItsRecessABallIsAsDeepAsInAHalfSpace) {
  for (const double curvature : {0.0, 20.0}) {
    PressedSurface surface = flatUnderOneNode();
    surface.curvature = curvature;
    NarrowPress press = underBall(0.02);
    press.force = 0.002;
    const double of_both = 1.0 / (1.0 / 0.02 + curvature);
    const double contact = std::cbrt(0.75 * press.force * of_both / kPlaneModulus);
    const double depth = contact * contact / of_both;
    const Recess alone = recessUnder(press, surface);
    EXPECT_NEAR(alone.depth + press.force * surface.compliance, depth, 4e-3 * depth) << curvature;
    press.height = 1e-4;
    EXPECT_NEAR(recessUnder(press, surface).depth, alone.depth - 1e-4, 1e-12);
    press.off_apex = 1e-5;
    EXPECT_NEAR(recessUnder(press, surface).depth, alone.depth - 1e-4 - 0.5e-5 * curvature, 1e-12);
    press.height = press.off_apex = press.force = 0.0;
    press.depth = depth;
    EXPECT_NEAR(recessUnder(press, surface).depth, alone.depth, 0.01 * depth) << "by its depth";
  }
}

// Of a ball of three spacings, that is half in, and of a large one.
TEST(NarrowContact, WideOnesHaveNone) {
  const PressedSurface surface = flatUnderOneNode();
  for (const auto& [radius, wide] : {std::pair(3.0, 1.75), std::pair(10.0, 2.45)}) {
    NarrowPress press = underBall(radius * kSpacing);
    const auto widen = [&, ball = radius](double width) {
      press.force = forceOfWidth(width * kSpacing, ball * kSpacing);
      return recessUnder(press, surface).depth;
    };
    EXPECT_LT(widen(wide - 1.2), 0.0) << "one node alone goes deeper than a half-space";
    EXPECT_EQ(widen(wide + 0.1), 0.0);
  }
}

// Tissue would come to its sides.
TEST(NarrowContact, WhatIsFarDownHasNone) {
  const PressedSurface surface = flatUnderOneNode();
  NarrowPress press = underBall(0.8 * kSpacing);
  for (const double depth : {0.5, 0.9, 1.5}) {
    press.force = forceOfWidth(std::sqrt(0.8 * depth) * kSpacing, 0.8 * kSpacing);
    EXPECT_EQ(recessUnder(press, surface).depth != 0.0, depth < 1.2) << depth;
  }
}

TEST(NarrowContact, ATissueTellsItWhereItIsAHalfSpace) {
  Tissue tissue(cube(), exact());
  const auto under = [&](int i, int j, int k, const Vec3& axis = -Vec3::UnitZ()) {
    NarrowPress press = underBall(0.02);
    press.axis = axis;
    press.force = 0.005;
    press.shares = {{tissue.lattice().node(i, j, k), 1.0}};
    return tissue.recessUnder(press);
  };
  EXPECT_TRUE(under(kMiddle, kMiddle, kMiddle));
  EXPECT_TRUE(under(0, kMiddle, kMiddle / 2, Vec3::UnitX())) << "a side";
  EXPECT_TRUE(under(0, kMiddle, kMiddle, Vec3(1.0, 0.0, -1.0).normalized())) << "an edge";
  EXPECT_FALSE(under(0, kMiddle, kMiddle, -Vec3::UnitX())) << "out of it";
  const double x = topAt(0.5, 0.0).x(), low = topAt(0, 0).z() - 2.2 * kSpacing;
  EXPECT_GT(tissue.cut({{x, -1.0, low}, {x, 1.0, low}, {x, 1.0, 1.0}, {x, -1.0, 1.0}}).springs_cut,
            0);
  EXPECT_LT(under(kMiddle, kMiddle, kMiddle)->depth, under(kMiddle - 2, kMiddle, kMiddle)->depth)
      << "beside a cut it gives way more";
}

// Held by a load it was taken to give way as if nothing held it: a ball beside that pressed itself
// ever deeper.
TEST(NarrowContact, WhatALoadHoldsStandsAsWhatIsFixed) {
  TissueConfig config = cube();
  NarrowPress press = underBall(0.02);
  press.axis = Vec3(1.0, 0.0, -1.0).normalized();
  press.force = 0.005;
  Tissue tissue(config, exact());
  press.shares = {{tissue.lattice().node(0, kMiddle, kMiddle), 1.0}};
  const double before = tissue.recessUnder(press)->depth;
  const Box beside = {topAt(1.0 - kMiddle, -2.0), topAt(3.0 - kMiddle, 2.0)};
  tissue.load(loadOf({displacedPatch("held", beside, Vec3::Zero())}));
  config.fixed.push_back(beside);
  const double fixed = Tissue(config, exact()).recessUnder(press)->depth;
  EXPECT_GT(fixed, before + 0.001 * kSpacing);
  EXPECT_DOUBLE_EQ(tissue.recessUnder(press)->depth, fixed);
  tissue.release({"held"});
  EXPECT_DOUBLE_EQ(tissue.recessUnder(press)->depth, before);
}

}  // namespace
}  // namespace robot_tissue::test_narrow_contact
