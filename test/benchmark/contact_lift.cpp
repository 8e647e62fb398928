// A block of 5 N on a table that nothing fixes is taken between two jaws, lifted, turned and held.
//   contact_lift [friction|grasp] [FRICTION] [SPACING in mm] [METHOD] [TOLERANCE]
// friction: two plates squeeze it and lift it by friction alone; grasp: a grasper's jaws hold it.
// Writes way,spacing_mm,friction,leg,increment,fx,fy,fz,wrench_error_percent,table_n,sunk_mm,
// penetration_mm,unbalanced_n,ms,status: f is the sum of the jaws' forces on the tissue, sunk_mm
// how far the block's mean is below where the jaws would carry it.
#include <cstdio>

#include "contact_trial.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kWeight = 5.0;  // N
const Vec3 kExtent(0.06, 0.08, 0.05);
const Vec3 kJaw(0.01, 0.06, 0.04);

class Lift {
 public:
  Lift(bool grasps, double friction, double spacing, const SolverConfig& solver)
      : grasps_(grasps), friction_(friction), spacing_(spacing) {
    TissueConfig tissue = blockOf(kExtent, spacing, false);
    tissue.gravity = Vec3(0.0, 0.0, -9.81);
    tissue.material.density = kWeight / (9.81 * kExtent.prod());
    SupportConfig table;
    table.name = "table";
    table.shape.type = ToolShape::Type::kPlane;
    std::vector<ToolGeometry> tools;
    if (grasps) {
      tools.push_back(toolOf("grasper", boxOf(kJaw), friction));
      tools.front().links.push_back(tools.front().links.front());
      tools.front().role = toolRole("grasper");
    } else {
      tools = {toolOf("left", boxOf(kJaw), friction), toolOf("right", boxOf(kJaw), friction)};
    }
    pipeline_ =
        std::make_unique<Pipeline>(tissue, solver, tools, std::vector<SupportConfig>{table});
  }

  void settle() { pipeline_->settle(); }
  void grasp() { pipeline_->grasp(0); }

  // `squeeze`: of each jaw (m).
  void go(const char* leg, int increments, double squeeze, double up) {
    const double squeeze_before = squeeze_, up_before = up_;
    for (int i = 1; i <= increments; ++i) {
      const double share = static_cast<double>(i) / increments;
      squeeze_ = squeeze_before + share * (squeeze - squeeze_before);
      up_ = up_before + share * (up - up_before);
      update(leg, i);
    }
  }

 private:
  void update(const char* leg, int increment) {
    const Vec3 middle(0.5 * kExtent.x(), 0.5 * kExtent.y(), 0.5 * kExtent.z() + up_);
    const Vec3 aside(0.5 * kExtent.x() + 0.5 * kJaw.x() - squeeze_, 0.0, 0.0);
    RobotPose pose;
    pose.links = {placedAt(middle - aside), placedAt(middle + aside)};
    const double begin = processorMs();
    const StepReport& report = pipeline_->step(pose);
    const double ms = processorMs() - begin;
    Vec3 on_tissue = Vec3::Zero();
    double penetration = 0.0, mean = 0.0;
    for (const ToolReport& tool : report.tools) {
      on_tissue -= tool.force_on_tool;
      penetration = std::max(penetration, tool.max_penetration);
    }
    const std::vector<Vec3>& displacement = pipeline_->tissue().state().displacement;
    for (const Vec3& way : displacement) mean += way.z() / static_cast<double>(displacement.size());
    const ForceBalance balance = pipeline_->forceBalance();
    std::printf("%s,%g,%g,%s,%d,%.5f,%.5f,%.5f,%.3f,%.5f,%.3f,%.4f,%.5f,%.1f,%s\n",
                grasps_ ? "grasp" : "friction", 1e3 * spacing_, friction_, leg, increment,
                on_tissue.x(), on_tissue.y(), on_tissue.z(),
                100.0 * (on_tissue - Vec3(0.0, 0.0, kWeight)).norm() / kWeight,
                balance.supports.z(), 1e3 * (up_ - mean), 1e3 * penetration,
                balance.unbalanced().norm(), ms, toString(pipeline_->tissue().lastReport().status));
    std::fflush(stdout);
  }

  bool grasps_;
  double friction_, spacing_;
  std::unique_ptr<Pipeline> pipeline_;
  double squeeze_ = -0.002, up_ = 0.0;
};

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const bool grasps = argc > 1 && std::string(argv[1]) == "grasp";
  const double friction = argument(argc, argv, 2, 0.5);
  const double spacing = 1e-3 * argument(argc, argv, 3, 5.0);
  Lift lift(grasps, friction, spacing,
            solverOf(argc > 4 ? argv[4] : "layered", argument(argc, argv, 5, 0.01)));
  std::printf(
      "way,spacing_mm,friction,leg,increment,fx,fy,fz,wrench_error_percent,table_n,sunk_mm,"
      "penetration_mm,unbalanced_n,ms,status\n");
  lift.settle();
  lift.go("appear", 1, -0.002, 0.0);
  lift.go("squeeze", 14, grasps ? 0.002 : 0.008, 0.0);
  if (grasps) lift.grasp();
  lift.go("lift", 30, grasps ? 0.002 : 0.008, 0.030);
  lift.go("hold", 10, grasps ? 0.002 : 0.008, 0.030);
  return 0;
}
