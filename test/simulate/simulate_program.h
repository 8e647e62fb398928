// The runner as a program, in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

namespace robot_tissue {

namespace fs = std::filesystem;

inline const std::vector<std::string> kFiles = {"increments.csv", "nodes.csv", "patches.csv",
                                                "surface.stl", "tools.csv"};

inline const std::string kScene = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.04, 0.03, 0.02]}
  spacing: 0.01
  material: {young_modulus: 10000.0}
  fixed:
    - {min: [-1.0, -1.0, 0.0], max: [1.0, 1.0, 0.0]}
steps:
  - settle: {}
  - load:
      increments: 3
      patches:
        - {name: punch, min: [0.01, 0.01, 0.02], max: [0.02, 0.02, 0.02], displacement: [0.0, 0.0, -0.003]}
  - load:
      increments: 2
      patches:
        - {name: pull, min: [0.04, 0.03, 0.02], max: [0.04, 0.03, 0.02], displacement: [0.0, 0.0, 0.001]}
  - release: {patches: [punch]}
  - reset: {}
  - load:
      increments: 1
      patches:
        - {name: last, min: [0.01, 0.01, 0.02], max: [0.01, 0.01, 0.02], displacement: [0.0, 0.0, 0.002]}
)";

// The patch is pushed through the block: cells turn inside out.
inline const std::string kInvertingScene = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.04, 0.04, 0.02]}
  spacing: 0.01
  model: six_spring
  material: {young_modulus: 10000.0}
  fixed:
    - {min: [-1.0, -1.0, 0.0], max: [1.0, 1.0, 0.0]}
steps:
  - load:
      increments: 4
      patches:
        - {name: punch, min: [0.02, 0.02, 0.02], max: [0.02, 0.02, 0.02], displacement: [0.0, 0.0, -0.1]}
)";

using Rows = std::vector<std::vector<std::string>>;

inline std::string readText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline Rows readCsv(const fs::path& path) {
  Rows rows;
  std::istringstream lines(readText(path));
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) rows.back().push_back(field);
  }
  return rows;
}

struct Outcome {
  int code = -1;
  std::string out;
  std::string err;
};

class Simulate : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "simulate_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    write("block.yaml", kScene);
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  // Runs the program in the test's folder.
  Outcome program(const std::string& arguments) const {
    const std::string command = "cd '" + folder_.string() + "' && '" + SIMULATE_PATH + "' " +
                                arguments + " >stdout.txt 2>stderr.txt";
    const int status = std::system(command.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, readText(folder_ / "stdout.txt"),
                    readText(folder_ / "stderr.txt")};
    return outcome;
  }
  std::vector<std::string> entries(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / name)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  void expectRefused(const std::string& arguments, const std::string& fragment) const {
    const Outcome outcome = program(arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find(fragment), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder_ / "out")) << arguments;
  }

  fs::path folder_;
};

}  // namespace robot_tissue
