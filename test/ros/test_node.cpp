// The node beside a robot that moves: what a user sees on its topics and services.
#include <algorithm>
#include <set>

#include "node_fixture.h"

namespace robot_tissue::test_node {
namespace {

const std::vector<std::vector<double>> kCut = {
    {0.0525, -0.01, 0.02}, {0.0525, 0.06, 0.02}, {0.0525, 0.06, 0.07}, {0.0525, -0.01, 0.07}};

class RunningNode : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    press(-0.01);
    ASSERT_TRUE(reset());
    ASSERT_TRUE(waitFor([this] { return state_ && state_->springs_cut == 0; }));
    ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  }

  // The surface is not in the probe, which its flat triangles touch no farther from their corners
  // than their longest side, a spacing's diagonal.
  void expectPressed(double depth) {
    constexpr double kOff = 2.0 * 0.005 * 0.005 / (2.0 * kRadius);  // of such a corner (m)
    EXPECT_LT(lowestOfTop(), kTop - depth + 1e-4);
    EXPECT_GT(lowestOfTop(), kTop - depth - kOff);
  }

  ApplyLoad::Response load(const std::string& name, double low, double high, double down) {
    ApplyLoad::Request request;
    request.name = name;
    request.min.x = request.min.y = low;
    request.max.x = request.max.y = high;
    request.min.z = request.max.z = kTop;
    request.displacement.emplace_back();
    request.displacement.front().z = -down;
    return applyLoad(request);
  }

  ApplyLoad::Response release(const std::string& name) {
    ApplyLoad::Request request;
    request.name = name;
    return applyLoad(request);
  }
};

TEST_F(RunningNode, MovingLinkDeformsTheMarkers) {
  press(0.005);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.0045; }));
  expectPressed(0.005);
  EXPECT_FALSE(markers_["loading_patches"].points.empty());
  EXPECT_EQ(markers_["contact_forces"].action, visualization_msgs::Marker::ADD);
  press(-0.01);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  EXPECT_EQ(markers_["loading_patches"].action, visualization_msgs::Marker::DELETE);
  EXPECT_EQ(markers_["contact_forces"].action, visualization_msgs::Marker::DELETE);
}

TEST_F(RunningNode, WrenchGrowsWithDepthWithTheRightSignAndFrame) {
  double last = 0.0;
  for (double depth = 0.001; depth < 0.0055; depth += 0.001) {
    const auto wrench = press(depth);
    EXPECT_EQ(wrench.header.frame_id, "probe");
    // The tissue pushes the probe up; the probe's own z points down.
    EXPECT_LT(wrench.wrench.force.z, -last) << "at a depth of " << depth << " m";
    last = -wrench.wrench.force.z;
    EXPECT_LT(std::hypot(wrench.wrench.force.x, wrench.wrench.force.y), 0.02 * last);
  }
  const auto wrench = press(-0.01);
  EXPECT_EQ(wrench.wrench.force.z, 0.0);
}

TEST_F(RunningNode, ContactsTellPatchAndNormal) {
  press(0.005);
  ASSERT_TRUE(waitForContacts());
  // Those of a shape that had yet to come to balance, on a busy machine, are deeper.
  ASSERT_TRUE(waitFor(
      [this] { return !contacts_->contacts.empty() && contacts_->contacts.front().depth < 1e-4; }));
  const TissueContact& contact = contacts_->contacts.front();
  EXPECT_EQ(contacts_->header.frame_id, "tissue");
  EXPECT_EQ(contact.tool, "probe");
  EXPECT_GT(contact.nodes.size(), 3U);
  EXPECT_NEAR(contact.normal.z, -1.0, 0.01);
  EXPECT_LT(contact.force.z, 0.0);  // of the tool on the tissue: down
  EXPECT_GE(contact.depth, 0.0);    // no depth is none: straight above a node it lies all around
}

TEST_F(RunningNode, CutSeversSpringsAndResetBringsThemBackBitForBit) {
  const Points rest = markers_["surface"].points;
  const Points wires = markers_["wireframe"].points;
  const auto response = cut(kCut);
  EXPECT_TRUE(response.success) << response.message;
  EXPECT_GT(response.springs_cut, 50);
  EXPECT_EQ(response.pieces, 1);
  EXPECT_TRUE(waitFor([&] { return state_->springs_cut == response.springs_cut; }));
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["cut_faces"].points.empty(); }));
  EXPECT_FALSE(markers_["wireframe"].points == wires);
  press(0.005);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.004; }));
  press(-0.01);
  ASSERT_TRUE(reset());
  ASSERT_TRUE(waitForMarkers([this] { return markers_["cut_faces"].points.empty(); }));
  EXPECT_TRUE(markers_["surface"].points == rest);
  EXPECT_TRUE(markers_["wireframe"].points == wires);
}

TEST_F(RunningNode, CutIsUnderstoodInAnotherFrame) {
  auto corners = kCut;
  for (auto& corner : corners) corner[0] += 1.0;
  const auto in_base = cut(corners, "base");
  ASSERT_TRUE(reset());
  const auto in_tissue = cut(kCut);
  EXPECT_EQ(in_base.springs_cut, in_tissue.springs_cut);
}

TEST_F(RunningNode, BadCutsAreRefusedAndChangeNothing) {
  EXPECT_FALSE(cut({{0, 0, 0}, {1, 1, 1}}).success);
  EXPECT_FALSE(cut({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}).success);
  EXPECT_FALSE(cut({{0, 0, 0}, {std::nan(""), 1, 1}, {2, 0, 2}}).success);
  const auto lost = cut(kCut, "no_such_frame");
  EXPECT_FALSE(lost.success);
  EXPECT_NE(lost.message.find("no_such_frame"), std::string::npos);
  EXPECT_EQ(lost.message.find('\n'), std::string::npos);
  EXPECT_LT(cut(kCut, std::string(1000000, 'x')).message.size(), 300U);
  EXPECT_FALSE(cut({{0, 0, 0}, {1e300, 1, 1}, {2, 0, 2}}).success);
  EXPECT_FALSE(cut(std::vector<std::vector<double>>(100000, {0.0, 0.0, 0.0})).success);
  const auto beside = cut({{0.5, 0, 0}, {0.5, 0.1, 0}, {0.5, 0.1, 0.1}});
  EXPECT_TRUE(beside.success);
  EXPECT_EQ(beside.springs_cut, 0);
}

TEST_F(RunningNode, LoadStandsUntilItIsReleased) {
  const auto loaded = load("punch", 0.04, 0.06, 0.003);
  ASSERT_TRUE(loaded.success) << loaded.message;
  EXPECT_LT(loaded.force.z, -0.1);
  EXPECT_DOUBLE_EQ(loaded.displacement.z, -0.003);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.0025; }));
  const auto released = release("punch");
  EXPECT_TRUE(released.success) << released.message;
  EXPECT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
}

TEST_F(RunningNode, BadLoadsAreRefusedAndChangeNothing) {
  ASSERT_TRUE(load("punch", 0.04, 0.06, 0.003).success);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.0025; }));
  const Points shape = markers_["surface"].points;
  for (const auto& refused :
       {load("", 0.01, 0.02, 0.003), load("upside_down", 0.06, 0.04, 0.003),
        load("nowhere", 5.0, 6.0, 0.003), load("overlap", 0.05, 0.07, 0.003),
        load("probe", 0.0, 0.01, 0.003), load("endless", 0.0, 0.01, INFINITY),
        load("far", 0.0, 0.01, 1.0), load("a,b", 0.0, 0.01, 0.001),
        load("two\nlines", 0.0, 0.01, 0.001), load("wide", -1e300, 0.01, 0.001),
        load(std::string(1000000, 'x'), 0.0, 0.01, 0.001), release(std::string(1000000, 'x')),
        load("deep", 0.0, 0.01, 1e300)}) {
    EXPECT_FALSE(refused.success);
    EXPECT_FALSE(refused.message.empty());
    EXPECT_LT(refused.message.size(), 300U);
    EXPECT_EQ(refused.message.find('\n'), std::string::npos);
  }
  EXPECT_FALSE(release("unknown").success);
  ASSERT_TRUE(load("punch", 0.04, 0.06, 0.003).success);
  // Solved once more, to the solver's tolerance of 1 %.
  const Points& again = markers_["surface"].points;
  ASSERT_EQ(again.size(), shape.size());
  for (std::size_t i = 0; i < shape.size(); ++i) {
    ASSERT_NEAR(again[i].x, shape[i].x, 0.01 * 0.003);
    ASSERT_NEAR(again[i].y, shape[i].y, 0.01 * 0.003);
    ASSERT_NEAR(again[i].z, shape[i].z, 0.01 * 0.003);
  }
}

TEST_F(RunningNode, OldTransformsAreReportedAndTheShapeStays) {
  press(0.004);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.0035; }));
  publishes_transform_ = false;
  ASSERT_TRUE(waitFor([this] { return state_->status == "STALE"; }));
  EXPECT_FALSE(state_->message.empty());
  expectPressed(0.004);
  publishes_transform_ = true;
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }));
}

// A controller takes silence for a fault.
TEST_F(RunningNode, ToolThatStandsGetsItsWrenchAtEveryPose) {
  const auto pressed = press(0.004);
  publishes_transform_ = false;
  for (int pose = 0; pose < 50; ++pose) {
    const ros::Time answered = ros::Time::now();
    const ros::Duration period(0.01);  // of the node's updates
    ASSERT_TRUE(waitFor([&] { return ros::Time::now() - answered >= period; }));
    auto moved = transforms();
    for (auto& transform : moved) transform.header.stamp = moved.front().header.stamp;
    broadcaster_.sendTransform(moved);
    ASSERT_TRUE(waitFor([&] { return wrench_->header.stamp == moved.front().header.stamp; }))
        << "pose " << pose;
    EXPECT_TRUE(wrench_->wrench == pressed.wrench);
  }
}

// Poses that are answered as still ones are newer than the last one that was solved for.
TEST_F(RunningNode, StampsDoNotGoBackWhereAServiceComesBetween) {
  press(0.004);
  ros::Time newest;
  int told = 0, went_back = 0;
  const ros::Subscriber listener = node_.subscribe<geometry_msgs::WrenchStamped>(
      "/tissue/probe/measured_cf", 1000, [&](const geometry_msgs::WrenchStampedConstPtr& wrench) {
        ++told;
        if (wrench->header.stamp < newest) ++went_back;
        newest = std::max(newest, wrench->header.stamp);
      });
  ApplyLoad to_its_pose;
  to_its_pose.request.name = "probe";
  for (int time = 0; time < 20; ++time) {
    told = 0;
    ASSERT_TRUE(waitFor([&] { return told >= 5; }));
    ASSERT_TRUE(ros::service::call("/tissue/apply_load", to_its_pose));
    EXPECT_TRUE(to_its_pose.response.success) << to_its_pose.response.message;
  }
  EXPECT_EQ(went_back, 0);
}

TEST_F(RunningNode, ToolThatStoodIsFollowedWhenItMovesAgain) {
  double shallow = press(0.004).wrench.force.z;
  for (int time = 0; time < 5; ++time) {
    const double deep = press(0.005).wrench.force.z;
    EXPECT_LT(deep, 1.1 * shallow);
    shallow = press(0.004).wrench.force.z;
    EXPECT_LT(deep, 1.1 * shallow);
  }
}

TEST_F(RunningNode, StateFollowsAServiceAndTheToolsLeaving) {
  ASSERT_TRUE(load("punch", 0.04, 0.06, 0.003).success);
  EXPECT_TRUE(waitFor([this] { return state_->volume_ratio < 0.9999; }));
  ASSERT_TRUE(reset());
  EXPECT_TRUE(waitFor([this] { return state_->volume_ratio == 1.0 && state_->status == "OK"; }));
}

TEST_F(RunningNode, TransformThatIsNotFiniteIsReportedAndSurvived) {
  press(0.004);
  depth_ = INFINITY;
  ASSERT_TRUE(waitFor([this] { return state_->status == "NO_TRANSFORM"; }));
  depth_ = 0.004;
  EXPECT_TRUE(waitFor([this] { return state_->status == "OK"; }, 30.0));
}

// All of them for who comes; then only what changed, until the tool stands and all are told again.
TEST_F(RunningNode, OnlyMarkersThatChangedAreSentWhileTheToolMoves) {
  press(-0.01);
  std::vector<std::set<std::string>> arrays;  // their namespaces
  const auto subscriber = node_.subscribe<visualization_msgs::MarkerArray>(
      "/tissue/markers", 100, [&](const visualization_msgs::MarkerArrayConstPtr& array) {
        arrays.emplace_back();
        for (const auto& marker : array->markers) arrays.back().insert(marker.ns);
      });
  ASSERT_TRUE(waitFor([&] { return !arrays.empty() && arrays.back().count("fixed_nodes") > 0; }));
  EXPECT_EQ(arrays.back().count("surface"), 1U);
  const auto pressed_alone = [](const std::set<std::string>& names) {
    return names.count("surface") > 0 && names.count("fixed_nodes") == 0;
  };
  int sent = 0;
  const auto is_sent = [&] {
    depth_ = 0.003 + 0.002 * std::sin(0.01 * ++sent);
    return std::count_if(arrays.begin(), arrays.end(), pressed_alone) >= 3;
  };
  EXPECT_TRUE(waitFor(is_sent));
  const std::size_t so_far = arrays.size();
  const auto whole_again = [&] {
    return arrays.size() > so_far && arrays.back().count("fixed_nodes") > 0;
  };
  EXPECT_TRUE(waitFor(whole_again));
  const std::size_t at_rest = arrays.size();
  EXPECT_FALSE(waitFor([&] { return arrays.size() > at_rest; }, 0.3)) << "nothing changed";
}

TEST_F(RunningNode, DiagnosticsTellPiecesAndMemoryOfWhatRuns) {
  const auto told = [this](const std::string& key) {
    for (const auto& value : diagnostics_["tissue: solver"].values) {
      if (value.key == key) return value.value;
    }
    return std::string();
  };
  ASSERT_TRUE(waitFor([&] { return told("pieces") == "1"; }));
  EXPECT_EQ(diagnostics_["tissue: solver"].hardware_id, "elastic layered: 4851 nodes");
  EXPECT_EQ(told("nodes"), "4851");
  EXPECT_GT(std::stod(told("memory of the process (MB)")), 1.0);
  EXPECT_GT(std::stod(told("heap in use (MB)")), 1.0);
  EXPECT_LT(std::stod(told("heap in use (MB)")), std::stod(told("memory of the process (MB)")));
  cut({{0.0525, -0.1, -0.1}, {0.0525, 0.2, -0.1}, {0.0525, 0.2, 0.2}, {0.0525, -0.1, 0.2}});
  EXPECT_TRUE(waitFor([&] { return told("pieces") == "2"; }));
  ASSERT_TRUE(reset());
}

TEST_F(RunningNode, DiagnosticsTellRateTransformsAndSolver) {
  EXPECT_TRUE(waitFor([this] {
    return diagnostics_.count("tissue: update rate") > 0 &&
           diagnostics_.count("tissue: solver") > 0 &&
           diagnostics_.count("tissue: transforms") > 0 &&
           diagnostics_["tissue: transforms"].level == diagnostic_msgs::DiagnosticStatus::OK;
  }));
}

}  // namespace
}  // namespace robot_tissue::test_node
