// The output folder gets all its files or stays as it was.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "output_folder.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue::test_output_folder {
namespace {

namespace fs = std::filesystem;

class OutputFolderTest : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "output_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
  }
  void TearDown() override { fs::remove_all(root_); }

  static std::string content(const fs::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }

  fs::path root_;
};

TEST_F(OutputFolderTest, WithoutCommitNothingIsLeft) {
  {
    OutputFolder folder((root_ / "a/b").string(), {"x.csv"});
    folder.write("x.csv", "1");
    EXPECT_FALSE(fs::exists(root_ / "a/b/x.csv"));
  }
  EXPECT_TRUE(fs::is_empty(root_));
}

// Each finds that some folders are missing, and that the other has made them meanwhile.
TEST_F(OutputFolderTest, TwoRunsAtOnceMakeTheParentsThatTheyShare) {
  constexpr int kRounds = 40;
  for (int round = 0; round < kRounds; ++round) {
    const fs::path shared = root_ / std::to_string(round) / "a/b/c/d/e/f/g/h";
    int gate[2];  // closed by this process, so that both start
    ASSERT_EQ(pipe(gate), 0);
    std::vector<pid_t> runs;
    for (const std::string name : {"one", "other"}) {
      runs.push_back(fork());
      if (runs.back() != 0) continue;
      close(gate[1]);
      char none = 0;
      if (read(gate[0], &none, 1) != 0) _exit(2);
      try {
        const OutputFolder folder((shared / name).string(), {"x.csv"});
        _exit(0);
      } catch (const InputError&) {
        _exit(1);
      }
    }
    close(gate[0]);
    close(gate[1]);
    for (const pid_t run : runs) {
      int status = -1;
      ASSERT_EQ(waitpid(run, &status, 0), run);
      ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "round " << round;
    }
  }
}

TEST_F(OutputFolderTest, WithoutCommitOldFilesStay) {
  std::ofstream(root_ / "x.csv") << "old";
  {
    OutputFolder folder(root_.string(), {"x.csv"});
    folder.write("x.csv", "new");
  }
  EXPECT_EQ(content(root_ / "x.csv"), "old");
}

TEST_F(OutputFolderTest, WhatAnEarlierRunLeftGoesWithCommit) {
  std::ofstream(root_ / "old.csv") << "old";
  {
    OutputFolder folder(root_.string(), {"x.csv"});
    folder.drop("old.csv");
    folder.drop("never_there.csv");
  }
  EXPECT_EQ(content(root_ / "old.csv"), "old");
  {
    OutputFolder folder(root_.string(), {"x.csv"});
    folder.drop("old.csv");
    folder.drop("never_there.csv");
    folder.commit();
  }
  EXPECT_FALSE(fs::exists(root_ / "old.csv"));
}

TEST_F(OutputFolderTest, CommitPutsTheFilesInPlace) {
  std::ofstream(root_ / "x.csv") << "old";
  std::ofstream(root_ / "other") << "kept";
  {
    OutputFolder folder(root_.string(), {"x.csv", "y.csv"});
    folder.write("x.csv", "new");
    folder.write("y.csv", "2");
    folder.commit();
  }
  EXPECT_EQ(content(root_ / "x.csv"), "new");
  EXPECT_EQ(content(root_ / "y.csv"), "2");
  EXPECT_EQ(content(root_ / "other"), "kept");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_), fs::directory_iterator()), 3);
}

}  // namespace
}  // namespace robot_tissue::test_output_folder
