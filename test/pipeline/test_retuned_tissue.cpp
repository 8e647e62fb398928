// Tissue that becomes stiffer or softer under a tool: what the tool feels is that of the new
// tissue.
#include "pipeline_fixtures.h"

namespace robot_tissue::test_retuned_tissue {
namespace {

constexpr double kDepth = 0.004;  // m
constexpr double kSoft = 1e4;     // Pa

TissueConfig blockOf(double young_modulus) {
  TissueConfig tissue = block();
  tissue.material.young_modulus = young_modulus;
  return tissue;
}

ToolGeometry tool() { return withFriction(0.3, probe()); }

const ToolReport& toolOf(const Pipeline& pipeline) { return pipeline.report().tools.front(); }

void stand(Pipeline& pipeline) {
  for (int update = 0; update < 3; ++update) pipeline.step(pressed(kDepth));
}

class RetunedTissue : public ::testing::TestWithParam<double> {};

TEST_P(RetunedTissue, ThatWasStifferPushesAsItIsNow) {
  Pipeline pipeline(blockOf(GetParam()), SolverConfig(), {tool()});
  Pipeline soft(blockOf(kSoft), SolverConfig(), {tool()});
  for (Pipeline* each : {&pipeline, &soft}) walk(*each, -0.001, kDepth);
  pipeline.retune(blockOf(kSoft), SolverConfig());
  stand(pipeline);
  const double expected = toolOf(soft).force_on_tool.z();
  ASSERT_GT(expected, 0.1);
  EXPECT_NEAR(toolOf(pipeline).force_on_tool.z(), expected, 0.02 * expected);
  EXPECT_LT(toolOf(pipeline).max_penetration, 0.05 * kSpacing);
  EXPECT_EQ(pipeline.tissue().lastReport().status, SolveStatus::kOk);
}

TEST_P(RetunedTissue, ThatWasSofterPushesAsItIsNow) {
  Pipeline pipeline(blockOf(kSoft), SolverConfig(), {tool()});
  walk(pipeline, -0.001, kDepth);
  const double before = toolOf(pipeline).force_on_tool.z();
  pipeline.retune(blockOf(GetParam()), SolverConfig());
  stand(pipeline);
  const double expected = before * GetParam() / kSoft;
  EXPECT_NEAR(toolOf(pipeline).force_on_tool.z(), expected, 0.02 * expected);
}

INSTANTIATE_TEST_SUITE_P(Modulus, RetunedTissue, ::testing::Values(2e4, 2e5, 1e7, 1e9, 1e13));

}  // namespace
}  // namespace robot_tissue::test_retuned_tissue
