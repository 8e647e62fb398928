// Three tools that move at random, into each other and through the block, far faster than tissue
// could follow; now and then all leave. A fixed seed.
//   contact_random [MOTIONS] [FRICTION] [SPACING in mm] [SEED] [METHOD] [FIRST motion to tell of]
// Writes one line a visit (from the rest shape until all tools have left): friction,visit,motions,
// load_steps,not_finite,inverted_updates,inverted_at_leave,left_mm,greatest_force_n,
// deepest_mm,most_displacement_mm,unconverged,s. With FIRST, one line a motion instead on stderr.
#include <chrono>
#include <cstdio>
#include <limits>
#include <random>

#include "contact_trial.h"

namespace robot_tissue {
namespace {

const Vec3 kExtent(0.06, 0.06, 0.04);
constexpr int kMotionsOfVisit = 50;

bool isFinite(const ToolReport& tool) {
  return tool.force_on_tool.allFinite() && tool.torque_on_tool.allFinite() &&
         tool.point.allFinite() && tool.normal.allFinite() && tool.offset.allFinite() &&
         std::isfinite(tool.max_penetration);
}

class Visits {
 public:
  Visits(double friction, double spacing, unsigned seed, const std::string& method, int first)
      : friction_(friction),
        first_(first),
        random_(seed),
        pipeline_(blockOf(kExtent, spacing), solverOf(method, 0.01),
                  {toolOf("sphere", sphereOf(0.012), friction),
                   toolOf("box", boxOf(Vec3(0.02, 0.025, 0.015)), friction),
                   toolOf("rod", cylinderOf(0.005, 0.05), friction)}) {
    for (int tool = 0; tool < 3; ++tool) pose_.links.push_back(placedAt(outside(tool)));
    pipeline_.step(pose_);
  }

  void visit(int number) {
    sums_ = Sums();
    const auto begin = std::chrono::steady_clock::now();
    for (int motion = 1; motion < kMotionsOfVisit; ++motion) {
      for (Pose& link : pose_.links) move(link);
      update(kMotionsOfVisit * number + motion);
    }
    for (std::size_t tool = 0; tool < 3; ++tool) {
      pose_.links[tool] = placedAt(outside(static_cast<int>(tool)));
    }
    update(kMotionsOfVisit * (number + 1));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    const SolveReport& solve = pipeline_.tissue().lastReport();
    std::printf("%g,%d,%d,%d,%d,%d,%d,%.9g,%.3f,%.3f,%.2f,%d,%.2f\n", friction_, number,
                kMotionsOfVisit, sums_.load_steps, sums_.not_finite, sums_.inverted,
                solve.inverted_cells, 1e3 * displaced(), sums_.force, 1e3 * sums_.depth,
                1e3 * sums_.displaced, sums_.unconverged, took.count());
    std::fflush(stdout);
  }

 private:
  struct Sums {
    int load_steps = 0, not_finite = 0, inverted = 0, unconverged = 0;
    double force = 0.0, depth = 0.0, displaced = 0.0;
  };

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 uniform(const Vec3& low, const Vec3& high) {
    return Vec3(uniform(low.x(), high.x()), uniform(low.y(), high.y()), uniform(low.z(), high.z()));
  }
  static Vec3 outside(int tool) { return Vec3(0.03, 0.03, 0.3 + 0.1 * tool); }

  // Of a hundred motions of a tool 84 are short, in 10 it stays, and 6 take it anywhere in or
  // around the block, down to the ground, in one update: at 100 of them a second up to 12 m/s.
  void move(Pose& link) {
    const double kind = uniform(0.0, 1.0);
    const Vec3 turn = uniform(-Vec3::Ones(), Vec3::Ones());
    if (link.translation().z() > 0.1) {  // at the start of a visit: to above the block
      link.translation() = uniform(Vec3(0.0, 0.0, 0.05), Vec3(0.06, 0.06, 0.07));
    } else if (kind < 0.06) {
      link.translation() = uniform(Vec3(-0.03, -0.03, 0.0), Vec3(0.09, 0.09, 0.08));
      link.linear() = Eigen::AngleAxisd(uniform(0.0, M_PI), turn.normalized()).toRotationMatrix();
    } else if (kind < 0.90) {
      link.translation() += uniform(Vec3::Constant(-0.005), Vec3::Constant(0.005));
      link.rotate(Eigen::AngleAxisd(uniform(0.0, 0.2), turn.normalized()));
    }
  }

  void update(int motion) {
    const auto begin = std::chrono::steady_clock::now();
    const StepReport& report = pipeline_.step(pose_);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
    const SolveReport& solve = pipeline_.tissue().lastReport();
    sums_.load_steps += report.substeps;
    bool finite = std::isfinite(displaced()) && std::isfinite(solve.residual) &&
                  pipeline_.forceBalance().unbalanced().allFinite();
    double force = 0.0, depth = 0.0;
    for (const ToolReport& tool : report.tools) {
      finite = finite && isFinite(tool);
      force = std::max(force, tool.force_on_tool.norm());
      depth = std::max(depth, tool.max_penetration);
    }
    if (!finite) ++sums_.not_finite;
    if (solve.inverted_cells > 0) ++sums_.inverted;
    if (solve.status == SolveStatus::kUnconverged) ++sums_.unconverged;
    sums_.force = std::max(sums_.force, force);
    sums_.depth = std::max(sums_.depth, depth);
    sums_.displaced = std::max(sums_.displaced, displaced());
    if (first_ < 0 || motion < first_) return;
    std::fprintf(stderr,
                 "motion %d: %d load steps, %.0f ms (contact %.0f, solve %.0f, %d iterations), %s, "
                 "inverted %d, force %.3f, depth %.3f mm, "
                 "displaced %.2f mm%s\n",
                 motion, report.substeps, took.count(), report.contact_ms, report.solve_ms,
                 solve.iterations, toString(solve.status), solve.inverted_cells, force, 1e3 * depth,
                 1e3 * displaced(), report.was_inside ? ", was inside" : "");
  }

  double displaced() const {
    double most = 0.0;
    for (const Vec3& way : pipeline_.tissue().state().displacement) {
      if (!way.allFinite()) return std::numeric_limits<double>::quiet_NaN();
      most = std::max(most, way.norm());
    }
    return most;
  }

  double friction_;
  int first_;
  std::mt19937_64 random_;
  Pipeline pipeline_;
  RobotPose pose_;
  Sums sums_;
};

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const int motions = static_cast<int>(argument(argc, argv, 1, 10000.0));
  const double friction = argument(argc, argv, 2, 0.3);
  const double spacing = 1e-3 * argument(argc, argv, 3, 10.0);
  const auto seed = static_cast<unsigned>(argument(argc, argv, 4, 1.0));
  Visits visits(friction, spacing, seed, argc > 5 ? argv[5] : "layered",
                static_cast<int>(argument(argc, argv, 6, -1.0)));
  std::printf(
      "friction,visit,motions,load_steps,not_finite,inverted_updates,inverted_at_leave,left_mm,"
      "greatest_force_n,deepest_mm,most_displacement_mm,unconverged,s\n");
  for (int visit = 0; visit < motions / kMotionsOfVisit; ++visit) visits.visit(visit);
  return 0;
}
