// How much wider than it is a bonded patch seems to the lattice of model `elastic`, and the springs
// between patch and rim nodes that make up for it. Prints CSV; doc/model.md reads it.
//
// A strip of N cells' height, fixed at the bottom, endless along y, is bonded to a rigid plate on
// top for x < a. The plate moves by one unit: normal to the strip, across the rim (x) or along it
// (y). In the continuum the energy of small motions is W = W0 (a + beta H): scale has no other
// place to enter. The lattice's is W0 (a + beta H + delta h), and two heights tell delta:
// with w = W / (W0 h), delta = 2 w(N) - w(2 N).
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <cstdio>
#include <vector>

#include "robot_tissue/core/elastic_cell.h"
#include "robot_tissue/core/material.h"

namespace robot_tissue {
namespace {

constexpr int kBonded = 3;  // length of the strip under the plate and beside it, in heights
constexpr int kBeside = 3;

// Stiffness of the springs that join a rim node to the plate, in shear moduli times the spacing.
struct RimSprings {
  bool rigid = true;
  Vec3 stiffness = Vec3::Zero();  // across, along, normal: x, y, z
};

// Of one slice of cells, a spacing of 1 m thick, in which nothing depends on y.
class Strip {
 public:
  Strip(int cells, double poisson_ratio, const RimSprings& rim) : cells_(cells), rim_(rim) {
    material_.young_modulus = 1.0;
    material_.poisson_ratio = poisson_ratio;
    ElasticCell::Corners rest;
    rest.fill(Vec3::Zero());
    hessian_ = ElasticCell({shearModulus(material_), bulkModulus(material_)}, 1.0, rest).hessian();
  }

  // w of the plate's motion along an axis.
  double energyOver(int axis) const {
    const double shear = shearModulus(material_);
    const double modulus = axis == 2 ? bulkModulus(material_) + 4.0 / 3.0 * shear : shear;
    return energy(axis) * 2.0 * cells_ / modulus;
  }

 private:
  int columns() const { return (kBonded + kBeside) * cells_ + 1; }
  int edge() const { return kBonded * cells_; }  // column of the rim nodes

  // The unknown of a node, -1: does not move, -2: moves with the plate.
  int unknown(int column, int row, int component, int axis) const {
    if (row == 0) return -1;
    if (row == cells_ && (column < edge() || (column == edge() && rim_.rigid))) {
      return component == axis ? -2 : -1;
    }
    // At the far end under the plate the strip deforms as an endless one.
    if (column == 0 && component != axis) return -1;
    return 3 * (column * (cells_ + 1) + row) + component;
  }

  double energy(int axis) const {
    const int count = 3 * columns() * (cells_ + 1);
    std::vector<Eigen::Triplet<double>> entries;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(count);
    double energy = 0.0;
    const auto add = [&](int i, int j, double value) {
      if (i == -1 || j == -1) return;
      if (i == -2 && j == -2) energy += 0.5 * value;
      if (i >= 0 && j == -2) force[i] -= value;
      if (i >= 0 && j >= 0) entries.emplace_back(i, j, value);
    };
    for (int column = 0; column + 1 < columns(); ++column) {
      for (int row = 0; row < cells_; ++row) {
        std::array<int, 3 * kCorners> of;
        for (int i = 0; i < 3 * kCorners; ++i) {
          const int corner = i / 3;
          of[at(i)] = unknown(column + (corner & 1), row + (corner >> 2 & 1), i % 3, axis);
        }
        for (int i = 0; i < 3 * kCorners; ++i) {
          for (int j = 0; j < 3 * kCorners; ++j) add(of[at(i)], of[at(j)], hessian_(i, j));
        }
      }
    }
    for (int component = 0; component < 3 && !rim_.rigid; ++component) {
      const int node = unknown(edge(), cells_, component, axis);
      const int plate = component == axis ? -2 : -1;
      const double stiffness = rim_.stiffness[component] * shearModulus(material_);
      add(node, node, stiffness);
      add(node, plate, -stiffness);
      add(plate, plate, stiffness);
    }
    // Components that nothing moves keep a row of their own.
    for (int i = 0; i < count; ++i) entries.emplace_back(i, i, 1e-12);
    Eigen::SparseMatrix<double> matrix(count, count);
    matrix.setFromTriplets(entries.begin(), entries.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);
    const Eigen::VectorXd moved = factor.solve(force);
    return energy - 0.5 * moved.dot(force);
  }

  int cells_;
  RimSprings rim_;
  Material material_;
  CellHessian hessian_;
};

Vec3 excessWidths(int cells, double poisson_ratio, const RimSprings& rim) {
  const Strip coarse(cells, poisson_ratio, rim), fine(2 * cells, poisson_ratio, rim);
  Vec3 delta;
  for (int axis = 0; axis < 3; ++axis) {
    delta[axis] = 2.0 * coarse.energyOver(axis) - fine.energyOver(axis);
  }
  return delta;
}

// Springs for which no excess width is left: Newton's method with slopes by differences.
RimSprings springsWithoutExcess(int cells, double poisson_ratio) {
  constexpr double kStep = 1e-3;
  RimSprings rim;
  rim.rigid = false;
  rim.stiffness = Vec3(5.0, 3.6, 7.0);
  for (int iteration = 0; iteration < 6; ++iteration) {
    const Vec3 delta = excessWidths(cells, poisson_ratio, rim);
    Eigen::Matrix3d slope;
    for (int axis = 0; axis < 3; ++axis) {
      RimSprings stiffer = rim;
      stiffer.stiffness[axis] += kStep;
      slope.col(axis) = (excessWidths(cells, poisson_ratio, stiffer) - delta) / kStep;
    }
    rim.stiffness -= slope.partialPivLu().solve(delta);
  }
  return rim;
}

void print(const char* joined, int cells, double poisson_ratio, const RimSprings& rim) {
  const Vec3 delta = excessWidths(cells, poisson_ratio, rim);
  std::printf("%s,%g,%d,%.3f,%.3f,%.3f,%.4f,%.4f,%.4f\n", joined, poisson_ratio, cells,
              rim.stiffness.x(), rim.stiffness.y(), rim.stiffness.z(), delta.x(), delta.y(),
              delta.z());
  std::fflush(stdout);
}

}  // namespace
}  // namespace robot_tissue

int main() {
  using namespace robot_tissue;
  std::printf(
      "joined,poisson_ratio,cells,k_across,k_along,k_normal,"
      "delta_across,delta_along,delta_normal\n");
  for (const double ratio : {0.25, 0.35, 0.45, 0.49}) {
    for (const int cells : {4, 8, 16}) print("rigidly", cells, ratio, RimSprings());
    print("by springs", 16, ratio, springsWithoutExcess(16, ratio));
  }
  return 0;
}
