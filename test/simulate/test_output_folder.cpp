// The output folder gets all its files or stays as it was.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <fstream>
#include <iterator>

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
