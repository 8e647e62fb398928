// The numbers of load stepping and of the rounds between shape and contacts: unit, where each comes
// from, and what turning it does. "spacing" is the lattice's; a "round" is a solve and the look at
// the contacts after it. Chosen: by judgment, and kept as the tests of physics and the contact
// study (doc/contact.md) passed; no other value was measured against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Load steps.
// Of the spacing (1): the longest motion of a tool between two solves. More: fewer solves, but what
// slips depends more on the steps, and tools get through thin tissue. Chosen.
constexpr double kToolStep = 0.2;
// Of the method's step of a patch (1): a patch that goes farther at once goes in several steps, and
// an increment of a force that moved it farther is taken back. More: longer steps, which may leap
// or turn cells inside out. Chosen: one spacing for methods whose step is half of it.
constexpr double kTooFar = 2.0;
// Of an increment of a force (1): the next is at most as much longer. More: soft ends of a load
// are reached sooner; leaps are taken back more often. Chosen.
constexpr double kMostGrowth = 2.0;
// Of the first increment of a force (1): none is shorter. Less: loads near a leap are followed more
// closely, in up to as many more solves. Chosen.
constexpr double kLeastOfFirst = 1.0 / 16.0;
// Steps of one load at most. More: patches that go farther take steps of the same length. Chosen.
constexpr double kMostSteps = 10000.0;
// Steps (1): 5 steps of a fifth are 5, not 6. Rounding.
constexpr double kRounding = 1e-9;
// Solves of a shape that is late, at most, before a new patch by force takes its shape there. More:
// a load waits longer where solve after solve has no time. Chosen.
constexpr int kMostBalances = 100;

// Rounds of a load step.
// Rounds in which the shape is what was solved for, at most. More: contacts that change to and fro
// settle in more cases, by longer load steps. Chosen.
constexpr int kContactRounds = 16;
// Rounds with those that are cut short, at most, and iterations of all, over the usual ones of a
// load step (1). More: hopeless load steps take longer, and a few more are solved. Chosen: the
// tools of the contact study take up to 829, of 1,500. A load step that takes more, and whose
// contacts still change, has not converged.
constexpr int kMostRounds = 200;
constexpr double kMostOfLoadStep = 1500.0 / 30.0;
// Iterations in rounds that gained nothing, after which the load step is given up. More: the same
// for load steps that stand still. Chosen.
constexpr int kMostIdle = 300;
// Iterations that a round without gain counts for at least. More: given up after fewer short
// rounds. Chosen.
constexpr int kIdleRound = 12;
// Of the least error so far (1): with less, a round gained. More: slow progress counts, too.
// Chosen.
constexpr double kNearer = 0.7;
// Of the farthest way of the tissue so far (1): with more, a round gained, as where tissue slips.
// Less: creeping counts as gain. Chosen.
constexpr double kFarther = 1.1;

// A bound on the iterations of a load step.
// Of that bound (1): with less made, contacts are settled before the shape is shown. More: fewer
// updates are late, and longer ones. Chosen (doc/contact_measured.md has others).
constexpr double kUnhurried = 1.0 / 3.0;
// Of the spacing (1): how deep tools may stand in a shape that is shown before that, from then on,
// and at the bound. More: shorter updates, deeper tools. Chosen: likewise.
constexpr double kBearableFirst = 0.05;
constexpr double kBearableLast = 0.1;

// Patience.
// What a solve of any length begins and ends with, over the usual iterations of a load step (1): 2
// by `layered`, as kIterationsOfEnds. More: contacts that change from round to round are given up
// earlier; less: load steps of many short solves are as free as one solve.
constexpr double kEndsOfSolve = 2.0 / 30.0;
// Work that is usual in a load step, over its usual iterations (1): these and the ends of 7 or 8
// solves. More: jams are followed for longer.
constexpr double kUsualWork = 1.5;
// Work beyond that, over the usual iterations of a load step (1), over all of a scene: then load
// steps have the usual work alone, and ways are given up that ask for more. And what an easy load
// step forgives, over the usual work. More: jams are followed for longer. Chosen: a sphere dragged
// over 25 mm of a block spends 0.5, a box's edge, in the most load steps of which tissue slips,
// about all of it.
constexpr double kMostSpent = 1500.0 / 30.0;
constexpr double kForgiven = 0.5;
// What a load step that ends in balance spends of the work beyond the usual (1). More: drags of an
// edge, off which tissue slips once a spacing, are given up on their way, and, in time, tissue that
// springs back between jaws; less: jams whose load steps end well are followed for longer. Chosen:
// a box's edge dragged 8 mm deep takes 6,000 iterations over 30 mm.
constexpr double kSpentBySettled = 0.1;
// Nodes (1) beyond which kMostSpent, and what load steps have once it is over, is less in
// proportion, as iterations are longer. Less: large scenes are given up earlier; more: their jams
// take minutes. Chosen: a box's edge dragged 8 mm deep over 115,351 and, at a tolerance of 1e-3,
// 67,626 nodes is followed to its end; at 15,000 it was given up on its way.
constexpr double kManyNodes = 60000.0;
// What a ghost adds to an iteration, over a node of the lattice (1), and nodes (1) below which
// iterations take no longer than of that many. More: jams on cut tissue are given up earlier; more
// of the second: later where it is small. Measured by `layered` on 4,851 nodes and 608 ghosts: 15.
constexpr double kNodesOfGhost = 15.0;
constexpr double kFewNodes = 5000.0;
// Iterations of a time step that count as one, and easy time steps that forgive as much as one easy
// load step (1). Less: motions that only touch now and then are given up; more: jams that swing are
// followed for longer. Chosen: a box's edge dragged at 20 mm/s spends 21 of the 1,500.
constexpr int kTimesInTimeStep = 4;
// Iterations' work in load steps that did not converge, since the last whole one on a tool's way,
// where nobody asked for an end of the scene: then the way is given up. More: hopeless ways take
// longer, and a few more are followed. Chosen.
constexpr double kMostSpentOnAWay = 3000.0;

// Cuts.
// Of the spacing (1): a tool or support nearer than that to a piece touches it, also where it does
// not push yet. More: what hovers is held; less: what lies may be taken out. Chosen.
constexpr double kTouchingGap = 0.02;
// Of the given forces on a piece that nothing else holds (1): as much unbalanced in all, with
// gravity, moves it without end, and it is kept where it is. As cycle_tuning::kFalling. More:
// pieces that move off slowly are solved for, without end.
constexpr double kAdrift = 0.5;
// Spacings (1): how far the lattice's nodes are from the surface that is shown, at most: a cell's
// diagonal, rounded up. More: blades beside the tissue are looked at in vain.
constexpr double kNodesBeyondSurface = 2.0;
// Solves after springs that tore, in one update. More: long cracks come to their end at once; then
// the rest is left to the next update. Chosen.
constexpr int kMostTearRounds = 500;

// Time.
// Of what is left of the budget (1): the next solve has so much, as the contacts are to be looked
// at again. More: fewer, longer solves; the last may leave none for the contacts. Chosen.
constexpr double kShareOfTime = 0.5;
// Of the time that a look at the contacts took (1): the next one is taken to need as much at least.
// Less: what was longer once is forgotten sooner, and calls end later. Chosen.
constexpr double kLooksFade = 0.9;
// ms: a look at the contacts that would end so much after the time is left to the next call. Less:
// more shapes are not shown where time ran out in them. Chosen.
constexpr double kMostOverstepMs = 0.3;
// ms: a solve has so much at least; one cycle, however short. Chosen.
constexpr double kLeastMs = 1e-6;
// Iterations that take as long as what a solve of any length begins and ends with (1): by
// `layered`, under two tools, it binds what holds the nodes, and smooths what is cut short. More:
// fewer rounds in a call that has little time left; less: it ends later.
constexpr double kIterationsOfEnds = 2.0;
// Of the time that a new surface and the contacts on it took (1): about as much the solve on it
// takes at least, its levels and one cycle, and what is looked at after it (1.9 after 200 cuts
// under two tools). Where less is left, the next call makes it. More: cuts are balanced one call
// later more often; less: their calls end later.
constexpr double kLevelsOverSurface = 2.0;

// Motion in time.
// ms: that a time step which was begun may take beyond the end of an update, or of a solve by
// max_ms. More: longer updates; less: more steps are cut short, after which the tissue stands still
// for a moment. Chosen: steps beside dragged tools, on large blocks, take up to 50.
constexpr double kMostBeyondMs = 300.0;
// In spacings (1): what goes less in a step, and by its velocity and acceleration would, is at
// rest. More: slow motions end early; less: the rounding of single precision never rests. Chosen.
constexpr double kAtRest = 4e-6;
// s, and of the greatest displacement times the tolerance (1): what came no farther in that time is
// at rest. Longer or less: trembling contacts keep it awake; shorter or more: slow swings end at
// their turning points. Chosen.
constexpr double kRestTime = 0.1;
constexpr double kTrembling = 0.05;
// Of the step's error, over h^2 |a' - a| (1): 1/2 - 1/6, as u' takes h^2 / 2 times the acceleration
// at its end (Zienkiewicz and Xie 1991, with beta = 1/2).
constexpr double kErrorOfStep = 1.0 / 3.0;
// The same of a step of Euler's backward method, over h^2 |a'| (1): u' takes h^2 times the
// acceleration at its end, and h^2 / 2 times the mean one is right.
constexpr double kErrorOfEulersStep = 0.5;
// What a step's error is held against, besides the way of the step: a share of the displacement
// (1), and spacings (1) for each node. More: longer steps where the tissue turns back. Chosen.
constexpr double kShareOfDisplacement = 1.0;
constexpr double kLeastMotion = 1e-3;
// What a step's solve is exact to, besides the way that forces go: a share of the way of the step
// and of the displacement (1), and spacings (1) for each node; times the tolerance. More: fewer
// cycles, and forces that are off by what a step's velocity is. Chosen.
constexpr double kSolvedOfWay = 0.1;
constexpr double kSolvedOfDisplacement = 0.01;
constexpr double kLeastSolved = 1e-4;
// Of the error allowed (1): what the next step aims at; and of the last step, how much longer or
// shorter the next one may be at most. Chosen.
constexpr double kSafety = 0.5;
constexpr double kMostShrink = 0.3;
constexpr double kMostGrowthOfStep = 2.0;
// Of the error allowed (1): a step of a larger one is made anew. More: fewer are. Chosen.
constexpr double kRefusedError = 4.0;
// rad: where tissue is damped, what it may turn in a step. The damped strain is linear: a turn by x
// counts as a contraction by x^2 / 2. A free block of 80 x 40 x 20 mm (760 kPa, 20 ms), squeezed by
// a quarter and let go, spins up by 0.49 rad at 0.02, by 0.006 at 0.01. More: longer steps; what
// spins is braked, and what is let go may spin.
constexpr double kMostTurn = 0.01;
// s: the first step from rest, and bounds of those that follow. Longer: coarser starts; shorter:
// more steps where something snaps. Chosen.
constexpr double kFirstStep = 1e-3;
constexpr double kShortestStep = 5e-5;
constexpr double kLongestStep = 0.05;

// Sutures.
// Spacings (1): a suture's point that is farther from the surface is nowhere. More: points that are
// meant for something else join. Chosen.
constexpr double kReachOfSuture = 1.0;
// Spacings (1): farther from a thread's end the surface that a cut or a removal left is not where
// it was; the thread is dropped. More: threads jump on; less: threads at a cut are lost. Chosen.
constexpr double kFarthestFromEnd = 0.5;
// Of the stiffness of a node at a thread's end (1): a stiffer thread is drawn in as one of that, in
// so many rounds to the length that its own stiffness has, and then made stiff. More: fewer solves
// where that is not needed, but threads that go taut and slack take long (a hundred times the
// stiffness, at once: up to 0.7 s at 4,851 nodes; so: 0.03 s). Rounds: each leaves about a tenth of
// what was off. Chosen.
constexpr double kSoftThread = 5.0;
constexpr int kRoundsOfThread = 3;
// Spacings (1): triangles as near to an end but for so much are alike, as the sides of a cut are.
// Rounding.
constexpr double kSameDistance = 1e-6;
// Spacings (1): below the surface, where the tissue of a triangle is. Any that is less than a cell
// tells sides apart. Chosen.
constexpr double kInnerDepth = 0.25;

// Memory.
// Bytes of a sparse factor of n nodes over n^(4/3), the growth by nested dissection in three
// dimensions. More: scenes are refused that the memory holds; less: the system ends the program.
// Measured: 105 MB at 4,851 nodes, 1,186 MB at 35,301.
constexpr double kFactorBytes = 1150.0;
// Bytes a cell of the grid around a lattice, filled or not: the arrays of layered's levels, and of
// the others' field. Likewise. Measured on an oblique rod of 4 mm in 7.4 million cells: 255 and 202
// with the 42 that every tissue takes there.
constexpr double kLevelsBytes = 230.0;
constexpr double kFieldBytes = 175.0;

// Bytes of the shapes that cuts can be taken back to. More: more of them come back bit for bit, not
// balanced anew. Chosen.
constexpr std::size_t kMostHistoryBytes = 256000000;
// Bytes of what tells the cuts themselves apart. More: the oldest ones are taken back one by one
// for longer. Chosen.
constexpr std::size_t kMostTopologyBytes = 256000000;

}  // namespace robot_tissue::tuning
