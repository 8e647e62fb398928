// The node's services that change the tissue, save it and take changes back.
#include <robot_tissue/File.h>
#include <robot_tissue/Remove.h>
#include <robot_tissue/Suture.h>
#include <std_srvs/Trigger.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "node_fixture.h"

namespace robot_tissue::test_surgery {
namespace {

namespace fs = std::filesystem;

const std::vector<std::vector<double>> kCut = {
    {0.0525, -0.01, 0.02}, {0.0525, 0.06, 0.02}, {0.0525, 0.06, 0.07}, {0.0525, -0.01, 0.07}};

class Surgery : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/load_state", ros::Duration(kDeadline)));
    ASSERT_TRUE(node_.getParam("/tissue/state_dir", folder_));
    press(-0.01);
    ASSERT_TRUE(reset());
    ASSERT_TRUE(waitForMarkers([this] { return markers_["cut_faces"].points.empty(); }));
  }
  void TearDown() override { fs::remove_all(folder_); }

  static File::Response ask(const std::string& service, const std::string& file) {
    File call;
    call.request.file = file;
    EXPECT_TRUE(ros::service::call("/tissue/" + service, call));
    EXPECT_EQ(call.response.message.find('\n'), std::string::npos) << call.response.message;
    return call.response;
  }

  std::string folder_;
};

TEST_F(Surgery, ASavedCutComesBackAfterAReset) {
  const auto cut_report = cut(kCut);
  ASSERT_TRUE(cut_report.success);
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["cut_faces"].points.empty(); }));
  const Points surface = markers_["surface"].points;
  const auto saved = ask("save_state", "cut.tissue");
  EXPECT_TRUE(saved.success) << saved.message;
  EXPECT_TRUE(fs::is_regular_file(fs::path(folder_) / "cut.tissue"));
  EXPECT_NE(saved.message.find(folder_ + "/cut.tissue"), std::string::npos) << saved.message;
  EXPECT_EQ(saved.message.find("in the place of"), std::string::npos) << saved.message;
  const auto again = ask("save_state", "cut.tissue");
  EXPECT_NE(again.message.find("in the place of"), std::string::npos) << again.message;
  ASSERT_TRUE(reset());
  ASSERT_TRUE(waitForMarkers([this] { return markers_["cut_faces"].points.empty(); }));
  const auto loaded = ask("load_state", "cut.tissue");
  EXPECT_TRUE(loaded.success) << loaded.message;
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["cut_faces"].points.empty(); }));
  EXPECT_TRUE(markers_["surface"].points == surface);
  EXPECT_TRUE(waitFor([&] { return state_->springs_cut == cut_report.springs_cut; }));
  press(0.005);
  EXPECT_TRUE(waitForMarkers([this] { return lowestOfTop() < kTop - 0.004; }));
}

TEST_F(Surgery, BadFilesAreRefusedAndChangeNothing) {
  ASSERT_TRUE(cut(kCut).success);
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["cut_faces"].points.empty(); }));
  const Points surface = markers_["surface"].points;
  for (const std::string name : {"../a", "/etc/passwd", "", "a/b", ".a", "a\nb"}) {
    EXPECT_FALSE(ask("save_state", name).success) << name;
    EXPECT_FALSE(ask("load_state", name).success) << name;
  }
  EXPECT_FALSE(ask("load_state", "never_saved").success);
  fs::create_directories(folder_);
  std::ofstream(fs::path(folder_) / "foreign") << "solid block\n";
  const auto foreign = ask("load_state", "foreign");
  EXPECT_FALSE(foreign.success);
  EXPECT_NE(foreign.message.find("file = 'foreign': is no saved state; allowed: "),
            std::string::npos)
      << foreign.message;
  press(0.003);
  press(-0.01);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  EXPECT_TRUE(markers_["surface"].points == surface);
}

std_srvs::Trigger::Response undo() {
  std_srvs::Trigger call;
  EXPECT_TRUE(ros::service::call("/tissue/undo", call));
  EXPECT_EQ(call.response.message.find('\n'), std::string::npos) << call.response.message;
  return call.response;
}

Remove::Response remove(const Remove::Request& request) {
  Remove call;
  call.request = request;
  EXPECT_TRUE(ros::service::call("/tissue/remove", call));
  EXPECT_EQ(call.response.message.find('\n'), std::string::npos) << call.response.message;
  return call.response;
}

// Of a fifth of the block's sides, at the middle of its top.
Remove::Request ballAtTheTop() {
  Remove::Request request;
  request.center.x = 0.05;
  request.center.y = 0.025;
  request.center.z = kTop;
  request.radius = 0.012;
  return request;
}

TEST_F(Surgery, RemovedTissueOpensAHoleAndComesBack) {
  const auto removed = remove(ballAtTheTop());
  ASSERT_TRUE(removed.success) << removed.message;
  EXPECT_GT(removed.volume, 0.0);
  EXPECT_EQ(removed.pieces, 1);
  ASSERT_TRUE(waitForMarkers([this] { return !markers_["cut_faces"].points.empty(); }));
  ASSERT_TRUE(cut(kCut).success);
  const auto first = undo();
  EXPECT_TRUE(first.success) << first.message;
  EXPECT_TRUE(undo().success);
  ASSERT_TRUE(waitForMarkers([this] { return markers_["cut_faces"].points.empty(); }));
  EXPECT_TRUE(waitFor([this] { return state_->springs_cut == 0; }));
  const auto none = undo();
  EXPECT_FALSE(none.success);
  EXPECT_NE(none.message.find("; allowed: "), std::string::npos) << none.message;
}

TEST_F(Surgery, BadRemovalsAreRefusedAndChangeNothing) {
  Remove::Request negative = ballAtTheTop(), nowhere = ballAtTheTop(), both = ballAtTheTop(), none,
                  all = ballAtTheTop();
  negative.radius = -1.0;
  nowhere.header.frame_id = "no_such_frame";
  both.max.x = 1.0;
  all.radius = 10.0;
  Remove::Request infinite = ballAtTheTop();
  infinite.center.x = std::numeric_limits<double>::infinity();
  for (const Remove::Request& request : {negative, nowhere, both, none, all, infinite}) {
    const auto answer = remove(request);
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find("allowed"), std::string::npos) << answer.message;
  }
  EXPECT_EQ(remove(Remove::Request()).message,
            "min, max, radius: all 0; allowed: min below max, or a radius above 0");
  Remove::Request flat;
  flat.max.x = flat.max.y = 0.02;
  flat.min.z = flat.max.z = 0.05;
  EXPECT_EQ(remove(flat).message, "max.z: 0.05; allowed: above min.z, 0.05 m");
  Remove::Request beside = ballAtTheTop();
  beside.center.x = 5.0;
  const auto answer = remove(beside);
  EXPECT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.volume, 0.0);
  EXPECT_FALSE(undo().success);
}

TEST_F(Surgery, ASutureJoinsTwoPointsOfTheSurface) {
  ASSERT_TRUE(cut(kCut).success);
  Suture call;
  call.request.start.x = 0.04;
  call.request.end.x = 0.065;
  call.request.start.y = call.request.end.y = 0.025;
  call.request.start.z = call.request.end.z = kTop;
  call.request.rest_length = 0.02;
  ASSERT_TRUE(ros::service::call("/tissue/suture", call));
  EXPECT_TRUE(call.response.success) << call.response.message;
  EXPECT_EQ(call.response.name, "s1");
  EXPECT_GT(call.response.tension, 0.0);
  EXPECT_TRUE(waitForMarkers([this] { return !markers_["sutures"].points.empty(); }));
  EXPECT_TRUE(waitFor([&] {
    return state_->sutures == std::vector<std::string>{"s1"} && state_->suture_tensions[0] > 0.0 &&
           state_->sutures_broken[0] == 0;
  }));
  for (const double height : {0.5 * kTop, std::nan("")}) {
    Suture bad = call;
    bad.request.name = "s2";
    bad.request.start.z = height;
    ASSERT_TRUE(ros::service::call("/tissue/suture", bad));
    EXPECT_FALSE(bad.response.success);
    EXPECT_NE(bad.response.message.find("allowed"), std::string::npos) << bad.response.message;
    EXPECT_NE(bad.response.message.find("start"), std::string::npos) << bad.response.message;
    EXPECT_EQ(bad.response.message.find("from ="), std::string::npos) << bad.response.message;
  }
  for (const auto& set : std::vector<void (*)(Suture::Request&)>{
           [](Suture::Request& request) { request.rest_length = 1e15; },
           [](Suture::Request& request) { request.stiffness = 1e-300; },
           [](Suture::Request& request) { request.break_force = 1e300; },
           [](Suture::Request& request) { request.bite = 1e15; }}) {
    Suture beyond = call;
    beyond.request.name = "s2";
    set(beyond.request);
    ASSERT_TRUE(ros::service::call("/tissue/suture", beyond));
    EXPECT_FALSE(beyond.response.success) << beyond.request;
    EXPECT_NE(beyond.response.message.find("allowed"), std::string::npos);
  }
  Suture pushing = call;
  pushing.request.name = "s2";
  pushing.request.stiffness = -5.0;
  ASSERT_TRUE(ros::service::call("/tissue/suture", pushing));
  EXPECT_EQ(pushing.response.message, "stiffness: -5; allowed: 1e-06 to 100000 N/m, or 0: 200");
  call.request.name = "s1";
  ASSERT_TRUE(ros::service::call("/tissue/suture", call));
  EXPECT_FALSE(call.response.success);
  EXPECT_TRUE(undo().success);
  EXPECT_TRUE(waitForMarkers([this] { return markers_["sutures"].points.empty(); }));
  EXPECT_TRUE(waitFor([&] { return state_->sutures.empty() && state_->springs_cut > 0; }));
}

}  // namespace
}  // namespace robot_tissue::test_surgery
