// Every number of this room that is no law: its unit, where it comes from, what turning it up does.
// "Chosen": it passes the tests; what its neighbors would do was not written down.
#pragma once

namespace robot_tissue::level_tuning {

// --- The greatest stiffness of a motion, by the power method (GridLevel::measureSteps)

// Steps of it, and the root mean square of the motion (spacings), so small that forces are linear
// (chosen). Up: slower to build; nearer to the greatest stiffness.
constexpr int kPowerSteps = 20;
constexpr double kPowerMotion = 1e-3;
// Steps where a motion is known that was the stiffest of a shape before (chosen). Likewise.
constexpr int kPowerStepsAgain = 4;
// Times what it found, as it finds no more than there is (chosen). Up: shorter, surer steps of the
// smoother.
constexpr double kStiffnessMargin = 1.1;

// --- The smoother

// Spacings: longest step of a node along an axis, or of a patch by force (also rad), so that no
// cell turns over at once (chosen). Up: far motions in fewer steps, less surely.
constexpr double kLongestStep = 0.25;
// Times a squeezed corner's barrier, in the nodes' stiffness: in the smoother's steps that this is
// found for, corners are squeezed on. 1: the twist by 180 degrees in four increments came to rest
// in another shape, 6 % off; 8: tools pressed and dragged take a tenth longer. Up: slower, surer.
constexpr double kSqueezedOn = 2.0;
// Of the trace of a corner's stiffness in a cell that is filled in part: in all directions besides,
// as what hangs by little turns far in a cycle. 0: meshes take half to all of the cycles, but a bar
// that hangs by part of a cell did not come to rest in 2,000 (sliver_hangs); 0.25 likewise, 1: 974
// for 2,118. Up: slower, surer.
constexpr double kAround = 0.5;
// Of a patch's greatest stiffness: directions in which it has less count as this stiff (chosen;
// far above rounding). Up: loose patches are moved in shorter steps. Likewise of E0 h: a thread's
// stiffness across itself that is less is none.
constexpr double kNoStiffness = 1e-12;
// Of the stiffness along the axes (1): a patch does not turn in directions in which it has less, as
// about a line of its nodes. Far above rounding in single precision, and far below what nodes on
// more than a line have.
constexpr double kNoTurn = 1e-5;

// Nodes of a membrane that are taken together (ConstrainedNodes::couple): share of r . D^-1 r that
// conjugate gradients leave, and their most steps. A ball whose capsule is 1000 times as stiff
// takes 10 cycles so, 25 with three steps each (0.01 mm). Up: cheaper, more cycles; dearer, fewer.
constexpr double kTogetherShare = 0.01;
constexpr int kMostTogether = 12;

// --- Relief (cell_relief.h)

// Volume ratio below which a coarse cell has none: which way it is turned is hardly told (chosen).
// Up: cells that are squeezed flat are as they were before.
constexpr double kFlattestRelieved = 0.05;
// Steps of Newton's method for a cell's rotation, at most, and the square of the change after which
// it ends (chosen: cells stretched by half take five). Up: dearer; down: rougher, which shows in
// cycles alone.
constexpr int kStepsOfRotation = 8;
constexpr double kSameRotation = 1e-8;

// --- Threads

// Nodes of a level: with fewer, threads that find their forces wait more than they work (3,000: a
// patch at 4,851 nodes takes 1.4 times as long in two threads). Up: more levels in one thread.
// Results are the same.
constexpr int kWorthSharing = 8000;
// Entries of a field that loops which do little with each take at once, in one thread (chosen; it
// decides the last bits of sums over longer fields). Up: threads have less even parts.
constexpr int kSpan = 1 << 14;

}  // namespace robot_tissue::level_tuning
