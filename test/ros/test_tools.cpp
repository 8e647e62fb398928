// Several tools: friction, wrenches at their own rate, tools that a force drives, links that vanish
// and jump, and what the state says of it all.
#include <Eigen/Core>
#include <limits>

#include "node_fixture.h"

namespace robot_tissue::test_tools {
namespace {

constexpr double kBlockTop = 0.03;  // m
const Eigen::Vector3d kParked(0.03, 0.03, 0.2);

geometry_msgs::Vector3 vector(double x, double y, double z) {
  geometry_msgs::Vector3 vector;
  vector.x = x;
  vector.y = y;
  vector.z = z;
  return vector;
}

class Tools : public NodeTest {
 protected:
  Tools() : places_{{"probe", kParked}, {"slick", kParked}, {"fork", kParked}, {"knife", kParked}} {
    subscribe<geometry_msgs::WrenchStamped>("slick/measured_cf", slick_);
    subscribe<geometry_msgs::WrenchStamped>("fork/measured_cf", fork_);
  }

  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    follow();
    ASSERT_TRUE(reset());
    follow();
    said_.clear();
    ASSERT_TRUE(waitFor([this] { return said_.count("OK") > 0; }));
  }

  std::vector<geometry_msgs::TransformStamped> transforms() const override {
    std::vector<geometry_msgs::TransformStamped> all = {transform("tissue", 1.0, 0.0, 0.0)};
    const auto add = [&](const std::string& link, const Eigen::Vector3d& place) {
      if (link != vanished_) all.push_back(transform(link, 1.0 + place.x(), place.y(), place.z()));
    };
    add("probe", places_.at("probe"));
    add("slick", places_.at("slick"));
    add("knife", places_.at("knife"));
    add("fork_base", places_.at("fork") + Eigen::Vector3d(0.0, 0.0, 0.1));
    add("tine", places_.at("fork"));
    return all;
  }

  // Of a sphere that is as deep in the block's top, `aside` of its middle.
  static Eigen::Vector3d pressed(double depth, double radius = kRadius, double aside = 0.0) {
    return {0.03 + aside, 0.03, kBlockTop + radius - depth};
  }

  ApplyLoad::Response push(const std::string& tool,
                           const std::vector<geometry_msgs::Vector3>& force) {
    ApplyLoad::Request request;
    request.name = tool;
    request.force = force;
    return applyLoad(request);
  }

  std::map<std::string, Eigen::Vector3d> places_;  // of the tools (m, tissue frame)
  std::string vanished_;
  boost::shared_ptr<const geometry_msgs::WrenchStamped> slick_, fork_;
};

TEST_F(Tools, WrenchesKeepTheirRateWhileShapesAreSolved) {
  std::vector<geometry_msgs::WrenchStamped> wrenches;
  const auto subscriber = node_.subscribe<geometry_msgs::WrenchStamped>(
      "/tissue/probe/measured_cf", 2000,
      [&](const geometry_msgs::WrenchStampedConstPtr& wrench) { wrenches.push_back(*wrench); });
  ASSERT_TRUE(waitFor([&] { return !wrenches.empty(); }));
  wrenches.clear();
  const ros::Time start = ros::Time::now();
  ASSERT_TRUE(waitFor([&] {
    const double passed = (ros::Time::now() - start).toSec();
    places_["probe"] = pressed(0.002 * passed);
    return passed >= 1.0;
  }));
  RecordProperty("wrenches", static_cast<int>(wrenches.size()));
  EXPECT_GE(wrenches.size(), 300U);  // of 500
  EXPECT_LE(wrenches.size(), 600U);
  ros::Time last;
  double greatest = 0.0;
  for (const auto& wrench : wrenches) {
    const auto& force = wrench.wrench.force;
    EXPECT_TRUE(std::isfinite(force.x + force.y + force.z));
    EXPECT_GE(wrench.header.stamp, last);
    last = wrench.header.stamp;
    greatest = std::max(greatest, force.z);
  }
  EXPECT_GT(greatest, 0.05);
}

TEST_F(Tools, PredictedWrenchesAreOfTheNewestPoses) {
  std::vector<geometry_msgs::WrenchStamped> predicted;
  const auto subscriber = node_.subscribe<geometry_msgs::WrenchStamped>(
      "/tissue/probe/predicted_cf", 2000,
      [&](const geometry_msgs::WrenchStampedConstPtr& wrench) { predicted.push_back(*wrench); });
  ASSERT_TRUE(waitFor([&] { return !predicted.empty(); }));
  const ros::Time start = ros::Time::now();
  ASSERT_TRUE(waitFor([&] {
    const double passed = (ros::Time::now() - start).toSec();
    places_["probe"] = pressed(0.003 * passed);
    return passed >= 1.0;
  }));
  ros::Time last;
  for (const auto& wrench : predicted) {
    const auto& force = wrench.wrench.force;
    EXPECT_TRUE(std::isfinite(force.x + force.y + force.z));
    EXPECT_GE(wrench.header.stamp, last);
    last = wrench.header.stamp;
  }
  EXPECT_GT(last, start);
  follow();
  predicted.clear();
  ASSERT_TRUE(waitFor([&] {
    return !predicted.empty() && wrench_->wrench.force.z > 0.05 &&
           std::abs(predicted.back().wrench.force.z - wrench_->wrench.force.z) < 1e-9;
  })) << "where the tool stands both are the same";
}

TEST_F(Tools, FrictionIsTheTools) {
  const auto drag = [&](const std::string& tool) {
    for (const double aside : {0.0, 0.0, 0.001, 0.002, 0.003, 0.004}) {
      places_[tool] = pressed(0.003, kRadius, aside);
      follow();
    }
    const auto met = tool == "probe" ? wrench_ : slick_;
    places_[tool] = kParked;
    follow();
    return met->wrench.force;
  };
  const auto rough = drag("probe"), slick = drag("slick");
  EXPECT_GT(rough.z, 0.1);
  EXPECT_GT(slick.z, 0.1);
  EXPECT_LT(rough.x, 0.0);  // the tissue holds it back
  EXPECT_LT(slick.x, 0.05 * slick.z);
  EXPECT_LT(rough.x / rough.z, slick.x / slick.z - 0.2);  // of 0.5
}

TEST_F(Tools, MaxForceIsToldAndFlagged) {
  places_["fork"] = pressed(0.004, 0.005);
  follow();
  ASSERT_TRUE(waitForContacts());
  const auto& contact = contacts_->contacts.front();
  EXPECT_EQ(contact.tool, "fork");
  EXPECT_TRUE(contact.saturated);
  EXPECT_TRUE(state_->saturated);
  EXPECT_NEAR(fork_->wrench.force.z, 0.05, 1e-3);
  EXPECT_EQ(fork_->header.frame_id, "fork_base");
  EXPECT_GT(std::abs(state_->force_of_tools.z), 0.06);  // before it is limited
}

TEST_F(Tools, ForcesOnTheTissueBalance) {
  places_["probe"] = pressed(0.004);
  follow();
  ASSERT_TRUE(waitFor([this] { return state_->force_of_tools.z < -0.1; }));
  EXPECT_LT(state_->unbalanced_force, 0.02 * std::abs(state_->force_of_tools.z));
  EXPECT_NEAR(state_->force_of_fixed.z, -state_->force_of_tools.z,
              0.02 * std::abs(state_->force_of_tools.z));
  EXPECT_NEAR(state_->force_of_tools.z, -wrench_->wrench.force.z, 1e-9);
  EXPECT_NEAR(state_->weight.z, 0.0, 1e-12);
  EXPECT_TRUE(state_->grasping.empty());
}

TEST_F(Tools, ForceDrivesAToolUntilItIsMet) {
  places_["probe"] = pressed(-0.002);
  follow();
  const auto pushed = push("probe", {vector(0.0, 0.0, -0.3)});
  ASSERT_TRUE(pushed.success) << pushed.message;
  EXPECT_NEAR(pushed.force.z, -0.3, 0.05 * 0.3) << pushed.message;
  EXPECT_LT(pushed.displacement.z, -0.003);
  EXPECT_NEAR(follow().wrench.force.z, 0.3, 0.05 * 0.3);
  const auto at_its_pose = push("probe", {});
  EXPECT_TRUE(at_its_pose.success) << at_its_pose.message;
  EXPECT_EQ(at_its_pose.displacement.z, 0.0);
  EXPECT_EQ(follow().wrench.force.z, 0.0);
}

TEST_F(Tools, AForceThatNothingAnswersIsToldUntilItIsReleased) {
  places_["probe"] = pressed(-0.002);
  follow();
  const auto pushed = push("probe", {vector(0.0, 0.0, 0.3)});
  EXPECT_NE(pushed.message.find("UNCONVERGED"), std::string::npos) << pushed.message;
  EXPECT_NE(pushed.message.find("nothing answers"), std::string::npos) << pushed.message;
  ASSERT_TRUE(waitFor([this] { return state_->status == "UNCONVERGED"; })) << state_->status;
  EXPECT_NE(state_->message.find("'probe'"), std::string::npos) << state_->message;
  EXPECT_NE(state_->message.find("release"), std::string::npos) << state_->message;
  EXPECT_TRUE(push("probe", {}).success);
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; })) << state_->message;
}

TEST_F(Tools, PushesThatAreNoneAreRefusedWithALine) {
  ApplyLoad::Request moved, turned;
  moved.name = turned.name = "probe";
  moved.displacement = {vector(0.0, 0.0, -0.001)};
  turned.force = {vector(0.0, 0.0, -0.1)};
  turned.turns = true;
  for (const auto& refused :
       {applyLoad(moved), applyLoad(turned), push("probe", {vector(0.0, 0.0, 0.0)}),
        push("probe", {vector(0.0, 0.0, std::nan(""))}), push("probe", {vector(0.0, 0.0, 1e300)}),
        push("probe", {vector(0.0, 0.0, -0.1), vector(0.0, 0.0, -0.1)})}) {
    EXPECT_FALSE(refused.success);
    EXPECT_NE(refused.message.find("probe"), std::string::npos) << refused.message;
    EXPECT_NE(refused.message.find("allowed"), std::string::npos) << refused.message;
    EXPECT_EQ(refused.message.find('\n'), std::string::npos);
  }
}

TEST_F(Tools, ForceOnAnUnknownToolIsRefusedByThatName) {
  ApplyLoad::Request moved;
  moved.name = "prope";
  moved.displacement = {vector(0.0, 0.0, -0.001)};
  for (const auto& refused : {push("prope", {vector(0.0, 0.0, -0.1)}), applyLoad(moved)}) {
    EXPECT_FALSE(refused.success);
    EXPECT_EQ(refused.message.find("name: 'prope' is no tool"), 0U) << refused.message;
    EXPECT_NE(refused.message.find("probe, slick, fork"), std::string::npos) << refused.message;
    EXPECT_EQ(refused.message.find('\n'), std::string::npos);
  }
  EXPECT_LT(push(std::string(1000, 'x'), {vector(0.0, 0.0, -0.1)}).message.size(), 300U);
}

TEST_F(Tools, OnlyGraspersGrasp) {
  const auto grasp = ask("grasp", "probe");
  EXPECT_FALSE(grasp.success);
  EXPECT_NE(grasp.message.find("'probe'"), std::string::npos) << grasp.message;
  EXPECT_NE(grasp.message.find("grasper"), std::string::npos) << grasp.message;
  const auto unknown = ask("grasp", "tongs");
  EXPECT_FALSE(unknown.success);
  EXPECT_NE(unknown.message.find("'tongs'"), std::string::npos) << unknown.message;
  EXPECT_NE(unknown.message.find("probe, slick, fork"), std::string::npos) << unknown.message;
  EXPECT_FALSE(ask("release", "probe").success);
  EXPECT_LT(ask("grasp", std::string(1000000, 'x')).message.size(), 300U);
}

// A blade without sides bends nothing: its force and its edge change, and the shape does not.
TEST_F(Tools, WhatIsShownOfABladeGoesWithIt) {
  bool any_force = false;
  for (double y = -0.01; y < 0.09; y += 0.005) {
    places_["knife"] = Eigen::Vector3d(0.033, y, 0.02);
    follow();
    any_force = any_force || !markers_["force_labels3"].text.empty();
  }
  EXPECT_TRUE(any_force);
  EXPECT_TRUE(waitFor([this] { return markers_["force_labels3"].text.empty(); }))
      << "it has left, and " << markers_["force_labels3"].text << " is shown";
  EXPECT_TRUE(waitFor([this] {
    const Points& edge = markers_["tool_edges"].points;
    return !edge.empty() && std::abs(edge.front().y - places_["knife"].y()) < 1e-9;
  }));
}

TEST_F(Tools, LinkThatVanishesIsNamedAndTheShapeStays) {
  places_["fork"] = pressed(0.003, 0.005);
  follow();
  vanished_ = "tine";  // the fork's other link goes on
  ASSERT_TRUE(waitFor([this] { return state_->status == "STALE"; }));
  EXPECT_NE(state_->message.find("'tine'"), std::string::npos) << state_->message;
  const ros::Time last_good = state_->header.stamp;
  EXPECT_LT(last_good, ros::Time::now() - ros::Duration(0.4)) << "of a pose that is stale";
  const Points shape = markers_["surface"].points;
  EXPECT_FALSE(markers_["loading_patches"].points.empty());
  const ros::Time last = fork_->header.stamp;
  places_["probe"] = pressed(0.004, kRadius, -0.02);
  ASSERT_FALSE(waitFor([&] { return fork_->header.stamp > last; }, 0.5)) << "a wrench of no pose";
  EXPECT_TRUE(markers_["surface"].points == shape);
  ros::Time newest = last_good;
  const ros::Subscriber listener =
      node_.subscribe<TissueState>("/tissue/state", 100, [&](const TissueStateConstPtr& state) {
        EXPECT_GE(state->header.stamp, newest) << "went back";
        newest = state->header.stamp;
      });
  vanished_.clear();
  ASSERT_TRUE(waitFor([this] { return state_->status == "OK"; }));
  EXPECT_GT(follow().wrench.force.z, 0.1);
}

TEST_F(Tools, TransformThatIsNoneIsToldWhereItsPoseGrowsOld) {
  places_["probe"].x() = std::numeric_limits<double>::quiet_NaN();
  ASSERT_TRUE(waitFor([this] { return state_->status == "STALE"; }));
  EXPECT_NE(state_->message.find("transform of 'probe' is left out"), std::string::npos)
      << state_->message;
  EXPECT_NE(state_->message.find("not finite"), std::string::npos) << state_->message;
  places_["probe"] = kParked;
  ASSERT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

// It may be a wrong pose: the shape stays until it has lasted.
TEST_F(Tools, JumpIsReportedAndFollowedWhenItLasts) {
  places_["probe"] = pressed(0.004);
  const auto pressed_in = follow();
  EXPECT_GT(pressed_in.wrench.force.z, 0.1);
  ASSERT_TRUE(waitForMarkers([this] { return markers_.count("surface") > 0; }));
  said_.clear();
  places_["probe"] = Eigen::Vector3d(5.0, 5.0, 5.0);
  ASSERT_TRUE(waitFor([this] { return said_.count("TOO_FAST") > 0; }));
  EXPECT_NE(said_["TOO_FAST"].find("'probe' jumped"), std::string::npos) << said_["TOO_FAST"];
  EXPECT_LT(state_->force_of_tools.z, -0.1);  // of the shape that stays
  const ros::Time last = state_->header.stamp;
  wrench_.reset();
  ASSERT_TRUE(waitFor([this] { return wrench_ != nullptr; }));
  EXPECT_TRUE(wrench_->wrench == pressed_in.wrench) << "told on, of the pose that was reached";
  EXPECT_LE(wrench_->header.stamp, last);
  EXPECT_EQ(follow().wrench.force.z, 0.0);
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

TEST_F(Tools, JumpThatDoesNotLastLeavesNoTrace) {
  places_["probe"] = pressed(0.004);
  const auto pressed_in = follow().wrench;
  said_.clear();
  places_["probe"] = Eigen::Vector3d(5.0, 5.0, 5.0);
  ASSERT_TRUE(waitFor([this] { return said_.count("TOO_FAST") > 0; }));
  places_["probe"] = pressed(0.004);
  EXPECT_TRUE(follow().wrench == pressed_in);
  EXPECT_EQ(said_.count("INSIDE"), 0U);
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

TEST_F(Tools, ToolThatAppearsInsideIsReportedAndWalkedIn) {
  places_["probe"] = pressed(0.004);
  const double force = follow().wrench.force.z;
  said_.clear();
  diagnostics_.clear();
  ASSERT_TRUE(reset());
  EXPECT_NEAR(follow().wrench.force.z, force, 0.1 * force);
  EXPECT_TRUE(waitFor([this] { return said_.count("INSIDE") > 0 && state_->status == "OK"; }));
  EXPECT_NE(said_["INSIDE"].find("'probe'"), std::string::npos) << said_["INSIDE"];
  const auto is_diagnosed = [this] {
    const auto& tools = diagnostics_["tissue: tools"];
    return tools.message.find("'probe' appeared inside") != std::string::npos &&
           tools.level == diagnostic_msgs::DiagnosticStatus::WARN;
  };
  EXPECT_TRUE(waitFor(is_diagnosed));
  EXPECT_TRUE(waitFor([this] { return diagnostics_["tissue: tools"].message == "followed"; }));
}

}  // namespace
}  // namespace robot_tissue::test_tools
