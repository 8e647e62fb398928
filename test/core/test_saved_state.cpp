// A tissue's state as bytes: it comes back bit for bit, or is refused in one line that changes
// nothing.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <random>

#include "../mutated_states.h"
#include "elastic_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_saved_state {
namespace {

constexpr double kSpacing = 0.01;

TissueConfig blockFor(const std::string& model) {
  TissueConfig config = withFixedBottom(blockOf(6, 5, 4, kSpacing));
  config.model = model;
  return config;
}

SolverConfig solverFor(const std::string& model) {
  SolverConfig solver;
  solver.method = model == "elastic" ? "layered" : "paper";
  return solver;
}

LoadStep pressOn(const TissueConfig& config) {
  return loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 4}, {2, 2, 4}), {0, 0, -0.004})});
}

// Springs along x are severed, upwards from `low`.
std::vector<Vec3> cutAt(double x, double low) {
  return {{x, -1.0, low}, {x, 1.0, low}, {x, 1.0, 1.0}, {x, -1.0, 1.0}};
}

void loadInto(Tissue& tissue, const std::string& bytes) {
  tissue.loadState(*tissue.readState(bytes));
}

std::string refusalOf(const Tissue& tissue, const std::string& bytes) {
  return inputErrorOf([&] { tissue.readState(bytes); });
}

class SavedStateOf : public ::testing::TestWithParam<std::string> {
 protected:
  const TissueConfig config_ = blockFor(GetParam());
  const SolverConfig solver_ = solverFor(GetParam());
};

TEST_P(SavedStateOf, ComesBackBitForBit) {
  Tissue tissue(config_, solver_);
  tissue.load(pressOn(config_));
  tissue.cut(cutAt(0.035, 0.015));
  tissue.cut(cutAt(0.015, 0.025));
  const std::string bytes = tissue.savedState();
  const Snapshot before(tissue);
  const SolveReport report = tissue.lastReport();
  for (const bool in_place : {true, false}) {
    Tissue other(config_, solver_);
    Tissue& to = in_place ? tissue : other;
    if (in_place) to.reset();
    loadInto(to, bytes);
    EXPECT_EQ(to.state().displacement, before.state.displacement);
    EXPECT_EQ(to.state().severed, before.state.severed);
    EXPECT_EQ(to.state().springs_cut, before.state.springs_cut);
    EXPECT_EQ(to.state().pieces, before.state.pieces);
    EXPECT_EQ(to.vertices(), before.vertices);
    EXPECT_EQ(to.surface().triangles, before.triangles);
    ASSERT_EQ(to.namedPatches(), 1U);
    EXPECT_EQ(to.patches()[0].nodes, before.patches[0].nodes);
    EXPECT_EQ(to.lastReport().patches[0].force, report.patches[0].force);
    EXPECT_EQ(to.lastReport().volume_ratio, report.volume_ratio);
    EXPECT_EQ(to.savedState(), bytes);
    EXPECT_EQ(to.stateHash(), tissue.stateHash());
  }
}

// Ghosts have the numbers that they had: what follows is the same to the last bit.
TEST_P(SavedStateOf, GoesOnAsIfItHadNeverBeenSaved) {
  Tissue tissue(config_, solver_), other(config_, solver_);
  tissue.load(pressOn(config_));
  tissue.cut(cutAt(0.035, 0.015));
  loadInto(other, tissue.savedState());
  loadInto(tissue, tissue.savedState());  // forgets what the method has learned
  for (Tissue* each : {&tissue, &other}) {
    each->cut(cutAt(0.015, 0.025));
    each->release({"punch"});
  }
  EXPECT_EQ(tissue.state().displacement, other.state().displacement);
  EXPECT_EQ(tissue.stateHash(), other.stateHash());
}

TEST_P(SavedStateOf, HashTellsStatesApart) {
  Tissue tissue(config_, solver_);
  const std::uint64_t at_rest = tissue.stateHash();
  tissue.load(pressOn(config_));
  const std::uint64_t pressed = tissue.stateHash();
  tissue.cut(cutAt(0.035, 0.015));
  const std::uint64_t cut = tissue.stateHash();
  EXPECT_NE(at_rest, pressed);
  EXPECT_NE(pressed, cut);
  tissue.reset();
  EXPECT_EQ(tissue.stateHash(), at_rest);
}

TEST_P(SavedStateOf, TruncatedForeignAndNewerOnesAreRefused) {
  Tissue tissue(config_, solver_);
  tissue.cut(cutAt(0.035, 0.015));
  const std::string bytes = tissue.savedState();
  const Snapshot before(tissue);
  for (std::size_t size = 0; size < bytes.size(); size += 1 + size / 50) {
    const std::string line = refusalOf(tissue, bytes.substr(0, size));
    EXPECT_TRUE(isOneLine(line) && mentions(line, "; allowed: a file as it was saved")) << size;
  }
  EXPECT_TRUE(mentions(refusalOf(tissue, "PK\x03\x04 of another program"), "is no saved state"));
  std::string newer = bytes;
  newer[kVersionAt] = 8;
  EXPECT_TRUE(mentions(refusalOf(tissue, newer), "version 8; allowed: up to 7"));
  EXPECT_TRUE(mentions(refusalOf(tissue, bytes + "x"), "damaged"));
  EXPECT_TRUE(mentions(refusalOf(tissue, bytes + "x"), "; allowed: a file as it was saved"));
  expectUnchanged(tissue, before);
}

TEST_P(SavedStateOf, ThoseWithANumberThatIsNoneAreRefused) {
  Tissue tissue(config_, solver_);
  const std::string good = tissue.savedState();
  const std::size_t nodes = at(tissue.lattice().nodeCount());
  const std::size_t after_springs = kHeaderBytes + 8 + (tissue.state().severed.size() + 7) / 8;
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (std::size_t component = 0; component < 3; ++component) {
      std::string bytes = good;
      std::uint64_t bits = 0;
      std::memcpy(&bits, &value, sizeof(bits));
      // After the count of nodes that cuts added: the last node's.
      putNumber(bytes, after_springs + 4 + 8 * (3 * (nodes - 1) + component), bits);
      EXPECT_TRUE(mentions(refusalOf(tissue, withChecksums(bytes)), "beyond all bounds"));
    }
  }
}

TEST_P(SavedStateOf, ThoseOfOtherLatticesAreRefused) {
  const std::string bytes = Tissue(config_, solver_).savedState();
  TissueConfig other = config_;
  other.spacing *= 0.5;
  EXPECT_TRUE(mentions(refusalOf(Tissue(other, solver_), bytes), "another lattice"));
  other = config_;
  other.fixed.front().max().z() += kSpacing;
  EXPECT_TRUE(mentions(refusalOf(Tissue(other, solver_), bytes), "another lattice"));
  other = config_;
  other.shape.max().x() += kSpacing;
  EXPECT_TRUE(mentions(refusalOf(Tissue(other, solver_), bytes), "another lattice"));
}

TEST_P(SavedStateOf, ThousandsOfChangedOnesAreRefusedOrLoaded) {
  Tissue tissue(config_, solver_);
  tissue.load(pressOn(config_));
  tissue.cut(cutAt(0.035, 0.015));
  tissue.remove(Sphere{config_.shape.max(), 0.015});
  MutatedStates changed(tissue.savedState(), 7);
  int refused = 0, loaded = 0;
  for (int i = 0; i < 4000; ++i) {
    const std::string line = refusalOf(tissue, changed.next());
    EXPECT_TRUE(line.empty() || isOneLine(line)) << line;
    ++(line.empty() ? loaded : refused);
  }
  EXPECT_GT(refused, 1000);
  EXPECT_GT(loaded, 100);  // a displacement may be another one
}

// What passes may be far from balance: it is a state all the same.
TEST_P(SavedStateOf, ChangedOnesThatPassAreFinite) {
  Tissue tissue(config_, solver_);
  tissue.cut(cutAt(0.035, 0.015));
  tissue.remove(Sphere{config_.shape.max(), 0.015});
  const std::string good = tissue.savedState();
  std::mt19937 random(3);
  std::uniform_int_distribution<std::size_t> place(kHeaderBytes, good.size() - 1);
  std::uniform_int_distribution<int> any(0, 255);
  int loaded = 0;
  for (int i = 0; i < 60; ++i) {
    std::string bytes = good;
    bytes[place(random)] = static_cast<char>(any(random));
    bytes = withChecksums(bytes);
    if (!refusalOf(tissue, bytes).empty()) continue;
    loadInto(tissue, bytes);
    for (const Vec3& vertex : tissue.vertices()) ASSERT_TRUE(vertex.allFinite());
    tissue.settle();
    for (const Vec3& vertex : tissue.vertices()) ASSERT_TRUE(vertex.allFinite());
    ++loaded;
  }
  EXPECT_GT(loaded, 3);
}

INSTANTIATE_TEST_SUITE_P(Models, SavedStateOf, ::testing::Values("elastic", "six_spring"),
                         [](const auto& parameter) { return parameter.param; });

// Files of before it was kept where springs were parted, nor how far the blade went beyond them, as
// it is not in tissue that may tear.
TEST(SavedState, OfAnOlderVersionIsPartedHalfWayAndBalancedAnew) {
  TissueConfig config = blockFor("elastic");
  config.material.tear_stretch = 100.0;
  const SolverConfig solver = solverFor("elastic");
  Tissue half_way(config, solver), off(config, solver), loaded(config, solver);
  for (Tissue* tissue : {&half_way, &off}) {
    tissue->cut(cutAt(tissue == &off ? 0.0328 : 0.035, 0.015));
    tissue->load(pressOn(config));
  }
  std::string older = off.savedState();
  const std::size_t springs = off.state().severed.size();
  const std::size_t extras_at = kHeaderBytes + 8 + (springs + 7) / 8;
  ASSERT_EQ(older[extras_at], 8);
  older.erase(extras_at, 1 + 8 * at(off.state().springs_cut));
  older[kVersionAt] = 1;
  loadInto(loaded, withChecksums(older));
  EXPECT_EQ(loaded.state().severed, off.state().severed);
  EXPECT_EQ(loaded.surface().rest, half_way.surface().rest);
  EXPECT_NE(loaded.surface().rest, off.surface().rest);
  const auto force = [](const Tissue& tissue) { return tissue.lastReport().patches[0].force.z(); };
  EXPECT_NEAR(force(loaded), force(half_way), 0.01 * std::abs(force(half_way)));
}

// Of other stiffness it is not in balance where it was: it sags less.
TEST(SavedState, OfAnotherMaterialIsBalancedAnew) {
  TissueConfig soft = blockFor("elastic");
  soft.gravity = Vec3(0.0, 0.0, -9.81);
  const SolverConfig solver = solverFor("elastic");
  TissueConfig hard = soft;
  hard.material.young_modulus *= 2.0;
  Tissue of_soft(soft, solver), of_hard(hard, solver), expected(hard, solver);
  of_soft.settle();
  expected.settle();
  loadInto(of_hard, of_soft.savedState());
  const auto sag = [](const Tissue& tissue) {
    double lowest = 0.0;
    for (const Vec3& moved : tissue.state().displacement) lowest = std::min(lowest, moved.z());
    return lowest;
  };
  EXPECT_LT(sag(expected), 0.0);
  EXPECT_NEAR(sag(of_hard), sag(expected), 0.02 * std::abs(sag(expected)));
  EXPECT_LT(sag(of_soft), 1.5 * sag(expected));
}

// The springs at the rim of a load are as stiff as the tissue that they were made in.
TEST(SavedState, WithLoadsOfAnotherMaterialIsRefused) {
  const TissueConfig soft = blockFor("elastic");
  const SolverConfig solver = solverFor("elastic");
  TissueConfig hard = soft;
  hard.material.young_modulus *= 2.0;
  Tissue of_soft(soft, solver), of_hard(hard, solver);
  of_soft.load(loadOf({forcedPatch("push", nodeBox(soft, {1, 1, 4}, {2, 2, 4}), {0, 0, -0.05})}));
  EXPECT_NE(refusalOf(of_hard, of_soft.savedState()).find("with another material"),
            std::string::npos);
}

// Two cuts that end in the tissue near its fixed bottom and cross: what stood in for a node beside
// the first wall stands in for a fixed one beside both.
TEST(SavedState, OfCrossingCutsBesideFixedNodesComesBack) {
  TissueConfig config = withFixedBottom(blockOf(8, 6, 4, kSpacing));
  config.model = "elastic";
  config.material.poisson_ratio = 0.3;
  config.gravity = Vec3(0.0, 0.0, -9.81);
  config.shape.translate(-config.shape.min());
  config.fixed = {Box(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1e-6))};
  Tissue tissue(config, solverFor("elastic"));
  const std::vector<std::vector<Vec3>> cuts = {{{0.0464, 0.0561, -0.0082},
                                                {0.0096, 0.0061, 0.0052},
                                                {-0.0398, -0.0181, 0.0252},
                                                {-0.003, 0.0319, 0.0118}},
                                               {{0.0023, 0.0005, 0.0189},
                                                {-0.0167, 0.0221, 0.0761},
                                                {0.0127, 0.0335, 0.0317},
                                                {0.0317, 0.0119, -0.0255}}};
  for (const std::vector<Vec3>& corners : cuts) {
    ASSERT_GT(tissue.cut(corners).springs_cut, 0);
    const LatticeState& state = tissue.state();
    for (int node = 0; node < state.cells->nodeCount(); ++node) {
      if (isFixed(tissue.lattice(), *state.cells, node)) {
        EXPECT_EQ(state.displacement[at(node)], Vec3(Vec3::Zero())) << node;
      }
    }
  }
  const std::string bytes = tissue.savedState();
  Tissue other(config, solverFor("elastic"));
  loadInto(other, bytes);
  EXPECT_EQ(other.savedState(), bytes);
}

// Out of time on its way: what was loaded is not all of what was asked for.
TEST(SavedState, OfALoadOnItsWayGoesOnToItsEnd) {
  const TissueConfig config = blockFor("elastic");
  const Box box = nodeBox(config, {1, 1, 4}, {2, 2, 4});
  const Vec3 way(0.0, 0.0, -0.02);
  Tissue late(config, solverFor("elastic")), loaded(config, solverFor("elastic"));
  late.setDeadline(Deadline(0.0));
  late.load(loadOf({displacedPatch("punch", box, way)}));
  late.setDeadline(std::nullopt);
  ASSERT_TRUE(late.isLoading());
  const std::string bytes = late.savedState();
  EXPECT_EQ(bytes[kVersionAt], 7);
  EXPECT_EQ(loaded.loadState(*loaded.readState(bytes)).status, SolveStatus::kLate);
  ASSERT_TRUE(loaded.isLoading());
  loaded.loadOn();
  EXPECT_FALSE(loaded.isLate());
  EXPECT_EQ(loaded.lastReport().status, SolveStatus::kOk);
  EXPECT_EQ(loaded.patches()[0].displacement.front(), way);
  EXPECT_EQ(loaded.savedState()[kVersionAt], 1);
  MutatedStates changed(bytes, 1);
  for (int file = 0; file < 500; ++file) {
    const std::string line = refusalOf(loaded, changed.next());
    EXPECT_TRUE(line.empty() || isOneLine(line)) << line;
  }
}

// 2 km below where it was made.
TEST(SavedState, OfTissueThatFellFarComesBack) {
  TissueConfig config = blockOf(2, 2, 2, kSpacing);
  config.model = "elastic";
  config.gravity = Vec3(0.0, 0.0, -9.81);
  config.time = TimeConfig{0.01};
  Tissue tissue(config, solverFor("elastic")), other(config, solverFor("elastic"));
  tissue.wait(20.0);
  const std::string bytes = tissue.savedState();
  ASSERT_LT(tissue.state().displacement.front().z(), -1900.0);
  loadInto(other, bytes);
  for (std::size_t node = 0; node < other.state().displacement.size(); ++node) {
    const Vec3 off = other.state().displacement[node] - tissue.state().displacement[node];
    EXPECT_LT(off.norm(), 1e-3) << node;
  }
}

}  // namespace
}  // namespace robot_tissue::test_saved_state
