// Parts of cut cells and their ghosts: what is one node, what moves apart, what nothing is lost of.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "cutting/cut.h"
#include "cutting/split_cells.h"
#include "elastic_fixtures.h"
#include "lattice/connectivity.h"
#include "mesh_fixtures.h"

namespace robot_tissue::test_split_cells {
namespace {

constexpr double kSpacing = 0.01;
constexpr double kFar = 1.0;

using Corners = std::vector<Vec3>;

// A rectangle across `axis` at `height` (in spacings), from `from` spacings on along the next axis.
Corners across(int axis, double height, double from = -100.0) {
  Corners corners(4, Vec3::Zero());
  for (std::size_t i = 0; i < 4; ++i) {
    corners[i][axis] = height * kSpacing;
    corners[i][(axis + 1) % 3] = i == 1 || i == 2 ? kFar : from * kSpacing;
    corners[i][(axis + 2) % 3] = i >= 2 ? kFar : -kFar;
  }
  return corners;
}

void sever(ElasticBlock& block, const std::vector<int>& springs) {
  sever(block.lattice, halfWay(springs), block.state, SplitCells::kParted);
}

void cut(ElasticBlock& block, const Corners& corners) {
  sever(block.lattice, springsAcross(block.lattice, block.state, corners), block.state,
        SplitCells::kParted);
}

double filled(const CellSet& cells) {
  double share = 0.0;
  for (const Cell& cell : cells.all()) share += cell.share();
  return share;
}

// For every node the lowest node of the lattice of the piece that it belongs to.
std::vector<int> piecesOf(const ElasticBlock& block) {
  const CellSet& cells = *block.state.cells;
  std::vector<int> piece(at(cells.nodeCount()));
  std::iota(piece.begin(), piece.end(), 0);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Cell& cell : cells.all()) {
      int lowest = cells.nodeCount();
      for (const int node : cell.nodes) lowest = std::min(lowest, piece[at(node)]);
      for (const int node : cell.nodes) {
        changed = changed || piece[at(node)] != lowest;
        piece[at(node)] = lowest;
      }
    }
  }
  return piece;
}

// Moves the pieces, each its own way, by a great turn.
void throwApart(ElasticBlock& block) {
  const std::vector<int> piece = piecesOf(block);
  for (int node = 0; node < block.state.cells->nodeCount(); ++node) {
    const double angle = 0.3 + 0.7 * piece[at(node)];
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle, Vec3(1, -2, 1).normalized()).matrix();
    const Vec3 rest = restPosition(block.lattice, *block.state.cells, node);
    block.state.displacement[at(node)] =
        turn * rest - rest + Vec3(0.01 * piece[at(node)], 0.02, -0.03);
  }
}

// Motions of the shape that no force resists.
int countFreeMotions(const ElasticBlock& block) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(hessianOf(block),
                                                              Eigen::EigenvaluesOnly);
  const Eigen::VectorXd& values = solver.eigenvalues();
  return static_cast<int>((values.array() < 1e-9 * values.maxCoeff()).count());
}

// What must hold after any cut: the volume is there, what springs part has no common node, nothing
// pulls, and nothing but each piece as a whole is free to move.
void expectSound(ElasticBlock& block, double cells) {
  EXPECT_NEAR(filled(*block.state.cells), cells, 1e-12);
  ASSERT_EQ(static_cast<int>(block.state.displacement.size()), block.state.cells->nodeCount());
  const std::vector<int> piece = piecesOf(block);
  EXPECT_EQ(static_cast<int>(std::set<int>(piece.begin(), piece.end()).size()), block.state.pieces);
  const std::vector<Vec3> shape = block.state.displacement;
  throwApart(block);
  EXPECT_LT(greatestForce(block.model.nodeForces(block.state)), 1e-11);
  EXPECT_LT(std::abs(block.model.energy(block.state)), 1e-15);
  EXPECT_EQ(countFreeMotions(block), 6 * block.state.pieces);
  block.state.displacement = shape;
}

TEST(Ghosts, PlaneThroughABlockGivesEachSideALayer) {
  ElasticBlock block(elasticBlockOf(4, 3, 2, 0.45));
  cut(block, across(0, 1.4));
  ASSERT_EQ(block.state.pieces, 2);
  EXPECT_EQ(block.state.cells->ghosts().size(), 2u * 4u * 3u);
  EXPECT_EQ(block.state.cells->all().size(), 24u + 6u);
  for (const Cell& cell : block.state.cells->all()) {
    const double part = cell.owns(0) ? 0.4 : 0.6;
    EXPECT_NEAR(cell.share(), cell.isPart() ? part : 1.0, 1e-12);
  }
  const std::vector<int> piece = piecesOf(block);
  for (int node = 0; node < block.state.cells->nodeCount(); ++node) {
    const auto index = block.lattice.gridIndex(block.state.cells->original(node));
    const bool is_left = index[0] <= 1;
    EXPECT_EQ(piece[at(node)], is_left != block.state.cells->isGhost(node) ? 0 : 2);
  }
  expectSound(block, 24.0);
}

TEST(Ghosts, ObliquePlaneParts) {
  ElasticBlock block(elasticBlockOf(3, 3, 2, 0.3));
  cut(block, {{0.012, -0.1, -0.1}, {0.004, -0.1, 0.2}, {0.026, 0.2, 0.2}, {0.034, 0.2, -0.1}});
  ASSERT_EQ(block.state.pieces, 2);
  expectSound(block, 18.0);
}

// The last column of ghosts stands behind the end of the cut: there the cut is closed.
TEST(Ghosts, CutThatEndsInsideIsClosedAtItsEnd) {
  ElasticBlock block(elasticBlockOf(3, 4, 2, 0.45));
  cut(block, across(0, 1.5, 1.5));  // severs the rows j = 2, 3, 4: cells 2 and 3
  ASSERT_EQ(block.state.pieces, 1);
  EXPECT_EQ(block.state.cells->ghosts().size(), 2u * 2u * 3u);
  for (const Ghost& ghost : block.state.cells->ghosts()) {
    EXPECT_GE(block.lattice.gridIndex(ghost.original)[1], 3);
  }
  expectSound(block, 24.0);
}

TEST(Ghosts, CrossingCutsMakeFourSoundPieces) {
  ElasticBlock block(elasticBlockOf(3, 3, 2, 0.45));
  cut(block, across(0, 1.5));
  cut(block, across(1, 1.5));
  ASSERT_EQ(block.state.pieces, 4);
  EXPECT_EQ(block.state.cells->ghosts().size(), 4u * 5u * 3u);
  expectSound(block, 18.0);
}

TEST(Ghosts, CutsThatEndInTheSameCellAreSound) {
  ElasticBlock block(elasticBlockOf(3, 3, 3, 0.45));
  cut(block, across(0, 1.5, 0.7));
  cut(block, across(1, 1.5, 0.7));
  cut(block, across(2, 1.5, 0.7));
  expectSound(block, 27.0);
}

TEST(Ghosts, SliverOfOneCornerIsFree) {
  ElasticBlock block(elasticBlockOf(2, 2, 2, 0.45));
  cut(block, {{0.03, -0.012, -0.012}, {-0.012, 0.03, -0.012}, {-0.012, -0.012, 0.03}});
  ASSERT_EQ(block.state.springs_cut, 3);
  EXPECT_EQ(block.state.cells->ghosts().size(), 7u + 1u);
  // The blade leaves a corner of 0.6 spacings along each edge.
  EXPECT_NEAR(block.state.cells->owner(0, 0)->share(), 0.6 * 0.6 * 0.6 / 6.0, 1e-12);
  EXPECT_NEAR(block.state.cells->owner(0, 7)->share(), 1.0 - 0.6 * 0.6 * 0.6 / 6.0, 1e-12);
  expectSound(block, 8.0);
}

TEST(Ghosts, NodeCutOutOfTheMiddleTakesItsEightCornersAlong) {
  ElasticBlock block(elasticBlockOf(2, 2, 2, 0.45));
  std::vector<int> springs;
  for (int direction = 0; direction < kNeighbors; ++direction) {
    springs.push_back(block.lattice.springOf(block.lattice.node(1, 1, 1), direction));
  }
  sever(block, springs);
  EXPECT_EQ(block.state.cells->ghosts().size(), 26u + 1u);
  expectSound(block, 8.0);
}

// Springs severed at random, ten more each time: every way a cell can be parted, and parted
// again.
TEST(Ghosts, AnyCutIsSoundAndLeavesTheEnergyOfALinearDeformationAsItIs) {
  constexpr std::size_t kCut = 10;
  std::mt19937 random(7);
  for (int trial = 0; trial < 6; ++trial) {
    ElasticBlock block(elasticBlockOf(3, 2, 2, 0.45));
    std::vector<int> springs(block.lattice.springs().size());
    std::iota(springs.begin(), springs.end(), 0);
    std::shuffle(springs.begin(), springs.end(), random);
    for (std::size_t first = 0; first + kCut < springs.size(); first += kCut) {
      Eigen::Matrix3d gradient;
      gradient << 1.1, 0.2, -0.1, 0.05, 0.9, 0.1, 0.1, -0.2, 1.05;
      for (int node = 0; node < block.state.cells->nodeCount(); ++node) {
        const Vec3 rest = restPosition(block.lattice, *block.state.cells, node);
        block.state.displacement[at(node)] = gradient * rest - rest;
      }
      const double before = block.model.energy(block.state);
      sever(block, {springs.begin() + static_cast<std::ptrdiff_t>(first),
                    springs.begin() + static_cast<std::ptrdiff_t>(first + kCut)});
      EXPECT_NEAR(block.model.energy(block.state), before, 1e-12 * before);
      shake(block.state, 0.1 * kSpacing, static_cast<unsigned>(first));
      expectSound(block, 12.0);
    }
  }
}

TEST(Ghosts, KeepTheirNumbersInLaterCuts) {
  ElasticBlock block(elasticBlockOf(3, 3, 2, 0.45));
  cut(block, across(0, 1.5));
  shake(block.state, 0.2 * kSpacing);
  const LatticeState before = block.state;
  sever(block,
        {block.lattice.springOf(0, 1), block.lattice.springOf(0, 3), block.lattice.springOf(0, 5),
         block.lattice.springOf(4, 3), block.lattice.springOf(5, 3), block.lattice.springOf(16, 3),
         block.lattice.springOf(17, 3), block.lattice.springOf(20, 3),
         block.lattice.springOf(21, 3)});
  ASSERT_GT(block.state.displacement.size(), before.displacement.size());
  for (int node = 0; node < before.cells->nodeCount(); ++node) {
    EXPECT_EQ(block.state.cells->original(node), before.cells->original(node));
    EXPECT_EQ(block.state.displacement[at(node)], before.displacement[at(node)]);
  }
}

// A second cut through a gap: what is new starts from the ghost of its own side.
TEST(Ghosts, OfAPartedPartStartFromTheEarlierGhost) {
  ElasticBlock block(elasticBlockOf(3, 3, 2, 0.45));
  cut(block, across(0, 1.5));
  throwApart(block);
  std::vector<int> springs;
  for (std::size_t index = 0; index < block.lattice.springs().size(); ++index) {
    const Spring& spring = block.lattice.springs()[index];
    const auto lower = block.lattice.gridIndex(spring.a);
    if (spring.axis == 1 && lower[1] == 1) springs.push_back(static_cast<int>(index));
  }
  sever(block, springs);
  ASSERT_EQ(block.state.pieces, 4);
  EXPECT_LT(std::abs(block.model.energy(block.state)), 1e-15);
  EXPECT_LT(greatestForce(block.model.nodeForces(block.state)), 1e-11);
}

TEST(Ghosts, OfFixedNodesAreFixedWhereTheirPartHoldsOn) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(3, 2, 2, 0.45));
  const auto countFixed = [&](const Corners& corners) {
    ElasticBlock block(config);
    cut(block, corners);
    int fixed = 0;
    for (int node = block.lattice.nodeCount(); node < block.state.cells->nodeCount(); ++node) {
      fixed += isFixed(block.lattice, *block.state.cells, node) ? 1 : 0;
      EXPECT_EQ(restPosition(block.lattice, *block.state.cells, node),
                block.lattice.restPosition(block.state.cells->original(node)));
    }
    return fixed;
  };
  EXPECT_EQ(countFixed(across(0, 1.5)), 2 * 3);  // upright: the bottom row on both sides
  EXPECT_EQ(countFixed(across(2, 0.5)), 0);      // what is cut off stands on ghosts of fixed nodes
}

TEST(Ghosts, PieceCutOffTheFixedNodesIsFree) {
  ElasticBlock block(withFixedBottom(elasticBlockOf(2, 2, 3, 0.45)));
  cut(block, across(2, 0.5));
  const DofMap unknowns(block.lattice, block.model, {block.state, {}});
  const auto nodes = static_cast<int>(block.state.displacement.size());
  EXPECT_EQ(unknowns.count(), 3 * (nodes - 9));
  expectSound(block, 12.0);
}

// A bar, clamped at one end, cut along its middle: two bars as if each had been built by itself, of
// 2 layers of cells and one that is filled by half.
class CutBar : public ::testing::Test {
 protected:
  static constexpr int kLong = 16, kHigh = 5;
  static TissueConfig bar(int high) {
    TissueConfig config = elasticBlockOf(kLong, 2, high, 0.3);
    config.fixed.push_back(nodeBox(config, {0, 0, 0}, {0, 2, high}));
    config.gravity = Vec3(0.0, 0.0, -0.05);
    return config;
  }
  static TissueConfig halfBar() {
    TissueConfig config = bar(3);
    // Besides it a box of three whole cells, so that the grid stands as that of the whole bar.
    config.mesh = std::make_shared<const TriangleMesh>(
        joined(boxMesh(Vec3::Zero(), kSpacing * Vec3(kLong, 2.0, 2.5)),
               boxMesh(kSpacing * Vec3(0.0, 5.0, 0.0), kSpacing * Vec3(1.0, 6.0, 3.0))));
    config.fixed.push_back({kSpacing * Vec3(-1.0, 4.5, -1.0), kSpacing * Vec3(2.0, 7.0, 4.0)});
    return config;
  }
};

TEST_F(CutBar, BendsLikeTwoBars) {
  ElasticBlock whole(bar(kHigh)), parted(bar(kHigh)), alone(halfBar());
  cut(parted, across(2, 2.5));
  ASSERT_EQ(parted.state.pieces, 2);
  for (ElasticBlock* block : {&whole, &parted, &alone}) {
    ASSERT_EQ(block->solve({}).status, SolveStatus::kOk);
  }
  for (int node = 0; node < alone.lattice.nodeCount(); ++node) {
    const auto [i, j, k] = alone.lattice.gridIndex(node);
    if (j > 2) continue;
    const Vec3& expected = alone.state.displacement[at(node)];
    const auto place = parted.lattice.node(i, j, k);
    const int twin = k < 3 ? place : [&] {
      for (int ghost = parted.lattice.nodeCount(); true; ++ghost) {
        if (parted.state.cells->original(ghost) == place) return ghost;
      }
    }();
    EXPECT_LT((parted.state.displacement[at(twin)] - expected).norm(), 1e-9 * kSpacing);
  }
  const double before = whole.state.displacement[at(whole.lattice.node(kLong, 1, 0))].z();
  const double after = parted.state.displacement[at(parted.lattice.node(kLong, 1, 0))].z();
  RecordProperty("softer", std::to_string(after / before));
  // Four by bending alone, less what shear adds to the whole bar's.
  EXPECT_GT(after / before, 3.5);
  EXPECT_LT(after / before, 4.1);
}

// Numbers from 0 on in the order of the lowest nodes; ghosts are of the part that they complete.
TEST(SplitCells, PiecesAreNumberedWithTheirGhosts) {
  ElasticBlock block(elasticBlockOf(4, 3, 2, 0.45));
  EXPECT_EQ(pieceOfNodes(block.lattice, block.state),
            std::vector<int>(at(block.lattice.nodeCount()), 0));
  cut(block, across(0, 1.5));
  cut(block, across(1, 0.5));
  const std::vector<int> piece = pieceOfNodes(block.lattice, block.state);
  const std::vector<int> lowest = piecesOf(block);
  ASSERT_EQ(piece.size(), lowest.size());
  std::map<int, int> number_of;  // by the lowest node
  for (std::size_t node = 0; node < piece.size(); ++node) {
    const auto [known, is_new] = number_of.emplace(lowest[node], piece[node]);
    if (is_new) {
      EXPECT_EQ(piece[node], static_cast<int>(number_of.size()) - 1);
    }
    EXPECT_EQ(piece[node], known->second) << "node " << node;
  }
  EXPECT_EQ(static_cast<int>(number_of.size()), countPieces(block.lattice, block.state));
  EXPECT_EQ(number_of.size(), 4U);
}

// A cut looks at the cells beside its springs alone.
TEST(SplitCells, ThoseOfEarlierCutsAreAsIfAllWereFoundAnew) {
  ElasticBlock block(elasticBlockOf(5, 5, 5, 0.45));
  for (const auto& [axis, height] : {std::pair(0, 2.3), {1, 1.9995}, {2, 3.4}, {0, 3.7}}) {
    const LatticeState before = block.state;
    cut(block, across(axis, height, 1.5));
    LatticeState anew = block.state;
    anew.cells = before.cells;
    const auto expected = cellsLeft(block.lattice, anew, SplitCells::kParted);
    const CellSet& found = *block.state.cells;
    ASSERT_EQ(found.all().size(), expected->all().size());
    ASSERT_EQ(found.nodeCount(), expected->nodeCount());
    for (std::size_t i = 0; i < found.all().size(); ++i) {
      const Cell &one = found.all()[i], &other = expected->all()[i];
      EXPECT_EQ(one.place, other.place);
      EXPECT_EQ(one.own, other.own);
      EXPECT_EQ(one.nodes, other.nodes);
      ASSERT_EQ(one.fill == nullptr, other.fill == nullptr);
      if (one.fill == nullptr) continue;
      EXPECT_EQ(one.fill->share, other.fill->share);
      EXPECT_EQ(one.fill->products, other.fill->products);
      EXPECT_EQ(one.fill->spread, other.fill->spread);
    }
  }
}

}  // namespace
}  // namespace robot_tissue::test_split_cells
