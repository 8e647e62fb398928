// What is taken back under loads leaves the loads as they are.
#include <gtest/gtest.h>

#include "block_fixtures.h"
#include "suture_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_undo_under_loads {
namespace {

TissueConfig tearing() {
  TissueConfig config = withFixedBottom(blockOf(8, 4, 3, 0.01));
  config.model = "elastic";
  config.material.poisson_ratio = 0.3;
  config.material.tear_stretch = 1.3;
  return config;
}

LoadStep lift(const TissueConfig& config, const std::string& name, int from, double way) {
  return loadOf(
      {displacedPatch(name, nodeBox(config, {from, 0, 3}, {from + 2, 4, 3}), {0, 0, way})});
}

// A blade that goes on after the loads became others.
TEST(UndoUnderLoads, AStrokeLeavesALoadThatCameWhileItLasted) {
  TissueConfig config = tearing();
  config.material.tear_stretch = 0.0;
  Tissue tissue(config, {});
  const auto strip = [](double from, double to) {
    const Vec3 a(0.035, -1.0, from), b(0.035, 1.0, from), c(0.035, 1.0, to), d(0.035, -1.0, to);
    return std::vector<CutTriangle>{{a, b, c}, {a, c, d}};
  };
  ASSERT_GT(tissue.cutAlong(strip(0.02, 0.04)).springs_cut, 0);
  tissue.load(lift(config, "a", 6, 0.002));
  ASSERT_GT(tissue.cutAlong(strip(0.01, 0.02), Stroke::kGoesOn).springs_cut, 0);
  ASSERT_EQ(tissue.undoable(), 1);
  tissue.undo(1);
  EXPECT_EQ(tissue.state().springs_cut, 0);
  EXPECT_EQ(tissue.namedPatches(), 1U);
}

}  // namespace
}  // namespace robot_tissue::test_undo_under_loads
