// Forces of many cells at a time are those of each cell alone.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

#include "elastic_fixtures.h"
#include "material/elastic_cell.h"
#include "solvers/multigrid/level/cell_kernel.h"
#include "solvers/multigrid/level/cell_operator.h"
#include "solvers/multigrid/level/constrained_nodes.h"

namespace robot_tissue::test_cell_kernel {
namespace {

constexpr std::array<int, 3> kPoints = {9, 6, 5};
constexpr double kShear = 1.0, kBulk = 5.0 / 3.0;
constexpr double kOfTheOther = 1e-14;  // rounding of a cell alone, which is told from its places

// A block of cells, two of them left out, one of them with corners beside the grid. Every third is
// filled in part, if asked for.
struct Cells {
  explicit Cells(double stiffening = 0.0, bool some_in_part = false) : grid(kPoints) {
    for (int k = 0; k + 1 < kPoints[2]; ++k) {
      for (int j = 0; j + 1 < kPoints[1]; ++j) {
        for (int i = 0; i + 1 < kPoints[0]; ++i) {
          if (i == 3 && j == 2 && k < 2) continue;
          LevelCell cell{{i, j, k}, {}, kShear, kBulk, stiffening, {}, {}};
          fills.emplace_back();
          if (some_in_part && all.size() % 3 == 0) fill(cell);
          for (int corner = 0; corner < kCorners; ++corner) {
            cell.nodes[at(corner)] =
                grid.index(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1));
          }
          all.push_back(cell);
        }
      }
    }
    for (int corner = 4; corner < kCorners; ++corner) {
      all.back().nodes[at(corner)] = grid.beside + corner - 4;
    }
    findReaches(all);
  }

  // With octants that differ from cell to cell.
  void fill(LevelCell& cell) {
    const auto corners = static_cast<std::uint8_t>(1 + all.size() * 37 % 254);
    CellFill found = fillOf(octantIntegrals(corners));
    fills.back() = std::make_shared<const CellFill>(found);
    cell.shear *= fills.back()->share;
    cell.bulk *= fills.back()->share;
    cell.fill = levelFill(*fills.back(), kShear, kBulk);
  }

  LevelGrid grid;
  std::vector<LevelCell> all;
  std::vector<std::shared_ptr<const CellFill>> fills;  // null: full
};

// What goes in and out with the displacement: all nodes free, no load.
template <typename Real>
struct Around {
  explicit Around(CellOperator<Real>& on) : cells(on), free(at(on.count()), Real(0)) {
    for (auto& values : inverse) values.assign(at(on.count()), Real(0));
    for (auto* field : {&load, &force}) {
      for (auto& values : *field) values.assign(at(on.count()), Real(0));
    }
  }
  void find(const Field<Real>& displacement, Find what) {
    cells.findForces(loads(displacement), what);
  }
  typename CellOperator<Real>::Loads loads(const Field<Real>& displacement) {
    return {displacement, load, free, force, inverse};
  }

  CellOperator<Real>& cells;
  Field<Real> load, force;
  SymmetricField<Real> inverse;
  Numbers<Real> free;
};

// Every node somewhere within `far` spacings of its rest, along each axis.
template <typename Real>
Field<Real> shaken(const CellOperator<Real>& cells, double far) {
  Field<Real> field;
  Shaker shaker(7);
  for (int node = 0; node < cells.count(); ++node) {
    const Vec3 moved = shaker.displacement(far);
    for (int axis = 0; axis < 3; ++axis) field[at(axis)].push_back(static_cast<Real>(moved[axis]));
  }
  return field;
}

// Greatest Rayleigh quotient of a stiffness in another.
double stiffest(const Eigen::Matrix3d& stiffness, const Eigen::Matrix3d& in) {
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix3d>(stiffness, in)
      .eigenvalues()
      .maxCoeff();
}

template <typename Real>
class CellKernel : public testing::Test {
 protected:
  void expectForcesOfEachCell(double far, double tolerance, double stiffening = 0.0,
                              bool some_in_part = false) {
    const Cells given(stiffening, some_in_part);
    CellOperator<Real> cells(given.grid, 4, given.all, {given.grid.whole(), {{1}, {0}}});
    const Field<Real> moved = shaken(cells, far);
    Around<Real> around(cells);
    around.find(moved, Find::kForcesAndStiffness);
    std::vector<Vec3> forces(at(cells.count()), Vec3::Zero());
    std::vector<Eigen::Matrix3d> blocks(at(cells.count()), Eigen::Matrix3d::Zero());
    double greatest = 0.0;
    for (std::size_t index = 0; index < given.all.size(); ++index) {
      const LevelCell& cell = given.all[index];
      const std::array<int, kMostReached> nodes = reachedNodes(cell);
      ElasticCell::Reached displacement;
      displacement.fill(Vec3::Zero());
      for (std::size_t c = 0; c < nodes.size(); ++c) {
        for (int axis = 0; axis < 3 && nodes[c] >= 0; ++axis) {
          displacement[c][axis] = static_cast<double>(moved[at(axis)][at(nodes[c])]);
        }
      }
      const ElasticCell alone({cell.shear, cell.bulk, stiffening}, 1.0, displacement,
                              given.fills[index].get(), cell.reach.get());
      for (int c = 0; c < alone.nodeCount(); ++c) {
        if (nodes[at(c)] < 0) continue;
        forces[at(nodes[at(c)])] -= alone.gradient(c);
        blocks[at(nodes[at(c)])] += alone.block(c);
        greatest = std::max(greatest, alone.gradient(c).norm());
      }
    }
    // Bounded but for one indefinite term, which is larger in crushed cells.
    const double slack = far < 0.5 ? 1.03 : 1.25;
    for (const LevelCell& cell : given.all) {
      for (const int node : cell.nodes) {
        for (int axis = 0; axis < 3; ++axis) {
          EXPECT_NEAR(cells.whole[at(axis)][at(node)], forces[at(node)][axis],
                      tolerance * greatest + kOfTheOther);
        }
        EXPECT_LT(stiffest(blocks[at(node)], matrixAt(cells.stiffness, node)), slack);
      }
    }
  }
};

// Greatest Rayleigh quotient of the second derivative, in the nodes' stiffness, by the power method
// with differences of forces.
double greatestStiffness(CellOperator<double>& cells, const Field<double>& shape) {
  constexpr double kStep = 1e-7;
  Around<double> around(cells);
  around.find(shape, Find::kForcesAndStiffness);
  const SymmetricField<double> stiffness = cells.stiffness;
  const Field<double> before = cells.whole;
  Field<double> motion;
  Shaker shaker(3);
  for (int node = 0; node < cells.count(); ++node) {
    const Vec3 moved = shaker.displacement(1.0);
    for (int axis = 0; axis < 3; ++axis) motion[at(axis)].push_back(moved[axis]);
  }
  double greatest = 0.0;
  for (int probe = 0; probe < 60; ++probe) {
    Field<double> moved = shape;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t node = 0; node < moved[axis].size(); ++node) {
        moved[axis][node] += kStep * motion[axis][node];
      }
    }
    around.find(moved, Find::kForces);
    double product = 0.0, length = 0.0, next = 0.0;
    for (int node = 0; node < cells.count(); ++node) {
      const Eigen::Matrix3d own = matrixAt(stiffness, node);
      if (own.isZero(0.0)) continue;
      const Vec3 along = vectorAt(motion, node);
      const Vec3 force = (vectorAt(before, node) - vectorAt(cells.whole, node)) / kStep;
      product += along.dot(force);
      length += along.dot(own * along);
      const Vec3 goes_on = own.inverse() * force;
      next += goes_on.squaredNorm();
      for (int axis = 0; axis < 3; ++axis) motion[at(axis)][at(node)] = goes_on[axis];
    }
    greatest = product / length;
    for (auto& values : motion) {
      for (double& value : values) value /= std::sqrt(next / cells.count());
    }
  }
  return greatest;
}

// What the smoother's steps are made for: no motion is much stiffer in the nodes' stiffness than at
// rest, also where corners are squeezed flat and turned over.
TEST(CellKernelStiffness, BoundsThatOfAllMotions) {
  for (const bool some_in_part : {false, true}) {
    const Cells given(0.0, some_in_part);
    CellOperator<double> cells(given.grid, 4, given.all, {given.grid.whole(), {{1}, {0}}});
    const double at_rest = greatestStiffness(cells, shaken(cells, 0.0));
    cells.per_greatest = 1.0 / at_rest;
    for (const double far : {0.1, 0.2, 0.3, 0.4, 0.6}) {
      EXPECT_LT(greatestStiffness(cells, shaken(cells, far)), 1.5 * at_rest) << far;
    }
  }
}

using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(CellKernel, Precisions);

template <typename Real>
constexpr double kRounding = sizeof(Real) == sizeof(float) ? 1e-5 : 1e-13;

TYPED_TEST(CellKernel, ForcesAreThoseOfEachCell) {
  for (const double far : {1e-4, 0.05, 0.2}) {
    this->expectForcesOfEachCell(far, kRounding<TypeParam>);
  }
}

TYPED_TEST(CellKernel, ForcesAreThoseOfEachCellAlsoFilledInPart) {
  for (const double far : {1e-4, 0.05, 0.2, 0.6}) {
    this->expectForcesOfEachCell(far, kRounding<TypeParam>, 0.0, true);
  }
}

// Corners squeezed and cells turned inside out: the barrier, and a(J) below its last place.
TYPED_TEST(CellKernel, ForcesAreThoseOfEachCellThatIsCrushed) {
  this->expectForcesOfEachCell(0.6, kRounding<TypeParam>);
}

// Stiffening, below and beyond its greatest exponent.
TYPED_TEST(CellKernel, ForcesAreThoseOfEachCellThatStiffens) {
  for (const double stiffening : {0.5, 10.0, 100.0}) {
    for (const double far : {1e-4, 0.05, 0.2, 0.6}) {
      this->expectForcesOfEachCell(far, kRounding<TypeParam>, stiffening);
    }
  }
}

// What is off rest by a millionth is known as well as what is off by a tenth.
TYPED_TEST(CellKernel, LosesNothingNearRest) {
  for (const double far : {1e-3, 1e-6}) {
    this->expectForcesOfEachCell(far, kRounding<TypeParam>);
  }
}

// Cells that stand for finer ones, beside others that do not: theirs are the forces of a lattice
// that has no others.
TYPED_TEST(CellKernel, ForcesOfTheCoveredPartAreOfItsCellsAlone) {
  const Cells given;
  const GridBox covered{{5, 2, 1}, {6, 3, 2}};
  const std::vector<LevelCell> on_grid(given.all.begin(), given.all.end() - 1);
  std::vector<LevelCell> standing;
  for (const LevelCell& cell : on_grid) {
    bool at_one = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at_one = at_one && cell.place[axis] + 1 >= covered.low[axis] &&
               cell.place[axis] <= covered.high[axis];
    }
    if (at_one) standing.push_back(cell);
  }
  ASSERT_EQ(standing.size(), 27U);
  const GridBox all = given.grid.whole();
  CellOperator<TypeParam> cells(given.grid, 4, on_grid, {all, covered});
  CellOperator<TypeParam> alone(given.grid, 4, standing, {all, all});
  const Field<TypeParam> moved = shaken(cells, 0.1);
  Around<TypeParam> around(cells), around_alone(alone);
  cells.findForcesOfCovered(around.loads(moved));
  around_alone.find(moved, Find::kForces);
  double greatest = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (int node = 0; node < given.grid.beside; ++node) {
      EXPECT_EQ(cells.whole[axis][at(node)], alone.whole[axis][at(node)]);
      greatest = std::max(greatest, std::abs(static_cast<double>(alone.whole[axis][at(node)])));
    }
  }
  EXPECT_GT(greatest, 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_cell_kernel
