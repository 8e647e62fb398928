// What is refused before it fills the memory or never ends: numbers without a meaning, lattices
// that do not fit, texts that stand for too much. And what only looks so, and is taken.
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "../core/mesh_fixtures.h"
#include "bad_scene.h"
#include "mesh_files.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/patch_name.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue::test_limits {
namespace {

namespace fs = std::filesystem;

// A tissue of 0.1 m at a spacing of 10 mm: lengths from 10 um to 1 km.
class MeaninglessNumber : public ::testing::TestWithParam<BadScene> {};

TEST_P(MeaninglessNumber, IsRefusedWithItsRange) {
  const std::string& from = GetParam().from;
  const bool of_tools = kRunnerScene.find(from) == std::string::npos;
  expectRefusal(of_tools ? kToolScene : kRunnerScene, SceneUser::kRunner, GetParam());
}

const std::vector<BadScene> kMeaningless = {
    {"HugeSphere",
     "sphere, radius: 0.01",
     "sphere, radius: 1.0e+15",
     {"tools[0].shapes[0].radius = 1.0e+15", "a number from 1e-05 to 1000 in m"}},
    {"TinySphere",
     "sphere, radius: 0.01",
     "sphere, radius: 1.0e-9",
     {"tools[0].shapes[0].radius = 1.0e-9", "from 1e-05"}},
    {"HugePadding",
     "padding: 0.0005",
     "padding: 1.0e+6",
     {"shapes[0].padding = 1.0e+6", "to 1000"}},
    {"ThinBox",
     "size: [0.01, 0.002, 0.02]",
     "size: [0.01, 1.0e-12, 0.02]",
     {"tools[2].jaws[0].shapes[0].size[1] = 1.0e-12", "from 1e-05"}},
    {"FarShape",
     "xyz: [0.01, 0.0, 0.0]",
     "xyz: [1.0e+12, 0.0, 0.0]",
     {"shapes[0].xyz[0] = 1.0e+12", "from -1000 to 1000 in m"}},
    {"FarPlace",
     "to: {xyz: [0.05, 0.05, 0.055]}",
     "to: {xyz: [0.05, 0.05, 1.0e+9]}",
     {"steps[0].move.to.xyz[2] = 1.0e+9", "from -1000 to 1000 in m"}},
    {"ManyTurns",
     "rpy: [0.0, 0.0, 1.57",
     "rpy: [0.0, 1.0e+14, 1.57",
     {"move.from.rpy[1] = 1.0e+14", "to 10000 in rad"}},
    {"WideJaws", "opening: 0.01", "opening: 1.0e+9", {"from.opening = 1.0e+9", "0 to 1000 in m"}},
    {"WideGap", "open_gap: 0.009", "open_gap: 1.0e+9", {"open_gap = 1.0e+9", "to 1000 in m"}},
    {"TinyGap", "close_gap: 0.004", "close_gap: 1.0e-12", {"close_gap = 1.0e-12", "from 1e-05"}},
    {"HugePush",
     "force: [0.0, 0.5, -1.0]",
     "force: [0.0, 0.5, -1.0e+12]",
     {"push.force[2] = -1.0e+12", "to 1e+09 in N"}},
    {"TinyPush",
     "force: [0.0, 0.5, -1.0]",
     "force: [0.0, 0.0, -1.0e-12]",
     {"push.force = [0.0, 0.0, -1.0e-12]", "1e-09"}},
    {"HugeMaxForce", "max_force: 5.0", "max_force: 1.0e+12", {"max_force = 1.0e+12", "in N"}},
    {"HugeFriction", "friction: 0.4", "friction: 1.0e+9", {"tools[0].friction", "0 to 1000"}},
    {"FarPlane",
     "point: [0.05, 0.04, -0.01]",
     "point: [0.05, 0.04, -1.0e+9]",
     {"supports[0].point[2] = -1.0e+9", "from -1000 to 1000 in m"}},
    {"FlatSupport",
     "max: [0.12, 0.1, 0.06]",
     "max: [0.12, 0.1, 1.0e-9]",
     {"supports[1] = {type: box", "thinner than 1e-05 m"}},
    {"TinyTolerance",
     "tolerance: 0.02",
     "tolerance: 1.0e-300",
     {"solver.tolerance = 1.0e-300", "from 1e-09 to 0.5"}},
    {"SoftAsNothing",
     "young_modulus: 10000.0",
     "young_modulus: 1.0e-9",
     {"tissue.material.young_modulus = 1.0e-9", "from 0.001"}},
    {"HardAsNothing",
     "young_modulus: 10000.0",
     "young_modulus: 1.0e+15",
     {"tissue.material.young_modulus = 1.0e+15", "to 1e+13 in Pa"}},
    {"Contrast",
     "young_modulus: 1.0e+5",
     "young_modulus: 1.0e+11",
     {"tissue.regions[0].young_modulus = 1.0e+11",
      "within a factor of 1000000 of tissue.material's, 10000"}},
    {"Dense", "density: 900.0", "density: 1.0e+9", {"tissue.material.density", "to 1000000 in kg"}},
    {"Heavy", "-9.81", "-1.0e+9", {"tissue.gravity[2] = -1.0e+9", "to 10000 in m/s^2"}},
    {"Weightless", "-9.81", "-1.0e-9", {"tissue.gravity = [0.0, 0.0, -1.0e-9]", "zero or"}},
    {"PulledFar",
     "[free, 0.0, -0.005]",
     "[free, 0.0, -11]",
     {"patches[0].displacement[2] = -11", "from -10 to 10 in m"}},
    {"PulledHard", "[0.0, 0.5, 1.0]", "[0.0, 0.5, 1.0e+12]", {"force[2] = 1.0e+12", "in N"}},
    {"PulledByNothing", "[0.0, 0.5, 1.0]", "[0.0, 0.0, 1.0e-300]", {"force = [0.0", "zero or"}},
    {"FarCut", "[0.055, 0.08, 0.051]", "[0.055, 0.08, 1.0e+9]", {"corners[2][2]", "1000 in m"}},
    {"Patience", "max_ms: 8", "max_ms: 1.0e+12", {"solver.max_ms = 1.0e+12", "to 1e+09 in ms"}},
    {"FarTissue",
     "min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}\n  spacing",
     "min: [1.0e+6, 0.0, 0.0], max: [1000000.1, 0.1, 0.05]}\n  spacing",
     {"tissue.spacing = 0.01", "1000000.1 m from its frame's origin", "1000000 spacings"}},
    {"NumberInQuotes", "friction: 0.4", "friction: \"0.4\"", {"friction = \"0.4\"", "a number"}},
    {"NumberByTruth", "friction: 0.4", "friction: true", {"friction = true", "a number"}},
    {"TruthInQuotes",
     "force: [0.0, 0.5, 1.0]",
     "force: [0.0, 0.5, 1.0], turns: \"false\"",
     {"turns = \"false\"", "must be true or false"}},
};

INSTANTIATE_TEST_SUITE_P(Limits, MeaninglessNumber, ::testing::ValuesIn(kMeaningless), caseName);

TEST(Limits, WhatOnlyLooksMeaninglessIsTaken) {
  const auto taken = [](const std::string& scene, const std::string& from, const std::string& to) {
    const std::string text = replaced(scene, from, to);
    ASSERT_NE(text, "") << from;
    EXPECT_EQ(refusal(text, SceneUser::kRunner), "") << to;
  };
  taken(kRunnerScene, "min: [-1.0, -1.0, -1.0e-6]", "min: [-1.0e+9, -1.0e+9, -1.0e+9]");
  taken(kRunnerScene, "gravity: [0.0, 0.0, -9.81]", "gravity: [6.0e-16, 0.0, -9.81]");
  taken(kRunnerScene, "gravity: [0.0, 0.0, -9.81]", "gravity: [0.0, 0.0, 0.0]");
  taken(kRunnerScene, "force: [0.0, 0.5, 1.0]", "force: [0, 0, 0]");
  taken(kToolScene, "friction: 0.4", "friction: 0.0");
  taken(kToolScene, "padding: 0.0005", "padding: 0.0");
  taken(kToolScene, "max_force: 5.0", "max_force: 0.0");
  taken(kToolScene, "radius: 0.01", "radius: 10.0");  // as good as a plane
  taken(kToolScene, "from: {xyz: [0.05, 0.05, 0.07]", "from: {xyz: [2.0, -30.0, 5.0]");
}

// Files of a machine, where a process of its own is in a container.
class MachineFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "limits_test_XXXXXX").string();
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    root_ = pattern;
    write("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    8000 kB\n");
  }
  void TearDown() override { fs::remove_all(root_); }
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  double freeBytes() const { return freeMemory(root_.string()); }

  fs::path root_;
};

TEST_F(MachineFiles, TellWhatTheMachineHasLeft) { EXPECT_EQ(freeBytes(), 8000.0 * 1024.0); }

TEST_F(MachineFiles, TellWhatAContainerOfVersionTwoLeaves) {
  write("proc/self/cgroup", "0::/pod/box\n");
  write("sys/fs/cgroup/pod/box/memory.max", "max\n");
  write("sys/fs/cgroup/pod/memory.max", "5000000\n");
  write("sys/fs/cgroup/pod/memory.current", "3000000\n");
  write("sys/fs/cgroup/pod/memory.stat", "anon 1\ninactive_file 1000000\n");
  EXPECT_EQ(freeBytes(), 3000000.0);
  write("sys/fs/cgroup/memory.max", "3500000\n");  // seen from within
  write("sys/fs/cgroup/memory.current", "3000000\n");
  EXPECT_EQ(freeBytes(), 500000.0);
}

TEST_F(MachineFiles, TellWhatAContainerOfVersionOneLeaves) {
  write("proc/self/cgroup", "5:cpu,cpuacct:/pod\n4:memory:/pod\n0::/\n");
  write("sys/fs/cgroup/memory/pod/memory.limit_in_bytes", "4000000\n");
  write("sys/fs/cgroup/memory/pod/memory.usage_in_bytes", "5000000\n");
  EXPECT_EQ(freeBytes(), 0.0);
  write("sys/fs/cgroup/memory/pod/memory.stat", "inactive_file 7\ntotal_inactive_file 4000000\n");
  EXPECT_EQ(freeBytes(), 3000000.0);
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif
constexpr char kOwnHeap[] = "the sanitizer has a heap of its own";

// As where surgery makes large things anew between small ones that stay.
TEST(Memory, GapsOfTheHeapAreGivenBack) {
  if (kSanitized) GTEST_SKIP() << kOwnHeap;
  constexpr std::size_t kBlocks = 2000, kBytes = 20000;
  std::vector<std::unique_ptr<std::string>> stay;
  {
    std::vector<std::unique_ptr<std::string>> go;
    for (std::size_t i = 0; i < kBlocks; ++i) {
      go.push_back(std::make_unique<std::string>(kBytes, 'a'));
      stay.push_back(std::make_unique<std::string>(100, 'b'));
    }
  }
  const double before = residentMemory();
  giveBackFreeMemory();
  EXPECT_LT(residentMemory(), before - 0.5 * kBlocks * kBytes);
  EXPECT_EQ(*stay.back(), std::string(100, 'b'));
}

// As of frames that are drawn one after the other.
TEST(Memory, WhatIsKeptIsNotAskedOfTheSystemAgain) {
  if (kSanitized) GTEST_SKIP() << kOwnHeap;
  constexpr std::size_t kBytes = 4 << 20;
  constexpr long kPages = kBytes / 4096;
  const auto faultsOfAFrame = [] {
    rusage before{}, after{};
    getrusage(RUSAGE_SELF, &before);
    const std::string frame(kBytes, 'a');
    EXPECT_EQ(frame.back(), 'a');
    getrusage(RUSAGE_SELF, &after);
    return after.ru_minflt - before.ru_minflt;
  };
  keepFreeMemory();
  faultsOfAFrame();
  for (int frame = 0; frame < 5; ++frame) EXPECT_LT(faultsOfAFrame(), kPages / 10);
}

TEST(Memory, HeapInUseIsWhatSomebodyHolds) {
  if (kSanitized) GTEST_SKIP() << kOwnHeap;
  constexpr double kBlocks = 1000.0, kBytes = 20000.0;
  const double before = heapInUse();
  {
    std::vector<std::string> held;
    for (double i = 0.0; i < kBlocks; ++i) held.emplace_back(static_cast<std::size_t>(kBytes), 'a');
    EXPECT_GE(heapInUse(), before + kBlocks * kBytes);
    EXPECT_LT(heapInUse(), before + 1.05 * kBlocks * kBytes);
  }
  EXPECT_NEAR(heapInUse(), before, 1000.0);
}

TEST(Memory, ALimitOfTheProcessCounts) {
  if (kSanitized) GTEST_SKIP() << kOwnHeap;
  const auto limited = [](auto resource) {
    constexpr rlim_t kMost = rlim_t{1} << 30;
    const rlimit limit{kMost, kMost};
    setrlimit(resource, &limit);
    _exit(freeMemory() > 0.0 && freeMemory() < static_cast<double>(kMost) ? 0 : 1);
  };
  EXPECT_EXIT(limited(RLIMIT_AS), ::testing::ExitedWithCode(0), "");
  EXPECT_EXIT(limited(RLIMIT_DATA), ::testing::ExitedWithCode(0), "");
}

TEST(Memory, NewtonTakesMoreANodeAndMoreSoForLargerLattices) {
  EXPECT_GE(memoryOf(4851, "newton"), 105e6);  // measured
  EXPECT_GE(memoryOf(35301, "newton"), 1190e6);
  EXPECT_LT(memoryOf(35301, "newton"), 2.0 * 1190e6);
  EXPECT_LT(memoryOf(35301, "layered"), 0.1 * memoryOf(35301, "newton"));
  for (const char* method : {"layered", "newton"}) {
    const double most = mostNodes(1e9, method);
    EXPECT_LE(memoryOf(most, method), 1e9);
    EXPECT_GT(memoryOf(most + 2.0, method), 1e9);
  }
  EXPECT_EQ(mostNodes(0.0, "newton"), 0.0);
}

// The lattice numbers a node's cell with 27 bits, its springs with 29, of three a node.
TEST(Memory, NoSceneHasMoreCellsOrSpringsThanCanBeNumbered) {
  const double most = mostNodes(1e30, "layered");
  EXPECT_LT(most, 1 << 27);
  EXPECT_LT(3.0 * most, 1 << 29);
}

// An oblique rod of 4 mm: next to all of the grid around it is empty, and arrays of methods go over
// the whole of it. Measured: 1,840 MB, 1,450 and 290 at a spacing of 1.5 mm.
TEST(Memory, TheGridAroundAMeshCountsByMethod) {
  TissueConfig tissue;
  tissue.spacing = 0.0015;
  auto rod = std::make_shared<TriangleMesh>();
  rod->vertices = {Vec3::Zero(), Vec3::Constant(0.291), Vec3(0.291, 0.291, 0.287)};
  rod->triangles = {{0, 1, 2}};
  tissue.mesh = rod;
  for (const auto& [method, bytes] :
       {std::pair{"layered", 1840e6}, std::pair{"vbd", 1450e6}, std::pair{"newton", 290e6}}) {
    EXPECT_GE(memoryAround(tissue, method), bytes) << method;
    EXPECT_LT(memoryAround(tissue, method), 1.3 * bytes) << method;
  }
}

// A block of 59,049 nodes took 78 MB more with a membrane around it.
TEST(Memory, MembranesCount) {
  TissueConfig tissue;
  tissue.shape.min() = Vec3::Zero();
  tissue.shape.max() = Vec3(0.2, 0.2, 0.02);
  tissue.spacing = 0.0025;
  EXPECT_EQ(memoryAround(tissue, "layered"), 0.0);
  tissue.membranes.emplace_back();
  EXPECT_GE(memoryAround(tissue, "layered"), 78e6);
  EXPECT_LT(memoryAround(tissue, "layered"), 1.5 * 78e6);
}

// The lattice of a machine's memory by one method is too large for another.
TEST(Memory, TheMethodsOwnBoundHolds) {
  const double cells = std::round(std::cbrt(1.5 * mostNodes(freeMemory(), "newton")));
  const std::string size = std::to_string(0.01 * cells);
  const std::string scene = "tissue:\n  shape: {type: box, min: [0, 0, 0], max: [" + size + ", " +
                            size + ", " + size +
                            "]}\n  spacing: 0.01\n  material: {young_modulus: 1.0e+4}\n";
  EXPECT_EQ(refusal(scene, SceneUser::kRunner), "");
  const std::string message = refusal(scene + "solver: {method: newton}\n", SceneUser::kRunner);
  for (const char* part : {"block.yaml:3: tissue.spacing = 0.01", "with method newton where ",
                           " MB are free: must give at most "}) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
}

// One vertex in the wrong place makes a grid and a surface that nobody meant.
TEST(Memory, OneCorruptedVertexIsBounded) {
  TriangleMesh box = boxMesh(Vec3::Zero(), Vec3::Constant(0.1));
  box.vertices[7] = Vec3(3000.0, 3000.0, 3000.0);
  writeFile("spike.stl", stlText(box));
  SceneSource source;
  source.name = "block.yaml";
  source.folder = meshFolder();
  std::string message;
  try {
    parseScene(YAML::Load("tissue: {shape: {type: mesh, resource: spike.stl}, spacing: 0.005, "
                          "material: {young_modulus: 1.0e+4}}"),
               source);
  } catch (const InputError& error) {
    message = error.what();
  }
  EXPECT_NE(message.find(
                "must be larger, or the mesh, 3000 m across, smaller (tissue.shape.scale: 0.001"),
            std::string::npos)
      << message;
}

class SceneText : public MachineFiles {
 protected:
  std::string refused(const std::string& text) const {
    write("scene.yaml", text);
    return refusedFile((root_ / "scene.yaml").string());
  }
  static std::string refusedFile(const std::string& path) {
    try {
      loadScene(path);
    } catch (const InputError& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error.what();
    }
    return "";
  }
  static void expectPart(const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  }
};

TEST_F(SceneText, AliasesOfAliasesAreRefused) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string below = "*a" + std::to_string(i - 1);
    text += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + below;
    for (int k = 0; k < 8; ++k) text += ", " + below;
    text += "]\n";
  }
  expectPart(refused(text), "has more than 1000000 values");
  expectPart(refused("steps: &s [*s]\n"), "an alias stands within what it stands for");
}

TEST_F(SceneText, DeepNestingIsRefused) {
  const std::string allowed = "deep, must not";
  expectPart(refused("tissue: " + std::string(100000, '[')), allowed);
  std::string blocks;
  for (int i = 0; i < 20000; ++i) blocks += "- ";
  expectPart(refused(blocks), allowed);
  expectPart(refused("a: " + std::string(99, '[') + std::string(99, ']')), "unknown key");
}

// Mistakes that editors make: the parser only says that something is illegal.
TEST_F(SceneText, WhatYamlIsToldWhereItIsNone) {
  for (const std::string text : {"tissue:\n\tspacing: 0.01\n",
                                 "tissue:\n  spacing:0.01\n  model: elastic\n", "steps: [\n"}) {
    expectPart(refused(text), "not YAML: ");
    expectPart(refused(text), ", must be YAML: indented by blanks, never tabs");
  }
}

TEST_F(SceneText, AKeyWithoutALetterIsNamed) {
  expectPart(refused("\"\": 1\n"), "\"\" = 1: unknown key");
}

// Logs, and services' answers that a Python program decodes.
TEST(ValueText, HasOnlyWhatATerminalAndADecoderTake) {
  EXPECT_EQ(onOneLine("a\nb\tc\x7f"), "a\\nb?c?");
  EXPECT_EQ(onOneLine("pr\xf6"
                      "be \xe2\x88\x92 \xc3\xa9"),
            "pr?be \xe2\x88\x92 \xc3\xa9");
  EXPECT_EQ(onOneLine("\xc2\x9b"
                      "31m \xe2\x80\xa8 \xed\xa0\x80"),
            "?31m ? ???");
  EXPECT_TRUE(isUtf8(onOneLine("\xf0\x9f\x98")));
  EXPECT_EQ(reasonText(std::runtime_error("is \"lost\" .\n ")), "is \"lost\" .");
}

TEST_F(SceneText, OnlyRegularFilesUpToALimitAreRead) {
  expectPart(refusedFile("/dev/zero"),
             "/dev/zero: is a pipe or a device, no regular file: must be");
  write("large.yaml", "tissue:");
  fs::resize_file(root_ / "large.yaml", kLargestSceneFile + 1);
  expectPart(refusedFile((root_ / "large.yaml").string()), "has more than 10 MB: must be");
}

TEST(PatchName, IsShortPrintedAndOneField) {
  for (const char* good : {"punch", "left jaw", "Rand-1", "m\xC3\xA4rz", "1"}) {
    EXPECT_EQ(patchNameFault(good), "") << good;
  }
  for (const std::string& bad :
       {std::string(), std::string(65, 'a'), std::string(1000000, 'a'), std::string("a,b"),
        std::string("a\"b"), std::string("a\nb"), std::string("a\0b", 3), std::string("\xC3"),
        std::string("\xFF"), std::string("\xED\xA0\x80"), std::string("\xC0\xAF")}) {
    EXPECT_NE(patchNameFault(bad), "");
    try {
      requirePatchName(bad);
      ADD_FAILURE() << "taken";
    } catch (const InputError& error) {
      EXPECT_LT(std::string(error.what()).size(), 200U);
      EXPECT_EQ(std::string(error.what()).rfind("name = \"", 0), 0U);
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_limits
