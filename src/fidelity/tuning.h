// The numbers of the search for a resolution in one place: unit, where each comes from, and what
// turning it does. The orders of convergence that are believed are in richardson.h. Chosen: by
// judgment, and kept as the tests (doc/fidelity.md) passed; no other value was measured against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// The ladder of lattices.
// Cells along the shortest edge, of the coarsest lattice. More: fewer rungs; less: lattices whose
// answers no power of the spacing describes. Chosen.
constexpr double kFewestCells = 2.0;
// Of two neighbors' spacings (1): their ratio is at least and at most. Nearer to each other, they
// tell errors from noise badly; farther apart, the next is dear. Chosen: around 2.
constexpr double kLeastRatio = 1.25;
constexpr double kMostRatio = 3.2;
// Time grows with the nodes to this power (1): with the nodes, and with the load steps, which get
// shorter with the spacing. More: rungs are left out sooner for want of time. Derived.
constexpr double kCostExponent = 4.0 / 3.0;

// The limit at spacing 0.
// Lattices that it is found from, the finest ones. More: coarse ones, which are far from it, count.
// Chosen: as many as an order of convergence needs.
constexpr std::size_t kMostSamples = 3;
// Orders (1) between which the observed one is sought. Wider: the same answers, as
// orders beyond those believed are cut off. Chosen.
constexpr double kLowestSought = -1.0;
constexpr double kHighestSought = 4.0;

// The probe: what presses where the scene has no step.
// Of the extent along it (1): how deep. More: larger strains, harder solves. Chosen.
constexpr double kDepth = 0.1;
// Of a face's edges (1): the patch's middle part of them. More: nearer to a plate. Chosen.
constexpr double kPatch = 0.4;
// Of the smallest extent (1): the sphere's radius. Less: finer lattices are needed to meet it.
// Chosen.
constexpr double kRadius = 1.0 / 6.0;
// Of a mesh's extent (1): its end opposite of the probe, which is held. More: stiffer. Chosen.
constexpr double kHeld = 0.1;
// Of the radius (1): how far off the sphere appears. More: a longer way without contact. Chosen.
constexpr double kClearance = 0.01;
// Of the extent (1): beyond a face, so that the nodes on it are in a box. Rounding.
constexpr double kBeyond = 1e-6;

// Runs.
// Updates of a load whose way no one knows, as it is of a force. More: slower, smaller steps.
// Chosen.
constexpr int kUpdatesOfForce = 10;
// Updates (1): 5 mm are 5 updates of 1 mm, not 6. Rounding.
constexpr double kUpdateRounding = 1e-9;
// Updates that are enough to tell the time of one, and s up to which short runs are repeated to get
// them. More: steadier times, a longer search. Chosen.
constexpr std::size_t kEnoughUpdates = 30;
constexpr double kShortSeconds = 0.5;
// Spacings (1): a point so near to a face belongs to the cells on both sides. Rounding.
constexpr double kOnFace = 1e-6;

}  // namespace robot_tissue::tuning
