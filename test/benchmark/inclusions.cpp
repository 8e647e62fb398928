// What a stiff or soft ball in a bar does wherever it stands in the grid, as a region by its mesh
// and as cells whose centers it holds: the tables of doc/accuracy.md.
//   inclusions eshelby|own [PLACES]
// eshelby: a ball in a long bar under tension; what it adds to the force, and the strain in it over
// that of the bar without it, beside Eshelby's (1957) ball in an infinite body.
// own: a ball in a cube between bonded plates, stretched and sheared; what it adds to the force
// over what it adds in the same lattice of a quarter of the spacing.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "../core/mesh_fixtures.h"
#include "robot_tissue/core/tissue.h"

using namespace robot_tissue;

namespace {

constexpr double kSpacing = 0.005, kYoung = 1e4, kRadius = 2.4 * kSpacing, kStrain = 1e-3;
constexpr int kBallRounds = 4;

enum class Ball { kNone, kByMesh, kByCenters };

struct Job {
  Vec3 extent;  // m
  double spacing;
  double nu;
  double ratio;  // of Young's moduli
  Vec3 middle;   // of the ball (m)
  Vec3 strain;   // of the top plate's displacement over the height
};

double insideRadius() {
  // Of the ball whose volume the faceted mesh has.
  return std::cbrt(volumeOf(sphereMesh(kRadius, kBallRounds)) / (4.0 / 3.0 * M_PI));
}

void addBall(const Job& job, Ball ball, TissueConfig& config) {
  Region region;
  region.material = config.material;
  region.material.young_modulus *= job.ratio;
  if (ball == Ball::kByMesh) {
    region.mesh =
        std::make_shared<const TriangleMesh>(moved(sphereMesh(kRadius, kBallRounds), job.middle));
    config.regions.push_back(region);
  }
  if (ball != Ball::kByCenters) return;
  const Lattice lattice(config);
  for (const Cell& cell : lattice.cells()) {
    const Vec3 center = lattice.cellCenter(cell);
    if ((center - job.middle).norm() > insideRadius()) continue;
    region.box = {center, center};
    config.regions.push_back(region);
  }
}

std::unique_ptr<Tissue> stretched(const Job& job, Ball ball) {
  TissueConfig config;
  config.shape.max() = job.extent;
  config.spacing = job.spacing;
  config.material.young_modulus = kYoung;
  config.material.poisson_ratio = job.nu;
  Box bottom = config.shape, top = config.shape;
  bottom.max().z() = 0.0;
  top.min().z() = job.extent.z();
  config.fixed.push_back(bottom);
  addBall(job, ball, config);
  SolverConfig solver;
  solver.method = "layered";
  solver.tolerance = 1e-5;
  auto tissue = std::make_unique<Tissue>(config, solver);
  LoadStep step;
  step.increments = 1;
  const Vec3 moved = job.extent.z() * job.strain;
  step.patches.push_back({"top", top, {{moved.x(), moved.y(), moved.z()}}, {}, false});
  tissue->load(step);
  if (tissue->lastReport().status != SolveStatus::kOk) std::printf("not OK\n");
  return tissue;
}

double work(const Tissue& tissue, const Job& job) {
  return tissue.lastReport().patches.front().force.dot(job.strain) / job.strain.squaredNorm();
}

Vec3 displacementAt(const Tissue& tissue, const Vec3& point) {
  const Lattice& lattice = tissue.lattice();
  const Vec3 from = (point - lattice.bounds().min()) / lattice.spacing();
  Vec3 sum = Vec3::Zero();
  for (int corner = 0; corner < kCorners; ++corner) {
    double weight = 1.0;
    std::array<int, 3> place{};
    for (int axis = 0; axis < 3; ++axis) {
      const double low = std::floor(from[axis]);
      const bool high = (corner >> axis & 1) != 0;
      weight *= high ? from[axis] - low : 1.0 - from[axis] + low;
      place[at(axis)] = static_cast<int>(low) + (high ? 1 : 0);
    }
    if (weight == 0.0) continue;
    sum += weight * tissue.state().displacement[at(lattice.node(place[0], place[1], place[2]))];
  }
  return sum;
}

// Strain along z in the ball, between points half way to its poles.
double innerStrain(const Tissue& tissue, const Job& job) {
  const Vec3 reach = 0.5 * kRadius * Vec3::UnitZ();
  const Vec3 stretch =
      displacementAt(tissue, job.middle + reach) - displacementAt(tissue, job.middle - reach);
  return stretch.z() / kRadius;
}

// Of a ball in a tension of strain 1 far away.
struct Eshelby {
  double inner_strain;  // along the tension
  double added_force;   // over what the bar bears without it, a share of its volume
};

Eshelby eshelby(double nu, double ratio) {
  const double bulk = 1.0 / (3.0 * (1.0 - 2.0 * nu)), shear = 1.0 / (2.0 * (1.0 + nu));
  const double alpha = (1.0 + nu) / (3.0 * (1.0 - nu));
  const double beta = 2.0 * (4.0 - 5.0 * nu) / (15.0 * (1.0 - nu));
  const double mean = (1.0 - 2.0 * nu) / 3.0, deviator = 2.0 * (1.0 + nu) / 3.0;
  const double mean_within = mean / (1.0 + alpha * (ratio - 1.0));
  const double deviator_within = deviator / (1.0 + beta * (ratio - 1.0));
  // strain : (C1 - C0) : strain within, over strain : C0 : strain = 1
  return {
      mean_within + deviator_within,
      (ratio - 1.0) * (9.0 * bulk * mean * mean_within + 3.0 * shear * deviator * deviator_within)};
}

void printRow(const char* load, double nu, double ratio, const char* rule, const char* quantity,
              std::vector<double> values) {
  std::sort(values.begin(), values.end());
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  std::printf("%s,%g,%g,%s,%s,%.3f,%.3f,%.3f\n", load, nu, ratio, rule, quantity, values.front(),
              mean, values.back());
  std::fflush(stdout);
}

const char* nameOf(Ball ball) { return ball == Ball::kByMesh ? "mesh" : "centers"; }

double added(const Job& job, Ball ball) {
  return work(*stretched(job, ball), job) - work(*stretched(job, Ball::kNone), job);
}

void compareWithEshelby(double nu, double ratio, int places) {
  Job job = {kSpacing * Vec3(20, 20, 40), kSpacing, nu, ratio, {}, Vec3(0, 0, kStrain)};
  const auto plain = stretched(job, Ball::kNone);
  const Eshelby theory = eshelby(nu, ratio);
  // What ends that cannot contract make the bar stiffer by, its middle is strained more by.
  const double bar = kYoung * job.extent.x() * job.extent.y() * kStrain;
  const double stiffer = work(*plain, job) * kStrain / bar;
  const double share = stiffer * volumeOf(sphereMesh(kRadius, kBallRounds)) / job.extent.prod();
  for (const Ball ball : {Ball::kByMesh, Ball::kByCenters}) {
    Random random;
    std::vector<double> inner, force;
    for (int place = 0; place < places; ++place) {
      job.middle = 0.5 * job.extent + 0.5 * kSpacing * random.offset(1.0);
      const auto tissue = stretched(job, ball);
      inner.push_back(innerStrain(*tissue, job) / innerStrain(*plain, job));
      force.push_back((work(*tissue, job) / work(*plain, job) - 1.0) / share / theory.added_force);
    }
    printRow("tension", nu, ratio, nameOf(ball), "added force over Eshelby's", force);
    printRow("tension", nu, ratio, nameOf(ball), "inner strain", inner);
  }
  printRow("tension", nu, ratio, "Eshelby", "inner strain", {theory.inner_strain});
}

void compareWithOwn(double nu, double ratio, const Vec3& strain, const char* load, int places) {
  Job job = {kSpacing * Vec3(12, 12, 12), kSpacing, nu, ratio, {}, strain};
  std::vector<double> by_mesh, by_centers;
  Random random;
  for (int place = 0; place < places; ++place) {
    job.middle = 0.5 * job.extent + 0.5 * kSpacing * random.offset(1.0);
    job.spacing = kSpacing / 4.0;
    const double truth = added(job, Ball::kByMesh);
    job.spacing = kSpacing;
    by_mesh.push_back(added(job, Ball::kByMesh) / truth);
    by_centers.push_back(added(job, Ball::kByCenters) / truth);
  }
  printRow(load, nu, ratio, "mesh", "added force over own", by_mesh);
  printRow(load, nu, ratio, "centers", "added force over own", by_centers);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string against = argc > 1 ? argv[1] : "eshelby";
  const int places = argc > 2 ? std::atoi(argv[2]) : 8;
  std::printf("load,nu,ratio,rule,quantity,least,mean,greatest\n");
  for (const double nu : {0.3, 0.45}) {
    for (const double ratio : {0.1, 3.0, 10.0, 100.0}) {
      if (against == "eshelby") {
        compareWithEshelby(nu, ratio, places);
      } else {
        compareWithOwn(nu, ratio, Vec3(0, 0, kStrain), "stretch", places);
        compareWithOwn(nu, ratio, Vec3(kStrain, 0, 0), "shear", places);
      }
    }
  }
}
