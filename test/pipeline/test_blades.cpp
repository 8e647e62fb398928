// Tools with an edge: what they cut on their way, and the force of it.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_blades {
namespace {

constexpr double kResistance = 200.0;  // J/m^2

// An upright edge from `down` below its origin to above the block.
ToolGeometry knife(double down, double resistance = kResistance) {
  ToolGeometry tool;
  tool.name = "knife";
  tool.role = toolRole("blade");
  tool.links.push_back({"knife", {}});
  tool.blade.edge = {Vec3(0.0, 0.0, -down), Vec3(0.0, 0.0, 0.02)};
  tool.blade.resistance = resistance;
  return tool;
}

// Across the block between two slices of nodes, at its top.
Vec3 cutAt(double x, double y = 0.0325) { return {x, y, kTop}; }

const Vec3 kBefore = cutAt(-0.012);
const Vec3 kBeyond = cutAt(0.072);

struct Way {
  std::vector<std::uint8_t> severed;
  int pieces = 0;
  double area = 0.0;  // m^2
  double work = 0.0;  // of the hand that leads the tool (J)
};

// In so many updates, from where it comes in.
Way cutAlong(Pipeline& pipeline, const std::vector<RobotPose>& poses) {
  Way way;
  Vec3 last = poses.front().links.front().translation();
  for (const RobotPose& pose : poses) {
    const StepReport& report = pipeline.step(pose);
    const Vec3 here = pose.links.front().translation();
    const Vec3 force = pose.links.front().linear() * report.tools.front().force_on_tool;
    way.work -= force.dot(here - last);
    way.area += report.area_cut;
    last = here;
  }
  way.severed = pipeline.tissue().state().severed;
  way.pieces = pipeline.tissue().state().pieces;
  return way;
}

std::vector<RobotPose> straight(const Vec3& from, const Vec3& to, int updates) {
  std::vector<RobotPose> poses;
  for (int i = 0; i <= updates; ++i) poses.push_back(at({from + (to - from) * i / updates}));
  return poses;
}

TEST(Blade, PartsABlockAndNoForcePasses) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05), probe()});
  const auto both = [](const Vec3& knife_at, const Vec3& probe_at) {
    return at({knife_at, probe_at});
  };
  const Vec3 aside(0.03, 0.2, 0.2);
  pipeline.step(both(kBefore, aside));
  pipeline.step(both(kBeyond, aside));
  EXPECT_EQ(pipeline.tissue().state().pieces, 2);
  EXPECT_EQ(pipeline.report().tools.front().force_on_tool, Vec3::Zero());
  // Pressed on one side, the other stays where it is.
  for (double depth = 0.0; depth <= 0.003; depth += 0.0005) {
    pipeline.step(both(kBeyond, Vec3(0.03, 0.05, kTop + kRadius - depth)));
  }
  EXPECT_GT(pipeline.report().tools.back().force_on_tool.z(), 0.05);
  const Tissue& tissue = pipeline.tissue();
  const double greatest = greatestDisplacement(tissue);
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (tissue.lattice().restPosition(node).y() > 0.0325) continue;
    EXPECT_LT(tissue.state().displacement[at(node)].norm(), 1e-6 * greatest);
  }
}

// Along an axis, aslant, and with the edge lying: layers of springs are a spacing apart.
TEST(Blade, AStrokeIsTakenBackAsOneCut) {
  const Vec3 aslant(0.03, 0.06, 0.0), along(kBeyond - kBefore);
  for (const Vec3& way : {along, Vec3(along + aslant), Vec3(0.7 * along - aslant)}) {
    for (const int updates : {10, 100}) {
      Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
      cutAlong(pipeline, straight(kBefore, kBefore + way, updates));
      EXPECT_GT(pipeline.tissue().state().springs_cut, 20);
      EXPECT_EQ(pipeline.tissue().undoable(), 1) << way.transpose() << " in " << updates;
      pipeline.undo(1);
      EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
    }
  }
}

// What it does after it went on through the air is another one.
TEST(Blade, AStrokeEndsWhereNothingIsCut) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.01)});
  const Vec3 first(0.012, 0.0, 0.0), second(0.03, 0.0, 0.0), up(0.0, 0.0, 0.03);
  std::vector<RobotPose> poses = straight(kBefore, kBefore + 2.0 * first, 20);
  for (const auto& leg : {straight(kBefore + 2.0 * first, kBefore + 2.0 * first + up, 20),
                          straight(kBefore + 2.0 * first + up, kBefore + second + first + up, 20),
                          straight(kBefore + second + first + up, kBefore + second + first, 20),
                          straight(kBefore + second + first, kBefore + second + 3.0 * first, 20)}) {
    poses.insert(poses.end(), leg.begin(), leg.end());
  }
  cutAlong(pipeline, poses);
  EXPECT_EQ(pipeline.tissue().undoable(), 2);
}

TEST(Blade, SameSpringsInOneTenAndAHundredUpdates) {
  for (const Vec3& to : {kBeyond, cutAt(0.041, 0.0467)}) {
    std::vector<Way> ways;
    for (const int updates : {1, 10, 100}) {
      Pipeline pipeline(block(), methodOf("elastic"), {knife(0.0225)});
      ways.push_back(cutAlong(pipeline, straight(kBefore, to, updates)));
    }
    EXPECT_GT(std::count(ways[0].severed.begin(), ways[0].severed.end(), 1), 20);
    EXPECT_EQ(ways[1].severed, ways[0].severed);
    EXPECT_EQ(ways[2].severed, ways[0].severed);
    EXPECT_NEAR(ways[1].area, ways[0].area, 1e-12);
  }
}

// Hung up at its bottom and pressed beside the cut, the tissue gives way as it is cut.
TEST(Blade, SameSpringsInTissueThatGivesWay) {
  TissueConfig hanging = block();
  hanging.gravity = Vec3(0.0, 0.0, 9.81);
  std::vector<std::vector<std::uint8_t>> severed;
  for (const int updates : {1, 7, 100}) {
    Pipeline pipeline(hanging, methodOf("elastic"), {knife(0.0225)});
    pipeline.settle();
    severed.push_back(cutAlong(pipeline, straight(kBefore, kBeyond, updates)).severed);
  }
  EXPECT_EQ(severed[1], severed[0]);
  EXPECT_EQ(severed[2], severed[0]);
}

// A pose every 10 ms, of tissue without and with time.
TEST(Blade, SameSpringsAtAnySpeed) {
  for (const bool has_time : {false, true}) {
    TissueConfig tissue = block();
    if (has_time) tissue.time = TimeConfig{0.02};
    std::vector<std::vector<std::uint8_t>> severed;
    for (const double speed : {0.01, 0.1, 1.0}) {
      Pipeline pipeline(tissue, methodOf("elastic"), {knife(0.0225)});
      const double seconds = (kBeyond - kBefore).norm() / speed;
      std::vector<RobotPose> way =
          straight(kBefore, kBeyond, static_cast<int>(std::ceil(100.0 * seconds)));
      for (std::size_t i = 0; i < way.size(); ++i) way[i].stamp_s = 0.01 * static_cast<double>(i);
      severed.push_back(cutAlong(pipeline, way).severed);
    }
    EXPECT_GT(std::count(severed[0].begin(), severed[0].end(), 1), 20);
    EXPECT_EQ(severed[1], severed[0]);
    EXPECT_EQ(severed[2], severed[0]);
  }
}

TEST(Blade, WorkIsResistanceTimesNewSurface) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  const Way way = cutAlong(pipeline, straight(kBefore, kBeyond, 336));
  EXPECT_NEAR(way.area, kWidth * kTop, 1e-9);
  EXPECT_NEAR(way.work, kResistance * way.area, 0.01 * kResistance * way.area);
}

// In its even way the force is resistance times the length of the edge in the tissue.
TEST(Blade, ForceIsResistanceTimesItsLength) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  pipeline.step(at({kBefore}));
  pipeline.step(at({cutAt(0.031)}));
  const ToolReport& tool = pipeline.report().tools.front();
  EXPECT_NEAR(tool.force_on_tool.x(), -kResistance * kTop, 1e-9);
  EXPECT_NEAR(tool.force_on_tool.y(), 0.0, 1e-12);
  // At the middle of the edge in the tissue, below the origin.
  EXPECT_NEAR(tool.torque_on_tool.y(), 0.5 * kTop * kResistance * kTop, 1e-9);
}

TEST(Blade, InTheAirItCostsNothing) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(-0.001)});
  const Way way = cutAlong(pipeline, straight(kBefore, kBeyond, 50));
  EXPECT_EQ(way.pieces, 1);
  EXPECT_EQ(way.work, 0.0);
  EXPECT_EQ(way.area, 0.0);
  EXPECT_FALSE(pipeline.report().changed);
}

TEST(Blade, AlongItsEdgeItCutsNothing) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.005)});
  pipeline.step(at({cutAt(0.0313, 0.0327) + Vec3(0.0, 0.0, 0.01)}));
  pipeline.step(at({cutAt(0.0313, 0.0327) - Vec3(0.0, 0.0, 0.01)}));
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
}

// Turned about an upright axis beside it, the edge cuts along an arc.
TEST(Blade, FollowsAnArc) {
  ToolGeometry tool = knife(0.05);
  for (Vec3& point : tool.blade.edge) point.x() = 0.03;
  std::vector<std::vector<std::uint8_t>> severed;
  for (const int updates : {2, 40}) {
    Pipeline pipeline(block(), methodOf("elastic"), {tool});
    for (int i = 0; i <= updates; ++i) {
      RobotPose pose = at({cutAt(0.03, 0.0)});
      pose.links.front().linear() =
          Eigen::AngleAxisd(-0.1 + (M_PI + 0.2) * i / updates, Vec3::UnitZ()).toRotationMatrix();
      pipeline.step(pose);
    }
    EXPECT_EQ(pipeline.tissue().state().pieces, 2);
    severed.push_back(pipeline.tissue().state().severed);
    const Tissue& tissue = pipeline.tissue();
    const std::vector<int> pieces = tissue.pieceOfNodes();
    for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
      const Vec3 rest = tissue.lattice().restPosition(node);
      const double radius = std::hypot(rest.x() - 0.03, rest.y());
      if (std::abs(radius - 0.03) < 1e-4) continue;
      const int outer = pieces[at(tissue.lattice().node(0, 12, 0))];
      EXPECT_EQ(pieces[at(node)] == outer, radius > 0.03) << rest.transpose();
    }
  }
  EXPECT_EQ(severed[1], severed[0]);
}

TEST(Blade, ComesInWithoutACutAndForgetsItsWayWhenItLeaves) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  pipeline.step(at({cutAt(0.03)}));  // appears in the tissue
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  RobotPose away;
  away.links.push_back(Pipeline::away());
  pipeline.step(away);
  pipeline.step(at({kBeyond}));
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  pipeline.step(at({cutAt(0.03)}));
  EXPECT_GT(pipeline.tissue().state().springs_cut, 0);
  pipeline.reset();
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
}

TEST(Blade, ATrialCutsNothing) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  pipeline.step(at({kBefore}));
  pipeline.beginTrial();
  pipeline.step(at({cutAt(0.03)}));
  pipeline.undoTrial();
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  pipeline.step(at({kBeyond}));
  EXPECT_EQ(pipeline.tissue().state().pieces, 2);
}

// Out of time it stops on its way, and the next updates bring it there.
TEST(Blade, WithoutTimeItComesLater) {
  Pipeline at_once(block(), methodOf("elastic"), {knife(0.05)});
  const Way whole = cutAlong(at_once, straight(kBefore, kBeyond, 1));
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  pipeline.setBudget(1e-9);
  pipeline.step(at({kBefore}));
  pipeline.step(at({kBeyond}));
  EXPECT_TRUE(pipeline.report().too_fast);
  EXPECT_EQ(pipeline.report().behind, std::vector<std::size_t>{0});
  int updates = 0;
  for (; updates < 1000 && !pipeline.hasArrived(); ++updates) pipeline.step(at({kBeyond}));
  EXPECT_TRUE(pipeline.hasArrived());
  EXPECT_GT(updates, 2);
  EXPECT_EQ(pipeline.tissue().state().severed, whole.severed);
}

TEST(Blade, CutsBesideToolsWithRigidPatchesAndOtherModels) {
  for (const std::string model : {"elastic", "six_spring"}) {
    ToolGeometry presses = probe();
    presses.patch = ToolConfig::Patch::kRigid;
    Pipeline pipeline(block(model), methodOf(model), {knife(0.0225), presses});
    const Vec3 pressing(kMiddle, 0.015, kTop + kRadius - 0.002);
    pipeline.step(at({kBefore, pressing + Vec3(0.0, 0.0, 0.003)}));
    pipeline.step(at({kBefore, pressing}));
    for (int i = 1; i <= 4; ++i) {
      pipeline.step(at({kBefore + (kBeyond - kBefore) * i / 4.0, pressing}));
    }
    EXPECT_EQ(pipeline.tissue().state().springs_cut, 13 * 5);
    EXPECT_GT(pipeline.report().tools.back().force_on_tool.z(), 0.0);
  }
}

TEST(Blade, NoForceDrivesIt) {
  Pipeline pipeline(block(), methodOf("elastic"), {knife(0.05)});
  pipeline.step(at({kBefore}));
  EXPECT_THROW(pipeline.push(0, Vec3(1.0, 0.0, 0.0)), InputError);
}

}  // namespace
}  // namespace robot_tissue::test_blades
