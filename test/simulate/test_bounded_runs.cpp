// The program from outside: what bounds it, and that it ends whatever it is given.
#include <gtest/gtest.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace robot_tissue::test_bounded_runs {
namespace {

namespace fs = std::filesystem;

// Against hangs, not a measurement: seconds of a busy machine hold less.
constexpr rlim_t kProcessorSeconds = 40;

// Many increments of a press that takes long.
const std::string kLongScene = R"(tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}
  spacing: 0.005
  material: {young_modulus: 10000.0, poisson_ratio: 0.45}
  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]
solver: {method: newton}
steps:
  - load:
      increments: 10000
      patches:
        - {name: p, min: [0.04, 0.04, 0.05], max: [0.06, 0.06, 0.05], displacement: [0, 0, -0.01]}
)";

std::string readText(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

// Of all rows of increments.csv.
int iterationsIn(const fs::path& path) {
  std::istringstream rows(readText(path));
  std::string row, cell;
  std::getline(rows, row);
  int iterations = 0;
  while (std::getline(rows, row)) {
    std::istringstream cells(row);
    for (int column = 0; column < 5; ++column) std::getline(cells, cell, ',');
    iterations += std::stoi(cell);
  }
  return iterations;
}

class BoundedRun : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "bounded_run_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
    std::ofstream(folder_ / "long.yaml") << kLongScene;
  }
  void TearDown() override { fs::remove_all(folder_); }

  // Of the program, with its stderr in a file, and at most so much of the processor.
  pid_t start(std::vector<std::string> words) const {
    words.insert(words.begin(), SIMULATE_PATH);
    const std::string err = (folder_ / "stderr.txt").string();
    const pid_t child = fork();
    if (child != 0) return child;
    const rlimit most{kProcessorSeconds, kProcessorSeconds};
    setrlimit(RLIMIT_CPU, &most);
    for (const int number : {SIGINT, SIGHUP}) signal(number, SIG_DFL);  // who started it may ignore
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    if (freopen(err.c_str(), "w", stderr) == nullptr) _exit(127);
    execv(SIMULATE_PATH, arguments.data());
    _exit(127);
  }
  int statusOf(pid_t child) const {
    int status = -1;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    return status;
  }
  std::string err() const { return readText(folder_ / "stderr.txt"); }

  // Interrupts it when it has begun to compute.
  void expectNothingLeftBehind(int signal) const {
    const fs::path out = folder_ / "out" / "deep";
    const pid_t child = start({(folder_ / "long.yaml").string(), "--out", out.string()});
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!fs::exists(out) || fs::is_empty(out)) {
      ASSERT_LT(std::chrono::steady_clock::now(), deadline);
      std::this_thread::yield();
    }
    kill(child, signal);
    const int status = statusOf(child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal) << status;
    EXPECT_FALSE(fs::exists(folder_ / "out"));
  }

  fs::path folder_;
};

TEST_F(BoundedRun, LeavesNothingBehindWhenInterrupted) { expectNothingLeftBehind(SIGINT); }

TEST_F(BoundedRun, LeavesNothingBehindWhenTerminated) { expectNothingLeftBehind(SIGTERM); }

TEST_F(BoundedRun, LeavesNothingBehindWhenItsTerminalGoes) { expectNothingLeftBehind(SIGHUP); }

// The scene's own bound of an update is the same in a run that has one, too.
TEST_F(BoundedRun, KeepsTheBoundOfAnUpdateBesideThatOfTheRun) {
  std::string scene = kLongScene;
  scene.replace(scene.find("method: newton"), 14, "max_ms: 1.0e-3");
  scene.replace(scene.find("10000\n"), 5, "1");
  std::ofstream(folder_ / "short.yaml") << scene;
  for (const std::string seconds : {"1000", "1e9"}) {
    const fs::path out = folder_ / seconds;
    const int status = statusOf(start({(folder_ / "short.yaml").string(), "--out", out.string(),
                                       "--max-seconds", seconds, "--quiet"}));
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << status;
    EXPECT_NE(readText(out / "increments.csv").find(",LATE,"), std::string::npos);
  }
}

TEST_F(BoundedRun, WritesWhatItCameToWhenTheTimeIsOver) {
  const fs::path out = folder_ / "out";
  const int status = statusOf(start({(folder_ / "long.yaml").string(), "--out", out.string(),
                                     "--method", "layered", "--max-seconds", "0.2"}));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  const std::string told = err();
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 1) << told;
  EXPECT_NE(told.find("--max-seconds is over at steps[0].load increment "), std::string::npos)
      << told;
  const std::string rows = readText(out / "increments.csv");
  const auto lines = std::count(rows.begin(), rows.end(), '\n');
  EXPECT_GT(lines, 1);
  EXPECT_LT(lines, 10001);
}

// Hundreds of load steps, each a solve, before the only row.
TEST_F(BoundedRun, LeavesAToolOnItsWayWhenTheTimeIsOver) {
  std::string scene = kLongScene;
  scene.replace(scene.find("steps:"), std::string::npos, R"(
tools: [{name: probe, friction: 0.5, shapes: [{type: sphere, radius: 0.01}]}]
steps:
  - move: {tool: probe, from: {xyz: [0.02, 0.05, 0.061]}, to: {xyz: [0.09, 0.05, 0.054]}, increments: 1}
)");
  std::ofstream(folder_ / "drag.yaml") << scene;
  const fs::path out = folder_ / "out";
  const int status = statusOf(start(
      {(folder_ / "drag.yaml").string(), "--out", out.string(), "--max-seconds", "1", "--quiet"}));
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 3);
  EXPECT_NE(readText(out / "tools.csv").find("\n0,1,probe,"), std::string::npos);
}

// Off an edge that is dragged tissue slips once in each spacing: load steps of up to two hundred
// iterations, all of which come to balance.
TEST_F(BoundedRun, FollowsAnEdgeThatTissueSlipsOff) {
  std::ofstream(folder_ / "edge.yaml") << R"(
tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.1, 0.1, 0.05]}
  spacing: 0.005
  material: {young_modulus: 10000.0, poisson_ratio: 0.45}
  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]
tools:
  - {name: edge, friction: 0.3, shapes: [{type: box, size: [0.02, 0.02, 0.02], rpy: [0, 0.785398, 0]}]}
steps:
  - move: {tool: edge, from: {xyz: [0.035, 0.05, 0.0646]}, to: {xyz: [0.035, 0.05, 0.056142]}, increments: 34}
  - move: {tool: edge, to: {xyz: [0.047, 0.05, 0.056142]}, increments: 48}
)";
  const int status = statusOf(
      start({(folder_ / "edge.yaml").string(), "--out", (folder_ / "out").string(), "--quiet"}));
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << err();
}

// A support leaves a block less than half of its room: its touches would have to press harder than
// any tissue does. A tool that holds nodes hard, far away, does not make a shape of that.
TEST_F(BoundedRun, TakesNoShapeThatNoTissueBearsBesideARigidToolEither) {
  for (const std::string patch : {"conforming", "rigid"}) {
    std::ofstream(folder_ / "crushed.yaml") << R"(
tissue:
  shape: {type: box, min: [0, 0, 0], max: [0.06, 0.06, 0.04]}
  spacing: 0.02
  material: {young_modulus: 10000.0, poisson_ratio: 0.49, law: fung, stiffening: 300}
  fixed: [{min: [-1, -1, -1.0e-6], max: [1, 1, 1.0e-6]}]
supports: [{type: plane, point: [0, 0, 0.015], normal: [0, 0, -1], friction: 0}]
tools:
  - {name: probe, shapes: [{type: sphere, radius: 0.01}]}
  - {name: bystander, patch: )" << patch << R"(, shapes: [{type: sphere, radius: 0.01}]}
steps:
  - move: {tool: probe, from: {xyz: [-0.011, 0.03, 0.02]}, to: {xyz: [-0.007, 0.03, 0.02]}, increments: 2}
  - move: {tool: bystander, from: {xyz: [0.3, 0, 0.3]}, to: {xyz: [0.3, 0, 0.31]}, increments: 1}
)";
    const fs::path out = folder_ / patch;
    const int status =
        statusOf(start({(folder_ / "crushed.yaml").string(), "--out", out.string()}));
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 3) << err();
    EXPECT_NE(readText(out / "increments.csv").find("\n0,2,UNCONVERGED"), std::string::npos);
  }
}

TEST_F(BoundedRun, RefusesATimeThatIsNone) {
  for (const char* seconds : {"0", "-1", "nan", "inf", "1e300", "soon"}) {
    const fs::path out = folder_ / "out";
    const int status = statusOf(
        start({(folder_ / "long.yaml").string(), "--out", out.string(), "--max-seconds", seconds}));
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 2) << seconds;
    EXPECT_EQ(err(), std::string("simulate: --max-seconds = ") + seconds +
                         ": must be a number above 0 and at most 1e+09\n");
    EXPECT_FALSE(fs::exists(out));
  }
}

// Scenes that once crashed, hung or took minutes (test/data/repro/README.md).
TEST_F(BoundedRun, EndsForScenesThatOnceDidNot) {
  int scenes = 0;
  for (const auto& entry : fs::directory_iterator(ROBOT_TISSUE_SOURCE_DIR "/test/data/repro")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenes;
    const std::string name = entry.path().stem().string();
    const fs::path out = folder_ / name;
    const int status = statusOf(start({entry.path().string(), "--out", out.string()}));
    ASSERT_TRUE(WIFEXITED(status)) << entry.path() << ": signal " << WTERMSIG(status);
    const int code = WEXITSTATUS(status);
    EXPECT_TRUE(code == 0 || code == 2 || code == 3) << entry.path() << ": " << code << err();
    const bool has_bad_mesh = name.rfind("ply", 0) == 0 || name.rfind("glb", 0) == 0;
    EXPECT_TRUE(!has_bad_mesh || code == 2) << name << ": " << code;
    // Springs that tear without end end by iterations, those that a jam may take at most and some
    // more for each row.
    if (name == "tear_beside_a_tool_slow") {
      EXPECT_LT(iterationsIn(out / "increments.csv"), 5000);
      EXPECT_NE(err().find("it took far too many iterations"), std::string::npos);
    }
    // Once a jam without end; each of its time steps comes to balance.
    if (name == "jam_in_time_slow") {
      EXPECT_EQ(code, 0) << err();
    }
    // A push that meets its force nowhere looks for it no further.
    if (name == "push_in_a_jam_slow") {
      EXPECT_EQ(code, 3);
      EXPECT_NE(readText(out / "increments.csv").find("\n2,1,UNCONVERGED"), std::string::npos);
    }
    // Between three tools that crush the tissue ways are given up, and all rows are there. Tools
    // that are drawn away let go, none comes in anew, and once all are away that is OK.
    if (name != "three_tools_slow_h5") continue;
    EXPECT_EQ(code, 3);
    EXPECT_NE(err().find("is followed no further on its way"), std::string::npos);
    EXPECT_EQ(err().find("come in anew"), std::string::npos) << err();
    const std::string rows = readText(out / "increments.csv");
    for (const char* row : {"\n11,1,UNCONVERGED", "\n11,2,OK", "\n12,2,OK"}) {
      EXPECT_NE(rows.find(row), std::string::npos) << row;
    }
    for (const char* row :
         {"\n10,2,t0,0,0,0,0,0,0,0,0", "\n11,2,t1,0,0,0,0,0,0,0,0", "\n12,2,t2,0,0,0,0,0,0,0,0"}) {
      EXPECT_NE(readText(out / "tools.csv").find(row), std::string::npos) << row;
    }
  }
  EXPECT_GE(scenes, 14);
}

// Cases of a seed, as many as a minute has time for: a failed one can be run again by its number.
TEST_F(BoundedRun, EndsForMutatedScenes) {
  const std::string command =
      "/usr/bin/python3 " ROBOT_TISSUE_SOURCE_DIR "/scripts/mutate_scenes --simulate " SIMULATE_PATH
      " --seed 1 --cases 200 --seconds 60 --max-seconds 4";
  const int status = std::system(command.c_str());
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace robot_tissue::test_bounded_runs
