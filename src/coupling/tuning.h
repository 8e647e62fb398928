// The numbers of contact in one place: unit, where each comes from, and what turning it does.
// "spacing" is the lattice's; "slack" the depth or gap of a touch that is none; "normal force" the
// sum of a tool's normal forces. Chosen: by judgment, and kept as the tests of physics and the
// contact study (doc/contact.md) passed; no other value was measured against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Springs in contact.
// Stiffness of a contact spring over the tissue's at its point (1). More: fewer updates of the
// multipliers, harder solves. 3, 6, 10, 20, from four starts: a sphere takes 1,709, 1,796, 1,825,
// 2,435 cycles, a box on its edge 5,515, 4,190, 3,489, 4,715, a lying cylinder 2,931, 2,960, 2,783,
// 3,380.
constexpr double kContactStiffness = 10.0;
// Vertices of the surface on a node (1) beyond which touches share that. More: touches on meshes
// finer than the lattice are harder to solve for; less: more of them push, and are found one after
// the other. A kidney of 3,968 triangles on a lattice of 10 mm, pressed by a ball of 10 mm and of
// 30 mm, fixed, and by the small one on a table: 0.5: 16, 18, 55 ms an update; 1: 16, 18, 44; 2:
// 15, 26, 34; 4: 16, 30, 25; where none is shared 45, 102, 29.
constexpr double kCrowded = 4.0;
// The same of friction's spring, at most (1). More: sticking gives way less. Chosen.
constexpr double kFrictionStiffness = 2.0;
// Of the fineness (1): how far a point that sticks goes before it slips, at least and at most.
// Less: sharper sticking, harder solves. Chosen.
constexpr double kElasticSlip = 0.02;
constexpr double kMostElasticSlip = 0.1;
// Of the spacing (1): what is so near a link that has only just come sticks to it in the first
// solve. More: it is drawn along (0.02: first touches of balls without a force); less: what lands
// on an edge slides off it.
constexpr double kMayStickFirst = 0.01;
// Of a node's stiffness times the spacing (1): no tissue pushes so hard; beyond, the shape is
// refused. Chosen.
constexpr double kMostForce = 45.0;

// When contacts stand.
// Of the normal force (1): what closing the gaps of all touches may change at most; gives the
// slack. Less: more updates, smaller penetration. 0.03, 0.07, 0.1: a sphere on a layer is off by up
// to 1.6, 1.7, 2.6 % at a fine spacing; pressed by less than a spacing it takes 1.8, 1.3, 1 times
// the time, and a box that slides 6, 1, 1 times. A tenth of one touch alone: off by up to 15 %.
constexpr double kSlackOfForce = 0.07;
// Of the spacing (1): the slack is at least, and at most. More of the least: fewer rounds where a
// tool only just touches, and forces of there that hang on the way: a ball of 5 mm, 0.2 mm deep at
// a spacing of 5 mm, that comes to the same place again feels 0.70 to 1.63 times the force at
// 0.003, 0.98 to 1.13 at 0.0003. In time what lands would tremble at that. Chosen.
constexpr double kLeastSlack = 0.0003;
constexpr double kLeastSlackInTime = 0.003;
constexpr double kMostSlack = 0.03;
// Of the normal force (1): a touch that pushes less may do so from afar. Chosen.
constexpr double kLittleForce = 0.05;
// Of the greatest friction force of all touches (1): its change in an update that is none. Chosen.
constexpr double kSameFriction = 0.03;
// Of what a link presses with (1): the most that it is taken to grow or fall by in a load step.
// More: bolder first guesses where contacts begin or end. Chosen.
constexpr double kMostGrowth = 0.5;
// Of how far from the origin a link is (1): what it goes by rounding, where it stands. Chosen.
constexpr double kStoodStill = 1e-12;
// Share (1) of what a plane's drift was other than foreseen, by which it is foreseen otherwise the
// next time. Less: slower to learn; more: touches that share a push swing. 0.3, 0.5, 0.7, 1: from
// four starts a sphere takes 1,968, 1,825, 1,987, 2,224 cycles (2,112 where nothing is foreseen), a
// lying cylinder 2,912, 2,908, 2,896, 3,019 (3,168).
constexpr double kDriftLearned = 0.5;
// Of the spacing (1): drift is foreseen of links so thick. Less: a needle takes 3 cycles in the
// median of its updates for 2, and 1.04 times as many in all.
constexpr double kThickForDrift = 0.5;
// Share (1) of their ways that planes which go to and fro go at least. Less: slower where they do
// not any more. Chosen.
constexpr double kLeastPlaneShare = 0.3;
// Updates in a row on the way to balance, after which planes no longer turn: some turn to and fro
// for ever. Chosen.
constexpr int kMostTurningRounds = 12;

// Touches come, wander and go.
// Of the spacing (1): the farthest that a touch's plane is put into the tissue in one update.
// Chosen.
constexpr double kMostPush = 0.2;
// rad: the farthest that a touch's plane turns in a load step. Chosen.
constexpr double kMostTurn = 0.5;
// Cosine of two normals on the same side; one that turns further has jumped. Chosen.
constexpr double kSameSideOfTool = 0.3;
// Of the spacing (1): a vertex with a larger gap is forgotten at the end of a load step. Chosen.
constexpr double kFarOff = 0.3;
// Barycentric (1): points of a triangle that are nearer than this are one touch. Chosen.
constexpr double kSamePoint = 0.25;
// Touches that push (1), up to which the nearest is looked for among them all. Speed alone.
constexpr std::size_t kFewTouches = 32;
// Of the spacing (1): farther on the tool, two touches that wander are not the same. Chosen.
constexpr double kFarthestWander = 0.5;
// Of the spacing (1): a point that is so much deeper than the touch takes its place. Less: places
// go to and fro, and forces in time tremble; more: touches stand beside what is deepest. Chosen.
constexpr double kDeeperThanTouch = 0.004;
// Barycentric (1): a corner's share that is none. Rounding.
constexpr double kNoShare = 1e-9;
// Of a point's weight (1): on nodes that give way, else it is not pushed. Less: points beside fixed
// nodes, which hardly give way, press as no tissue does, and no shape follows: of 2,000 motions of
// three tools at random 288, 200, 102 by 0.1, 0.25, 0.4. More: tools stand deeper in what is fixed.
constexpr double kLeastFree = 0.4;

// In time: of the spacing (1), how deep a touch that was found so may go on to be; and s, in which
// what is left of that falls to 1/e. More: smoother forces, tools deeper in the tissue; from
// kTooDeep (pipeline) on, more solves. A box's edge dragged at 20 mm/s, damping times of 10, 30,
// 100 ms: its force jumps by 17, 20, 42 % without, by 8, 16, 24 % with it, in three quarters of the
// time; 0.1 s: 8, 14, 19 %.
constexpr double kMostEntry = 0.035;
constexpr double kEntryTime = 0.05;

// Spacings: a recess that is farther from where the force asks for it is followed by another solve.
// More: forces hang on how the tool came; less: more rounds. Chosen.
constexpr double kRecessStays = 0.006;
// Of the depth (1): how far a ball is taken to reach out by its first touch alone, where others
// will bear, too. More: large balls that come fast press far too hard in the first solve (of 60 mm,
// half a millimeter in one load step: 1.4 N for 0.28 in the end); less: small ones begin too deep.
// Chosen.
constexpr double kMostGuessedOutwards = 0.5;
// Spacings: what touches a shape so far off the part that is looked at touches another one, as
// another prong; planes of touches that wander are off the shape. Chosen.
constexpr double kOffPart = 0.5;
// Of the force (1): what may touch there. Chosen.
constexpr double kForceOffPart = 0.1;
// Spacings: what touches, spread wider than that (standard deviation), is no narrow contact. Less:
// some are left out; more: what is wide is looked at for nothing. Of a strip as wide as the law
// reaches, 3 spacings, 1.5 at most.
constexpr double kWideTouches = 1.6;
// Spacings: a shape that is thinner has no law of narrow contacts. More: light touches
// of thin tools hang on where nodes are; less: it would be recessed by its own size, and a needle
// is lost. Chosen.
constexpr double kLeastThickness = 0.25;
// Of a shape's thickness (1): its deepest recess. More: thin tools are right farther down; less:
// tissue comes less far into them. Chosen.
constexpr double kMostOfThickness = 0.3;

// Rims of flat faces.
// Cosine of the outward normals of an edge in two rounds. Chosen.
constexpr double kSameEdge = 0.9;
// Of a firm touch's stiffness (1): rim springs are no softer, so that where they are all but free
// the surface is still shown where the face has it. Rounding: of no weight in the force.
constexpr double kSoftestRim = 1e-4;
// Share (1) of the push that goes by these springs, up to which a vertex beside a face comes to be
// shown in its plane. Less: it comes at once; more: the tool's edge stands the deeper in what is
// shown. Chosen.
constexpr double kShownShare = 0.2;

// Nodes that stick.
// Sweeps over the contacts while nodes are pushed out of a rigid tool, at most. Chosen.
constexpr int kPushSweeps = 300;
// Of the spacing (1): a depth that is none, which ends them. Chosen.
constexpr double kPushedOut = 1e-3;
// How far a node that sits on a tool already is pushed, beside others (1): it keeps its place where
// others can give way. Chosen.
constexpr double kSeatedMobility = 0.05;

}  // namespace robot_tissue::tuning
