// Scissors: what their edges cut where they have passed each other.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_scissors {
namespace {

constexpr double kLength = 0.03;   // of the edges (m)
constexpr double kSlant = 0.002;   // m: so much the edges overlap at the hinge when parallel
constexpr double kPlane = 0.0325;  // y of the edges, between nodes (m)
const Vec3 kHinge(-0.001, kPlane, 0.0213);

// The edges go away from each other by a slant, so that they meet from the hinge on.
ToolGeometry scissors() {
  ToolGeometry tool;
  tool.name = "scissors";
  tool.role = toolRole("scissors");
  tool.links = {{"", {}}, {"upper", {}}, {"lower", {}}};
  const Vec3 near(0.0, 0.0, kSlant), far(kLength, 0.0, kSlant);
  tool.scissors.edges = {std::vector<Vec3>{Vec3(-near), far},
                         std::vector<Vec3>{near, Vec3(far.x(), 0.0, -far.z())}};
  return tool;
}

// Half the angle to either side of the x axis (rad); below 0 they have passed.
RobotPose open(double half, const Vec3& hinge = kHinge) {
  RobotPose pose = at({hinge, hinge, hinge});
  pose.links[1].linear() = Eigen::AngleAxisd(-half, Vec3::UnitY()).toRotationMatrix();
  pose.links[2].linear() = Eigen::AngleAxisd(half, Vec3::UnitY()).toRotationMatrix();
  return pose;
}

void shut(Pipeline& pipeline, double from, double to, int updates) {
  for (int i = 0; i <= updates; ++i) pipeline.step(open(from + (to - from) * i / updates));
}

int severed(const Pipeline& pipeline) { return pipeline.tissue().state().springs_cut; }

// Between the edges as they were open, up to a length from the hinge, with that margin (m).
bool isBetween(const Vec3& place, double half, double length, double margin) {
  const double along = place.x() - kHinge.x(), up = std::abs(place.z() - kHinge.z());
  const double edge = along * std::tan(half) - kSlant + 2.0 * kSlant * along / kLength;
  return std::hypot(along, up) < length + margin && up < edge + margin;
}

TEST(Scissors, CutWhatIsBetweenTheirEdges) {
  constexpr double kHalf = 0.5;
  Pipeline pipeline(block(), methodOf("elastic"), {scissors()});
  shut(pipeline, kHalf, -0.2, 1);
  const Tissue& tissue = pipeline.tissue();
  int between = 0;
  for (std::size_t spring = 0; spring < tissue.lattice().springs().size(); ++spring) {
    const Spring& ends = tissue.lattice().springs()[spring];
    const Vec3 a = tissue.lattice().restPosition(ends.a), b = tissue.lattice().restPosition(ends.b);
    const bool crosses = (a.y() - kPlane) * (b.y() - kPlane) < 0.0;
    const Vec3 place = 0.5 * (a + b);
    const bool is_severed = tissue.state().severed[spring] != 0;
    if (!crosses || !isBetween(place, kHalf, kLength, 0.001)) {
      EXPECT_FALSE(is_severed) << place.transpose();
    } else if (isBetween(place, kHalf, kLength, -0.002)) {
      EXPECT_TRUE(is_severed) << place.transpose();
      ++between;
    }
  }
  EXPECT_GT(between, 10);
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
  EXPECT_EQ(tissue.undoable(), 1);
}

// Parallel, the half of the edges at the hinge has passed.
TEST(Scissors, CutOnlyAsFarAsTheyHavePassed) {
  Pipeline pipeline(block(), methodOf("elastic"), {scissors()});
  shut(pipeline, 0.5, 0.0, 20);
  const Tissue& tissue = pipeline.tissue();
  EXPECT_GT(severed(pipeline), 2);
  for (std::size_t spring = 0; spring < tissue.lattice().springs().size(); ++spring) {
    if (tissue.state().severed[spring] == 0) continue;
    const Spring& ends = tissue.lattice().springs()[spring];
    const Vec3 place =
        0.5 * (tissue.lattice().restPosition(ends.a) + tissue.lattice().restPosition(ends.b));
    EXPECT_LT(place.x() - kHinge.x(), 0.5 * kLength + 0.0015);
  }
  const int half = severed(pipeline);
  shut(pipeline, 0.0, -0.2, 20);
  EXPECT_GT(severed(pipeline), 2 * half);
  EXPECT_EQ(tissue.undoable(), 1);  // one closing, one change
  pipeline.undo(1);
  EXPECT_EQ(severed(pipeline), 0);
}

TEST(Scissors, SameSpringsInOneTenAndAHundredUpdates) {
  TissueConfig hanging = block();
  hanging.gravity = Vec3(0.0, 0.0, 9.81);
  std::vector<std::vector<std::uint8_t>> all;
  for (const int updates : {1, 10, 100}) {
    Pipeline pipeline(hanging, methodOf("elastic"), {scissors()});
    pipeline.settle();
    shut(pipeline, 0.5, -0.2, updates);
    all.push_back(pipeline.tissue().state().severed);
  }
  EXPECT_GT(std::count(all[0].begin(), all[0].end(), 1), 10);
  EXPECT_EQ(all[1], all[0]);
  EXPECT_EQ(all[2], all[0]);
}

TEST(Scissors, CutNothingWhereTheyOpenOrGoWithoutClosing) {
  Pipeline pipeline(block(), methodOf("elastic"), {scissors()});
  pipeline.step(open(-0.2));
  shut(pipeline, -0.2, 0.5, 30);
  EXPECT_EQ(severed(pipeline), 0);
  for (int i = 0; i <= 20; ++i) pipeline.step(open(0.5, kHinge + Vec3(0.001 * i, 0.0, 0.0)));
  EXPECT_EQ(severed(pipeline), 0);
  // What they cut is where they close.
  for (int i = 0; i <= 20; ++i) {
    pipeline.step(open(0.5 - 0.035 * i, kHinge + Vec3(0.02, 0.0, 0.0)));
  }
  EXPECT_GT(severed(pipeline), 10);
  const int once = severed(pipeline);
  for (int i = 0; i <= 20; ++i) {  // closed they are no blade
    pipeline.step(open(-0.2, kHinge + Vec3(0.02, 0.0, 0.001 * i)));
  }
  EXPECT_EQ(severed(pipeline), once);
}

TEST(Scissors, WithoutTimeTheyCutLater) {
  Pipeline at_once(block(), methodOf("elastic"), {scissors()});
  shut(at_once, 0.5, -0.2, 1);
  Pipeline pipeline(block(), methodOf("elastic"), {scissors()});
  pipeline.setBudget(1e-9);
  pipeline.step(open(0.5));
  pipeline.step(open(-0.2));
  EXPECT_TRUE(pipeline.report().too_fast);
  for (int update = 0; update < 1000 && !pipeline.hasArrived(); ++update) {
    pipeline.step(open(-0.2));
  }
  EXPECT_TRUE(pipeline.hasArrived());
  EXPECT_EQ(pipeline.tissue().state().severed, at_once.tissue().state().severed);
}

TEST(Scissors, ATrialCutsNothing) {
  Pipeline pipeline(block(), methodOf("elastic"), {scissors()});
  pipeline.step(open(0.5));
  pipeline.beginTrial();
  pipeline.step(open(-0.2));
  pipeline.undoTrial();
  EXPECT_EQ(severed(pipeline), 0);
  pipeline.step(open(-0.2));
  EXPECT_GT(severed(pipeline), 10);
}

}  // namespace
}  // namespace robot_tissue::test_scissors
