// Tissue that moves in time beside what it touches: the energy of its motion and shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_time_contact {
namespace {

// A block on fixed nodes under a plane without friction, that pushes its top.
class UnderAPlane {
 public:
  static constexpr int kCells = 4;
  static constexpr double kSpacing = 0.01;

  explicit UnderAPlane(double damping_time) : tissue_(config(damping_time), solver()) {
    velocity_.assign(tissue_.state().displacement.size(), Vec3::Zero());
  }

  // Where the plane is: m below the top at rest.
  void put(double depth) { depth_ = depth; }
  SolveStatus step(double duration) {
    const std::vector<Vec3> before = tissue_.state().displacement;
    tissue_.beginTimeStep(duration, Touched::kByTools);
    const SolveReport report = tissue_.follow({plane()}, {});
    tissue_.endTimeStep();
    for (std::size_t node = 0; node < before.size(); ++node) {
      velocity_[node] = (tissue_.state().displacement[node] - before[node]) / duration;
    }
    return report.status;
  }
  Tissue& tissue() { return tissue_; }
  bool rests() const { return !tissue_.isMoving(); }
  double energy() const {
    const Lattice& lattice = tissue_.lattice();
    double energy = ElasticModel(lattice, config(0.0)).energy(tissue_.state());
    for (int node = 0; node < lattice.nodeCount(); ++node) {
      energy += 0.5 * lattice.mass(node) * velocity_[at(node)].squaredNorm();
    }
    const LoadingPatch touched = plane();
    for (const ContactSpring& spring : touched.contacts) {
      energy += energyOf(spring, tissue_.state().displacement);
    }
    return energy;
  }

 private:
  static TissueConfig config(double damping_time) {
    TissueConfig config = withFixedBottom(elasticBlockOf(kCells, kCells, kCells, 0.45));
    config.time = TimeConfig{damping_time};
    return config;
  }
  static SolverConfig solver() {
    SolverConfig solver;
    solver.method = "layered";
    return solver;
  }
  LoadingPatch plane() const {
    LoadingPatch plane;
    plane.name = "plane";
    std::vector<ContactSpring> springs;
    for (int i = 0; i <= kCells; ++i) {
      for (int j = 0; j <= kCells; ++j) {
        ContactSpring spring;
        const int node = tissue_.lattice().node(i, j, kCells);
        spring.carriers = {{node, 1.0}};
        spring.rest = tissue_.lattice().restPosition(node);
        spring.normal = -Vec3::UnitZ();
        spring.plane_point = Vec3(0.0, 0.0, kCells * kSpacing - depth_);
        spring.stiffness = 10.0 * tissue_.nodeStiffness(node);
        springs.push_back(spring);
      }
    }
    plane.contacts = springs;
    return plane;
  }

  Tissue tissue_;
  std::vector<Vec3> velocity_;
  double depth_ = 0.0;
};

// Ten thousand steps of 0.05 to 50 ms in random order; every hundred, the plane is put elsewhere.
TEST(TimeInContact, EnergyNeverGrows) {
  for (const double damping_time : {0.0, 0.01}) {
    UnderAPlane block(damping_time);
    std::mt19937 random(1);
    const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
    int longest_motion = 0;
    for (int visit = 0, steps = 0; steps < 5000; ++visit) {
      block.put(visit % 2 == 0 ? 0.001 + 0.005 * share() : -0.002);
      const double first = block.energy();
      double before = first;
      for (int step = 0; step < 100; ++step, ++steps) {
        ASSERT_EQ(block.step(5e-5 * std::pow(1000.0, share())), SolveStatus::kOk) << steps;
        const double now = block.energy();
        ASSERT_LE(now, before + 1e-3 * first) << steps;
        before = now;
        if (block.rests()) break;
        longest_motion = std::max(longest_motion, step);
      }
    }
    EXPECT_GT(longest_motion, 20);  // it did swing
  }
}

TEST(TimeInContact, CountsAQuarterOfItsIterations) {
  UnderAPlane block(0.01);
  Patience& patience = block.tissue().patience();
  patience.limit();
  const int before = patience.left();
  block.put(0.01);
  const Patience::LoadStep load_step(patience);
  ASSERT_EQ(block.step(0.05), SolveStatus::kOk);
  const int iterations = block.tissue().lastReport().iterations;
  ASSERT_GT(iterations, 0);
  EXPECT_LE(before - patience.left(), (iterations + 3) / 4 + 1);
  EXPECT_GE(before - patience.left(), iterations / 4);
}

}  // namespace
}  // namespace robot_tissue::test_time_contact
