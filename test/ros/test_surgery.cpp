// The node's services that change the tissue, save it and take changes back.
#include <robot_tissue/File.h>

#include <filesystem>
#include <fstream>

#include "node_fixture.h"

namespace robot_tissue {
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
  EXPECT_NE(foreign.message.find("is no saved state"), std::string::npos) << foreign.message;
  press(0.003);
  press(-0.01);
  ASSERT_TRUE(waitForMarkers([this] { return lowestOfTop() == kTop; }));
  EXPECT_TRUE(markers_["surface"].points == surface);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "surgery_test");
  return RUN_ALL_TESTS();
}
