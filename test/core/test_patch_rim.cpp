// Rims of loading patches: which nodes are joined, and what comes of it.
#include <gtest/gtest.h>

#include <cmath>

#include "cutting/cut.h"
#include "elastic_fixtures.h"
#include "loads/patch_rim.h"
#include "loads/rim_law.h"

namespace robot_tissue::test_patch_rim {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kRatio = 0.3;

class RimOfBlock : public ::testing::Test {
 protected:
  std::vector<RimSpring> rim(const Box& box) const {
    return rimOf(lattice_, model_, state_, box, lattice_.nodesIn(box));
  }
  const RimSpring* find(const std::vector<RimSpring>& springs, int i, int j, int k) const {
    for (const RimSpring& spring : springs) {
      if (spring.node == lattice_.node(i, j, k)) return &spring;
    }
    return nullptr;
  }
  // Box on top of the block, in spacings.
  static Box onTop(double x0, double x1, double y0, double y1) {
    return {kSpacing * Vec3(x0, y0, 4.0), kSpacing * Vec3(x1, y1, 4.0)};
  }

  TissueConfig config_ = withFixedBottom(elasticBlockOf(8, 8, 4, kRatio));
  Lattice lattice_{config_};
  ElasticModel model_{lattice_, config_};
  LatticeState state_ = lattice_.restState();
  double unit_ = shearModulus(config_.material) * kSpacing;  // N/m
};

TEST_F(RimOfBlock, EdgeOnNodesJoinsTheBorderNodesByTheLaw) {
  const auto springs = rim(onTop(2, 6, 2, 6));
  EXPECT_EQ(springs.size(), 16u);
  const RimLaw law = rimLaw(kRatio);
  const RimSpring* edge = find(springs, 2, 4, 4);  // its edge runs along y
  ASSERT_NE(edge, nullptr);
  EXPECT_NEAR(edge->stiffness.x(), law.across.stiffness * unit_, 1e-9 * unit_);
  EXPECT_NEAR(edge->stiffness.y(), law.along.stiffness * unit_, 1e-9 * unit_);
  EXPECT_NEAR(edge->stiffness.z(), law.normal.stiffness * unit_, 1e-9 * unit_);
  const RimSpring* corner = find(springs, 2, 2, 4);
  ASSERT_NE(corner, nullptr);
  EXPECT_NEAR(corner->stiffness.z(), 0.5 * law.normal.stiffness * unit_, 1e-9 * unit_);
  EXPECT_EQ(find(springs, 4, 4, 4), nullptr) << "a node inside is hard";
}

TEST_F(RimOfBlock, EdgeBetweenNodesReachesOutToTheNextOnes) {
  const auto springs = rim(onTop(2, 6.5, 1.5, 6.5));
  const RimSpring* outside = find(springs, 7, 4, 4);
  ASSERT_NE(outside, nullptr);
  const RimLaw law = rimLaw(kRatio);
  EXPECT_NEAR(outside->stiffness.x(), rimStiffness(law.across, -0.5) * unit_, 1e-9 * unit_);
  EXPECT_LT(outside->stiffness.x(), law.across.stiffness * unit_);
  EXPECT_EQ(find(springs, 6, 4, 4), nullptr) << "half a spacing inside: hard";
  EXPECT_NE(find(springs, 2, 4, 4), nullptr);
}

TEST_F(RimOfBlock, ThereIsNoneWhereTheTissueEndsWithThePatch) {
  EXPECT_TRUE(rim(onTop(0, 8, 0, 8)).empty());
  const auto strip = rim(onTop(0, 4, 0, 8));
  EXPECT_EQ(strip.size(), 9u) << "one edge, at i = 4";
  // At the block's side half the tissue is behind the node.
  EXPECT_NEAR(find(strip, 4, 0, 4)->stiffness.z(), 0.5 * find(strip, 4, 4, 4)->stiffness.z(),
              1e-9 * unit_);
}

TEST_F(RimOfBlock, PatchesInsideAndThickOnesAreHard) {
  EXPECT_TRUE(rim({kSpacing * Vec3(2, 2, 2), kSpacing * Vec3(6, 6, 2)}).empty());
  EXPECT_TRUE(rim({kSpacing * Vec3(2, 2, 3), kSpacing * Vec3(6, 6, 4)}).empty());
}

// The banks of a cut end the tissue, for the rim too.
TEST_F(RimOfBlock, DoesNotReachAcrossACut) {
  const Box box = onTop(2, 6.5, 2, 6);
  ASSERT_NE(find(rim(box), 7, 4, 4), nullptr);
  const double x = 6.3 * kSpacing;
  sever(lattice_,
        springsAcross(lattice_, state_, {{x, -1, 0.02}, {x, 1, 0.02}, {x, 1, 1}, {x, -1, 1}}),
        state_, SplitCells::kParted);
  const auto springs = rim(box);
  EXPECT_EQ(find(springs, 7, 4, 4), nullptr) << "the other bank";
  EXPECT_EQ(find(springs, 6, 4, 4), nullptr) << "this bank is hard";
  EXPECT_NE(find(springs, 6, 2, 4), nullptr) << "the edge that runs to the cut";
}

// On a side face the law turns with the face.
TEST_F(RimOfBlock, SideFaceHasItsOwnNormal) {
  const auto springs = rim({kSpacing * Vec3(0, 3, 2), kSpacing * Vec3(0, 5, 4)});
  const RimSpring* edge = find(springs, 0, 3, 3);
  ASSERT_NE(edge, nullptr);
  const RimLaw law = rimLaw(kRatio);
  EXPECT_NEAR(edge->stiffness.x(), law.normal.stiffness * unit_, 1e-9 * unit_);
  EXPECT_NEAR(edge->stiffness.y(), law.across.stiffness * unit_, 1e-9 * unit_);
  EXPECT_EQ(find(springs, 0, 4, 4), nullptr) << "the tissue ends there";
}

// The force grows steadily with the patch, without jumps where its edge passes nodes, and does not
// depend on where the lattice has its nodes.
TEST_F(RimOfBlock, ForceFollowsThePatchNotTheNodes) {
  const auto forceOf = [&](double from, double to) {
    ElasticBlock block(config_);
    const Box box = onTop(from, to, from, to);
    LoadingPatch patch = displaced(block.lattice.nodesIn(box), Vec3(0.0, 0.0, -0.05 * kSpacing));
    patch.rim = rimOf(block.lattice, block.model, block.state, box, patch.nodes);
    for (RimSpring& spring : patch.rim) spring.anchor = Vec3(0.0, 0.0, -0.05 * kSpacing);
    const SolveReport report = block.solve({patch});
    EXPECT_EQ(report.status, SolveStatus::kOk);
    return -report.patches.front().force.z();
  };
  double last = 0.0;
  for (double width = 2.2; width < 4.4; width += 0.2) {
    const double force = forceOf(4.0 - 0.5 * width, 4.0 + 0.5 * width);
    if (last > 0.0) {
      EXPECT_GT(force, 1.01 * last) << width;
      EXPECT_LT(force, 1.15 * last) << width;
    }
    last = force;
  }
  const double aligned = forceOf(3.0, 5.0);
  for (const double shift : {0.2, 0.4, 0.6, 0.8}) {
    EXPECT_NEAR(forceOf(3.0 + shift, 5.0 + shift), aligned, 0.03 * aligned) << shift;
  }
}

}  // namespace
}  // namespace robot_tissue::test_patch_rim
