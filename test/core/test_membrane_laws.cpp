// What a membrane's triangles and hinges answer: derivatives by differences, small and large
// stretch, bending by theory, pressure.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <utility>

#include "membrane/hinge.h"
#include "membrane/membrane.h"
#include "membrane/pressed_triangle.h"
#include "membrane/sheet_kernel.h"
#include "membrane/stretched_triangle.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_membrane_laws {
namespace {

constexpr double kStep = 1e-6;  // of the differences (m), where lengths are about 1

MembraneConfig sheet(double ratio) {
  MembraneConfig config;
  config.thickness = 0.01;
  config.young_modulus = 1e4;
  config.poisson_ratio = ratio;
  return config;
}

template <typename Corners>
Corners shaken(Corners places, double size, Random& random) {
  for (Vec3& place : places) place += random.offset(size);
  return places;
}

const StretchedTriangle::Corners kTriangle = {Vec3(0.1, 0.0, 0.2), Vec3(1.1, 0.2, 0.0),
                                              Vec3(0.3, 0.9, 0.4)};
const Hinge::Corners kHinge = {Vec3(0.1, 0.0, 0.2), Vec3(1.1, 0.2, 0.0), Vec3(0.3, 0.9, 0.4),
                               Vec3(0.7, -0.8, 0.5)};

// Forces and stiffness are the energy's differences, and none of them is nothing.
template <typename Law, typename Corners>
void expectDerivatives(const Law& law, const Corners& places) {
  const auto gradient = law.gradient(places);
  const auto hessian = law.hessian(places, Curvature::kExact);
  double size = 0.0;
  for (const Vec3& part : gradient) size = std::max(size, part.norm());
  ASSERT_GT(size, 0.0);
  ASSERT_GT(hessian.norm(), 0.0);
  for (std::size_t corner = 0; corner < places.size(); ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      Corners above = places, below = places;
      above[corner][axis] += kStep;
      below[corner][axis] -= kStep;
      const double slope = (law.energy(above) - law.energy(below)) / (2.0 * kStep);
      EXPECT_NEAR(gradient[corner][axis], slope, 1e-6 * size);
      const auto up = law.gradient(above), down = law.gradient(below);
      for (std::size_t other = 0; other < places.size(); ++other) {
        const Vec3 change = (up[other] - down[other]) / (2.0 * kStep);
        const auto column = static_cast<Eigen::Index>(3 * corner) + axis;
        const Vec3 block =
            hessian.col(column).template segment<3>(static_cast<Eigen::Index>(3 * other));
        EXPECT_LT((block - change).norm(), 1e-7 * hessian.norm());
      }
    }
  }
}

TEST(MembraneLaw, DerivativesOfTriangles) {
  Random random;
  for (const double ratio : {0.0, 0.3, 0.5}) {
    const StretchedTriangle law(sheetLaw(sheet(ratio)), kTriangle);
    expectDerivatives(law, shaken(kTriangle, 0.2, random));
  }
}

TEST(MembraneLaw, DerivativesOfHinges) {
  Random random;
  const Hinge law(3.0, kHinge);
  for (int trial = 0; trial < 5; ++trial) expectDerivatives(law, shaken(kHinge, 0.3, random));
}

TEST(MembraneLaw, DerivativesOfPressure) {
  Random random;
  expectDerivatives(PressedTriangle(7.0, Vec3(0.5, 0.1, 0.2)), shaken(kTriangle, 0.2, random));
}

// Stretched, folded to either side and turned over, from where they have no forces on: more than
// a vector holds, and some that are left.
TEST(MembraneLaw, ManyAtATimeAreAsEachAlone) {
  for (const double ratio : {0.0, 0.3, 0.5}) {
    const SheetLaw law = sheetLaw(sheet(ratio));
    SheetKernel kernel;
    Random random;
    std::vector<Vec3> places, expected;
    const auto take = [&](const auto& element, const auto& corners) {
      const auto gradient = element.gradient(corners);
      places.insert(places.end(), corners.begin(), corners.end());
      for (const Vec3& slope : gradient) expected.push_back(-slope);
    };
    for (int i = 0; i < 29; ++i) {
      const int first = static_cast<int>(places.size());
      const double shake = 0.04 * i;
      const StretchedTriangle triangle(law, kTriangle);
      kernel.add(triangle, {first, first + 1, first + 2});
      take(triangle, shaken(kTriangle, shake, random));
      const Hinge hinge(law.bending, kHinge);
      kernel.add(hinge, {first + 3, first + 4, first + 5, first + 6});
      take(hinge, shaken(kHinge, shake, random));
    }
    std::vector<Vec3> forces(places.size(), Vec3::Zero());
    kernel.addForces(places, forces);
    double greatest = 0.0;
    for (const Vec3& force : expected) greatest = std::max(greatest, force.norm());
    ASSERT_GT(greatest, 0.0);
    for (std::size_t i = 0; i < forces.size(); ++i) {
      EXPECT_LT((forces[i] - expected[i]).norm(), 1e-13 * greatest + 1e-12 * expected[i].norm())
          << i;
    }
  }
}

// The angle is signed: a ridge seen from outside is positive.
TEST(MembraneLaw, HingeAngle) {
  const Hinge::Corners flat = {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(1, 0, 0)};
  EXPECT_DOUBLE_EQ(Hinge::angle(flat), 0.0);
  Hinge::Corners ridge = flat;
  ridge[3] = Vec3(0, 0, -1);
  EXPECT_NEAR(Hinge::angle(ridge), 0.5 * M_PI, 1e-12);
}

// What is left out for kConvex may not make any motion's energy fall.
TEST(MembraneLaw, ConvexPartsAreConvex) {
  Random random;
  const StretchedTriangle triangle(sheetLaw(sheet(0.4)), kTriangle);
  const Hinge hinge(3.0, kHinge);
  int differ = 0;
  for (int trial = 0; trial < 20; ++trial) {
    const auto places = shaken(kTriangle, 0.3, random);
    const StretchedTriangle::Hessian convex = triangle.hessian(places, Curvature::kConvex);
    const Eigen::SelfAdjointEigenSolver<StretchedTriangle::Hessian> solver(convex);
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-9 * convex.norm());
    if ((convex - triangle.hessian(places, Curvature::kExact)).norm() > 1e-3 * convex.norm()) {
      ++differ;
    }
    const Hinge::Hessian bent = hinge.hessian(shaken(kHinge, 0.3, random), Curvature::kConvex);
    const Eigen::SelfAdjointEigenSolver<Hinge::Hessian> of_hinge(bent);
    EXPECT_GT(of_hinge.eigenvalues().minCoeff(), -1e-9 * bent.norm());
  }
  EXPECT_GT(differ, 0);
}

// --- Whole sheets, each vertex on a node of its own

TissueSurface onNodes(const TriangleMesh& mesh) {
  TissueSurface surface;
  surface.rest = mesh.vertices;
  surface.triangles = mesh.triangles;
  surface.opened.assign(mesh.triangles.size(), 0);
  for (std::size_t vertex = 0; vertex < mesh.vertices.size(); ++vertex) {
    surface.carriers.push_back({{static_cast<int>(vertex), 1.0}});
    surface.node.push_back(static_cast<int>(vertex));
  }
  return surface;
}

// n x m squares of this size (m), split along alternate diagonals, inner vertices off the grid.
TriangleMesh flatSheet(int n, int m, double size, double off) {
  Random random;
  TriangleMesh mesh;
  for (int j = 0; j <= m; ++j) {
    for (int i = 0; i <= n; ++i) {
      const bool inner = i > 0 && i < n && j > 0 && j < m;
      const Vec3 shift = random.offset(off * size);
      mesh.vertices.emplace_back(i * size + (inner ? shift.x() : 0.0),
                                 j * size + (inner ? shift.y() : 0.0), 0.0);
    }
  }
  for (int j = 0; j < m; ++j) {
    for (int i = 0; i < n; ++i) {
      const int a = i + (n + 1) * j, b = a + 1, c = a + n + 1, d = c + 1;
      if ((i + j) % 2 == 0) {
        mesh.triangles.push_back({a, b, d});
        mesh.triangles.push_back({a, d, c});
      } else {
        mesh.triangles.push_back({a, b, c});
        mesh.triangles.push_back({b, d, c});
      }
    }
  }
  return mesh;
}

Membrane membraneOn(const TissueSurface& surface, const MembraneConfig& config) {
  MembranePart part;
  part.law = sheetLaw(config);
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    part.triangles.push_back(static_cast<int>(i));
  }
  return {surface, {part}};
}

template <typename Map>
std::vector<Vec3> movedBy(const TissueSurface& surface, const Membrane& membrane, Map map) {
  std::vector<Vec3> moved;
  for (const int node : membrane.nodes()) {
    moved.push_back(map(surface.rest[at(node)]) - surface.rest[at(node)]);
  }
  return moved;
}

// Patch test: stretched alike everywhere, the inner vertices of an uneven sheet are in balance, the
// energy is the area times W, and at small strain W is that of plane stress.
TEST(Membrane, StretchesAsASheet) {
  const MembraneConfig config = sheet(0.3);
  const int n = 6, m = 5;
  const TissueSurface surface = onNodes(flatSheet(n, m, 0.1, 0.25));
  const Membrane membrane = membraneOn(surface, config);
  const double small = 1e-4, x = 2.0 * small, y = -0.5 * small;
  const auto moved = movedBy(surface, membrane, [&](const Vec3& p) {
    return Vec3((1.0 + x) * p.x(), (1.0 + y) * p.y(), 0.0);
  });
  const std::vector<Vec3> forces = membrane.forces(moved);
  double greatest = 0.0;
  for (const Vec3& force : forces) greatest = std::max(greatest, force.norm());
  ASSERT_GT(greatest, 0.0);
  for (int j = 1; j < m; ++j) {
    for (int i = 1; i < n; ++i) {
      EXPECT_LT(forces[at(i + (n + 1) * j)].norm(), 1e-8 * greatest);
    }
  }
  const double nu = config.poisson_ratio;
  const double per_area = 0.5 * config.young_modulus * config.thickness / (1.0 - nu * nu) *
                          (x * x + y * y + 2.0 * nu * x * y);
  const double expected = per_area * n * m * 0.01;
  EXPECT_NEAR(membrane.energy(moved), expected, 1e-3 * expected);
}

// Uniaxial, incompressible, far: the stretch across is L^-1/2 and the force mu t (L - L^-2) a
// width.
TEST(Membrane, StretchesFarAsNeoHookean) {
  const MembraneConfig config = sheet(0.5);
  const TissueSurface surface = onNodes(flatSheet(4, 4, 0.1, 0.2));
  const Membrane membrane = membraneOn(surface, config);
  const double stretch = 1.7;
  const auto moved = movedBy(surface, membrane, [&](const Vec3& p) {
    return Vec3(stretch * p.x(), p.y() / std::sqrt(stretch), 0.0);
  });
  Vec3 pull = Vec3::Zero(), across = Vec3::Zero();
  const std::vector<Vec3> forces = membrane.forces(moved);
  for (int j = 0; j <= 4; ++j) pull += forces[at(4 + 5 * j)];
  for (int i = 0; i <= 4; ++i) across += forces[at(i + 20)];
  const double mu = config.young_modulus / 3.0;
  const double expected = -mu * config.thickness * (stretch - 1.0 / (stretch * stretch)) * 0.4;
  EXPECT_NEAR(pull.x(), expected, 1e-9 * std::abs(expected));
  EXPECT_LT(across.norm(), 1e-9 * std::abs(expected));
}

// Bending alone, of a sheet that has been moved so.
template <typename Map>
double bendingEnergy(const TissueSurface& surface, const MembraneConfig& config, Map map) {
  MembraneConfig limp = config;
  limp.thickness *= 1e-4;
  limp.young_modulus *= 1e4;  // the same stretch, no bending
  const Membrane membrane = membraneOn(surface, config);
  const auto moved = movedBy(surface, membrane, map);
  return membrane.energy(moved) - membraneOn(surface, limp).energy(moved);
}

Vec3 rolledUp(const Vec3& place, double curvature) {
  const double angle = curvature * place.x();
  return {std::sin(angle) / curvature, place.y(), (1.0 - std::cos(angle)) / curvature};
}

// A strip rolled to a part of a cylinder, without stretch: D / 2 kappa^2 of its area, but for the
// outermost half squares, which have no hinge.
TEST(Membrane, BendsAsAPlate) {
  const MembraneConfig config = sheet(0.3);
  const int n = 40, m = 4;
  const double size = 0.01, curvature = 1.5;
  const double bent = bendingEnergy(onNodes(flatSheet(n, m, size, 0.0)), config,
                                    [&](const Vec3& p) { return rolledUp(p, curvature); });
  const double expected =
      0.5 * sheetLaw(config).bending * curvature * curvature * (n - 1) * m * size * size;
  EXPECT_NEAR(bent, expected, 2e-3 * expected);
}

// Every other column of squares is a hair wide, as a cut may leave its triangles. Rolled up, the
// sheet bends as any other; one side of a hair lifted by half its width, it does not.
TEST(Membrane, ThinTrianglesBendWithTheirNeighbors) {
  const MembraneConfig config = sheet(0.3);
  const int n = 40, m = 4;
  const double size = 0.01, hair = 1e-6 * size, curvature = 1.5;
  TriangleMesh mesh = flatSheet(2 * n + 1, m, size, 0.0);
  for (Vec3& vertex : mesh.vertices) {
    const int column = static_cast<int>(std::lround(vertex.x() / size));
    vertex.x() = column / 2 * size + column % 2 * hair;
  }
  const TissueSurface surface = onNodes(mesh);
  const double bending = sheetLaw(config).bending;
  const double bent =
      bendingEnergy(surface, config, [&](const Vec3& p) { return rolledUp(p, curvature); });
  const double expected = 0.5 * bending * curvature * curvature * (n - 1) * m * size * size;
  EXPECT_NEAR(bent, expected, 2e-3 * expected);
  const Vec3 lifted = surface.rest[at(n + 2 * (n + 1) * m / 2)];
  const double kinked = bendingEnergy(surface, config, [&](const Vec3& p) {
    return p == lifted ? Vec3(p + Vec3(0, 0, 0.5 * hair)) : p;
  });
  EXPECT_LT(std::abs(kinked), bending);
}

// Turned as a whole it has no energy; turned when deformed it has the same, and turned forces.
TEST(Membrane, TurnsWithoutEnergy) {
  const TissueSurface surface = onNodes(sphereMesh(0.3, 2));
  const Membrane membrane = membraneOn(surface, sheet(0.4));
  Random random;
  const Pose pose = random.pose(1.0);
  const auto turned = movedBy(surface, membrane, [&](const Vec3& p) { return pose * p; });
  EXPECT_NEAR(membrane.energy(turned), 0.0, 1e-12);
  std::vector<Vec3> deformed(surface.rest.size()), both;
  for (Vec3& motion : deformed) motion = random.offset(0.02);
  for (std::size_t i = 0; i < deformed.size(); ++i) {
    both.push_back(pose * (surface.rest[i] + deformed[i]) - surface.rest[i]);
  }
  const double energy = membrane.energy(deformed);
  ASSERT_GT(energy, 0.0);
  EXPECT_NEAR(membrane.energy(both), energy, 1e-9 * energy);
  const std::vector<Vec3> forces = membrane.forces(deformed), forces_turned = membrane.forces(both);
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < forces.size(); ++i) {
    EXPECT_LT((pose.linear() * forces[i] - forces_turned[i]).norm(),
              1e-9 * forces[i].norm() + 1e-12);
    sum += forces[i];
  }
  EXPECT_LT(sum.norm(), 1e-9);
}

// Vertices that several nodes carry: forces are the energy's differences in the nodes, the
// stiffness the forces', and one node's force is that of all.
TEST(Membrane, HangsOnTheNodesThatCarryIt) {
  TissueSurface surface = onNodes(sphereMesh(0.3, 1));
  const int count = static_cast<int>(surface.rest.size());
  surface.carriers = CarrierLists();
  for (int vertex = 0; vertex < count; ++vertex) {
    surface.carriers.push_back({{2 * (vertex / 2), 0.3}, {3 * (vertex / 3) + 1, 0.7}});
  }
  MembranePart part;
  part.law = sheetLaw(sheet(0.4));
  part.pressure = 30.0;
  for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
    part.triangles.push_back(static_cast<int>(i));
  }
  part.pressed = part.triangles;
  const Membrane membrane(surface, {part});
  Random random;
  std::vector<Vec3> all(at(count) + 3, Vec3::Zero());
  for (Vec3& motion : all) motion = random.offset(0.02);
  const std::vector<Vec3> moved = membrane.ofNodes(all);
  const std::vector<Vec3> forces = membrane.forces(moved);
  NodeBlocks of_vertices = membrane.stiffnessPattern();
  membrane.findStiffness(moved, Curvature::kExact, of_vertices);
  const NodeBlocks stiffness = membrane.carriers().stiffness(of_vertices);
  double greatest = 0.0, stiffest = 0.0;
  for (int row = 0; row < stiffness.rows(); ++row) {
    greatest = std::max(greatest, forces[at(row)].norm());
    stiffest = std::max(stiffest, stiffness.diagonal(row).norm());
  }
  ASSERT_GT(greatest, 0.0);
  for (std::size_t i = 0; i < moved.size(); ++i) {
    EXPECT_LT((membrane.force(all, membrane.nodes()[i]) - forces[i]).norm(), 1e-12 * greatest);
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<Vec3> above = moved, below = moved, along(moved.size(), Vec3::Zero());
      above[i][axis] += kStep;
      below[i][axis] -= kStep;
      along[i][axis] = 1.0;
      const double slope = (membrane.energy(above) - membrane.energy(below)) / (2.0 * kStep);
      EXPECT_NEAR(-forces[i][axis], slope, 1e-6 * greatest);
      const std::vector<Vec3> up = membrane.forces(above), down = membrane.forces(below);
      const std::vector<Vec3> product = stiffness.times(along);
      for (std::size_t j = 0; j < moved.size(); ++j) {
        const Vec3 change = (down[j] - up[j]) / (2.0 * kStep);
        EXPECT_LT((product[j] - change).norm(), 1e-6 * stiffest);
      }
    }
  }
  EXPECT_GT(membrane.pressureNorm(moved), 0.0);
}

double weightOf(Random& random) { return random.offset(1.0).x(); }

// Of a ring, in which each has something in common with the next; symmetric.
NodeBlocks randomBlocks(int rows, Random& random) {
  std::vector<std::pair<int, int>> pairs;
  for (int row = 0; row < rows; ++row) {
    pairs.emplace_back(row, (row + 1) % rows);
    pairs.emplace_back((row + 1) % rows, row);
  }
  NodeBlocks blocks(rows, std::move(pairs));
  for (int row = 0; row < rows; ++row) {
    for (int i = blocks.first(row); i < blocks.last(row); ++i) {
      Eigen::Matrix3d part;
      for (double& number : part.reshaped()) number = weightOf(random);
      blocks.block(i) += part;
      blocks.block(blocks.place(blocks.column(i), row)) += part.transpose();
    }
  }
  return blocks;
}

// What carries the carriers carries the vertices, but for one that stands; the stiffness need not
// be written out.
TEST(Membrane, CarriersOfCarriers) {
  constexpr int kVertices = 12, kFine = 9, kCoarse = 5;
  Random random;
  std::vector<VertexCarriers::Shares> of_vertices(kVertices), of_fine(kFine);
  for (int vertex = 0; vertex < kVertices; ++vertex) {
    for (const int step : {4, 1, 7}) {
      of_vertices[at(vertex)].push_back({(vertex + step) % kFine, weightOf(random)});
    }
  }
  for (int i = 1; i < kFine; ++i) {
    of_fine[at(i)] = {{i / 2, weightOf(random)}, {(i + 1) / 2, weightOf(random)}};
  }
  const VertexCarriers fine(kFine, of_vertices), coarse(fine, kCoarse, of_fine);
  std::vector<Vec3> motion(kCoarse), of_carriers(kFine, Vec3::Zero());
  for (Vec3& vector : motion) vector = random.offset(1.0);
  for (int i = 0; i < kFine; ++i) {
    for (const NodeWeight& share : of_fine[at(i)]) {
      of_carriers[at(i)] += share.weight * motion[at(share.node)];
    }
  }
  const std::vector<Vec3> means = fine.toVertices(of_carriers), same = coarse.toVertices(motion);
  for (std::size_t i = 0; i < means.size(); ++i) EXPECT_LT((means[i] - same[i]).norm(), 1e-14);
  const NodeBlocks blocks = randomBlocks(kVertices, random), written = coarse.stiffness(blocks);
  const std::vector<Vec3> product = written.times(motion);
  const std::vector<Vec3> unwritten = coarse.toCarriers(blocks.times(same));
  const std::vector<Eigen::Matrix3d> diagonal = coarse.diagonal(blocks);
  for (int row = 0; row < kCoarse; ++row) {
    EXPECT_LT((product[at(row)] - unwritten[at(row)]).norm(), 1e-13);
    EXPECT_LT((written.diagonal(row) - diagonal[at(row)]).norm(), 1e-13);
  }
}

}  // namespace
}  // namespace robot_tissue::test_membrane_laws
