// Blocks of model `elastic` and shapes that its tests share.
#pragma once

#include <Eigen/Geometry>
#include <random>

#include "../deform_by.h"
#include "block_fixtures.h"
#include "material/elastic_model.h"
#include "solvers/newton/newton_method.h"

namespace robot_tissue {

inline TissueConfig elasticBlockOf(int cells_x, int cells_y, int cells_z, double poisson_ratio) {
  TissueConfig config = blockOf(cells_x, cells_y, cells_z);
  config.model = "elastic";
  config.material.poisson_ratio = poisson_ratio;
  return config;
}

// An elastic block with the exact method on it.
struct ElasticBlock {
  explicit ElasticBlock(const TissueConfig& config, const NewtonOptions& options = {})
      : lattice(config),
        model(lattice, config),
        method(lattice, model, options),
        state(lattice.restState()) {}

  SolveReport solve(std::vector<LoadingPatch> patches) { return method.solve(patches, {}, state); }

  Lattice lattice;
  ElasticModel model;
  NewtonMethod method;
  LatticeState state;
};

// Displacements of up to `size` along each axis, the same at every run.
class Shaker {
 public:
  explicit Shaker(unsigned seed) : random_(seed) {}

  Vec3 displacement(double size) {
    const auto component = [&] {
      return size * (2.0 * static_cast<double>(random_()) / 4294967295.0 - 1.0);
    };
    const double x = component(), y = component();
    return {x, y, component()};
  }

 private:
  std::mt19937 random_;
};

inline void shake(LatticeState& state, double size, unsigned seed = 1) {
  Shaker shaker(seed);
  for (Vec3& displacement : state.displacement) displacement += shaker.displacement(size);
}

// Second derivative of the energy: rows and columns 3 * node + axis.
inline Eigen::MatrixXd hessianOf(const ElasticBlock& block) {
  const auto count = static_cast<Eigen::Index>(3 * block.state.displacement.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  block.model.visitHessians(block.state, [&](const auto& nodes, const CellHessian& hessian) {
    for (int i = 0; i < static_cast<int>(hessian.rows()) / 3; ++i) {
      for (int j = 0; j < static_cast<int>(hessian.rows()) / 3; ++j) {
        if (nodes[at(i)] < 0 || nodes[at(j)] < 0) continue;
        matrix.block<3, 3>(3 * nodes[at(i)], 3 * nodes[at(j)]) += hessian.block<3, 3>(3 * i, 3 * j);
      }
    }
  });
  return matrix;
}

inline double greatestForce(const std::vector<Vec3>& forces) {
  double greatest = 0.0;
  for (const Vec3& force : forces) greatest = std::max(greatest, force.norm());
  return greatest;
}

}  // namespace robot_tissue
