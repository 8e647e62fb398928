// A frozen hash of results guards against silent change: small scenes (test/data/golden/*.yaml)
// give, bit for bit, what they gave when hashes.csv beside them was written, with any number of
// threads.
//
// The loops are compiled once for each kind of processor, and compilers and libraries of
// mathematics round otherwise: hashes are of one platform each. On a platform without hashes only
// the threads are compared, and the test of frozen ones skips itself.
//
// Where a change of results is meant, renew the hashes of this platform and commit them with the
// reason (those of other platforms go out: they are of the results before):
//   ROBOT_TISSUE_RENEW_GOLDEN=1 build/devel/lib/robot_tissue/simulate_test --gtest_filter='Golden*'
#include <gnu/libc-version.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <type_traits>
#include <vector>

#include "robot_tissue/scene/scene_parser.h"
#include "run_scene.h"

namespace robot_tissue::test_golden {
namespace {

namespace fs = std::filesystem;

using Hashes = std::map<std::string, std::string>;  // by scene

const fs::path kFolder = fs::path(ROBOT_TISSUE_SOURCE_DIR) / "test/data/golden";
const std::string kHeader = "platform;scene;hash";

// FNV-1a, 64 bits, of the numbers as they are in memory.
class Hash {
 public:
  template <typename Number>
  void add(const Number& number) {
    static_assert(std::is_arithmetic<Number>::value || std::is_enum<Number>::value,
                  "a number without padding");
    unsigned char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    for (const unsigned char byte : bytes) hash_ = (hash_ ^ byte) * 0x100000001b3U;
  }
  void add(const Vec3& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }
  void add(const std::string& text) {
    for (const char letter : text) add(letter);
    add(text.size());
  }
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

 private:
  std::uint64_t hash_ = 0xcbf29ce484222325U;
};

void add(const PatchAnswer& answer, Hash& hash) {
  hash.add(answer.force);
  hash.add(answer.torque);
  hash.add(answer.displacement);
}

// All but the time that it took.
void add(const SolveReport& report, Hash& hash) {
  hash.add(report.status);
  hash.add(report.iterations);
  hash.add(report.residual);
  hash.add(report.error_estimate);
  hash.add(report.active_nodes);
  hash.add(report.layers);
  hash.add(report.volume_ratio);
  hash.add(report.inverted_cells);
  for (const PatchAnswer& answer : report.patches) add(answer, hash);
}

std::string hashOf(const RunResult& result) {
  Hash hash;
  for (const IncrementRow& row : result.increments) add(row.report, hash);
  for (const PatchRow& row : result.patches) {
    hash.add(row.patch);
    add(row.answer, hash);
  }
  for (const ToolRow& row : result.tools) {
    hash.add(row.tool);
    hash.add(row.force);
    hash.add(row.torque);
    hash.add(row.contacts);
    hash.add(row.max_penetration);
  }
  for (const Vec3& moved : result.displacement) hash.add(moved);
  for (const Vec3& vertex : result.vertices) hash.add(vertex);
  for (const auto& triangle : result.triangles) {
    for (const int corner : triangle) hash.add(corner);
  }
  for (const std::string& remark : result.remarks) hash.add(remark);
  return hash.text();
}

// Also after each step, which the one that follows may undo.
std::string hashOf(const fs::path& scene, int threads) {
  SolverOverrides overrides;
  overrides.threads = std::to_string(threads);
  Scene parsed = loadScene(scene.string(), overrides);
  parsed.remarks.clear();  // methods that have one thread say so
  Hash steps;
  const RunResult result = runScene(parsed, {}, [&](int, const Tissue& tissue) {
    for (const Vec3& moved : tissue.state().displacement) steps.add(moved);
  });
  EXPECT_FALSE(result.increments.empty()) << scene;
  return steps.text() + hashOf(result);
}

std::vector<fs::path> scenes() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(kFolder)) {
    if (entry.path().extension() == ".yaml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// As the loader chooses among the clones of core/simd/vector_clones.h.
std::string kernels() {
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
  __builtin_cpu_init();
  if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
  if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
  return "x86-64";
#else
  return "kernels made once";
#endif
}

std::string platform() {
  return kernels() + ", compiler " __VERSION__ ", libc " + gnu_get_libc_version() +
         ", " ROBOT_TISSUE_BUILD;
}

Hashes frozenHashes() {
  Hashes hashes;
  std::ifstream file(kFolder / "hashes.csv");
  std::string line;
  std::getline(file, line);
  EXPECT_EQ(line, kHeader);
  while (std::getline(file, line)) {
    const std::size_t scene = line.find(';') + 1;
    const std::size_t hash = line.find(';', scene) + 1;
    if (line.substr(0, scene - 1) != platform()) continue;
    hashes[line.substr(scene, hash - 1 - scene)] = line.substr(hash);
  }
  return hashes;
}

void renew(const Hashes& hashes) {
  std::ofstream file(kFolder / "hashes.csv");
  file << kHeader << '\n';
  for (const auto& [scene, hash] : hashes)
    file << platform() << ';' << scene << ';' << hash << '\n';
  ASSERT_TRUE(file.flush().good()) << kFolder / "hashes.csv";
}

// Per scene, with one thread.
const Hashes& hashesNow() {
  static const Hashes all = [] {
    Hashes hashes;
    for (const fs::path& scene : scenes()) hashes[scene.stem().string()] = hashOf(scene, 1);
    return hashes;
  }();
  return all;
}

TEST(Golden, AnyNumberOfThreadsGivesTheSameResults) {
  for (const fs::path& scene : scenes()) {
    const std::string name = scene.stem().string();
    EXPECT_EQ(hashOf(scene, 2), hashesNow().at(name)) << name << ": 2 threads, other bits than 1";
    EXPECT_EQ(hashOf(scene, 7), hashesNow().at(name)) << name << ": 7 threads, other bits than 1";
  }
  ASSERT_GE(hashesNow().size(), 10U) << kFolder;
}

TEST(Golden, ResultsAreAsFrozen) {
  if (std::getenv("ROBOT_TISSUE_RENEW_GOLDEN") != nullptr) return renew(hashesNow());
  const Hashes frozen = frozenHashes();
  if (frozen.empty()) GTEST_SKIP() << "no frozen hashes for this platform (" << platform() << ")";
  for (const auto& [scene, hash] : hashesNow()) {
    EXPECT_TRUE(frozen.count(scene) > 0 && frozen.at(scene) == hash)
        << scene << " gives other bits than frozen in test/data/golden/hashes.csv; how to renew "
        << "them when that is meant: test/simulate/test_golden.cpp";
  }
  EXPECT_EQ(frozen.size(), hashesNow().size()) << "a scene with a hash is gone";
}

TEST(Golden, OtherBitsGiveAnotherHash) {
  RunResult result;
  result.displacement = {Vec3(0.1, 0.2, 0.3)};
  const std::string hash = hashOf(result);
  EXPECT_EQ(hashOf(result), hash);
  result.displacement[0].y() = std::nextafter(0.2, 1.0);
  EXPECT_NE(hashOf(result), hash);
}

}  // namespace
}  // namespace robot_tissue::test_golden
