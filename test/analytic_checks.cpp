#include "analytic_checks.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "config/material.h"
#include "deform_by.h"
#include "material/elastic_model.h"
#include "robot_tissue/core/tissue.h"
#include "tissue/registry.h"

namespace robot_tissue {
namespace {

constexpr double kYoungModulus = 1e4;  // Pa

TissueConfig blockOf(const Vec3& extent, double spacing, double poisson_ratio) {
  TissueConfig config;
  config.model = "elastic";
  config.shape.max() = extent;
  config.spacing = spacing;
  config.material.young_modulus = kYoungModulus;
  config.material.poisson_ratio = poisson_ratio;
  return config;
}

SolverConfig exactSolver() {
  SolverConfig solver;
  solver.method = "newton";
  return solver;
}

Box faceOf(const Box& shape, int axis, bool upper) {
  Box face = shape;
  (upper ? face.min() : face.max())[axis] = upper ? shape.max()[axis] : shape.min()[axis];
  return face;
}

SolveReport loaded(Tissue& tissue, const LoadStep& step) {
  SolveReport last;
  tissue.load(step, [&](int, int, const SolveReport& report) { last = report; });
  if (last.status != SolveStatus::kOk) throw std::runtime_error("no equilibrium was found");
  return last;
}

// An inextensible bar clamped level at s = 0 under its own weight, load * L^3 / EI = `weight`:
// theta'' = -weight (1 - s) cos(theta), theta(0) = 0, theta'(1) = 0; theta downwards, lengths in L.
double elasticaDeflection(double weight) {
  constexpr int kSteps = 2000;
  double deflection = 0.0;
  const auto endCurvature = [&](double curvature) {
    double theta = 0.0, s = 0.0;
    const double step = 1.0 / kSteps;
    deflection = 0.0;
    for (int i = 0; i < kSteps; ++i, s += step) {  // midpoint rule
      const double theta_middle = theta + 0.5 * step * curvature;
      const double curvature_middle = curvature - 0.5 * step * weight * (1.0 - s) * std::cos(theta);
      deflection += step * std::sin(theta_middle);
      theta += step * curvature_middle;
      curvature -= step * weight * (1.0 - s - 0.5 * step) * std::cos(theta_middle);
    }
    return curvature;
  };
  double low = 0.0, high = weight;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (endCurvature(middle) > 0.0 ? high : low) = middle;
  }
  return deflection;
}

}  // namespace

PulledBar pulledBar(int axis, double poisson_ratio) {
  constexpr double kSpacing = 0.005, kStrain = 1e-3;
  Vec3 extent = Vec3::Constant(4 * kSpacing);
  extent[axis] = 12 * kSpacing;
  Tissue tissue(blockOf(extent, kSpacing, poisson_ratio), exactSolver());
  LoadStep pull;
  for (const bool upper : {false, true}) {
    PatchConfig end;
    end.name = upper ? "pulled" : "held";
    end.box = faceOf(tissue.lattice().bounds(), axis, upper);
    end.displacement.emplace();
    (*end.displacement)[at(axis)] = upper ? kStrain * extent[axis] : 0.0;
    pull.patches.push_back(end);
  }
  const SolveReport report = loaded(tissue, pull);
  const int across = (axis + 1) % 3;
  const double area = extent[across] * extent[(axis + 2) % 3];
  const auto& size = tissue.lattice().size();
  std::array<int, 3> low{size[0] / 2, size[1] / 2, size[2] / 2}, high = low;
  low[at(across)] = 0;
  high[at(across)] = size[at(across)] - 1;
  const auto moved = [&](const std::array<int, 3>& index) {
    return tissue.state()
        .displacement[at(tissue.lattice().node(index[0], index[1], index[2]))][across];
  };
  const double thinner = (moved(low) - moved(high)) / extent[across];
  PulledBar bar;
  bar.young_modulus_error =
      report.patches.back().force[axis] / (area * kStrain) / kYoungModulus - 1.0;
  bar.poisson_ratio_error = thinner / kStrain / poisson_ratio - 1.0;
  return bar;
}

PulledBar uniaxialStress(const Vec3& direction, double poisson_ratio) {
  constexpr double kStrain = 1e-3;
  const TissueConfig config = blockOf(Vec3::Constant(0.03), 0.01, poisson_ratio);
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  // Basis of strains: along the direction, and five that leave it alone.
  const Vec3 n = direction.normalized(), a = n.unitOrthogonal(), b = n.cross(a);
  const auto both = [](const Vec3& u, const Vec3& v) -> Eigen::Matrix3d {
    return 0.5 * (u * v.transpose() + v * u.transpose());
  };
  const std::vector<Eigen::Matrix3d> strains = {both(n, n), both(a, a), both(b, b),
                                                both(a, b), both(n, a), both(n, b)};
  const auto energy = [&](const Eigen::Matrix3d& strain) {
    LatticeState state = lattice.restState();
    deformBy(lattice, Eigen::Matrix3d::Identity() + strain, state);
    return model.energy(state) / 2.7e-5;  // J/m^3
  };
  Eigen::Matrix<double, 6, 6> stiffness;  // by differences round rest
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      const Eigen::Matrix3d x = kStrain * strains[at(i)], y = kStrain * strains[at(j)];
      stiffness(i, j) = (energy(x + y) - energy(x - y) - energy(y - x) + energy(-x - y)) /
                        (4.0 * kStrain * kStrain);
    }
  }
  const Eigen::Matrix<double, 6, 1> answer =
      stiffness.inverse() * Eigen::Matrix<double, 6, 1>::Unit(0);  // strain for a stress of 1 Pa
  PulledBar bar;
  bar.young_modulus_error = 1.0 / answer[0] / kYoungModulus - 1.0;
  bar.poisson_ratio_error = -0.5 * (answer[1] + answer[2]) / answer[0] / poisson_ratio - 1.0;
  return bar;
}

double forceAfterTurn(double angle, double poisson_ratio) {
  const TissueConfig config = blockOf(Vec3::Constant(0.03), 0.01, poisson_ratio);
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  LatticeState state = lattice.restState();
  const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized();
  deformBy(lattice, Eigen::AngleAxisd(angle, axis).toRotationMatrix(), state);
  double greatest = 0.0;
  for (const Vec3& force : model.nodeForces(state)) greatest = std::max(greatest, force.norm());
  return greatest / (shearModulus(config.material) * config.spacing * config.spacing);
}

double patchTestError(double poisson_ratio) {
  TissueConfig config = blockOf(Vec3(0.05, 0.04, 0.03), 0.01, poisson_ratio);
  const Lattice lattice(config);
  const ElasticModel model(lattice, config);
  const auto method = makeMethod(exactSolver(), lattice, model);
  Eigen::Matrix3d gradient;
  gradient << 1.05, 0.02, -0.01, 0.03, 0.96, 0.04, -0.02, 0.01, 1.02;
  LatticeState state = lattice.restState();
  LoadingPatch border;
  double greatest = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    const Vec3 moved = gradient * rest - rest;
    greatest = std::max(greatest, moved.norm());
    const auto index = lattice.gridIndex(node);
    bool inside = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inside = inside && index[axis] > 0 && index[axis] + 1 < lattice.size()[axis];
    }
    if (inside) continue;
    border.nodes.push_back(node);
    border.displacement.push_back(moved);
  }
  std::vector<LoadingPatch> patches = {border};
  if (method->solve(patches, {}, state).status != SolveStatus::kOk) {
    throw std::runtime_error("no equilibrium was found");
  }
  double error = 0.0;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const Vec3 rest = lattice.restPosition(node);
    error = std::max(error, (state.displacement[at(node)] - (gradient * rest - rest)).norm());
  }
  return error / greatest;
}

HangingBar hangingBar(int cells_thick, double poisson_ratio) {
  constexpr double kThick = 0.02, kLong = 0.2, kGravity = 9.81;
  TissueConfig config = blockOf(Vec3(kLong, kThick, kThick), kThick / cells_thick, poisson_ratio);
  config.material.young_modulus = 4e5;
  config.gravity = Vec3(0.0, 0.0, -kGravity);
  config.fixed.push_back(faceOf(config.shape, 0, false));
  Tissue tissue(config, exactSolver());
  if (tissue.settle().status != SolveStatus::kOk) {
    throw std::runtime_error("no equilibrium was found");
  }
  const auto& size = tissue.lattice().size();
  const int tip = tissue.lattice().node(size[0] - 1, size[1] / 2, size[2] / 2);
  HangingBar bar;
  bar.deflection = -tissue.state().displacement[at(tip)].z() / kLong;
  // load L^3 / EI with load = density g A, I = thickness^4 / 12
  bar.elastica = elasticaDeflection(12.0 * config.material.density * kGravity * std::pow(kLong, 3) /
                                    (config.material.young_modulus * kThick * kThick));
  return bar;
}

double volumeRatioUnderPress(bool by_punch, double spacing, double poisson_ratio) {
  TissueConfig config = blockOf(Vec3(0.10, 0.10, 0.05), spacing, poisson_ratio);
  config.fixed.push_back(faceOf(config.shape, 2, false));
  Tissue tissue(config, exactSolver());
  PatchConfig punch;
  punch.name = "punch";
  punch.box = faceOf(config.shape, 2, true);
  if (by_punch) {
    punch.box.min().head<2>().setConstant(0.04);
    punch.box.max().head<2>().setConstant(0.06);
  }
  punch.displacement = {{0.0, 0.0, -0.01}};
  LoadStep press;
  press.patches.push_back(punch);
  return loaded(tissue, press).volume_ratio;
}

}  // namespace robot_tissue
