// Tissue: the ways back (release, reset, tools that leave) and cuts.
#include <gtest/gtest.h>

#include "tissue_fixtures.h"

namespace robot_tissue::test_tissue_release {
namespace {

const TissueConfig kBlock = withFixedBottom(blockOf(20, 8, 5));
const Box kLeft = nodeBox(kBlock, {2, 3, 5}, {4, 5, 5});
const Box kRight = nodeBox(kBlock, {16, 3, 5}, {18, 5, 5});
const Vec3 kDown(0.0, 0.0, -2e-3);

// A blade across x between two slices of nodes, through the whole block or its upper half.
std::vector<Vec3> bladeAcross(double x, double z_from) {
  return {{x, -0.1, z_from}, {x, 0.2, z_from}, {x, 0.2, 0.1}, {x, -0.1, 0.1}};
}

class LoadedTissue : public ::testing::Test {
 protected:
  LoadedTissue() : tissue_(kBlock, paperSolver()) {
    last_ = reportsOf(tissue_, loadOf({displacedPatch("left", kLeft, kDown),
                                       displacedPatch("right", kRight, kDown)}))
                .back();
    EXPECT_TRUE(isDeformed(tissue_));
  }
  Tissue tissue_;
  SolveReport last_;
};

TEST_F(LoadedTissue, ReleasedOfAllReturnsToRestToTheLastBit) {
  const SolveReport report = tissue_.release({"left", "right"});
  EXPECT_EQ(report.status, SolveStatus::kOk);
  EXPECT_TRUE(tissue_.patches().empty());
  EXPECT_EQ(tissue_.namedPatches(), 0u);
  EXPECT_NEAR(report.volume_ratio, 1.0, 1e-12);
  expectAtRest(tissue_);
}

TEST_F(LoadedTissue, ReleasedOfOneKeepsTheOther) {
  const SolveReport report = tissue_.release({"left"});
  ASSERT_EQ(tissue_.namedPatches(), 1u);
  ASSERT_EQ(report.patches.size(), 1u);
  const PatchAnswer before = last_.patches[1], after = tissue_.answerOf("right", report);
  ASSERT_GT(before.force.norm(), 1e-3);
  EXPECT_LT((after.force - before.force).norm(), 1e-9 * before.force.norm());
  EXPECT_LT((after.displacement - kDown).norm(), 1e-15);
  for (int node = 0; node < tissue_.lattice().nodeCount(); ++node) {
    if (tissue_.lattice().gridIndex(node)[0] > 6) continue;
    EXPECT_TRUE(tissue_.state().displacement[at(node)].isZero(0.0));
  }
  for (std::size_t i = 0; i < tissue_.vertices().size(); ++i) {
    if (tissue_.surface().rest[i].x() > 0.06) continue;
    EXPECT_EQ(tissue_.vertices()[i], tissue_.surface().rest[i]);
  }
}

TEST_F(LoadedTissue, CanBeLoadedAgainAfterARelease) {
  tissue_.release({"left", "right", "left"});  // named twice is released once
  const SolveReport again = reportsOf(tissue_, loadOf({displacedPatch("left", kLeft, kDown),
                                                       displacedPatch("right", kRight, kDown)}))
                                .back();
  ASSERT_EQ(again.patches.size(), 2u);
  EXPECT_EQ(again.patches[0].force, last_.patches[0].force);
}

TEST_F(LoadedTissue, ForceReleasedReturnsToRestToTheLastBit) {
  tissue_.load(loadOf({forcedPatch("left", kLeft, Vec3(0.05, 0.0, -0.2))}));
  tissue_.release({"right"});
  EXPECT_TRUE(isDeformed(tissue_));
  tissue_.release({"left"});
  expectAtRest(tissue_);
}

TEST_F(LoadedTissue, ResetMendsEverythingToTheLastBit) {
  const Tissue untouched(kBlock, paperSolver());
  tissue_.cut(bladeAcross(0.095, 0.022));
  ASSERT_GT(tissue_.state().springs_cut, 0);
  const std::uint64_t version = tissue_.surface().revision;
  tissue_.reset();
  expectAtRest(tissue_);
  EXPECT_TRUE(tissue_.patches().empty());
  EXPECT_EQ(tissue_.namedPatches(), 0u);
  EXPECT_EQ(tissue_.state().severed, untouched.state().severed);
  EXPECT_EQ(tissue_.state().springs_cut, 0);
  EXPECT_EQ(tissue_.state().pieces, 1);
  EXPECT_EQ(tissue_.surface().triangles, untouched.surface().triangles);
  EXPECT_EQ(tissue_.surface().rest, untouched.surface().rest);
  EXPECT_EQ(tissue_.surface().opened, untouched.surface().opened);
  EXPECT_NE(tissue_.surface().revision, version);
  const SolveReport again = reportsOf(tissue_, loadOf({displacedPatch("left", kLeft, kDown),
                                                       displacedPatch("right", kRight, kDown)}))
                                .back();
  EXPECT_EQ(again.patches[0].force, last_.patches[0].force);
  EXPECT_EQ(again.patches[1].force, last_.patches[1].force);
}

TEST_F(LoadedTissue, ToolThatLeavesLetsTheTissueBackToRest) {
  tissue_.release({"left", "right"});
  LoadingPatch tool = displaced(tissue_.lattice().nodesIn(kLeft), kDown);
  const SolveReport report = tissue_.follow({tool}, {});
  ASSERT_EQ(report.patches.size(), 1u);
  EXPECT_LT(report.patches[0].force.z(), 0.0);
  EXPECT_FALSE(tissue_.isUntouched());
  EXPECT_EQ(tissue_.namedPatches(), 0u);
  EXPECT_TRUE(isDeformed(tissue_));
  tissue_.follow({}, {});
  EXPECT_TRUE(tissue_.isUntouched());
  expectAtRest(tissue_);
}

TEST_F(LoadedTissue, ToolsComeAfterNamedPatchesAndLeaveThemStanding) {
  LoadingPatch tool =
      displaced(tissue_.lattice().nodesIn(nodeBox(kBlock, {9, 3, 5}, {11, 5, 5})), 0.5 * kDown);
  tool.name = "tool";
  const SolveReport report = tissue_.follow({tool}, {});
  ASSERT_EQ(report.patches.size(), 3u);
  EXPECT_EQ(tissue_.patches()[2].name, "tool");
  EXPECT_LT((report.patches[2].displacement - 0.5 * kDown).norm(), 1e-15);
  EXPECT_LT((tissue_.answerOf("right", report).displacement - kDown).norm(), 1e-15);
  EXPECT_THROW(tissue_.release({"tool"}), InputError);
  const SolveReport left = tissue_.follow({}, {});
  ASSERT_EQ(left.patches.size(), 2u);
  EXPECT_LT((left.patches[0].displacement - kDown).norm(), 1e-15);
  for (const int node : tool.nodes) {
    EXPECT_LT(tissue_.state().displacement[at(node)].norm(), 0.1 * kDown.norm());
  }
}

TEST(TissueCut, LowersTheSpringsAndRaisesThePieces) {
  Tissue tissue(kBlock, paperSolver());
  const std::uint64_t version = tissue.surface().revision;
  const std::size_t triangles = tissue.surface().triangles.size();
  CutReport report = tissue.cut(bladeAcross(0.095, 0.022));
  EXPECT_EQ(report.springs_cut, 9 * 3);  // nodes at z = 30, 40 and 50 mm
  EXPECT_EQ(report.pieces, 1);
  EXPECT_GT(tissue.surface().triangles.size(), triangles);
  EXPECT_NE(tissue.surface().revision, version);
  EXPECT_NEAR(report.solve.volume_ratio, 1.0, 1e-9);
  report = tissue.cut(bladeAcross(0.095, -0.1));
  EXPECT_EQ(report.springs_cut, 9 * 3);  // the rest of them
  EXPECT_EQ(report.pieces, 2);
  EXPECT_EQ(tissue.state().springs_cut, 9 * 6);
  EXPECT_EQ(tissue.state().pieces, 2);
  int severed = 0;
  for (const auto flag : tissue.state().severed) severed += flag;
  EXPECT_EQ(severed, 9 * 6);
  EXPECT_EQ(tissue.vertices().size(), tissue.surface().rest.size());
}

TEST(TissueCut, BesideTheTissueChangesNothing) {
  Tissue tissue(kBlock, paperSolver());
  const Snapshot before(tissue);
  const CutReport report = tissue.cut(bladeAcross(0.5, -0.1));
  EXPECT_EQ(report.springs_cut, 0);
  EXPECT_EQ(report.pieces, 1);
  expectUnchanged(tissue, before);
}

TEST(TissueCut, PieceThatIsCutOffFeelsNoLoadOnTheOther) {
  Tissue tissue(kBlock, paperSolver());
  tissue.cut(bladeAcross(0.055, -0.1));
  const Box near_cut = nodeBox(kBlock, {2, 3, 5}, {5, 5, 5});
  tissue.load(loadOf({displacedPatch("left", near_cut, 3.0 * kDown)}));
  int moved = 0;
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    const bool left = tissue.lattice().gridIndex(node)[0] <= 5;
    const bool is_moved = !tissue.state().displacement[at(node)].isZero(0.0);
    if (left && is_moved) ++moved;
    EXPECT_TRUE(left || !is_moved);
  }
  EXPECT_GT(moved, 12);
}

// A stretched block springs back from the blade.
TEST(TissueCut, OpensUnderTension) {
  TissueConfig config = blockOf(8, 2, 2);
  config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 2, 2}));
  Tissue tissue(config, paperSolver());
  tissue.load(
      loadOf({displacedPatch("end", nodeBox(config, {8, 0, 0}, {8, 2, 2}), Vec3(8e-3, 0.0, 0.0))}));
  for (int i = 0; i < 5; ++i) tissue.settle();
  const int lower = tissue.lattice().node(3, 1, 1), upper = tissue.lattice().node(4, 1, 1);
  const auto gap = [&] {
    return (tissue.state().displacement[at(upper)] - tissue.state().displacement[at(lower)]).x();
  };
  const double before = gap();
  ASSERT_GT(before, 5e-4);
  const double middle =
      tissue.lattice().restPosition(lower).x() + 5e-3 +
      0.5 * (tissue.state().displacement[at(lower)] + tissue.state().displacement[at(upper)]).x();
  const CutReport report = tissue.cut(bladeAcross(middle, -0.1));
  EXPECT_EQ(report.springs_cut, 9);
  EXPECT_EQ(report.pieces, 2);
  EXPECT_GT(gap(), 2.0 * before);
}

}  // namespace
}  // namespace robot_tissue::test_tissue_release
