// Tissue: a refused request says why in one line and changes nothing.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "tissue_fixtures.h"

namespace robot_tissue::test_tissue_refusals {
namespace {

const TissueConfig kBlock = withFixedBottom(blockOf(10, 6, 4));
const Box kPunch = nodeBox(kBlock, {2, 2, 4}, {4, 4, 4});
const Box kElsewhere = nodeBox(kBlock, {7, 2, 4}, {8, 4, 4});
const Vec3 kDown(0.0, 0.0, -2e-3);

// A tissue that is loaded and cut, so that there is something to lose.
class Refusal : public ::testing::Test {
 protected:
  Refusal() : tissue_(kBlock, paperSolver()) {
    tissue_.cut({{0.055, -0.1, 0.025}, {0.055, 0.1, 0.025}, {0.055, 0.1, 0.1}, {0.055, -0.1, 0.1}});
    tissue_.load(loadOf({displacedPatch("punch", kPunch, kDown)}));
    EXPECT_TRUE(isDeformed(tissue_));
    EXPECT_GT(tissue_.state().springs_cut, 0);
  }

  void expectRefused(const std::function<void()>& call, const std::string& named) {
    const Snapshot before(tissue_);
    const std::string line = inputErrorOf(call);
    EXPECT_TRUE(isOneLine(line)) << line;
    EXPECT_TRUE(mentions(line, named)) << line;
    EXPECT_TRUE(mentions(line, "allowed")) << line;
    expectUnchanged(tissue_, before);
  }

  void expectLoadRefused(const std::vector<PatchConfig>& patches, const std::string& named) {
    expectRefused([&] { tissue_.load(loadOf(patches)); }, named);
  }

  Tissue tissue_;
};

// In meters, too, beside the size of the tissue; by a force there is no such way.
TEST_F(Refusal, OfALoadOfMoreIncrementsThanMayBe) {
  const auto load = [&](const PatchConfig& patch) {
    tissue_.load(
        loadOf({patch}), [](int, int, const SolveReport&) {}, 3);
  };
  const Vec3 far(0.0, 0.0, -1.0);
  expectRefused([&] { load(displacedPatch("far", kElsewhere, far)); },
                "m at once (the tissue is 0.1 x 0.06 x 0.04 m)");
  expectRefused([&] { load(forcedPatch("far", kElsewhere, 1e3 * far)); }, "a smaller load");
}

TEST_F(Refusal, OfALoadWithoutAPatch) { expectLoadRefused({}, "patch"); }

TEST_F(Refusal, OfAPatchWithoutANode) {
  const Box outside{Vec3::Constant(1.0), Vec3::Constant(2.0)};
  expectLoadRefused({displacedPatch("void", outside, kDown)}, "void");
}

TEST_F(Refusal, OfAPatchWithFixedNodes) {
  expectLoadRefused({displacedPatch("deep", nodeBox(kBlock, {8, 2, 0}, {9, 4, 4}), kDown)}, "deep");
}

TEST_F(Refusal, OfAPatchThatSharesNodesWithAStandingOne) {
  expectLoadRefused({displacedPatch("second", nodeBox(kBlock, {4, 4, 4}, {6, 6, 4}), kDown)},
                    "second");
}

TEST_F(Refusal, OfTwoPatchesThatShareNodes) {
  expectLoadRefused({displacedPatch("one", kElsewhere, kDown),
                     forcedPatch("two", nodeBox(kBlock, {8, 4, 4}, {9, 5, 4}), kDown)},
                    "two");
}

TEST_F(Refusal, OfAStandingNameOnOtherNodes) {
  expectLoadRefused({displacedPatch("punch", kElsewhere, kDown)}, "punch");
}

TEST_F(Refusal, OfTheSecondPatchLeavesTheFirstUnplaced) {
  const Box outside{Vec3::Constant(1.0), Vec3::Constant(2.0)};
  expectLoadRefused({displacedPatch("good", kElsewhere, kDown), forcedPatch("bad", outside, kDown)},
                    "bad");
}

TEST_F(Refusal, OfOneNameForTwoPatches) {
  expectLoadRefused({displacedPatch("twin", kElsewhere, kDown),
                     displacedPatch("twin", nodeBox(kBlock, {7, 0, 4}, {8, 1, 4}), kDown)},
                    "twin");
}

TEST_F(Refusal, OfReleaseOfAnUnknownName) {
  expectRefused([&] { tissue_.release({"nobody"}); }, "nobody");
  expectRefused([&] { tissue_.release({"punch", "nobody"}); }, "nobody");
}

TEST_F(Refusal, OfBadCuts) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Vec3 a(0.015, -0.1, -0.1), b(0.015, 0.2, -0.1);
  expectRefused([&] { tissue_.cut({a, b}); }, "corners");
  expectRefused([&] { tissue_.cut({a, b, 0.5 * (a + b)}); }, "corners");
  expectRefused([&] { tissue_.cut({a, b, Vec3(nan, 0.0, 0.0)}); }, "corners[2]");
}

TEST_F(Refusal, LeavesTheTissueUsable) {
  EXPECT_THROW(tissue_.release({"nobody"}), InputError);
  const auto reports = reportsOf(tissue_, loadOf({displacedPatch("other", kElsewhere, kDown)}));
  EXPECT_EQ(reports.back().patches.size(), 2u);
}

}  // namespace
}  // namespace robot_tissue::test_tissue_refusals
