// Three tools that move at random, into each other and through a block, far faster than tissue
// could follow; now and then all leave. A fixed seed.
#pragma once

#include <chrono>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "contact_trial.h"

namespace robot_tissue {

class RandomVisits {
 public:
  static constexpr int kMotionsOfVisit = 50;

  struct Trial {
    double friction = 0.3;
    double spacing = 0.01;  // m
    unsigned seed = 1;
    std::string method = "layered";
    std::string model = "elastic";
    ToolConfig::Patch patch = ToolConfig::Patch::kConforming;
    int first_told = -1;  // motion from which on each is told on stderr; -1: none
  };

  // From the rest shape until all tools have left.
  struct Sums {
    int load_steps = 0, not_finite = 0, inverted = 0, unconverged = 0;
    int lost = 0;                 // updates in which no shape could follow the tools
    double depth_followed = 0.0;  // m, greatest where one could
    double force = 0.0, depth = 0.0, displaced = 0.0;  // greatest: N, m, m
    int inverted_at_leave = 0;
    double left = 0.0;            // m
    double error_estimate = 0.0;  // greatest
    double seconds = 0.0;
  };

  explicit RandomVisits(const Trial& trial)
      : trial_(trial),
        random_(trial.seed),
        pipeline_(block(trial), solverOf(trial.method, 0.01),
                  {tool("sphere", sphereOf(0.012)), tool("box", boxOf(Vec3(0.02, 0.025, 0.015))),
                   tool("rod", cylinderOf(0.005, 0.05))}) {
    for (int number = 0; number < 3; ++number) pose_.links.push_back(placedAt(outside(number)));
    pipeline_.step(pose_);
  }

  // Draws the numbers of a visit that is left out.
  void skip() {
    for (int motion = 1; motion < kMotionsOfVisit; ++motion) {
      for (Pose& link : pose_.links) move(link);
    }
    leave();
  }

  Sums visit(int number) {
    sums_ = Sums();
    const auto begin = std::chrono::steady_clock::now();
    for (int motion = 1; motion < kMotionsOfVisit; ++motion) {
      for (Pose& link : pose_.links) move(link);
      update(kMotionsOfVisit * number + motion);
    }
    leave();
    update(kMotionsOfVisit * (number + 1));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
    sums_.seconds = took.count();
    sums_.inverted_at_leave = pipeline_.tissue().lastReport().inverted_cells;
    sums_.left = displaced();
    return sums_;
  }

 private:
  static bool isFinite(const ToolReport& tool) {
    return tool.force_on_tool.allFinite() && tool.torque_on_tool.allFinite() &&
           tool.point.allFinite() && tool.normal.allFinite() && tool.offset.allFinite() &&
           std::isfinite(tool.max_penetration);
  }

  static TissueConfig block(const Trial& trial) {
    TissueConfig tissue = blockOf(Vec3(0.06, 0.06, 0.04), trial.spacing);
    tissue.model = trial.model;
    return tissue;
  }
  ToolGeometry tool(const std::string& name, const ToolShape& shape) const {
    ToolGeometry geometry = toolOf(name, shape, trial_.friction);
    geometry.patch = trial_.patch;
    return geometry;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 uniform(const Vec3& low, const Vec3& high) {
    return Vec3(uniform(low.x(), high.x()), uniform(low.y(), high.y()), uniform(low.z(), high.z()));
  }
  static Vec3 outside(int tool) { return Vec3(0.03, 0.03, 0.3 + 0.1 * tool); }

  void leave() {
    for (std::size_t link = 0; link < 3; ++link) {
      pose_.links[link] = placedAt(outside(static_cast<int>(link)));
    }
  }

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
    sums_.error_estimate = std::max(sums_.error_estimate, solve.error_estimate);
    if (solve.inverted_cells > 0) ++sums_.inverted;
    if (solve.status == SolveStatus::kUnconverged) ++sums_.unconverged;
    sums_.force = std::max(sums_.force, force);
    sums_.depth = std::max(sums_.depth, depth);
    if (report.lost) ++sums_.lost;
    if (!report.lost) sums_.depth_followed = std::max(sums_.depth_followed, depth);
    sums_.displaced = std::max(sums_.displaced, displaced());
    if (trial_.first_told < 0 || motion < trial_.first_told) return;
    std::fprintf(stderr,
                 "motion %d: %d load steps, %.0f ms (contact %.0f, solve %.0f, %d iterations), %s, "
                 "inverted %d, force %.3f, depth %.3f mm, "
                 "displaced %.2f mm%s%s\n",
                 motion, report.substeps, took.count(), report.contact_ms, report.solve_ms,
                 solve.iterations, toString(solve.status), solve.inverted_cells, force, 1e3 * depth,
                 1e3 * displaced(), !report.were_inside.empty() ? ", was inside" : "",
                 report.lost ? ", lost" : "");
  }

  double displaced() const {
    double most = 0.0;
    for (const Vec3& way : pipeline_.tissue().state().displacement) {
      if (!way.allFinite()) return std::numeric_limits<double>::quiet_NaN();
      most = std::max(most, way.norm());
    }
    return most;
  }

  Trial trial_;
  std::mt19937_64 random_;
  Pipeline pipeline_;
  RobotPose pose_;
  Sums sums_;
};

}  // namespace robot_tissue
