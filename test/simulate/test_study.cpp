// The study speed_accuracy goes on after a kill at any point: no finished run is lost or done
// again.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

namespace robot_tissue::test_study {
namespace {

namespace fs = std::filesystem;

// A runner that notes what it solves. The file `kills` tells at which solve since the start of the
// study it kills: the study alone, or all, itself too.
constexpr char kRunner[] = R"sh(#!/bin/sh
cd "$(dirname "$0")" || exit 1
case "$*" in *runs/*)
  key=${*#*runs/}; key=${key%% *}
  echo "$key" >>solved
  echo "$key" >>of_this_start
  read -r solve victims <kills
  if [ "$(wc -l <of_this_start)" -eq "$solve" ]; then
    kill -9 "$(cat study_pid)"
    if [ "$victims" = all ]; then kill -9 $PPID; kill -9 $$; fi
    tries=0  # this run outlives the study, until the next one waits for it
    until grep -q waiting log || [ $tries -gt 300 ]; do tries=$((tries + 1)); sleep 0.1; done
  fi;;
esac
cd study && exec "$REAL_SIMULATE" "$@"
)sh";

class StudyTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "study_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    fs::create_directory(root_ / "study");
    std::ofstream(root_ / "simulate") << kRunner;
    ASSERT_EQ(chmod((root_ / "simulate").c_str(), S_IRWXU), 0);
  }
  void TearDown() override { fs::remove_all(root_); }

  // Six runs: a press at 10 mm by `layered` at five tolerances and by `newton`.
  int study(const std::string& kills) {
    std::ofstream(root_ / "kills") << kills << '\n';
    std::ofstream(root_ / "of_this_start");
    const std::string command =
        "cd '" + root_.string() +
        "' && REAL_SIMULATE='" SIMULATE_PATH
        "' sh -c 'echo $$ >study_pid; exec /usr/bin/python3 " ROBOT_TISSUE_SOURCE_DIR
        "/scripts/study speed_accuracy --simulate ./simulate --folder study --table table.csv "
        "--quiet --repeats 1 --methods layered,newton "
        "--only ^press_d1_elastic_nu25_h10000um' >>log 2>&1";
    return std::system(command.c_str());
  }

  std::map<std::string, int> solved() const {
    std::map<std::string, int> times;
    std::ifstream file(root_ / "solved");
    for (std::string key; std::getline(file, key);) ++times[key];
    return times;
  }

  std::string content(const char* name) const {
    std::ifstream file(root_ / name);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path root_;
};

TEST_F(StudyTest, GoesOnAfterKillsWithoutLosingOrRepeatingFinishedRuns) {
  EXPECT_NE(study("2 study"), 0);  // the run that is under way ends by itself
  EXPECT_FALSE(fs::exists(root_ / "table.csv"));
  EXPECT_NE(study("2 all"), 0);  // the run that is under way dies, too
  EXPECT_FALSE(fs::exists(root_ / "table.csv"));
  ASSERT_EQ(study("0 none"), 0) << content("log");

  const auto times = solved();
  EXPECT_EQ(times.size(), 6U);
  int again = 0;
  for (const auto& [key, count] : times) again += count - 1;
  EXPECT_EQ(again, 1) << "only the run that died is done again\n" << content("solved");

  const std::string table = content("table.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 7) << table;
  EXPECT_EQ(study("0 none"), 0);
  EXPECT_EQ(solved(), times) << "nothing is left to do";
  EXPECT_EQ(content("table.csv"), table);
}

}  // namespace
}  // namespace robot_tissue::test_study
