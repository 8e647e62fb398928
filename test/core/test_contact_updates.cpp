// Solves while tools touch: the rounds end where they no longer gain.
#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "robot_tissue/core/contact_update.h"
#include "tissue/round_gain.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_contact_updates {
namespace {

// Lets the shape go nowhere, and wants another solve each time.
class NeverContent : public ContactUpdate {
 public:
  std::vector<double> longestWays() override { return {}; }
  double shareOfWay(const std::vector<Vec3>&) override { return 0.0; }
  bool renew(std::vector<LoadingPatch>&, Shape, Round round) override {
    ++rounds_;
    return round == Round::kNext;
  }
  int rounds() const { return rounds_; }

 private:
  int rounds_ = 0;
};

// Takes its time to look at the contacts, and wants another solve each time.
class SlowLook : public ContactUpdate {
 public:
  explicit SlowLook(std::chrono::milliseconds look) : look_(look) {}
  std::vector<double> longestWays() override { return {}; }
  double shareOfWay(const std::vector<Vec3>&) override { return 1.0; }
  bool renew(std::vector<LoadingPatch>&, Shape, Round) override {
    std::this_thread::sleep_for(look_);
    ++looks_;
    return true;
  }
  int looks() const { return looks_; }

 private:
  std::chrono::milliseconds look_;
  int looks_ = 0;
};

// A plane on the top of a block that is deeper and less deep in turn; of 20 shapes on the way one
// may be reached.
class Trembling : public ContactUpdate {
 public:
  explicit Trembling(const Tissue& tissue) : lattice_(tissue.lattice()) {}
  std::vector<double> longestWays() override { return {}; }
  double shareOfWay(const std::vector<Vec3>&) override { return ++ways_ % 20 == 0 ? 1.0 : 0.9; }
  bool renew(std::vector<LoadingPatch>& of_tools, Shape, Round) override {
    depth_ = 0.003 - depth_;
    of_tools = {plane()};
    return true;
  }
  LoadingPatch plane() const {
    LoadingPatch plane;
    plane.name = "plane";
    std::vector<ContactSpring> touches;
    for (int node = 0; node < lattice_.nodeCount(); ++node) {
      ContactSpring touch;
      touch.rest = lattice_.restPosition(node);
      if (touch.rest.z() < 0.02 - 1e-6) continue;
      touch.carriers = {{node, 1.0}};
      touch.normal = -Vec3::UnitZ();
      touch.plane_point = Vec3(0.0, 0.0, 0.02 - depth_);
      touch.stiffness = 1000.0;  // N/m
      touches.push_back(touch);
    }
    plane.contacts = touches;
    return plane;
  }

 private:
  const Lattice& lattice_;
  double depth_ = 0.001;  // m
  int ways_ = 0;
};

TissueConfig smallBlock() {
  TissueConfig config;
  config.shape.max() = Vec3(0.04, 0.04, 0.02);
  config.spacing = 0.01;
  config.material.young_modulus = 1e4;
  config.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return config;
}

LoadStep punched(double depth) {
  const Box punch{Vec3(0.01, 0.01, 0.02), Vec3(0.03, 0.03, 0.02)};
  return loadOf({displacedPatch("punch", punch, Vec3(0.0, 0.0, -depth))}, 1);
}

// After a look at the unloaded shape and one at the first solve's, 50 ms are left: the last look is
// at the shape that there is.
TEST(ContactUpdates, BeginNoSolveThatWouldEndAfterTheDeadline) {
  Tissue tissue(smallBlock(), {});
  SlowLook contacts(std::chrono::milliseconds(100));
  tissue.setContactUpdate(&contacts);
  tissue.setDeadline(Deadline(0.25));
  tissue.load(punched(0.001));
  EXPECT_LE(contacts.looks(), 3);
  EXPECT_TRUE(tissue.isLate());
}

TEST(ContactUpdates, EndWhereTheyLeadNeitherNearerNorFarther) {
  Tissue tissue(smallBlock(), {});
  NeverContent contacts;
  tissue.setContactUpdate(&contacts);
  tissue.load(punched(0.001));
  EXPECT_GT(contacts.rounds(), 1);
  EXPECT_LT(contacts.rounds(), 40);
}

TEST(ContactUpdates, ThatStillChangeAfterManyIterationsHaveNotConverged) {
  SolverConfig solver;
  solver.tolerance = 1e-6;
  Tissue tissue(smallBlock(), solver);
  Trembling contacts(tissue);
  const LoadingPatch plane = contacts.plane();
  ASSERT_EQ(tissue.follow({plane}, {}).status, SolveStatus::kOk);
  tissue.setContactUpdate(&contacts);
  const SolveReport report = tissue.follow({plane}, {});
  ASSERT_GT(report.iterations, 1500);
  EXPECT_EQ(report.status, SolveStatus::kUnconverged);
}

class Rounds : public ::testing::Test {
 protected:
  // The only node's way (m).
  void note(double error, double way, bool whole = false) {
    SolveReport report;
    report.error_estimate = error;
    report.iterations = 100;
    gain_.note(report, {Vec3(way, 0.0, 0.0)}, whole);
  }

  RoundGain gain_{std::make_shared<const std::vector<Vec3>>(1, Vec3::Zero())};
};

TEST_F(Rounds, ThatGainNothingAreOver) {
  note(0.1, 0.01);
  for (int round = 0; round < 3; ++round) {
    note(0.09, 0.0105);
    EXPECT_FALSE(gain_.isOver());
  }
  note(0.09, 0.0105);
  EXPECT_TRUE(gain_.isOver());
}

TEST_F(Rounds, GoOnNearerOrFartherOrWhole) {
  double error = 0.1, way = 0.01;
  for (int round = 0; round < 60; ++round) {
    if (round % 3 == 0) error *= 0.6;
    if (round % 3 == 1) way *= 1.2;
    note(error, way, round % 3 == 2);
    EXPECT_FALSE(gain_.isOver()) << round;
  }
}

}  // namespace
}  // namespace robot_tissue::test_contact_updates
