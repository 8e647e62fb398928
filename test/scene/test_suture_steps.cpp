// Steps that suture: what they say, and what is refused.
#include "bad_scene.h"

namespace robot_tissue::test_suture_steps {
namespace {

const std::string kSutureScene = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}
  spacing: 0.01
  material: {young_modulus: 10000.0}
steps:
  - settle: {}
  - suture: {from: [0.04, 0.05, 0.05], to: [0.06, 0.05, 0.05]}
  - suture: {name: s2, from: [0.04, 0.06, 0.05], to: [0.06, 0.06, 0.05], rest_length: 0.004,
      stiffness: 50, break_force: 1.5, bite: 0.002}
  - suture: {from: [0.04, 0.07, 0.05], to: [0.06, 0.07, 0.05]}
)";

TEST(SutureSteps, HaveEveryField) {
  SceneSource source;
  source.name = "scene.yaml";
  const Scene scene = parseScene(YAML::Load(kSutureScene), source);
  const auto suture = [&](std::size_t step) {
    return std::get<SutureStep>(scene.steps[step]).suture;
  };
  EXPECT_EQ(suture(1).name, "");  // the runner knows which are free
  EXPECT_EQ(suture(1).from, Vec3(0.04, 0.05, 0.05));
  EXPECT_EQ(suture(1).to, Vec3(0.06, 0.05, 0.05));
  EXPECT_EQ(suture(1).rest_length, 0.0);
  EXPECT_EQ(suture(1).stiffness, 200.0);
  EXPECT_EQ(suture(1).break_force, 0.0);
  EXPECT_EQ(suture(2).name, "s2");
  EXPECT_EQ(suture(2).rest_length, 0.004);
  EXPECT_EQ(suture(2).stiffness, 50.0);
  EXPECT_EQ(suture(2).break_force, 1.5);
  EXPECT_EQ(suture(1).bite, 0.0);
  EXPECT_EQ(suture(2).bite, 0.002);
  EXPECT_EQ(suture(3).name, "");
}

class BadSutures : public ::testing::TestWithParam<BadScene> {};

TEST_P(BadSutures, AreRefusedInOneLine) {
  expectRefusal(kSutureScene, SceneUser::kRunner, GetParam());
}

const std::vector<BadScene> kBadSutures = {
    {"SutureWithoutAnEnd",
     "- settle: {}",
     "- suture: {from: [0, 0, 0]}",
     {"steps[0].suture.to", "a list of 3 numbers"}},
    {"SutureFromNowhere",
     "- settle: {}",
     "- suture: {from: [0, 0, .inf], to: [0, 0, 0]}",
     {"steps[0].suture.from[2] = .inf", "a number from -1000 to 1000 in m"}},
    {"SutureKey",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], length: 1}",
     {"steps[0].suture.length = 1", "rest_length"}},
    {"SutureName",
     "- settle: {}",
     "- suture: {name: \"a,b\", from: [0, 0, 0], to: [0.01, 0, 0]}",
     {"steps[0].suture.name = \"a,b\"", "without commas"}},
    {"SutureLength",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], rest_length: -0.01}",
     {"steps[0].suture.rest_length = -0.01", "a number from 0 to 1000 in m"}},
    {"SutureStiffness",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], stiffness: 0}",
     {"steps[0].suture.stiffness = 0", "N/m"}},
    {"SutureBreakForce",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], break_force: -1}",
     {"steps[0].suture.break_force = -1", "a number from 0 to 1"}},
    {"SutureBreakForceTooGreat",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], break_force: 1.0e10}",
     {"steps[0].suture.break_force = 1.0e10", "a number from 0 to 1e+09 in N"}},
    {"SutureBite",
     "- settle: {}",
     "- suture: {from: [0, 0, 0], to: [0.01, 0, 0], bite: -0.01}",
     {"steps[0].suture.bite = -0.01", "a number from 0 to 1000 in m"}},
};

INSTANTIATE_TEST_SUITE_P(, BadSutures, ::testing::ValuesIn(kBadSutures), caseName);

}  // namespace
}  // namespace robot_tissue::test_suture_steps
