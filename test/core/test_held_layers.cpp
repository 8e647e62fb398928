// Meshes whose faces stand between the lattice's nodes, held or loaded there: nodes outside of the
// surface are held, and it is as if the surface were.
#include <gtest/gtest.h>

#include "lattice/held_layers.h"
#include "mesh_fixtures.h"
#include "robot_tissue/core/lattice.h"
#include "tissue_fixtures.h"

namespace robot_tissue::test_held_layers {
namespace {

constexpr double kWidth = 0.05, kHeight = 0.0255, kFitting = 0.0051;  // m

const Box kBelow{Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1e-6)};
const Box kAbove{Vec3(-1.0, -1.0, kHeight - 1e-6), Vec3(0.06, 1.0, 1.0)};

// A block, and beside it a bar that goes deeper by this much (m) and ends below the block's top: as
// lattices are centered on their mesh, it says where the block's faces are between the nodes.
TissueConfig blockBeside(double deeper, double spacing, const std::string& model = "elastic") {
  TissueConfig config;
  config.mesh = std::make_shared<const TriangleMesh>(
      joined(boxMesh(Vec3::Zero(), {kWidth, kWidth, kHeight}),
             boxMesh({0.08, 0.0, -deeper}, {0.09, 0.01, kHeight - 0.002})));
  config.spacing = spacing;
  config.model = model;
  config.material.young_modulus = 1e4;
  config.material.poisson_ratio = 0.45;
  config.fixed.push_back(kBelow);
  return config;
}

struct Measured {
  double sag = 0.0;    // m, of the middle of the top
  double force = 0.0;  // N, to press the top down by a millimeter
  double slide = 0.0;  // N, or aside
};

double heightOfTop(const Tissue& tissue) {
  const TissueSurface& surface = tissue.surface();
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < surface.rest.size(); ++i) {
    const Vec3 off = surface.rest[i] - Vec3(0.5 * kWidth, 0.5 * kWidth, kHeight);
    if (off.cwiseAbs().maxCoeff() > 0.2 * kWidth || std::abs(off.z()) > 1e-9) continue;
    sum += tissue.vertices()[i].z();
    ++count;
  }
  return sum / count;
}

Vec3 forceFor(const TissueConfig& config, const Vec3& displacement) {
  Tissue tissue(config, SolverConfig());
  tissue.load(loadOf({displacedPatch("plate", kAbove, displacement)}));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  return tissue.lastReport().patches.front().force;
}

Measured measured(TissueConfig config) {
  Measured found;
  found.force = -forceFor(config, {0.0, 0.0, -0.001}).z();
  found.slide = forceFor(config, {0.001, 0.0, 0.0}).x();
  config.gravity = {0.0, 0.0, -9.81};
  Tissue heavy(config, SolverConfig());
  EXPECT_EQ(heavy.settle().status, SolveStatus::kOk);
  found.sag = kHeight - heightOfTop(heavy);
  return found;
}

// Were the strain next to a face that over a whole spacing, the block would sag by up to seven
// times as much.
TEST(HeldLayers, FacesBetweenNodesAreHeldAndLoadedAsFacesOnNodes) {
  const Measured fitting = measured(blockBeside(0.0, kFitting));
  EXPECT_GT(fitting.force, 1.0);
  EXPECT_GT(fitting.sag, 1e-4);
  for (const double spacing : {0.0051, 0.005, 0.0036}) {
    for (const double deeper : {0.0, 0.001, 0.0025, 0.004, 0.0044}) {
      const Measured between = measured(blockBeside(deeper, spacing));
      EXPECT_NEAR(between.sag / fitting.sag, 1.0, 0.04) << spacing << ' ' << deeper;
      EXPECT_NEAR(between.force / fitting.force, 1.0, 0.06) << spacing << ' ' << deeper;
      EXPECT_NEAR(between.slide / fitting.slide, 1.0, 0.06) << spacing << ' ' << deeper;
    }
  }
}

// Force on a plate with the given middle and width (m) that goes by this (m).
Vec3 onPlate(const TissueConfig& config, double middle_x, double middle_y, double width,
             const Vec3& displacement) {
  Tissue tissue(config, SolverConfig());
  const Box box{Vec3(middle_x - 0.5 * width, middle_y - 0.5 * width, kHeight - 1e-6),
                Vec3(middle_x + 0.5 * width, middle_y + 0.5 * width, 1.0)};
  tissue.load(loadOf({displacedPatch("plate", box, displacement)}));
  EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
  return tissue.lastReport().patches.front().force;
}

// The plate ends between nodes, too, and its face stands anywhere between them. With springs by the
// area that it covers it felt 5 to 52 % too little, by its nodes alone even less.
TEST(HeldLayers, APlateIsAsWideAsItsBoxWhereverTheNodesAre) {
  const double middle = 0.5 * kWidth, spacing = 0.005;
  const Vec3 pressed(0.0, 0.0, -0.0005), sheared(0.0005, 0.0, 0.0);
  const TissueConfig fine = blockBeside(0.0, 0.5 * kFitting);
  for (const double width : {0.005, 0.01, 0.02}) {
    const double press = onPlate(fine, middle, middle, width, pressed).z();
    const double shear = onPlate(fine, middle, middle, width, sheared).x();
    const double most = width < 2.0 * spacing ? 0.1 : 0.06;
    for (const double deeper : {0.0, 0.003}) {
      const TissueConfig coarse = blockBeside(deeper, spacing);
      for (const double aside : {-0.4, 0.2}) {
        const double x = middle + aside * spacing, y = middle + 0.7 * aside * spacing;
        EXPECT_NEAR(onPlate(coarse, x, y, width, pressed).z() / press, 1.0, most)
            << width << ' ' << deeper << ' ' << aside;
        EXPECT_NEAR(onPlate(coarse, x, y, width, sheared).x() / shear, 1.0, most)
            << width << ' ' << deeper << ' ' << aside;
      }
    }
  }
}

// Where the tissue ends with the plate, between nodes, it is held as by a plate that is wider.
TEST(HeldLayers, APlateThatEndsWithTheTissueIsAsOneThatGoesOn) {
  const TissueConfig config = blockBeside(0.003, 0.0045);
  for (const Vec3& displacement : {Vec3(0.0, 0.0, -0.001), Vec3(0.001, 0.0, 0.0)}) {
    const Vec3 ends = onPlate(config, 0.5 * kWidth, 0.5 * kWidth, kWidth, displacement);
    const Vec3 goes_on = forceFor(config, displacement);
    EXPECT_NEAR(ends.norm() / goes_on.norm(), 1.0, 0.02);
  }
}

// What the plate's nodes and springs do to tissue is what its ground bears.
TEST(HeldLayers, APlatesForceIsBorneByTheGround) {
  Tissue tissue(blockBeside(0.003, 0.005), SolverConfig());
  const Box box{Vec3(0.0171, 0.0183, kHeight - 1e-6), Vec3(0.0262, 0.0249, 1.0)};
  tissue.load(loadOf({displacedPatch("plate", box, {0.0003, 0.0, -0.0005})}));
  const Vec3 force = tissue.lastReport().patches.front().force;
  Vec3 on_ground = Vec3::Zero();
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (tissue.lattice().isFixed(node)) on_ground += tissue.nodeForce(node);
  }
  EXPECT_LT((force - on_ground).norm(), 0.02 * force.norm());
}

TEST(HeldLayers, ALoadByForceMovesTheFaceAsFar) {
  double moved[2];
  for (const bool fits : {true, false}) {
    Tissue tissue(blockBeside(fits ? 0.0 : 0.003, fits ? kFitting : 0.005), SolverConfig());
    PatchConfig plate = displacedPatch("plate", kAbove, Vec3::Zero());
    plate.displacement.reset();
    plate.force = Vec3(0.0, 0.0, -1.0);
    tissue.load(loadOf({plate}));
    EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk);
    moved[fits ? 0 : 1] = tissue.lastReport().patches.front().displacement.z();
  }
  EXPECT_LT(moved[0], -3e-4);
  EXPECT_NEAR(moved[1] / moved[0], 1.0, 0.05);
}

// What it is let go of is as it was, bit for bit but for rounding.
TEST(HeldLayers, NothingIsLeftOfALoadThatIsReleased) {
  Tissue tissue(blockBeside(0.003, 0.005), SolverConfig());
  tissue.load(loadOf({displacedPatch("plate", kAbove, {0.001, 0.0, -0.002})}));
  tissue.release({"plate"});
  for (const Vec3& node : tissue.state().displacement) EXPECT_LT(node.norm(), 1e-12);
}

// Each half of a block that is cut through stands as firmly on its face as the whole.
TEST(HeldLayers, ACutLeavesItsPartsHeld) {
  const auto sagOf = [](double deeper, double spacing) {
    TissueConfig config = blockBeside(deeper, spacing);
    config.gravity = {0.0, 0.0, -9.81};
    Tissue tissue(config, SolverConfig());
    const double x = 0.0263;
    EXPECT_EQ(
        tissue.cut({Vec3(x, -1.0, -1.0), Vec3(x, 1.0, -1.0), Vec3(x, 1.0, 1.0), Vec3(x, -1.0, 1.0)})
            .pieces,
        3);
    tissue.settle();
    return kHeight - heightOfTop(tissue);
  };
  EXPECT_NEAR(sagOf(0.003, 0.005) / sagOf(0.0, kFitting), 1.0, 0.05);
}

std::vector<Vec3> plane(double height, double to) {
  return {Vec3(-1.0, -1.0, height), Vec3(to, -1.0, height), Vec3(to, 1.0, height),
          Vec3(-1.0, 1.0, height)};
}

// Under half of the block, along its face. Divided where it is laid, the layer would leave the
// wrong part of itself on either side of the cut, or next to nothing outside of its cell, where no
// balance is found.
TEST(HeldLayers, ACutAlongALayerLeavesWhatIsAboveAndBelowIt) {
  const auto forceAfterCut = [](double deeper, double spacing, double height) {
    Tissue tissue(blockBeside(deeper, spacing), SolverConfig());
    tissue.cut(plane(height, 0.0258));
    tissue.load(loadOf({displacedPatch("plate", kAbove, {0.0, 0.0, 0.001})}));
    EXPECT_EQ(tissue.lastReport().status, SolveStatus::kOk) << deeper << ' ' << height;
    return tissue.lastReport().patches.front().force.z();
  };
  for (const double height : {0.0004, 0.0008}) {
    const double fitting = forceAfterCut(0.0, kFitting, height);
    for (const double deeper : {0.001, 0.0025, 0.003}) {
      EXPECT_NEAR(forceAfterCut(deeper, 0.005, height) / fitting, 1.0, 0.1)
          << deeper << ' ' << height;
    }
  }
}

// The plate's springs would hold what is below the cut: it felt 1.8 times what it should.
TEST(HeldLayers, ACutUnderAPlatePartsItsSpringsToo) {
  const auto forceOf = [](double deeper, double spacing) {
    Tissue tissue(blockBeside(deeper, spacing), SolverConfig());
    tissue.load(loadOf({displacedPatch("plate", kAbove, {0.0, 0.0, 0.0003})}));
    const CutReport cut = tissue.cut(plane(0.0248, 0.0258));
    EXPECT_EQ(cut.solve.status, SolveStatus::kOk);
    return cut.solve.patches.front().force.z();
  };
  const double fitting = forceOf(0.0, kFitting);
  for (const double deeper : {0.001, 0.003}) {
    EXPECT_NEAR(forceOf(deeper, 0.005) / fitting, 1.0, 0.12) << deeper;
  }
}

// Springs to nodes that only the cut made would be to none once it is undone, and in no saved
// state.
TEST(HeldLayers, ACutUnderAPlateIsUndoneAndSaved) {
  Tissue tissue(blockBeside(0.003, 0.005), SolverConfig());
  tissue.cut(plane(0.0248, 0.0258));
  tissue.load(loadOf({displacedPatch("plate", kAbove, {0.0, 0.0, 0.0003})}));
  const double force = tissue.lastReport().patches.front().force.z();
  const std::string saved = tissue.savedState();
  EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
  EXPECT_GT(tissue.lastReport().patches.front().force.z(), force);
  tissue.loadState(*tissue.readState(saved));
  EXPECT_EQ(tissue.lastReport().patches.front().force.z(), force);
}

// As one that is put on anew: whether it was there before the cut, with another way since, or came
// after it.
TEST(HeldLayers, APlateOnMendedTissueHasAllOfItsSprings) {
  const auto answerAfter = [](const std::vector<PatchConfig>& before, const PatchConfig& plate,
                              bool cuts) {
    Tissue tissue(blockBeside(0.003, 0.005), SolverConfig());
    for (const PatchConfig& earlier : before) tissue.load(loadOf({earlier}));
    if (cuts) tissue.cut(plane(0.0248, 0.0258));
    tissue.load(loadOf({plate}));
    if (cuts) {
      EXPECT_EQ(tissue.undo(1).status, SolveStatus::kOk);
    }
    return tissue.lastReport().patches.front();
  };
  const auto pulled = [](double force) { return forcedPatch("plate", kAbove, {0.0, 0.0, force}); };
  const auto raised = [](double way) { return displacedPatch("plate", kAbove, {0.0, 0.0, way}); };
  const PatchAnswer whole = answerAfter({}, raised(0.0004), false);
  const PatchAnswer pulled_whole = answerAfter({}, pulled(0.2), false);
  for (const bool was_there : {false, true}) {
    const auto before = [&](const PatchConfig& plate) {
      return was_there ? std::vector<PatchConfig>{plate} : std::vector<PatchConfig>();
    };
    const PatchAnswer way = answerAfter(before(raised(0.0002)), raised(0.0004), true);
    EXPECT_NEAR(way.force.z() / whole.force.z(), 1.0, 0.01) << was_there;
    const PatchAnswer force = answerAfter(before(pulled(0.1)), pulled(0.2), true);
    EXPECT_NEAR(force.displacement.z() / pulled_whole.displacement.z(), 1.0, 0.01) << was_there;
  }
}

// A layer is of the material next to the face; the mass, and so the weight, stays the mesh's own.
TEST(HeldLayers, TheWeightIsTheMeshs) {
  TissueConfig held = blockBeside(0.003, 0.005), floating = held;
  floating.fixed.clear();
  const Lattice on_face(held), in_space(floating);
  double mass[2] = {0.0, 0.0};
  for (int node = 0; node < on_face.nodeCount(); ++node) {
    mass[0] += on_face.mass(node);
    mass[1] += in_space.mass(node);
  }
  EXPECT_NEAR(mass[0] / mass[1], 1.0, 1e-12);
}

CellFill slab(double from, double to) {
  FillIntegrals integrals;
  const double thick = to - from, middle = 0.5 * (from + to);
  integrals.volume = thick;
  integrals.first.z() = thick * middle;
  integrals.second = thick * Eigen::Matrix3d::Identity() / 12.0;
  integrals.second(2, 2) = thick * (middle * middle + thick * thick / 12.0);
  return fillOf(integrals);
}

// Of small strains the layer has the energy that a cell of its own thickness has: it is laid at the
// held nodes, and as firm as 1 / t^2.
TEST(HeldLayers, ALayerIsLaidOnTheNodesThatHoldIt) {
  Cell cell;
  for (int corner = 0; corner < kCorners; ++corner) cell.nodes[at(corner)] = corner;
  cell.fill = SharedConst<CellFill>(slab(0.1, 0.5));
  const auto of_sides = [&cell](std::vector<bool> held) {
    return heldLayer(cell, [held](int side) { return held[at(side)]; });
  };
  const auto layer = of_sides({false, true, false, false, true, false});
  ASSERT_TRUE(layer.has_value());
  EXPECT_EQ(layer->side, 4);
  EXPECT_NEAR(layer->thickness, 0.4, 1e-12);
  std::vector<Cell> cells{cell};
  layOnFixedNodes(cells, {1, 1, 1, 1, 0, 0, 0, 0});
  const CellFill& laid = *cells.front().fill;
  EXPECT_NEAR((laid.products - slab(-0.5, -0.1).products).norm(), 0.0, 1e-12);
  EXPECT_NEAR(laid.centroid.z(), -0.3, 1e-12);
  EXPECT_NEAR(laid.share, 0.4, 1e-12);
  EXPECT_NEAR(cells.front().stiffnessShare(), 1.0 / 0.4, 1e-9);
  // The material reaches the nodes above, and no layer is held from both sides.
  EXPECT_FALSE(of_sides({false, false, false, false, false, true}).has_value());
  EXPECT_FALSE(of_sides({false, false, false, false, true, true}).has_value());
  EXPECT_FALSE(of_sides({false, false, false, false, false, false}).has_value());
  // A cut from side to side: what stands on the held nodes is a layer, what does not is where it
  // is.
  EXPECT_NEAR((fillInMesh(laid).products - cell.fill->products).norm(), 0.0, 1e-12);
  Cell below = cells.front(), above = cells.front();
  below.own = 0x0f;
  above.own = 0xf0;
  const CellFill left = partOfLayer(cells.front(), below, slab(0.1, 0.2));
  EXPECT_EQ(left.held_side, 4);
  EXPECT_NEAR(left.centroid.z(), -0.45, 1e-12);
  EXPECT_EQ(left.thickness, laid.thickness);
  const CellFill freed = partOfLayer(cells.front(), above, slab(0.2, 0.5));
  EXPECT_EQ(freed.held_side, -1);
  EXPECT_NEAR(freed.centroid.z(), 0.35, 1e-12);
  EXPECT_EQ(freed.firmness(), 1.0);
}

}  // namespace
}  // namespace robot_tissue::test_held_layers
