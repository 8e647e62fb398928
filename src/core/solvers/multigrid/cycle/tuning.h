// Every number of this room that is no law: its unit, where it comes from, what turning it up does.
// "model.md": doc/model.md, method `layered`, tells it, with what was measured. "Chosen": it passes
// the tests; what its neighbors would do was not written down.
//
// Lengths in spacings of the finest lattice. |x|: length (L2) of the motion left
// (CompositeShape::correctionNorm). Tolerance: LayeredOptions::tolerance, of the relative error.
#pragma once

#include <cstddef>

namespace robot_tissue::cycle_tuning {

// --- Precision, rest

// Tolerance that single precision reaches (model.md). Up: more solves in double, slower.
constexpr double kSinglePrecision = 1e-3;
// Of what a time step's solve may be off: a displacement's rounding. A ball and an edge dragged, 10
// to 100 ms of damping: 0.04 to 0.2, forces as in double and half the time. Up: fine steps tremble.
constexpr double kRoundingInTime = 0.5;
// Of the greatest force (1): left unbalanced by a solve in single precision that did not converge,
// so little may be rounding (4e-5 pressed by 40 of 50 mm at nu 0.49). Up: hopeless solves are made
// twice.
constexpr double kRoundedForces = 1e-3;
// Spacings, per free node: off rest by less is at rest (model.md). Up: small loads are answered
// less exactly.
constexpr double kStill = 1e-6;

// --- A cycle (FasCgCycle)

// The smoother takes this times the root of the greatest stiffness of any motion in the nodes' own
// stiffnesses, as a Chebyshev polynomial's reach goes by the square of its degree (Lottes 2022;
// 1.6: model.md), and no fewer steps than these. Up: fewer cycles, each dearer.
constexpr double kStepsOfRoot = 1.6;
constexpr int kFewestSteps = 3;
// Times as many, in contact from the second cycle of a solve on (model.md). Up: likewise.
constexpr double kMoreInContact = 1.3;
// Steps of the smoother in the place of a cycle that led nowhere (model.md). Up: slower, surer.
constexpr int kPlainSteps = 8;
// |x| after a cycle over |x| before: above it, cycles are slow and conjugate gradients help
// (model.md). Up: more cycles stand alone.
constexpr double kSlow = 0.3;
// Likewise in contact, where cycles alone get on, each gone on with by one secant (model.md). Up:
// fewer conjugate gradients: quicker, but what slips slowly is left behind, and drags count too
// much.
constexpr double kSlowInContact = 0.7;
// Cycles of a solve in contact that may stand alone: where more are needed, as where a tool
// squeezes tissue flat, they get on slowly for long, and conjugate gradients are several times as
// fast. 6 and 20 measured alike (a box through the floor: 4.3 s, 15 s without this bound). Up:
// likewise.
constexpr int kCyclesAlone = 20;
// Of the slope at the start of a search: flat enough to end there (model.md). Up: shorter searches.
constexpr double kFlatEnough = 0.3;
// beta, share of the last direction: below, it is left out (chosen). Up: more begin anew.
constexpr double kWorthKeeping = 0.05;
// Cycles of a solve without contacts beyond which it is a long one, and many ways are kept
// (EarlierWays). 16 in place of 30: press_40 99 cycles in place of 96, sliver_hangs 848 and 758.
// Up: later; down: short solves pay for what they do not need.
constexpr int kLongSolve = 30;
// Ways that are kept. 2, 4, 8, 16 from the first cycle on: sliver_pulled 639, 502, 821, 632 cycles,
// one alone 1,663; ratio_10000 4,050, 1,866, 350, 141. Up: fewer cycles; two fields each.
constexpr std::size_t kMostWays = 16;
// Cycles of a solve without contacts after which coarse cells have relief (model.md) where more
// than this share of |x| is left. 1, 5, 12 cycles: bars that sag far take 54, 56 and 66 (mean of
// nine). Without the share cells have relief that are squeezed, not bent: press_40 417 cycles for
// 209, twist_180_by_45 a fold. 0.2 to 0.5: that one takes 664 to 709 cycles, 1: 2,868. Up: later,
// where it is too late; down: in more solves that need none.
constexpr int kCyclesBeforeRelief = 12;
constexpr double kLeadsAstray = 0.4;
// Share of a cycle's own slope that is left, at least, once it is conjugate to a way: below, this
// one and older ones do not fit any more. 0.1: sliver_pulled took up to 1,973 cycles, mesh_ball_20
// up to 338. Up: ways are forgotten sooner.
constexpr double kLeastOfSlope = 0.5;
// Places that a line search tries (chosen), and how many of them further and further, where the
// slope stays positive (chosen). Up: longer searches; longer steps.
constexpr int kTrials = 8;
constexpr int kTrialsAhead = 2;
// Times the last load step: the farthest warm start (chosen). Up: bolder where steps grow.
constexpr double kFarthestWarmStart = 2.0;

// --- Going astray (FasCgIteration)

// Times |x| where cycles began: the shape blew up, and the best one comes back (model.md). Up:
// later.
constexpr double kBlownUp = 100.0;
// Likewise, of a solve cut short, whose shape no cycle comes to mend (chosen). Up: likewise.
constexpr double kAstray = 3.0;
// Spacings from a tool at which springs already count as stiff in the last steps of a solve cut
// short (model.md). Up: what is thrown into a tool is told less as a force; steps are shorter.
constexpr double kSoonTouches = 0.1;

// --- Forces (ForceBalance)

// Times the tolerance: share of the given force that may be unbalanced in all at the end; and
// rounds of the smoother that are spent on it (both: model.md). Up: worse forces, quicker; better
// forces, slower.
constexpr double kForceShare = 2.0;
constexpr int kMostSettling = 3;
// Of a solve's time (1): beyond it by so much, a solve cut short spends none of these rounds
// (chosen). Up: better forces; calls that have no time end later.
constexpr double kMostOverdrawn = 0.25;
// Likewise after the one cycle of a solve in contact that ends with it: what is unbalanced is what
// forces jump by from update to update (0.5: as smooth as with a second look, 2: twice as rough,
// model.md). Up: fewer second looks, rougher forces.
constexpr double kQuietForceShare = 0.5;
// Share of a patch's own force that may be unbalanced on it, if the tolerance is less: single
// precision knows no better (chosen). Up: patches by force stop earlier.
constexpr double kPatchBalance = 1e-5;
// Of the greatest other force that acts: a patch's load that is less, as one of zero, is balanced
// as exactly as one of that size (chosen). Up: small loads are answered less exactly; down:
// rounding is taken for what is out of balance.
constexpr double kLeastLoad = 1e-3;
// Share of the greatest force that may be unbalanced on a node, without contacts (chosen, for what
// hangs by little and moves far). Up: that stops early.
constexpr double kMostUnbalanced = 0.1;
// Likewise of the greatest force that there was, where nothing acts any more (as little as single
// precision is sure of, kRoundedForces; 0.1: a bar that hangs by part of a cell, let go, was left 4
// h off rest with 0.02 unbalanced). Up: what hangs by little stays where it is; down: free pieces
// take longer.
constexpr double kMostUnloaded = 1e-3;
// Last digits of the displacement (1): forces that move nodes by no more, each alone, are rounding
// (chosen; a free piece let go again 0.2 to 20 h off rest). Up: likewise.
constexpr double kRoundedDigits = 4.0;
// Share of the contacts' force that may be unbalanced in all, and cycles of a solve that are spent
// on it (both chosen). Up: worse forces in contact, quicker; slower where tissue slips.
constexpr double kContactBalance = 0.05;
constexpr int kCyclesForBalance = 6;
// Share of the force on patches by force: as much unbalanced in all, nothing holds them (chosen).
// Up: what falls may count as balanced.
constexpr double kFalling = 0.5;

// --- Estimate of the error (ErrorEstimator)

// |x| after cycles over |x| before: above it, they teach nothing of the factor, as the difference
// is too small to divide by (chosen). Up: more samples, and wilder ones.
constexpr double kMostLeft = 0.9;
// Likewise in contact, where |x| swings as springs begin and end: at 0.9 one swing may show a
// factor of 20, which the next ten solves then reckon with. 0.5 takes a tenth less time, but ends
// with up to 0.3 % more of a force missing. Up: likewise.
constexpr double kMostLeftInContact = 0.7;
// Greatest factor that the first kLong cycles of a solve may show, and later ones, in which what
// hangs by little moves far (chosen). Up: a chance sample costs more cycles.
constexpr double kMostSoon = 32.0;
constexpr double kMostFactor = 1000.0;
constexpr int kLong = 15;
// Share of the factor that is left after a cycle that shows less (chosen). Up: hard solves make the
// next ones longer.
constexpr double kRemembered = 0.9;
// Share of |x| before a cycle that counts as left after it, at least, under conjugate gradients,
// where |x| swings on its way down (chosen). Up: surer, more cycles.
constexpr double kDip = 0.5;
// Share of the error that is left, at least, by the smooth motion that ends a solve (model.md). Up:
// likewise.
constexpr double kLeastAfter = 0.6;
// Cycles: at each power of two from here on, the shape is marked, and so many cycles later what it
// went since then tells of slow motions (chosen). Up: these are seen later.
constexpr int kFirstMark = 16;
constexpr int kShortest = 4;

// The trial at rest (model.md). Cycles where all is open, and where a part is, as what is beyond
// comes later. Up: slower to build, slower motions count.
constexpr int kTrialCycles = 6;
constexpr int kTrialCyclesInPart = 12;
// Of a long block between its free ends, which bends: what bends is slow, and seen late (3 cells
// across: 1 until 20 cycles, 4 and 44 at 24). Up: likewise.
constexpr int kTrialCyclesBetweenEnds = 40;
// Spacings from end to end of its random numbers: so small that the answer is linear.
constexpr double kTrialMotion = 1e-3;
// Share of the cells: once cuts have changed more since the trial, it is made again, and the
// levels' greatest stiffness is measured again. Up: fewer trials, errors are told as too small.
constexpr double kMeasuredAgain = 0.01;
// Times what levels take that are not measured (1): so long, about, it takes to measure them (2.5
// to 3.5 after 1 to 200 cuts at 4,851 nodes). Up: a solve with little time leaves that to a later
// one more often; down: it ends later.
constexpr double kMeasuringOverLevels = 3.0;
// What the last cycle would move over what is left: beyond, cycles go to and fro (2: for ever, a
// bar three cells across). Up: that is taken for convergence.
constexpr double kToAndFro = 1.5;
// Greatest factor that it may show: nu 0.49 has it. Up: more cycles there.
constexpr double kMostAtRest = 8.0;
// Of smooth motions. Share of them that is left in the third cycle: less, and nothing is slow
// (blocks on the ground: 0.01 to 0.4, at nu 0.49 0.3 to 0.7; held by a corner: 0.6 and more). Up:
// fewer lattices are looked at closely.
constexpr double kFast = 0.4;
constexpr int kFirstFastCycle = 2;
// What a cycle leaves of them, and how much more of them is hidden than before it (1): beyond both
// they are slow, and cycles go on after the sixth (blocks on the ground: 0.2 to 0.9; held by a
// corner: 0.95 to 1.02). Up: likewise; down: more cycles.
constexpr double kHardlyFalls = 0.9;
constexpr double kHidesMore = 1.02;
constexpr int kFirstSlowCycle = 5;
constexpr int kMostSlowCycles = 30;
// The least factor that counts of them (blocks on the ground show 1 to 8, and 10 at nu 0.49), and
// the greatest: of 300 small blocks at random those that were off most, by 8, 5.5 and 3 times what
// was told, wanted 70. Up: fewer lattices; more cycles for those.
constexpr double kClearlySlow = 12.0;
constexpr double kMostOfSlow = 100.0;
// What shows more than this moves freely, as tissue that nothing holds (held by a corner: 740).
constexpr double kFree = 1000.0;

// --- Patience

// Times the farthest that a solve came from its start: it gets on (chosen). Up: it gives up sooner.
constexpr double kFarther = 1.1;
// Cycles without a gain in a part: then all is open (model.md). Up: later.
constexpr int kPatienceInPart = 6;
// Cycles of a load step in contact beyond which it is a hard one (chosen: nine in ten under the
// tools of the contact study take up to 18, tissue that slips off an edge 100 to 800). Up: jams are
// followed for longer.
constexpr int kUsualCycles = 30;
// Radians by which a patch by force turns to be solved for anew (model.md), and how often at most
// (chosen). Up: less exact moments; longer solves.
constexpr double kTurned = 1e-4;
constexpr int kMostTurns = 20;
// Of the tolerance (rad): a patch that still turns so little, as to and fro, is in balance (chosen:
// moments are as exact then as a tenth of the tolerance). Up: less exact moments.
constexpr double kTurnsOn = 0.1;
// Rounds of one solve, in wider parts or for what these miss (chosen). Up: longer solves.
constexpr int kMostRounds = 8;

// --- The open part (OpenPart)

// Layers around the seeds to begin with: kLayersOfError over the tolerance, within these bounds
// (model.md). Up: dearer cycles, parts are widened less often.
constexpr double kLayersOfError = 0.06;
constexpr double kFewestLayers = 4.0;
constexpr double kEnoughLayers = 6.0;
// Times the layers there were, where coarse lattices miss too much (model.md). Up: likewise.
constexpr double kMoreLayers = 1.5;
// Share of the tolerance that coarse lattices may miss (model.md). Up: fewer layers, but more
// cycles, which have what is left of the tolerance.
constexpr double kMostMissed = 0.7;
// Tolerance: below it, all is open (model.md). Up: parts are open less often.
constexpr double kLeastOfPart = 5e-3;

}  // namespace robot_tissue::cycle_tuning
