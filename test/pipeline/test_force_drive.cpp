#include <array>

#include "force_drive.h"
#include "pipeline_fixtures.h"

namespace robot_tissue::test_force_drive {
namespace {

constexpr double kLoadStep = 1e-3;  // m
constexpr double kWanted = 0.5;     // N

// A tool that is pushed along z against a force that is a function of its way.
class DrivenTool {
 public:
  template <typename ForceAt>
  explicit DrivenTool(ForceAt force_at) {
    drive_.setTools(1);
    drive_.push(0, Vec3(0.0, 0.0, kWanted));
    way_ = {kLoadStep, [this, force_at] { return Vec3(0.0, 0.0, force_at(gone())); },
            [this] {
              ++walks_;
              return true;
            },
            [] { return false; }};
  }

  // Calls until none is asked for any more.
  int follow() {
    int calls = 1;
    while (drive_.meetForce(0, way_) && calls < 100) ++calls;
    return calls;
  }
  double gone() const { return drive_.offset(0).z(); }  // m
  double met() const { return way_.met().z(); }         // N
  int walks() const { return walks_; }

 private:
  ForceDrive drive_;
  ForceDrive::Way way_;
  int walks_ = 0;
};

TEST(ForceDrive, SoftTissueIsFollowedUntilTheForceIsMet) {
  DrivenTool tool([](double way) { return std::max(0.0, way - 0.01) * kWanted / 0.1; });
  EXPECT_LT(tool.follow(), 20);
  EXPECT_NEAR(tool.met(), kWanted, 0.01 * kWanted);
  EXPECT_NEAR(tool.gone(), 0.11, 0.002);
}

TEST(ForceDrive, StiffTissueIsMetToo) {
  DrivenTool tool([](double way) { return std::max(0.0, way - 0.0101) * 1e5; });
  tool.follow();
  EXPECT_NEAR(tool.met(), kWanted, 0.01 * kWanted);
}

TEST(ForceDrive, AForceThatTissueLeapsPastIsLookedForNoFurther) {
  DrivenTool tool([](double way) { return way < 0.0101 ? 0.0 : 100.0 * kWanted; });
  EXPECT_LT(tool.follow(), 10);
  EXPECT_NEAR(tool.gone(), 0.0101, 0.1 * kLoadStep) << "where it leaps";
  EXPECT_LT(tool.walks(), 60);
}

ToolGeometry probe() {
  ToolGeometry tool;
  tool.name = "probe";
  tool.links = {{"probe", {}}};
  return tool;
}

// A tool of one link that is told to be at the origin and comes to so much of a way along z (m).
class HaltedTool {
 public:
  explicit HaltedTool(double came) : tools_({probe()}, {}) {
    drive_.setTools(1);
    drive_.push(0, Vec3(0.0, 0.0, kWanted));
    drive_.meetForce(0, {kLoadStep, [] { return Vec3(Vec3::Zero()); }, [] { return false; },
                         [] { return true; }});
    RobotPose told, reached;
    told.links = {Pose::Identity()};
    reached.links = {Pose(Eigen::Translation3d(0.0, 0.0, came))};
    drive_.noteReached(told, reached, tools_);
  }
  ForceDrive& drive() { return drive_; }

 private:
  ToolSet tools_;
  ForceDrive drive_;
};

TEST(ForceDrive, AnotherForceGoesOnFromWhereTheToolCame) {
  const double came = 0.3 * kLoadStep;
  HaltedTool tool(came);
  ForceDrive& drive = tool.drive();
  EXPECT_NEAR(drive.offset(0).z(), kLoadStep, 1e-15);
  EXPECT_NEAR(drive.came(0).z(), came, 1e-15);
  drive.push(0, Vec3(0.0, 0.0, kWanted));
  EXPECT_NEAR(drive.offset(0).z(), kLoadStep, 1e-15) << "the same: it is on its way";
  drive.push(0, Vec3(0.0, 0.0, 0.5 * kWanted));
  EXPECT_NEAR(drive.offset(0).z(), came, 1e-15);
}

TEST(ForceDrive, ToolThatNoShapeFollowsStaysWhereItCame) {
  HaltedTool tool(0.3 * kLoadStep);
  tool.drive().stay();
  EXPECT_NEAR(tool.drive().offset(0).z(), 0.3 * kLoadStep, 1e-15);
}

// What the second pushes changes the shape under the first, whose force was met.
TEST(PushedPair, BothMeetTheirForcesInAnyOrder) {
  const std::array<double, 2> forces = {0.3, 0.5};  // N
  for (const std::size_t first : {0u, 1u}) {
    TissueConfig tissue = block("elastic", 0.01);
    ToolShape ball;
    ball.radius = 0.012;
    Pipeline pipeline(tissue, SolverConfig(), {toolOf(ball, "p"), toolOf(ball, "q")});
    const double z = kTop + ball.radius;
    const RobotPose pose = at({Vec3(kMiddle - 0.01, kMiddle, z), Vec3(kMiddle + 0.01, kMiddle, z)});
    pipeline.step(pose);
    for (const std::size_t tool : {first, 1 - first}) {
      pipeline.push(tool, Vec3(0.0, 0.0, -forces[tool]));
      for (int update = 0; update < 30; ++update) pipeline.step(pose);
    }
    for (const std::size_t tool : {0u, 1u}) {
      const double met = pipeline.report().tools[tool].force_on_tool.z();
      EXPECT_NEAR(met, forces[tool], 0.01 * forces[tool]) << first << ", " << tool;
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_force_drive
