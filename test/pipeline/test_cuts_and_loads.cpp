// Tools on tissue that is cut and loaded meanwhile.
#include <gtest/gtest.h>

#include "pipeline_fixtures.h"

namespace robot_tissue::test_cuts_and_loads {
namespace {

std::vector<Vec3> uprightAt(double x) {
  return {Vec3(x, -0.01, 0.02), Vec3(x, 0.07, 0.02), Vec3(x, 0.07, 0.06), Vec3(x, -0.01, 0.06)};
}

TEST_P(PressedBlock, CutUnderLoadStaysAndTheToolStaysOut) {
  walk(pipeline_, -0.001, 0.004);
  const CutReport cut = pipeline_.cut(uprightAt(0.0275));
  EXPECT_GT(cut.springs_cut, 0);
  walk(pipeline_, 0.004, 0.005);
  EXPECT_LT(tool().max_penetration, 0.05 * kSpacing);
  EXPECT_GT(tool().force_on_tool.z(), 0.05);
  walk(pipeline_, 0.005, -0.001);
  EXPECT_EQ(pipeline_.tissue().state().springs_cut, cut.springs_cut);
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

TEST_P(PressedBlock, NamedLoadStandsBesideTheTool) {
  pipeline_.step(pressed(-0.001));
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, 0.01, kTop)};
  patch.displacement = {{0.0, 0.0, -0.002}};
  pipeline_.load({1, {patch}});
  walk(pipeline_, -0.001, 0.004);
  EXPECT_GT(tool().force_on_tool.z(), 0.1);
  walk(pipeline_, 0.004, -0.001);
  EXPECT_EQ(tool().force_on_tool, Vec3::Zero());
  const Lattice& lattice = pipeline_.tissue().lattice();
  const int corner = lattice.node(0, 0, lattice.size()[2] - 1);
  EXPECT_EQ(pipeline_.tissue().state().displacement[at(corner)], Vec3(0.0, 0.0, -0.002));
  pipeline_.release({"punch"});
  EXPECT_EQ(greatestDisplacement(pipeline_.tissue()), 0.0);
}

// The nodes that a cut adds are gone when it is taken back, and so is what a tool had on them, also
// where the tool stands there but pushes no more.
TEST(CutUnderATool, TakenBackLeavesNothingOnNodesThatAreGone) {
  for (const double left : {0.003, 0.00002, 0.0, -0.00002, -0.0002}) {
    Pipeline pipeline(block(), methodOf("elastic"), {probe()});
    walk(pipeline, -0.001, 0.003);
    ASSERT_GT(pipeline.cut(uprightAt(0.0275)).springs_cut, 0);
    walk(pipeline, 0.003, left);
    pipeline.undo(1);
    const Tissue& tissue = pipeline.tissue();
    const int nodes = static_cast<int>(tissue.state().displacement.size());
    EXPECT_EQ(nodes, tissue.lattice().nodeCount());
    for (const LoadingPatch& patch : tissue.patches()) {
      for (const int node : patch.nodes) EXPECT_LT(node, nodes) << left;
      for (const ContactSpring& spring : patch.contacts) {
        for (const NodeWeight& carrier : spring.carriers) EXPECT_LT(carrier.node, nodes) << left;
      }
    }
  }
}

// Nodes of both sides are in a patch, or in a grasper's hold: the mended tissue stays in it.
class HeldCut : public testing::TestWithParam<bool> {
 protected:
  // A rigid patch that is pressed, or jaws that close.
  static ToolGeometry tool() {
    ToolGeometry tool = probe();
    if (!GetParam()) {
      tool.patch = ToolConfig::Patch::kRigid;
      return tool;
    }
    const Vec3 jaw(0.02, 0.003, 0.02);
    tool.role = toolRole("grasper");
    tool.links = {{"left", {boxOf(jaw)}}, {"right", {boxOf(jaw)}}};
    tool.grasp.close_gap = 0.012;
    tool.grasp.open_gap = 0.02;
    return tool;
  }
  void hold() {
    if (!GetParam()) return walk(pipeline_, -0.001, 0.003);
    const Vec3 down(kMiddle, kMiddle, kTop), up(kMiddle, kMiddle, kTop + 0.03);
    const auto jaws = [](const Vec3& at, double half) -> std::vector<Vec3> {
      return {at - half * Vec3::UnitY(), at + half * Vec3::UnitY()};
    };
    walk(pipeline_, jaws(up, 0.014), jaws(down, 0.014));
    walk(pipeline_, jaws(down, 0.014), jaws(down, 0.006));
    ASSERT_TRUE(pipeline_.report().tools.front().grasps);
  }

  Pipeline pipeline_{block(), methodOf("elastic"), {tool()}};
};

TEST_P(HeldCut, TakenBackLeavesTheToolItsHold) {
  ASSERT_GT(pipeline_.cut(uprightAt(0.0275)).springs_cut, 0);
  hold();
  const double before = pipeline_.report().tools.front().force_on_tool.norm();
  EXPECT_GT(before, 0.01);
  pipeline_.undo(1);
  const Tissue& tissue = pipeline_.tissue();
  EXPECT_EQ(static_cast<int>(tissue.state().displacement.size()), tissue.lattice().nodeCount());
  for (const LoadingPatch& patch : tissue.patches()) {
    EXPECT_FALSE(patch.nodes.empty());
    for (const int node : patch.nodes) EXPECT_LT(node, tissue.lattice().nodeCount());
  }
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  EXPECT_EQ(pipeline_.report().tools.front().grasps, GetParam());
  const double after = pipeline_.report().tools.front().force_on_tool.norm();
  EXPECT_NEAR(after, before, 0.5 * before);
  // All forces on the tissue add up to none.
  EXPECT_LT(pipeline_.forceBalance().unbalanced().norm(), 0.05 * after);
}

// What is held is of the nodes that the cut made, too.
TEST_P(HeldCut, ARemovalElsewhereLeavesTheToolItsHold) {
  ASSERT_GT(pipeline_.cut(uprightAt(0.0275)).springs_cut, 0);
  hold();
  const double before = pipeline_.report().tools.front().force_on_tool.norm();
  pipeline_.remove(Sphere{Vec3(0.0, 0.0, kTop), 0.008});
  EXPECT_EQ(pipeline_.tissue().lastReport().status, SolveStatus::kOk);
  EXPECT_EQ(pipeline_.report().tools.front().grasps, GetParam());
  EXPECT_NEAR(pipeline_.report().tools.front().force_on_tool.norm(), before, 0.05 * before);
}

INSTANTIATE_TEST_SUITE_P(Grasped, HeldCut, testing::Bool());

TEST(LoadUnderATool, MayHaveItsName) {
  Pipeline pipeline(block(), methodOf("elastic"), {probe()});
  walk(pipeline, -0.001, 0.002);
  PatchConfig patch;
  patch.name = pipeline.tools().front().name;
  patch.box = {Vec3(0.0, 0.0, kTop), Vec3(0.01, 0.01, kTop)};
  patch.displacement = {{0.0, 0.0, -0.001}};
  pipeline.load({{}, {patch}});
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
  EXPECT_EQ(pipeline.tissue().namedPatches(), 1U);
  pipeline.release({patch.name});
  EXPECT_EQ(pipeline.tissue().namedPatches(), 0U);
  EXPECT_GT(pipeline.report().tools.front().contacts, 0);
}

// Removed nodes stand in a cavity as at rest: they are no tissue.
TEST(GraspInACavity, HoldsNothing) {
  ToolGeometry forceps = probe();
  const Vec3 jaw(0.006, 0.002, 0.006);
  forceps.role = toolRole("grasper");
  forceps.links = {{"left", {boxOf(jaw)}}, {"right", {boxOf(jaw)}}};
  forceps.grasp.close_gap = 0.012;
  forceps.grasp.open_gap = 0.014;
  Pipeline pipeline(block(), methodOf("elastic"), {forceps});
  const double deep = 0.03, half = 0.02;  // m
  pipeline.remove(PlacedBox{Box(Vec3(kMiddle - half, kMiddle - half, kTop - deep),
                                Vec3(kMiddle + half, kMiddle + half, kTop + deep))});
  const auto jaws = [](const Vec3& at, double apart) -> std::vector<Vec3> {
    return {at - apart * Vec3::UnitY(), at + apart * Vec3::UnitY()};
  };
  const Vec3 up(kMiddle, kMiddle, kTop + 0.03), down(kMiddle, kMiddle, kTop - 0.5 * deep);
  walk(pipeline, jaws(up, 0.006), jaws(down, 0.006));
  EXPECT_THROW(pipeline.grasp(0), InputError);
  EXPECT_FALSE(pipeline.report().tools.front().grasps);
  EXPECT_EQ(pipeline.report().tools.front().contacts, 0);
}

// A patch beside a standing tool goes down: the tissue comes away from the tool or into it.
TEST(LoadUnderATool, IsMetByTheToolAtEachIncrement) {
  Pipeline pipeline(block(), methodOf("elastic"), {probe()});
  walk(pipeline, -0.001, 0.002);
  PatchConfig patch;
  patch.name = "lift";
  patch.box = {Vec3(0.0, 0.0, kTop), Vec3(0.015, kWidth, kTop)};
  patch.displacement = {{0.0, 0.0, 0.006}};
  const double before = pipeline.report().tools.front().force_on_tool.z();
  double last = before;
  int increments = 0;
  pipeline.load({4, {patch}}, [&](int, int, const SolveReport&) {
    const ToolReport& tool = pipeline.report().tools.front();
    EXPECT_LT(tool.max_penetration, 0.05 * kSpacing);
    EXPECT_GT(tool.force_on_tool.z(), last);
    last = tool.force_on_tool.z();
    ++increments;
  });
  EXPECT_EQ(increments, 4);
  EXPECT_LT(pipeline.forceBalance().unbalanced().norm(), 0.06 * last);
  pipeline.release({"lift"});
  EXPECT_LT(pipeline.report().tools.front().force_on_tool.z(), last);
}

// The probe presses on both edges of the cut, nodes and ghosts.
TEST(PressedElasticBlock, CutOpensUnderTheToolAndClosesAgain) {
  for (const auto patch : {ToolConfig::Patch::kConforming, ToolConfig::Patch::kRigid}) {
    SolverConfig solver;
    solver.method = "newton";
    ToolGeometry sphere = probe();
    sphere.patch = patch;
    const TissueConfig tissue = block("elastic", 0.01);
    Pipeline pipeline(tissue, solver, {sphere});
    walk(pipeline, -0.001, 0.002, 0.001);
    const double whole = pipeline.report().tools.front().force_on_tool.z();
    EXPECT_GT(pipeline.cut(uprightAt(0.0345)).springs_cut, 0);
    walk(pipeline, 0.002, 0.006, 0.001);
    const ToolReport& tool = pipeline.report().tools.front();
    EXPECT_LT(tool.max_penetration, 0.05 * tissue.spacing);
    EXPECT_GT(tool.force_on_tool.z(), whole);
    const CellSet& cells = *pipeline.tissue().state().cells;
    EXPECT_TRUE(std::any_of(tool.nodes.begin(), tool.nodes.end(),
                            [&](int node) { return cells.isGhost(node); }));
    EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
    walk(pipeline, 0.006, -0.001, 0.001);
    EXPECT_LT(greatestDisplacement(pipeline.tissue()), 1e-12);
  }
}

// Two springs at a corner of the block. A first cut there ends what the tool's last solve left.
TEST(CutBesideATool, LeavesItsForceAsItWas) {
  for (const double friction : {0.0, 0.3}) {
    SolverConfig solver = methodOf("elastic");
    solver.tolerance = 1e-3;
    Pipeline pipeline(block(), solver, {withFriction(friction, probe())});
    walk(pipeline, -0.001, 0.004);
    Vec3 before = Vec3::Zero();
    for (const double low : {0.0375, 0.0275}) {
      before = pipeline.report().tools.front().force_on_tool;
      const double high = low + 0.01;
      const CutReport cut = pipeline.cut({Vec3(0.0025, -1, low), Vec3(0.0025, 0.0075, low),
                                          Vec3(0.0025, 0.0075, high), Vec3(0.0025, -1, high)});
      EXPECT_GE(cut.springs_cut, 2);
      EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
    }
    const Vec3 change = pipeline.report().tools.front().force_on_tool - before;
    EXPECT_LT(change.norm(), 2e-3 * before.norm()) << friction;
  }
}

constexpr double kGap = 0.0002;  // m

// A force upwards on the patch in the box, with the tool above the block by the gap.
void liftBelowTheTool(Pipeline& pipeline, const Box& box, double force) {
  walk(pipeline, -0.001, -kGap);
  PatchConfig patch;
  patch.name = "lift";
  patch.box = box;
  patch.force = Vec3(0.0, 0.0, force);
  pipeline.load({1, {patch}});
}

// A tool in the way of the tissue beside what a force drives: solves are taken back in part, and
// the patch is told where its nodes are.
TEST(ForcedPatch, IsWhereItsNodesAreBesideATool) {
  for (const double force : {1.0, 2.0, 3.0}) {
    Pipeline pipeline(block(), methodOf("elastic"), {probe()});
    liftBelowTheTool(pipeline, {Vec3(0.0, 0.0, kTop), Vec3(0.02, 0.06, kTop)}, force);
    const Tissue& tissue = pipeline.tissue();
    EXPECT_GT(pipeline.report().tools.front().force_on_tool.norm(), 0.01) << force;
    const LoadingPatch& lift = tissue.patches().front();
    const Vec3 told = tissue.answerOf("lift", tissue.lastReport()).displacement;
    EXPECT_GT(told.z(), 0.0005);
    for (const int node : hardNodes(lift)) {
      EXPECT_LT((tissue.state().displacement[at(node)] - told).norm(), 1e-9) << force;
    }
    for (const RimSpring& spring : lift.rim) {
      EXPECT_LT((spring.anchor - told).norm(), 1e-9) << force;
    }
  }
}

// A patch that is driven against a ball gives way as a piece, not as a node under a ball.
TEST(ForcedPatch, IsHeldUpByABallAboveIt) {
  for (const double force : {0.2, 0.5}) {
    Pipeline pipeline(block(), methodOf("elastic"), {probe()});
    liftBelowTheTool(pipeline, {Vec3(0.02, 0.02, kTop), Vec3(0.04, 0.04, kTop)}, force);
    const Tissue& tissue = pipeline.tissue();
    const PatchAnswer answer = tissue.answerOf("lift", tissue.lastReport());
    EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
    EXPECT_NEAR(answer.displacement.z(), kGap, 0.05 * kSpacing);
    const double borne = pipeline.report().tools.front().force_on_tool.z();
    EXPECT_GT(borne, 0.5 * force);
    EXPECT_LT(borne, 1.05 * force);
  }
}

TEST(ForceBalance, OfTissueThatIsResetIsNone) {
  TissueConfig large = block();
  large.shape = {Vec3::Zero(), Vec3(0.2, 0.2, 0.1)};
  Pipeline pipeline(large, methodOf("elastic"), {});
  PatchConfig patch;
  patch.name = "punch";
  patch.box = {Vec3(0.09, 0.09, 0.1), Vec3(0.11, 0.11, 0.1)};
  patch.displacement = {{0.0, 0.0, -0.004}};
  pipeline.load({1, {patch}});
  EXPECT_GT(pipeline.forceBalance().fixed.norm(), 0.01);
  pipeline.reset();
  EXPECT_EQ(pipeline.forceBalance().fixed.norm(), 0.0);
}

}  // namespace
}  // namespace robot_tissue::test_cuts_and_loads
