// The runner as a program and as a function: exit codes, files and their content.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>

#include "result_text.h"
#include "simulate_program.h"

namespace robot_tissue::test_simulate {
namespace {

TEST_F(Simulate, WritesAllFilesAndNothingElse) {
  const Outcome outcome = program("block.yaml --out out/deep/");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.out + outcome.err, "");
  EXPECT_EQ(entries("out/deep"), kFiles);
  EXPECT_EQ(entries("out"), std::vector<std::string>({"deep"}));
}

TEST_F(Simulate, HasARowForEachIncrement) {
  ASSERT_EQ(program("block.yaml --out out").code, 0);
  const Rows rows = readCsv(folder_ / "out/increments.csv");
  const std::vector<std::array<std::string, 2>> expected = {{"step", "increment"},
                                                            {"0", "1"},
                                                            {"1", "1"},
                                                            {"1", "2"},
                                                            {"1", "3"},
                                                            {"2", "1"},
                                                            {"2", "2"},
                                                            {"3", "1"},
                                                            {"4", "1"},
                                                            {"5", "1"}};
  ASSERT_EQ(rows.size(), expected.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].size(), 13U);
    EXPECT_EQ(rows[i][0], expected[i][0]);
    EXPECT_EQ(rows[i][1], expected[i][1]);
    EXPECT_EQ(rows[i][2], i > 0 ? "OK" : "status");
  }
  EXPECT_EQ(rows[8][9], "1");             // after the reset the volume is the rest volume
  EXPECT_LT(std::stod(rows[4][9]), 1.0);  // the punch presses the block together
}

TEST_F(Simulate, HasARowForEachStandingPatchAndItsWay) {
  ASSERT_EQ(program("block.yaml --out out").code, 0);
  const Rows rows = readCsv(folder_ / "out/patches.csv");
  const std::vector<std::array<std::string, 3>> expected = {
      {"1", "1", "punch"}, {"1", "2", "punch"}, {"1", "3", "punch"},
      {"2", "1", "punch"}, {"2", "1", "pull"},  {"2", "2", "punch"},
      {"2", "2", "pull"},  {"3", "1", "pull"},  {"5", "1", "last"}};
  ASSERT_EQ(rows.size(), expected.size() + 1);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_EQ(rows[i + 1].size(), 9U);
    for (std::size_t field = 0; field < 3; ++field)
      EXPECT_EQ(rows[i + 1][field], expected[i][field]);
  }
  for (int increment = 1; increment <= 3; ++increment) {
    const auto& row = rows[static_cast<std::size_t>(increment)];
    EXPECT_NEAR(std::stod(row[8]), -0.001 * increment, 1e-12);
    EXPECT_LT(std::stod(row[5]), 0.0);  // pressing down takes a force downwards
  }
  EXPECT_GT(std::stod(rows[9][5]), 0.0);
}

TEST_F(Simulate, HasEveryNodeWithXFastestAndWhereItWent) {
  ASSERT_EQ(program("block.yaml --out out").code, 0);
  const Rows rows = readCsv(folder_ / "out/nodes.csv");
  ASSERT_EQ(rows.size(), 1U + 5 * 4 * 3);
  EXPECT_EQ(rows[0], std::vector<std::string>({"x", "y", "z", "ux", "uy", "uz"}));
  int moved = 0;
  for (std::size_t node = 0; node + 1 < rows.size(); ++node) {
    const auto& row = rows[node + 1];
    ASSERT_EQ(row.size(), 6U);
    EXPECT_NEAR(std::stod(row[0]), 0.01 * static_cast<double>(node % 5), 1e-12);
    EXPECT_NEAR(std::stod(row[1]), 0.01 * static_cast<double>(node / 5 % 4), 1e-12);
    EXPECT_NEAR(std::stod(row[2]), 0.01 * static_cast<double>(node / 20), 1e-12);
    EXPECT_TRUE(node >= 20 || row[5] == "0") << "a fixed node moved";
    if (std::stod(row[5]) > 0.0) ++moved;
  }
  EXPECT_GT(moved, 1);
  EXPECT_NEAR(std::stod(rows[1 + 46][5]), 0.002, 1e-12);  // node (1, 1, 2): the patch "last"
}

float floatAt(const std::string& bytes, std::size_t at) {
  float value = 0.0F;  // on a little-endian machine, as all of today's
  std::memcpy(&value, bytes.data() + at, sizeof(value));
  return value;
}

TEST_F(Simulate, HasTheDeformedSurfaceAsClosedBinaryStl) {
  ASSERT_EQ(program("block.yaml --out out").code, 0);
  const std::string stl = readText(folder_ / "out/surface.stl");
  ASSERT_GT(stl.size(), 84U);
  EXPECT_NE(stl.compare(0, 5, "solid"), 0);
  const std::size_t triangles = (stl.size() - 84) / 50;
  std::uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, sizeof(count));
  ASSERT_EQ(count, triangles);
  ASSERT_EQ(stl.size(), 84 + 50 * triangles);
  double volume = 0.0;
  double highest = 0.0;
  for (std::size_t i = 0; i < triangles; ++i) {
    std::array<Vec3, 4> v;  // normal, corners
    for (std::size_t part = 0; part < 4; ++part) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        v[part][static_cast<Eigen::Index>(axis)] =
            static_cast<double>(floatAt(stl, 84 + 50 * i + 12 * part + 4 * axis));
      }
    }
    const Vec3 normal = (v[2] - v[1]).cross(v[3] - v[1]).normalized();
    EXPECT_LT((normal - v[0]).norm(), 1e-3);
    volume += v[1].dot(v[2].cross(v[3])) / 6.0;
    highest = std::max({highest, v[1].z(), v[2].z(), v[3].z()});
  }
  const double rest_volume = 0.04 * 0.03 * 0.02;
  const double ratio = std::stod(readCsv(folder_ / "out/increments.csv").back()[9]);
  EXPECT_NEAR(volume / rest_volume, ratio, 1e-5);
  EXPECT_NEAR(highest, 0.022, 1e-6);
}

TEST_F(Simulate, NumbersKeepAllTheirDigits) {
  RunResult result;
  result.rest = {Vec3(0.1, 1.0 / 3.0, 0.0)};
  result.displacement = {Vec3(1e-300, -2.0 / 3.0, 0.0)};
  const std::string csv = nodesCsv(result);
  EXPECT_NE(csv.find("0.10000000000000001,0.33333333333333331,0,"), std::string::npos) << csv;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  double ux = 0.0;
  double uy = 0.0;
  ASSERT_EQ(
      std::sscanf(csv.c_str() + csv.find('\n') + 1, "%lf,%lf,%lf,%lf,%lf", &x, &y, &z, &ux, &uy),
      5);
  EXPECT_EQ(y, 1.0 / 3.0);
  EXPECT_EQ(uy, -2.0 / 3.0);
}

TEST_F(Simulate, NumbersThatAreNotFiniteAreNeverWritten) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    RunResult result;
    result.rest = {Vec3::Zero()};
    result.displacement = {Vec3(0.0, bad, 0.0)};
    EXPECT_THROW(nodesCsv(result), std::runtime_error);
    result.increments.resize(1);
    EXPECT_NO_THROW(incrementsCsv(result));
    result.increments[0].report.residual = bad;
    EXPECT_THROW(incrementsCsv(result), std::runtime_error);
    result.patches.resize(1);
    EXPECT_NO_THROW(patchesCsv(result));
    result.patches[0].answer.force.z() = bad;
    EXPECT_THROW(patchesCsv(result), std::runtime_error);
    result.vertices = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
    result.triangles = {{0, 1, 2}};
    EXPECT_NO_THROW(surfaceStl(result));
    result.vertices[1].x() = bad;
    EXPECT_THROW(surfaceStl(result), std::runtime_error);
  }
}

TEST_F(Simulate, IncrementsThatAreNotOkGiveExitCode3AndAllFiles) {
  write("through.yaml", kInvertingScene);
  const Outcome outcome = program("through.yaml --out out");
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_NE(outcome.err.find("increments not OK"), std::string::npos) << outcome.err;
  EXPECT_EQ(entries("out"), kFiles);
  EXPECT_EQ(readCsv(folder_ / "out/increments.csv").back()[2], "INVERTED");
  const Outcome quiet = program("through.yaml --out out --quiet");
  EXPECT_EQ(quiet.code, 3);
  EXPECT_EQ(quiet.err, "");
}

TEST_F(Simulate, SolvesTheElasticModelExactly) {
  std::string scene = kScene;
  const std::string place = "  material: {";
  scene.replace(scene.find(place), place.size(), "  model: elastic\n" + place);
  write("elastic.yaml", scene);
  const Outcome outcome = program("elastic.yaml --out out --method newton");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Rows rows = readCsv(folder_ / "out/increments.csv");
  ASSERT_EQ(rows.size(), 10U);
  for (std::size_t row = 1; row < rows.size(); ++row) {
    EXPECT_EQ(rows[row].at(2), "OK");
    EXPECT_LE(std::stod(rows[row].at(5)), 1e-10);
  }
}

TEST_F(Simulate, WritesTheLatticesNodesAlsoAfterACutOfElasticTissue) {
  std::string scene = kScene;
  const std::string place = "  material: {";
  scene.replace(scene.find(place), place.size(), "  model: elastic\n" + place);
  scene +=
      "  - cut: {corners: [[0.025, -1, 0.005], [0.025, 1, 0.005], [0.025, 1, 1], [0.025, -1, "
      "1]]}\n";
  write("elastic.yaml", scene);
  const Outcome outcome = program("elastic.yaml --out out");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(readCsv(folder_ / "out/nodes.csv").size(), 1U + 5U * 4U * 3U);
}

}  // namespace
}  // namespace robot_tissue::test_simulate
