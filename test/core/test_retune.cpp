// Other moduli, another tolerance: a tissue that goes on with them is the one made with them.
#include <gtest/gtest.h>

#include "mesh_fixtures.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_retune {
namespace {

constexpr double kForceError = 1e-3;  // relative; the solver's tolerance is a tenth of it

SolverConfig exactSolver() {
  SolverConfig solver;
  solver.tolerance = 1e-4;
  return solver;
}

// With a region of its own modulus in a corner.
TissueConfig blockWith(double young_modulus) {
  TissueConfig config = withFixedBottom(blockOf(6, 5, 4));
  config.model = "elastic";
  config.material.young_modulus = young_modulus;
  Region region;
  region.box = {Vec3::Zero(), Vec3::Constant(0.03)};
  region.material = config.material;
  region.material.young_modulus = 3e4;
  region.own_modulus = true;
  config.regions.push_back(region);
  return config;
}

LoadStep press(const TissueConfig& config) {
  return loadOf({displacedPatch("punch", nodeBox(config, {1, 1, 4}, {2, 2, 4}), {0, 0, -0.004})});
}

Vec3 forceOf(const SolveReport& report) { return report.patches.at(0).force; }

TEST(Retune, IsTheTissueOfThatMaterial) {
  const TissueConfig soft = blockWith(1e4), hard = blockWith(2e4);
  Tissue made(hard, exactSolver());
  made.load(press(hard));
  Tissue retuned(soft, exactSolver());
  retuned.load(press(soft));
  const Vec3 before = forceOf(retuned.lastReport());
  EXPECT_TRUE(retuned.retune(hard, exactSolver()));
  const Vec3 force = forceOf(retuned.settle());
  const Vec3 expected = forceOf(made.lastReport());
  EXPECT_LT((force - expected).norm(), kForceError * expected.norm());
  EXPECT_GT(force.norm(), 1.2 * before.norm());
  EXPECT_LT(force.norm(), 1.9 * before.norm());  // the region's modulus stays
}

TEST(Retune, CellsOfTwoMaterialsKeepTheirShares) {
  TissueConfig soft = blockWith(1e4), hard = blockWith(2e4);
  const TriangleMesh ball = moved(sphereMesh(0.017, 2), Vec3(0.028, 0.023, 0.019));
  for (TissueConfig* config : {&soft, &hard}) {
    config->regions[0].mesh = std::make_shared<const TriangleMesh>(ball);
  }
  Tissue made(hard, exactSolver()), retuned(soft, exactSolver());
  made.load(press(hard));
  retuned.load(press(soft));
  EXPECT_TRUE(retuned.retune(hard, exactSolver()));
  const Vec3 force = forceOf(retuned.settle()), expected = forceOf(made.lastReport());
  EXPECT_LT((force - expected).norm(), kForceError * expected.norm());
}

TEST(Retune, SpringsHaveTheStiffnessOfTheirCells) {
  const TissueConfig soft = withFixedBottom(blockOf(4, 4, 4));
  TissueConfig hard = soft;
  hard.material.young_modulus *= 3.0;
  Tissue tissue(soft, paperSolver());
  const Lattice& lattice = tissue.lattice();
  const double before = lattice.springStiffness(lattice.springs()[7]),
               mass = tissue.lattice().mass(7);
  tissue.retune(hard, paperSolver());
  EXPECT_DOUBLE_EQ(lattice.springStiffness(lattice.springs()[7]), 3.0 * before);
  EXPECT_EQ(tissue.lattice().mass(7), mass);
  EXPECT_EQ(tissue.lattice().springs().size(),
            Tissue(hard, paperSolver()).lattice().springs().size());
}

TEST(Retune, ThatIsRefusedLeavesTheTissueAsItWas) {
  const TissueConfig config = blockWith(1e4);
  Tissue tissue(config, exactSolver());
  tissue.load(press(config));
  const Snapshot before(tissue);
  SolverConfig unknown = exactSolver();
  unknown.method = "none";
  EXPECT_TRUE(mentions(inputErrorOf([&] { tissue.retune(blockWith(2e4), unknown); }), "none"));
  expectUnchanged(tissue, before);
  EXPECT_EQ(tissue.settle().status, SolveStatus::kOk);
}

TEST(Retune, CutsStayAndAreTakenBack) {
  const TissueConfig soft = blockWith(1e4), hard = blockWith(2e4);
  Tissue tissue(soft, exactSolver());
  tissue.load(press(soft));
  const CutReport cut =
      tissue.cut({{0.035, -1.0, 0.01}, {0.035, 1.0, 0.01}, {0.035, 1.0, 1.0}, {0.035, -1.0, 1.0}});
  ASSERT_GT(cut.springs_cut, 0);
  tissue.retune(hard, exactSolver());
  tissue.settle();
  EXPECT_EQ(tissue.state().springs_cut, cut.springs_cut);
  const Vec3 force = forceOf(tissue.undo(1));
  Tissue whole(hard, exactSolver());
  whole.load(press(hard));
  const Vec3 expected = forceOf(whole.lastReport());
  EXPECT_LT((force - expected).norm(), kForceError * expected.norm());
}

TEST(Retune, ABudgetAloneChangesNoShape) {
  const TissueConfig config = blockWith(1e4);
  Tissue tissue(config, exactSolver());
  tissue.load(press(config));
  const std::uint64_t before = tissue.stateHash();
  SolverConfig budgeted = exactSolver();
  budgeted.max_ms = 50.0;
  EXPECT_FALSE(tissue.retune(config, budgeted));
  EXPECT_EQ(tissue.stateHash(), before);
}

TEST(Retune, LoadsOfASavedStateAreOfItsMaterial) {
  const TissueConfig soft = blockWith(1e4), hard = blockWith(2e4);
  Tissue tissue(soft, exactSolver());
  tissue.load(press(soft));
  const std::uint64_t before = tissue.stateHash();
  const std::string saved = tissue.savedState();
  tissue.retune(hard, exactSolver());
  const std::string refusal = inputErrorOf([&] { tissue.readState(saved); });
  EXPECT_TRUE(isOneLine(refusal) && mentions(refusal, "another material")) << refusal;
  tissue.retune(soft, exactSolver());
  tissue.loadState(*tissue.readState(saved));
  EXPECT_EQ(tissue.stateHash(), before);
}

TEST(Retune, LoadsOfASavedStateAreOfItsRegionsMesh) {
  TissueConfig config = blockWith(1e4), other = config;
  config.regions[0].mesh =
      std::make_shared<const TriangleMesh>(moved(sphereMesh(0.017, 2), Vec3(0.028, 0.023, 0.019)));
  other.regions[0].mesh =
      std::make_shared<const TriangleMesh>(moved(sphereMesh(0.016, 2), Vec3(0.028, 0.023, 0.019)));
  Tissue tissue(config, exactSolver()), same(config, exactSolver()),
      elsewhere(other, exactSolver());
  tissue.load(press(config));
  const std::string saved = tissue.savedState();
  same.loadState(*same.readState(saved));
  EXPECT_EQ(same.stateHash(), tissue.stateHash());
  const std::string refusal = inputErrorOf([&] { elsewhere.readState(saved); });
  EXPECT_TRUE(mentions(refusal, "regions")) << refusal;
}

}  // namespace
}  // namespace robot_tissue::test_retune
