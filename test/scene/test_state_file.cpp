// Files of saved states: plain names, whole files or none.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <climits>
#include <filesystem>
#include <fstream>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/state_file.h"

namespace robot_tissue::test_state_file {
namespace {

namespace fs = std::filesystem;

class StateFile : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "state_file_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  template <class Call>
  static std::string refusalOf(const Call& call) {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  std::string folder() const { return folder_.string(); }

  fs::path folder_;
};

TEST_F(StateFile, IsReadAsItWasWritten) {
  const std::string bytes("a\0b\r\n\xff", 6);
  const std::string made = (folder_ / "made/here").string();
  EXPECT_FALSE(writeStateFile(made, "a.tissue", bytes));
  EXPECT_EQ(readStateFile(made, "a.tissue"), bytes);
  EXPECT_TRUE(writeStateFile(made, "a.tissue", "new"));
  EXPECT_EQ(readStateFile(made, "a.tissue"), "new");
  EXPECT_EQ(std::distance(fs::directory_iterator(made), fs::directory_iterator()), 1);
}

// As of any other result.
TEST_F(StateFile, MayBeReadByWhomTheMaskLets) {
  const mode_t before = umask(022);
  writeStateFile(folder(), "a.tissue", "x");
  umask(before);
  EXPECT_EQ(fs::status(folder_ / "a.tissue").permissions(), fs::perms(0644));
}

TEST_F(StateFile, OnlyPlainNamesAreTaken) {
  for (const std::string& name :
       {std::string(), std::string("."), std::string(".."), std::string("../a"),
        std::string("/etc/passwd"), std::string("a/b"), std::string(".hidden"), std::string("a b"),
        std::string("a\nb"), std::string("a\0b", 3), std::string("nodes.csv"),
        std::string("surface.stl"), std::string(101, 'a')}) {
    for (const std::string& line : {refusalOf([&] { writeStateFile(folder(), name, "x"); }),
                                    refusalOf([&] { readStateFile(folder(), name); })}) {
      EXPECT_NE(line.find("must be a plain name"), std::string::npos) << name;
      EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
  }
  EXPECT_TRUE(fs::is_empty(folder_));
}

// The path as a whole: the system says what is wrong with it.
TEST_F(StateFile, APathThatTheSystemDoesNotTakeIsRefusedInALine) {
  fs::path deep = folder_;
  while (deep.string().size() + 201 < PATH_MAX - 10) deep /= std::string(200, 'd');
  deep /= std::string(PATH_MAX - 10 - deep.string().size(), 'd');
  EXPECT_EQ(refusalOf([&] { writeStateFile(deep.string(), std::string(50, 'a'), "x"); }),
            "file = '" + std::string(50, 'a') +
                "': File name too long; allowed: a file in a folder that can "
                "be made and written");
}

TEST_F(StateFile, WhatIsMissingOrNoFileIsRefused) {
  EXPECT_EQ(
      refusalOf([&] { readStateFile(folder(), "none"); }),
      "file = 'none': No such file or directory; allowed: a saved state in the folder " + folder());
  fs::create_directory(folder_ / "sub");
  EXPECT_NE(refusalOf([&] { readStateFile(folder(), "sub"); }), "");
  EXPECT_NE(refusalOf([&] { writeStateFile(folder(), "sub", "x"); }).find("; allowed: a new file"),
            std::string::npos);
  ASSERT_EQ(mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_NE(refusalOf([&] { readStateFile(folder(), "pipe"); }), "");
  std::ofstream(folder_ / "file") << "x";
  EXPECT_NE(refusalOf([&] {
              writeStateFile((folder_ / "file").string(), "a", "x");
            }).find("; allowed: a file in a folder that can be made"),
            std::string::npos);
}

// A link in the folder must not lead a save out of it.
TEST_F(StateFile, ALinkIsNotFollowedByASave) {
  fs::create_directory(folder_ / "in");
  std::ofstream(folder_ / "outside") << "old";
  fs::create_symlink(folder_ / "outside", folder_ / "in/link");
  EXPECT_NE(refusalOf([&] { writeStateFile((folder_ / "in").string(), "link", "new"); }), "");
  EXPECT_EQ(readStateFile(folder(), "outside"), "old");
}

// Kills a program that saves two states in turn, at a random time of a save.
TEST_F(StateFile, KilledInASaveTheOldStateIsThereOrTheNew) {
  const std::string one(200000, '1'), two(300000, '2');
  writeStateFile(folder(), "a.tissue", one);
  int found_two = 0;
  for (int kill_number = 0; kill_number < 100; ++kill_number) {
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      for (bool is_two = true;; is_two = !is_two) {
        if (write(ends[1], "x", 1) != 1) _exit(1);
        writeStateFile(folder(), "a.tissue", is_two ? two : one);
      }
    }
    char begun = 0;
    const int saves = 1 + kill_number % 4;
    for (int save = 0; save < saves; ++save) ASSERT_EQ(read(ends[0], &begun, 1), 1);
    const auto end = std::chrono::steady_clock::now() + std::chrono::microseconds(37 * kill_number);
    while (std::chrono::steady_clock::now() < end) {
    }
    ASSERT_EQ(kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
    close(ends[0]);
    close(ends[1]);
    const std::string found = readStateFile(folder(), "a.tissue");
    ASSERT_TRUE(found == one || found == two) << found.size() << " bytes";
    found_two += found == two ? 1 : 0;
  }
  EXPECT_GT(found_two, 0);
  EXPECT_LT(found_two, 100);
}

}  // namespace
}  // namespace robot_tissue::test_state_file
