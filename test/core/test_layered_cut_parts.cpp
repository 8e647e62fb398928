// Method `layered` where it visits a part of a block that is cut.
#include <gtest/gtest.h>

#include "cutting/cut.h"
#include "lattice/changed_cells.h"
#include "layered_fixtures.h"
#include "solvers/multigrid/hierarchy/level_source.h"

namespace robot_tissue::test_layered_cut_parts {
namespace {

constexpr double kTolerance = 0.01;

struct CutCase {
  std::array<int, 3> cells;
  std::vector<Vec3> corners;  // of the cut, in spacings
  const char* what;
};

std::vector<CutCase> cases() {
  return {{{32, 32, 16},
           {{20.4, 10, 11.3}, {20.9, 22, 11.3}, {20.9, 22, 17}, {20.4, 10, 17}},
           "upright slit beside the punch"},
          {{35, 33, 17},
           {{20, 12.3, 12.6}, {24, 12.3, 17.5}, {24, 19.4, 17.5}, {20, 19.4, 12.6}},
           "oblique slit, odd numbers of cells"},
          {{32, 32, 16},
           {{12.2, 12.2, 0.4}, {20.2, 12.2, 0.4}, {20.2, 20.2, 0.4}, {12.2, 20.2, 0.4}},
           "parted from the fixed nodes below"},
          {{48, 48, 32},
           {{28.6, 18, 22.3}, {29.4, 30, 22.3}, {29.4, 30, 33}, {28.6, 18, 33}},
           "coarse levels visited in part"},
          {{48, 48, 32},
           {{6.3, 14.3, 26.4}, {41.7, 14.3, 26.4}, {41.7, 33.7, 26.4}, {6.3, 33.7, 26.4}},
           "a flap, which bends"}};
}

class LayeredCutParts : public testing::TestWithParam<std::size_t> {
 protected:
  CutCase with() const { return cases()[GetParam()]; }
  TissueConfig config() const {
    return withFixedBottom(elasticBlockOf(with().cells[0], with().cells[1], with().cells[2], 0.45));
  }
  void cut(LayeredBlock& block) const {
    std::vector<Vec3> corners = with().corners;
    for (Vec3& corner : corners) corner *= block.lattice.spacing();
    const auto crossings = springsAcross(block.lattice, block.state, corners);
    ASSERT_GT(crossings.size(), 10U);
    sever(block.lattice, crossings, block.state, SplitCells::kParted);
  }
  LoadingPatch punch(const LayeredBlock& block, const Vec3& displacement) const {
    const std::array<int, 3> cells = with().cells;
    const int x = cells[0] / 2 - 2, y = cells[1] / 2 - 2;
    return displaced(
        block.lattice.nodesIn(nodeBox(config(), {x, y, cells[2]}, {x + 4, y + 4, cells[2]})),
        displacement);
  }
};
INSTANTIATE_TEST_SUITE_P(Cuts, LayeredCutParts, testing::Range<std::size_t>(0, cases().size()));

TEST_P(LayeredCutParts, AreAsNearTheEquilibriumAsTheWhole) {
  SCOPED_TRACE(with().what);
  LayeredBlock block(config(), within(kTolerance)), exact(config(), within(1e-5));
  cut(block);
  cut(exact);
  for (const Vec3& place : {Vec3(-0.002, 0, -0.005), Vec3(-0.002, 0, -0.01), Vec3(0, 0, -0.004)}) {
    const SolveReport report = block.solve({punch(block, place)});
    const SolveReport right = exact.solve({punch(exact, place)});
    ASSERT_EQ(report.status, SolveStatus::kOk);
    ASSERT_EQ(right.status, SolveStatus::kOk);
    EXPECT_LT(report.active_nodes, 2 * block.lattice.nodeCount() / 3);
    const double error =
        errorOf(block.lattice, block.patches, block.state.displacement, exact.state.displacement);
    EXPECT_LE(error, 1.5 * kTolerance);
    EXPECT_LE(error, 3.0 * report.error_estimate);
    const Vec3 force = report.patches.front().force, exactly = right.patches.front().force;
    EXPECT_LT((force - exactly).norm(), 1.5 * kTolerance * exactly.norm());
  }
}

// The lips part: without ghosts that move by themselves this would hold by chance.
TEST_P(LayeredCutParts, HaveGhostsThatMove) {
  LayeredBlock block(config(), within(kTolerance));
  cut(block);
  block.solve({punch(block, Vec3(-0.002, 0, -0.01))});
  const CellSet& cells = *block.state.cells;
  double apart = 0.0;
  for (int node = cells.latticeNodeCount(); node < cells.nodeCount(); ++node) {
    const Vec3 way =
        block.state.displacement[at(node)] - block.state.displacement[at(cells.original(node))];
    apart = std::max(apart, way.norm());
  }
  EXPECT_GT(apart, 1e-4);
}

// A state that is loaded brings other cells, and a tool in the air nothing to solve for.
TEST_P(LayeredCutParts, BearThatNothingActs) {
  LayeredBlock block(config(), within(kTolerance));
  block.solve({punch(block, Vec3(0, 0, -0.002))});
  block.state = block.lattice.restState();
  cut(block);
  EXPECT_EQ(block.solve({}).status, SolveStatus::kOk);
  for (const Vec3& moved : block.state.displacement) EXPECT_EQ(moved, Vec3(Vec3::Zero()));
  EXPECT_EQ(block.solve({punch(block, Vec3(0, 0, -0.002))}).status, SolveStatus::kOk);
  block.state = block.lattice.restState();  // as after an undo
  EXPECT_EQ(block.solve({}).status, SolveStatus::kOk);
  EXPECT_EQ(block.solve({punch(block, Vec3(0, 0, -0.002))}).status, SolveStatus::kOk);
}

TEST(LevelSource, ListsWhatIsCutAndNoMore) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(32, 32, 16, 0.3));
  LayeredBlock block(config);
  const double h = config.spacing;
  sever(block.lattice,
        springsAcross(block.lattice, block.state,
                      {h * Vec3(20.5, 12, 12.5), h * Vec3(20.5, 17, 12.5), h * Vec3(20.5, 17, 17),
                       h * Vec3(20.5, 12, 17)}),
        block.state, SplitCells::kParted);
  const CellSet& cells = *block.state.cells;
  std::vector<LevelSource> sources =
      levelSources(block.lattice, block.model, wholeOf(block.lattice.size()), 1.0, 3);
  listCuts(block.lattice, block.model, cells, 1.0, sources);
  ASSERT_GT(sources.size(), 2U);
  const ListedCells& finest = sources[0].listed;
  EXPECT_EQ(finest.beside, static_cast<int>(cells.ghosts().size()));
  EXPECT_GT(finest.box.low[0], 14);
  EXPECT_LT(finest.box.high[0], 26);
  EXPECT_GE(finest.box.low[2], 8);
  for (const LevelSource& source : sources) {
    const LevelGrid grid(source.size);
    double listed = 0.0, uncut = 0.0;
    for (const LevelCell& cell : source.cellsIn(source.whole(), grid)) listed += cell.shear;
    for (const LevelCell& cell : source.uncutIn(source.whole(), grid)) uncut += cell.shear;
    ASSERT_GT(uncut, 0.0);
    EXPECT_NEAR(listed, uncut, 1e-9 * uncut);  // nothing is lost
  }
}

TEST(ChangedCells, AreCountedByPlaceAndCorners) {
  const TissueConfig config = withFixedBottom(elasticBlockOf(8, 8, 8, 0.3));
  LayeredBlock block(config);
  const auto whole = block.state.cells;
  EXPECT_EQ(changedCells(block.lattice, *whole, *whole).share, 0.0);
  EXPECT_TRUE(changedCells(block.lattice, *whole, *whole).box.isEmpty());
  const double h = config.spacing;
  sever(block.lattice,
        springsAcross(block.lattice, block.state,
                      {h * Vec3(4.5, -1, 6.5), h * Vec3(4.5, 9, 6.5), h * Vec3(4.5, 9, 9),
                       h * Vec3(4.5, -1, 9)}),
        block.state, SplitCells::kParted);
  const CellSet& cut = *block.state.cells;
  // Eight cells along the top's middle are two parts each; those below hang together.
  const double parts = static_cast<double>(cut.all().size() - whole->all().size());
  ASSERT_EQ(parts, 8.0);
  const ChangedCells changed = changedCells(block.lattice, *whole, cut);
  EXPECT_NEAR(changed.share, 3.0 * parts / static_cast<double>(cut.all().size()), 1e-12);
  EXPECT_EQ(changed.box, (GridBox{{4, 0, 7}, {5, 8, 8}}));
  EXPECT_EQ(changed.share, changedCells(block.lattice, cut, *whole).share);
}

}  // namespace
}  // namespace robot_tissue::test_layered_cut_parts
