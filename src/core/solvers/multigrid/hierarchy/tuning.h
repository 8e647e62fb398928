// Every number of this room that is no law: its unit, where it comes from, what turning it up does.
// "model.md": doc/model.md, method `layered`, tells it, with what was measured. "Chosen": it passes
// the tests; what its neighbors would do was not written down.
#pragma once

namespace robot_tissue::hierarchy_tuning {

// --- A visit of the coarse levels (V-cycle)

// Steps of the smoother on a coarse level, before and after the next coarser one corrects it, and
// on the coarsest (model.md; two or four visits a cycle were slower). Up: fewer cycles, each
// dearer.
constexpr int kStepsBefore = 3;
constexpr int kStepsAfter = 3;
constexpr int kStepsCoarsest = 12;
// Spacings of a level: where what corrects it moves a node farther, the stiffness of nodes is found
// again, as it may look another way now (0.1: chosen). Up: cheaper, and bars that swing take
// longer.
constexpr double kSameStiffness = 0.1;
// Grid points along the longest side of the coarsest level, at most (model.md); there are two
// levels at least, as what the coarse one would move tells the error. Up: fewer levels, of which
// the coarsest is balanced less.
constexpr int kFewestPoints = 3;

// --- The parts that are open

// A level is solved for in a part only where the next coarser one has more points than this along
// its shortest side, and at most so many times as many cells along its longest: few trilinear cells
// are too stiff in bending (model.md). Up: more is open as a whole; less.
constexpr int kThick = 8;
constexpr int kMostSlender = 4;
// Layers around what a coarser level does not resolve (LevelSource::rough; model.md). Up: larger
// parts.
constexpr int kBesideRough = 2;
// Of a level's points: where a part has more, all of it is open (model.md). Up: larger parts that
// save little.
constexpr double kMostOpen = 0.6;
// The part that is open before there is a load, for the trial at rest: layers around the middle
// point, and then on each level (chosen, as under a tool). Up: slower to build.
constexpr int kAroundMiddle = 8;
constexpr int kLayersAroundMiddle = 6;

// --- Free ends of long blocks (FreeEnds)

// Of what balances in itself, e^-kDecay is left so far away as the block is wide: 4.2 in a strip's
// plane (Timoshenko and Goodier 1970), less where a thin one bends (chosen). Up: shorter blocks,
// and more is missed.
constexpr double kDecay = 2.0;
// Of the tolerance (1): what is left of it where an end begins (chosen). Up: likewise.
constexpr double kLeftOfEnds = 0.1;

// --- Membranes

// Spacings: their stiffness is found anew where a node of theirs has moved farther (chosen). Up: it
// is found less often, and fits worse.
constexpr double kSameMembrane = 0.02;

// --- Rounding and measuring

// Relative: a displacement in spacings that was written in meters and read back may differ by so
// much (rounding, double precision). Up: what others moved by less is not seen.
constexpr double kSame = 1e-15;
// Cells around those that a cut has changed, whose greatest stiffness is measured with them
// (chosen). Up: slower; less is told of sides that are none.
constexpr int kBesideChanged = 2;
// Cells along an axis of the block that tells the greatest stiffness of equal cells (chosen; larger
// blocks have the same). Up: slower to build.
constexpr int kMeasuredCells = 24;

}  // namespace robot_tissue::hierarchy_tuning
