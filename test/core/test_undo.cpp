// What changes the topology and is taken back: cuts, strokes of a blade, tears, sutures.
#include <gtest/gtest.h>

#include <cmath>

#include "block_fixtures.h"
#include "mesh_fixtures.h"
#include "tissue/history.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_undo {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig block() {
  TissueConfig config = withFixedBottom(blockOf(8, 6, 5, kSpacing));
  config.model = "elastic";
  return config;
}

LoadStep pressOn(const TissueConfig& config) {
  return loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 5}, {2, 2, 5}), {0, 0, -0.004})});
}

std::vector<Vec3> acrossX(double x) {
  return {{x, -1.0, 0.01}, {x, 1.0, 0.01}, {x, 1.0, 1.0}, {x, -1.0, 1.0}};
}

SutureConfig sutureOver(double x, const std::string& name) {
  SutureConfig suture;
  suture.name = name;
  suture.from = Vec3(x - 0.01, 0.03, 0.05);
  suture.to = Vec3(x + 0.01, 0.03, 0.05);
  suture.rest_length = 0.012;
  return suture;
}

// A strip of the plane x, over all of y, from height to height.
std::vector<CutTriangle> sweptAt(double x, double from, double to) {
  const Vec3 a(x, -1.0, from), b(x, 1.0, from), c(x, 1.0, to), d(x, -1.0, to);
  return {{a, b, c}, {a, c, d}};
}

TEST(Undo, OfACutThatWasCutShortIsBitForBit) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(pressOn(config));
  const std::string before = tissue.savedState();
  tissue.setDeadline(Deadline(0.0));
  ASSERT_EQ(tissue.cut(acrossX(0.035)).solve.status, SolveStatus::kLate);
  tissue.setDeadline(std::nullopt);
  EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
  EXPECT_EQ(tissue.savedState(), before);
  EXPECT_FALSE(tissue.isLate());
}

TEST(Undo, OfManyRandomCutsIsBitForBit) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(pressOn(config));
  std::vector<std::string> states = {tissue.savedState()};
  Random random;
  const Vec3 low = config.shape.min(), extent = config.shape.sizes();
  for (int cut = 0; cut < 20; ++cut) {
    std::vector<Vec3> corners;
    for (int corner = 0; corner < 3; ++corner) {
      const double x = random.between(-0.2, 1.2), y = random.between(-0.2, 1.2);
      corners.push_back(low + Vec3(x, y, random.between(-0.2, 1.2)).cwiseProduct(extent));
    }
    if (tissue.cut(corners).springs_cut > 0) states.push_back(tissue.savedState());
  }
  ASSERT_EQ(tissue.undoable() + 1, static_cast<int>(states.size()));
  states.pop_back();
  for (int half = static_cast<int>(states.size()) / 2; half > 0; --half) {
    tissue.undo(1);
    EXPECT_EQ(tissue.savedState(), states.back());
    states.pop_back();
  }
  tissue.undo(tissue.undoable());
  EXPECT_EQ(tissue.savedState(), states.front());
}

TEST(Undo, BringsTheTopologyBackUnderTheLoadsThatStandNow) {
  const TissueConfig config = block();
  Tissue tissue(config, {}), uncut(config, {});
  tissue.cut(acrossX(0.045));
  const LoadStep press = pressOn(config);
  const double force_cut = reportsOf(tissue, press).back().patches[0].force.z();
  const double force = reportsOf(uncut, press).back().patches[0].force.z();
  ASSERT_LT(std::abs(force_cut), 0.999 * std::abs(force));
  const SolveReport report = tissue.undo(1);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  ASSERT_EQ(tissue.namedPatches(), 1U);
  EXPECT_NEAR(report.patches[0].force.z(), force, 0.01 * std::abs(force));
}

TEST(Undo, OfAStrokeIsOne) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(pressOn(config));
  const std::string before = tissue.savedState();
  EXPECT_GT(tissue.cutAlong(sweptAt(0.045, 0.04, 0.06)).springs_cut, 0);
  EXPECT_GT(tissue.cutAlong(sweptAt(0.045, 0.03, 0.04), Stroke::kGoesOn).springs_cut, 0);
  EXPECT_EQ(tissue.undoable(), 1);
  const std::string cut = tissue.savedState();
  EXPECT_GT(tissue.cutAlong(sweptAt(0.065, 0.03, 0.06)).springs_cut, 0);
  EXPECT_EQ(tissue.undoable(), 2);
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), cut);
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), before);
}

TEST(Undo, OfATearIsOneAndMendsIt) {
  TissueConfig config = block();
  config.material.tear_stretch = 1.3;
  Tissue tissue(config, {});
  const auto pull = [&](double way) {
    return loadOf({displacedPatch("pull", nodeBox(config, {3, 2, 5}, {5, 4, 5}), {0, 0, way})});
  };
  tissue.load(pull(0.002));
  ASSERT_EQ(tissue.undoable(), 0);
  tissue.load(pull(0.012));
  ASSERT_GT(tissue.springsTorn(), 0);
  EXPECT_EQ(tissue.undoable(), 1);
  tissue.release({"pull"});
  tissue.undo(1);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  EXPECT_EQ(tissue.undoable(), 0);
}

TEST(Undo, OfASutureLetsTheWoundOpenAgain) {
  const TissueConfig config = block();
  Tissue tissue(config, {});
  tissue.load(pressOn(config));
  tissue.cut(acrossX(0.045));
  const std::string open = tissue.savedState();
  ASSERT_GT(tissue.suture(sutureOver(0.045, "a")).suture.tension, 0.0);
  const std::string sutured = tissue.savedState();
  ASSERT_GT(tissue.suture(sutureOver(0.045, "b")).suture.tension, 0.0);
  EXPECT_EQ(tissue.undoable(), 3);
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), sutured);
  ASSERT_EQ(tissue.sutures().size(), 1U);
  EXPECT_EQ(tissue.sutures()[0].name, "a");
  tissue.undo(1);
  EXPECT_EQ(tissue.savedState(), open);
  EXPECT_TRUE(tissue.sutures().empty());
}

TEST(Undo, OfARemovalBringsItsSuturesBack) {
  const TissueConfig config = block();
  SolverConfig solver;
  solver.tolerance = 1e-3;
  Tissue tissue(config, solver);
  tissue.cut(acrossX(0.045));
  ASSERT_GT(tissue.suture(sutureOver(0.045, "a")).suture.tension, 0.0);
  const double tension = tissue.sutures()[0].tension;
  tissue.remove(PlacedBox{Box(Vec3(0.0, 0.0, 0.03), Vec3(0.045, 0.06, 0.06))});
  EXPECT_TRUE(tissue.sutures().empty());
  // Under another load the shape of then is no longer the one to have.
  tissue.load(loadOf({forcedPatch("far", nodeBox(config, {7, 5, 5}, {8, 6, 5}), {0, 0, -1e-6})}));
  tissue.undo(1);
  ASSERT_EQ(tissue.sutures().size(), 1U);
  EXPECT_NEAR(tissue.sutures()[0].tension, tension, 0.02 * tension);
}

TEST(SavedState, HasItsSutures) {
  const TissueConfig config = block();
  Tissue tissue(config, {}), other(config, {});
  tissue.load(pressOn(config));
  tissue.cut(acrossX(0.045));
  tissue.suture(sutureOver(0.045, "a"));
  tissue.remove(Sphere{config.shape.max(), 0.015});
  const std::string bytes = tissue.savedState();
  other.loadState(*other.readState(bytes));
  EXPECT_EQ(other.savedState(), bytes);
  ASSERT_EQ(other.sutures().size(), 1U);
  EXPECT_EQ(other.sutures()[0].tension, tissue.sutures()[0].tension);
  // What follows is the same to the last bit.
  tissue.loadState(*tissue.readState(bytes));  // forgets what the method has learned
  for (Tissue* each : {&tissue, &other}) {
    each->cut(acrossX(0.065));
    each->release({"punch"});
  }
  EXPECT_EQ(tissue.savedState(), other.savedState());
}

// Loads came since: the shape is found anew, in which nodes that cuts made have other numbers.
TEST(Undo, UnderOtherLoadsThreadsStayWhereTheyWere) {
  const TissueConfig config = block();
  SolverConfig exact;
  exact.tolerance = 1e-3;
  Tissue tissue(config, exact), never(config, exact);
  for (Tissue* each : {&tissue, &never}) {
    each->cut(acrossX(0.065));
    each->cut(acrossX(0.045));
    each->suture(sutureOver(0.065, "s"));
  }
  tissue.cut(acrossX(0.055));
  for (Tissue* each : {&tissue, &never}) each->load(pressOn(config));
  EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
  EXPECT_NEAR(tissue.sutures()[0].length, never.sutures()[0].length, 1e-4);
  EXPECT_NEAR(tissue.sutures()[0].tension, never.sutures()[0].tension,
              0.03 * never.sutures()[0].tension);
  double off = 0.0, all = 0.0;
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    const Vec3& there = never.state().displacement[at(node)];
    off += (tissue.state().displacement[at(node)] - there).squaredNorm();
    all += there.squaredNorm();
  }
  EXPECT_LT(std::sqrt(off), 0.005 * std::sqrt(all));
}

// More than is kept: the oldest changes are joined, the beginning and the last ones stay.
TEST(HistoryOfManyChanges, IsBoundedAndLeadsBackToTheBeginning) {
  constexpr std::size_t kSprings = 8000;  // 1000 bytes a change
  History history(1000000, 5500);
  for (std::size_t change = 0; change < 20; ++change) {
    History::Entry entry;
    entry.severed.assign(kSprings, false);
    entry.severed[change] = true;
    ASSERT_TRUE(history.begins(History::Kind::kByItself, {}));
    history.begin(History::Kind::kByItself, entry, {});
    history.end({});
  }
  ASSERT_EQ(history.size(), 5U);
  EXPECT_TRUE(history.before(0).severed[0]);
  for (std::size_t last = 1; last < 5; ++last) {
    EXPECT_TRUE(history.before(last).severed[15 + last]) << last;
  }
  EXPECT_TRUE(history.hasLoadsSince(0, {}));
}

}  // namespace
}  // namespace robot_tissue::test_undo
