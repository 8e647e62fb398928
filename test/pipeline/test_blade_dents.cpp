// Blades that touch before they cut, and whose sides push.
#include <gtest/gtest.h>

#include <limits>

#include "material/elastic_model.h"
#include "pipeline_fixtures.h"
#include "swept_surface.h"

namespace robot_tissue::test_blade_dents {
namespace {

constexpr double kResistance = 200.0;  // J/m^2
constexpr double kLength = 0.028;      // of the edge (m)

// Its edge lies 28 mm long across the block, along y, at its origin; looking down.
ToolGeometry lyingKnife(double resistance = kResistance) {
  ToolGeometry tool;
  tool.name = "knife";
  tool.role = toolRole("blade");
  tool.links.push_back({"knife", {}});
  tool.blade.edge = {Vec3(0.0, -0.014, 0.0), Vec3(0.0, 0.014, 0.0)};
  tool.blade.resistance = resistance;
  return tool;
}

// With flat sides 0.8 mm apart, from its edge upwards.
ToolGeometry flatKnife(double resistance = kResistance) {
  ToolGeometry tool = lyingKnife(resistance);
  tool.links.front().shapes = {boxOf(Vec3(0.0008, 0.028, 0.02), Vec3(0.0, 0.0, 0.01))};
  return tool;
}

Vec3 over(double height, double x = 0.0313) { return {x, 0.03, kTop + height}; }

struct Led {
  double work = 0.0;  // of the hand that leads it (J)
  double area = 0.0;  // cut (m^2)
};

// In so many updates.
Led lead(Pipeline& pipeline, const Vec3& from, const Vec3& to, int updates) {
  Led led;
  Vec3 before = Vec3::Zero();
  for (int i = 0; i <= updates; ++i) {
    const StepReport& report = pipeline.step(at({from + (to - from) * i / updates}));
    const Vec3& force = report.tools.front().force_on_tool;
    if (i > 0) led.work -= 0.5 * (before + force).dot((to - from) / updates);
    led.area += report.area_cut;
    before = force;
  }
  return led;
}

// Of the block, whatever was cut of it (J).
double storedEnergy(const Tissue& tissue) {
  return ElasticModel(tissue.lattice(), block()).energy(tissue.state());
}

TEST(BladeDents, ATouchDentsAndComesBack) {
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.0, lyingKnife())});
  const Led in = lead(pipeline, over(0.002), over(-0.003), 50);
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  EXPECT_GT(greatestDisplacement(pipeline.tissue()), 0.0025);
  const ToolReport& knife = pipeline.report().tools.front();
  EXPECT_GT(knife.force_on_tool.z(), 0.5);
  EXPECT_LT(knife.max_penetration, 0.1 * kSpacing);
  EXPECT_NEAR(in.work, storedEnergy(pipeline.tissue()), 0.05 * in.work);
  const Led out = lead(pipeline, over(-0.003), over(0.002), 50);
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  EXPECT_NEAR(in.work + out.work, 0.0, 0.05 * in.work);  // stored, and given back
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
}

TEST(BladeDents, GoesInAtItsResistanceOrOneSpacingDeep) {
  for (const double resistance : {10.0, 20.0, 200.0}) {
    Pipeline pipeline(block(), methodOf("elastic"), {lyingKnife(resistance)});
    double depth = -0.002, hardest = 0.0;
    while (pipeline.tissue().state().springs_cut == 0 && depth < 0.01) {
      pipeline.step(at({over(-(depth += 0.0001))}));
      const bool is_cut = pipeline.tissue().state().springs_cut > 0;
      const double force = pipeline.report().tools.front().force_on_tool.norm();
      if (!is_cut) hardest = std::max(hardest, force);
    }
    // What it dented is cut at the end of a stride.
    EXPECT_LT(depth, kSpacing * (1.0 + 2.0 * 0.25));
    if (resistance < 100.0) {
      EXPECT_LT(depth, 0.7 * kSpacing);
      EXPECT_GT(hardest, 0.8 * resistance * kLength);
      EXPECT_LT(hardest, 1.3 * resistance * kLength);
    } else {
      EXPECT_GT(depth, 0.9 * kSpacing);
    }
  }
}

// Through the whole block, so that nothing stays stored.
TEST(BladeDents, WorkIsResistanceTimesNewSurface) {
  ToolGeometry tool = lyingKnife(20.0);
  tool.blade.edge = {Vec3(0.0, -0.04, 0.0), Vec3(0.0, 0.04, 0.0)};
  Pipeline pipeline(block(), methodOf("elastic"), {tool});
  const Led down = lead(pipeline, over(0.002), over(-0.0338), 358);
  const Led up = lead(pipeline, over(-0.0338), over(-0.0238), 100);  // pays for the last of it
  EXPECT_NEAR(down.area, kWidth * 6.5 * kSpacing, 1e-9);             // half a layer at the top
  EXPECT_EQ(up.area, 0.0);
  EXPECT_NEAR(down.work + up.work, 20.0 * down.area, 0.05 * 20.0 * down.area);
}

// Down, aside against a lip, and along its edge, where it cuts nothing and pays for the last of it.
TEST(BladeDents, WorkIsResistanceTimesNewSurfaceAndWhatIsStored) {
  const double resistance = 20.0;
  Pipeline pipeline(block(), methodOf("elastic"), {withFriction(0.0, flatKnife(resistance))});
  const Vec3 aside = over(-0.015, 0.0383), along(0.0, 0.0055, 0.0);
  const Led down = lead(pipeline, over(0.002), over(-0.015), 340);
  const Led across = lead(pipeline, over(-0.015), aside, 140);
  const Led on = lead(pipeline, aside, aside + along, 110);
  const double work = down.work + across.work + on.work;
  const double area = down.area + across.area + on.area;
  const double stored = storedEnergy(pipeline.tissue());
  EXPECT_GT(stored, 0.1 * work);
  EXPECT_NEAR(work, resistance * area + stored, 0.05 * work);
  RecordProperty("work_over_balance", std::to_string(work / (resistance * area + stored)));
}

TEST(BladeDents, SameSpringsInOneTenAndAHundredUpdates) {
  TissueConfig hanging = block();
  hanging.gravity = Vec3(2.0, 0.0, 9.81);
  std::vector<std::vector<std::uint8_t>> severed;
  for (const int updates : {1, 10, 100}) {
    Pipeline pipeline(hanging, methodOf("elastic"), {lyingKnife()});
    pipeline.settle();
    pipeline.step(at({over(0.01)}));
    lead(pipeline, over(0.01), over(-0.0172, 0.0367), updates);
    severed.push_back(pipeline.tissue().state().severed);
  }
  EXPECT_GT(std::count(severed[0].begin(), severed[0].end(), 1), 15);
  EXPECT_EQ(severed[1], severed[0]);
  EXPECT_EQ(severed[2], severed[0]);
}

// Straight down it pushes neither lip; then aside the one ahead, and the other stays.
// For hours, as it may tremble there: from where it touched to where it is.
TEST(BladeDents, TheWayOfAnEdgeThatDentsStaysShort) {
  std::vector<Pose> path;
  std::size_t longest = 0;
  for (int i = 0; i < 100000; ++i) {
    path.push_back(Pose(Eigen::Translation3d(1e-8 * i, 0.0, i % 2 == 0 ? 1e-5 : -1e-5)));
    keepShort(path);
    longest = std::max(longest, path.size());
    ASSERT_EQ(path.front().translation().x(), 0.0);
    ASSERT_EQ(path.back().translation().x(), 1e-8 * i);
  }
  EXPECT_LT(longest, 1000U);
  EXPECT_GT(longest, 50U) << "bends of a dent are followed";
}

TEST(BladeDents, SidesPushTheLipsOfTheWound) {
  Pipeline pipeline(block(), methodOf("elastic"), {flatKnife()});
  lead(pipeline, over(0.002), over(-0.015), 34);
  EXPECT_GT(pipeline.tissue().state().springs_cut, 10);
  EXPECT_EQ(greatestDisplacement(pipeline.tissue()), 0.0);
  lead(pipeline, over(-0.015), over(-0.015, 0.0363), 10);
  EXPECT_GT(pipeline.report().tools.front().contacts, 0);
  const Tissue& tissue = pipeline.tissue();
  const auto moved = [&](int column) {
    return tissue.state().displacement[at(tissue.lattice().node(column, 6, 8))].x();
  };
  EXPECT_GT(moved(7), 0.001);
  EXPECT_GT(moved(7), moved(6) + 0.0003);  // they are apart: the other one only hangs on
  EXPECT_LT(pipeline.report().tools.front().force_on_tool.x(), 0.0);
}

// Laid on its side.
TEST(BladeDents, AFlatSidePushesAsAnyTool) {
  Pipeline pipeline(block(), methodOf("elastic"), {flatKnife()});
  RobotPose pose = at({over(0.005, 0.02)});
  pose.links.front().linear() = Eigen::AngleAxisd(0.5 * M_PI, Vec3::UnitY()).toRotationMatrix();
  for (int i = 0; i <= 16; ++i) {
    pose.links.front().translation() = over(0.005 - 0.0005 * i, 0.02);
    pipeline.step(pose);
  }
  EXPECT_EQ(pipeline.tissue().state().springs_cut, 0);
  const ToolReport& knife = pipeline.report().tools.front();
  EXPECT_GT((pose.links.front().linear() * knife.force_on_tool).z(), 1.0);
  EXPECT_LT(knife.max_penetration, 0.1 * kSpacing);
}

// Without time for all of it, the tissue comes back before what it swept is cut.
TEST(BladeDents, WithoutTimeTheSameSprings) {
  std::vector<std::vector<std::uint8_t>> severed;
  for (const double budget : {std::numeric_limits<double>::infinity(), 1e-9}) {
    Pipeline pipeline(block(), methodOf("elastic"), {lyingKnife(), probe()});
    pipeline.setBudget(budget);
    const Vec3 presses(0.045, 0.03, kTop + kRadius - 0.002);
    const auto go = [&](const Vec3& knife) {
      for (int update = 0; update < 2000; ++update) {
        pipeline.step(at({knife, presses}));
        if (pipeline.hasArrived()) return;
      }
      ADD_FAILURE() << "never arrived";
    };
    go(over(0.004, 0.0113));
    go(over(-0.0172, 0.0113));
    severed.push_back(pipeline.tissue().state().severed);
  }
  EXPECT_GT(std::count(severed[0].begin(), severed[0].end(), 1), 15);
  EXPECT_EQ(severed[1], severed[0]);
}

}  // namespace
}  // namespace robot_tissue::test_blade_dents
