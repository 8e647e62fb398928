// Pieces that nothing holds any more stay where they were carried, without strain.
#include <gtest/gtest.h>

#include "suture_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_left_pieces {
namespace {

// 60 x 40 x 40 mm on a fixed bottom, cut through level.
struct LidOnABed {
  explicit LidOnABed(const std::string& method) : tissue(config(), solverWith(method)) {
    tissue.cut({{-1, -1, 0.025}, {1, -1, 0.025}, {1, 1, 0.025}, {-1, 1, 0.025}});
  }

  static TissueConfig config() {
    TissueConfig block = withFixedBottom(blockOf(6, 4, 4, 0.01));
    block.model = "elastic";
    block.material.poisson_ratio = 0.45;
    return block;
  }

  TissuePiece lid() const {
    const std::vector<TissuePiece> pieces = tissue.pieces();
    return pieces[0].fixed ? pieces[1] : pieces[0];
  }

  double distance(int a, int b) const {
    return (tissue.nodePosition(a) - tissue.nodePosition(b)).norm();
  }

  Tissue tissue;
};

class LeftPiece : public ::testing::TestWithParam<std::string> {};

TEST_P(LeftPiece, StaysWhereALoadCarriedItAndIsStrainedNoLonger) {
  LidOnABed block(GetParam());
  Tissue& tissue = block.tissue;
  const Lattice& lattice = tissue.lattice();
  // One side of its top goes up more than the other: it turns.
  tissue.load(loadOf(
      {displacedPatch("one", nodeBox(block.config(), {0, 0, 4}, {1, 4, 4}), Vec3(0.0, 0.0, 0.03)),
       displacedPatch("other", nodeBox(block.config(), {5, 0, 4}, {6, 4, 4}),
                      Vec3(0.002, 0.0, 0.04))}));
  tissue.load(loadOf({displacedPatch("far", nodeBox(block.config(), {6, 4, 1}, {6, 4, 1}),
                                     Vec3(0.001, 0.0, 0.0))}));
  const Vec3 center = block.lid().center;
  const Vec3 up =
      tissue.nodePosition(lattice.node(6, 2, 3)) - tissue.nodePosition(lattice.node(0, 2, 3));
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"one", "other"}, std::vector<std::string>{"far"}}) {
    EXPECT_EQ(tissue.release(names).status, SolveStatus::kOk);
    EXPECT_LT((block.lid().center - center).norm(), 1e-7) << names.front();
    EXPECT_NEAR(block.distance(lattice.node(0, 0, 3), lattice.node(6, 4, 4)),
                Vec3(0.06, 0.04, 0.01).norm(), 1e-5);
    const Vec3 now =
        tissue.nodePosition(lattice.node(6, 2, 3)) - tissue.nodePosition(lattice.node(0, 2, 3));
    EXPECT_GT(now.normalized().dot(up.normalized()), 0.999);
  }
  // What is held is at rest.
  EXPECT_EQ(tissue.state().displacement[at(lattice.node(6, 4, 1))], Vec3(Vec3::Zero()));
}

INSTANTIATE_TEST_SUITE_P(, LeftPiece, ::testing::Values("layered", "newton"),
                         [](const auto& tested) { return tested.param; });

TEST(LeftPieces, StayAsTheLastToolLeaves) {
  LidOnABed block("layered");
  Tissue& tissue = block.tissue;
  const std::vector<int> top =
      tissue.lattice().nodesIn(nodeBox(block.config(), {0, 0, 4}, {6, 4, 4}));
  tissue.follow({displaced(top, Vec3(0.0, 0.0, 0.01))}, {});
  const Vec3 center = block.lid().center;
  tissue.follow({}, {});
  EXPECT_LT((block.lid().center - center).norm(), 1e-7);
}

TEST(LeftPieces, ThatForcesMoveWithoutEndStayWhenAnotherLoadGoes) {
  LidOnABed block("layered");
  Tissue& tissue = block.tissue;
  const Box top = nodeBox(block.config(), {0, 0, 4}, {6, 4, 4});
  tissue.load(loadOf({displacedPatch("lift", top, Vec3(0.0, 0.0, 0.03))}));
  tissue.release({"lift"});
  tissue.load(loadOf(
      {displacedPatch("far", nodeBox(block.config(), {6, 4, 1}, {6, 4, 1}), Vec3(0.001, 0.0, 0.0)),
       forcedPatch("pull", top, Vec3(0.0, 0.0, 0.1))}));
  const Vec3 center = block.lid().center;
  tissue.release({"far"});
  EXPECT_LT((block.lid().center - center).norm(), 1e-7);
}

TEST(LeftPieces, InTheirBedComeBackToTheLastBit) {
  LidOnABed block("layered");
  Tissue& tissue = block.tissue;
  tissue.load(loadOf({displacedPatch("far", nodeBox(block.config(), {6, 4, 1}, {6, 4, 1}),
                                     Vec3(0.001, 0.0, 0.0))}));
  tissue.release({"far"});
  expectAtRest(tissue);
}

}  // namespace
}  // namespace robot_tissue::test_left_pieces
