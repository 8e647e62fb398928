// Bad entries of tissue.membranes are refused.
#include "bad_scene.h"

namespace robot_tissue::test_bad_membranes {
namespace {

const std::string kCovered = R"(tissue:
  shape: {type: box, min: [0.0, 0.0, 0.0], max: [0.1, 0.1, 0.05]}
  spacing: 0.01
  model: elastic
  material: {young_modulus: 10000.0}
  membranes:
    - {name: capsule, thickness: 0.001, young_modulus: 1.0e+5, poisson_ratio: 0.4, side: outer, pressure: 20}
    - {thickness: 0.002, young_modulus: 2.0e+5, boxes: [{min: [-1, -1, 0.04], max: [1, 1, 1]}]}
solver: {method: layered}
)";

class BadMembrane : public ::testing::TestWithParam<BadScene> {};

TEST_P(BadMembrane, IsRefusedInOneLine) { expectRefusal(kCovered, SceneUser::kRunner, GetParam()); }

const std::vector<BadScene> kBadMembranes = {
    {"ThicknessMissing",
     "thickness: 0.001, ",
     "",
     {"tissue.membranes[0].thickness is missing", "in m"}},
    {"ThicknessZero", "0.001", "0", {"tissue.membranes[0].thickness = 0", "from 1e-09"}},
    {"ThickerThanTheSpacing",
     "0.001",
     "0.02",
     {"tissue.membranes[0].thickness = 0.02", "at most the spacing, 0.01"}},
    {"ModulusMissing",
     ", young_modulus: 1.0e+5",
     "",
     {"tissue.membranes[0].young_modulus is missing", "in Pa"}},
    {"ModulusBeyondAllContrast",
     "1.0e+5",
     "1.0e+13",
     {"tissue.membranes[0].young_modulus = 1.0e+13", "at most", "layer of cells"}},
    {"RatioBeyondHalf",
     "poisson_ratio: 0.4",
     "poisson_ratio: 0.51",
     {"tissue.membranes[0].poisson_ratio = 0.51", "from 0 to 0.5"}},
    {"SideUnknown",
     "side: outer",
     "side: left",
     {"tissue.membranes[0].side = left", "all, outer, inner"}},
    {"PressureIsWord",
     "pressure: 20",
     "pressure: high",
     {"tissue.membranes[0].pressure = high", "in Pa"}},
    {"BoxesEmpty",
     "[{min: [-1, -1, 0.04], max: [1, 1, 1]}]",
     "[]",
     {"tissue.membranes[1].boxes = []", "boxes with min and max"}},
    {"BoxWithoutMax",
     ", max: [1, 1, 1]}",
     "}",
     {"tissue.membranes[1].boxes[0].max is missing", "3 numbers"}},
    {"UnknownKey",
     "pressure: 20",
     "presure: 20",
     {"tissue.membranes[0].presure = 20", "did you mean pressure?"}},
    {"OnSprings",
     "model: elastic",
     "model: six_spring",
     {"tissue.membranes = ", "must be left out", "only model elastic"}},
    {"InTime",
     "model: elastic",
     "time: {mode: dynamic}",
     {"tissue.membranes = ", "must be left out", "tissue.time"}},
    {"MethodWithoutMembranes",
     "method: layered",
     "method: vbd",
     {"solver.method = vbd", "must be layered, newton"}},
};

INSTANTIATE_TEST_SUITE_P(Membranes, BadMembrane, ::testing::ValuesIn(kBadMembranes), caseName);

// What is given is what is read.
TEST(Membrane, IsReadAsWritten) {
  SceneSource source;
  const Scene scene = parseScene(YAML::Load(kCovered), source);
  ASSERT_EQ(scene.tissue.membranes.size(), 2U);
  const MembraneConfig& capsule = scene.tissue.membranes[0];
  EXPECT_EQ(capsule.name, "capsule");
  EXPECT_EQ(capsule.thickness, 0.001);
  EXPECT_EQ(capsule.young_modulus, 1e5);
  EXPECT_EQ(capsule.poisson_ratio, 0.4);
  EXPECT_EQ(capsule.side, MembraneConfig::Side::kOuter);
  EXPECT_EQ(capsule.pressure, 20.0);
  EXPECT_TRUE(capsule.boxes.empty());
  const MembraneConfig& patch = scene.tissue.membranes[1];
  EXPECT_EQ(patch.poisson_ratio, 0.45);
  EXPECT_EQ(patch.side, MembraneConfig::Side::kAll);
  EXPECT_EQ(patch.pressure, 0.0);
  ASSERT_EQ(patch.boxes.size(), 1U);
  EXPECT_EQ(patch.boxes[0].min(), Vec3(-1, -1, 0.04));
}

}  // namespace
}  // namespace robot_tissue::test_bad_membranes
