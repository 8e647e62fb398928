// The numbers of the pipeline in one place: unit, where each comes from, and what turning it does.
// "spacing" is the lattice's, "thickness" that of the thinnest of a link's shapes near the tissue,
// or of the shape that touches, "load step" the longest motion between two solves
// (WayLengths::stepOf). Chosen: by judgment, and kept as the tests of physics and the contact study
// (doc/contact.md) passed; no other value was measured against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Spacings (1): a tool that is nearer to the tissue is expected to touch it. More: the solver's
// levels are made for tools that pass by. Chosen.
constexpr double kExpectedFrom = 2.0;

// Load steps.
// Of the thickness (1): the longest load step of a link. More: fewer solves, but a thin link may be
// through what it meets. Chosen.
constexpr double kStepOfThickness = 0.25;
// Of a load step (1): the shortest that is tried where no shape follows. Less: more is followed
// between tools that meet, at up to 1 / this as many solves. Chosen.
constexpr double kShortestStep = 1.0 / 8.0;
// Of the time that a load step took (1): with less left no further one is begun, as one cut short
// takes about that (0.7 to 0.9 under two tools in tissue cut 200 times). More: tools fall behind by
// a load step more; less: calls end later.
constexpr double kOfLastLoadStep = 0.7;
// Of a load step (1): so little more than whole ones is rounding. A needle that goes by just its
// load step in each update takes half the time.
constexpr double kWayRounding = 1e-6;
// Shapes at the ends of load steps that are kept for rigid patches to come back to. More: a longer
// way back is found again, for a copy of the shape each. Chosen.
constexpr std::size_t kMostCheckpoints = 64;
// Of the spacing (1): a motion of a tool that is none. More: fewer updates of a tool that trembles,
// and forces that are off by so much of a motion. Chosen.
constexpr double kStandsStill = 1e-3;
// Iterations of the method where the tools stand, over all updates: then what is late is given up.
// As many as one load step takes at most (Tissue). More: a scene without balance works longer.
constexpr int kMostLateIterations = 1500;
// Of the bound on a load step's iterations (1): where one that is gone on with took no more, the
// next one begins in the same update. More: updates of two long load steps; less: tools are
// followed later. Chosen.
constexpr double kShortToGoOn = 1.0 / 3.0;
// Iterations of a load step that updates without time go on with, in all: then no shape follows it.
// More: jams are told later; less: long slips are given up. A needle that tissue snaps off takes
// some 470.
constexpr int kMostUnderWay = 600;
// Iterations that a load step whose shape is shown, but late, is finished with before the next one
// begins all the same. More: tools are followed later, less: forces of steps that were cut short
// add up.
constexpr int kMostToFinish = 150;

// Shapes that are taken.
// Of the spacing (1): the farthest that a vertex of the surface goes in a load step; beyond, the
// shape is one that was thrown away. Less: real slips are refused. Chosen.
constexpr double kMostLeap = 10.0;
// Of the spacing and of the thickness (1), whichever is less: deeper in the surface, a link is on
// its way through. More: thin tools get through; less: sharp edges are refused. Chosen.
constexpr double kThrough = 0.25;
constexpr double kThroughOfThickness = 0.25;
// Of the spacing (1): penetration of a rigid tool that asks for another round. Chosen.
constexpr double kDeepEnough = 0.01;
// Of the spacing (1): a deepest point after which a load step is solved on. Less: more solves,
// smaller penetration. Chosen.
constexpr double kTooDeep = 0.04;
// Of the tools' force (1): unbalanced in all, where a solve did not converge; beyond, it is solved
// on. Chosen.
constexpr double kMostUnbalanced = 0.5;
// Further solves of a load step for these two. Chosen.
constexpr int kMoreSolves = 2;

// Tools with rigid patches.
// Rounds of pushing nodes out and solving, as the solve moves nodes into the tool. Chosen.
constexpr int kRigidRounds = 6;
// Passes of one push: a curved tool's way out turns as the surface moves. Chosen.
constexpr int kPushPasses = 4;
// Of the spacing (1): a gap that is none, so that its node stays in the patch. More: nodes that
// came off the tool stick to it; less: what only trembles lets go. Chosen.
constexpr double kStaysOnRigid = 0.02;

// Contacts: where they are looked for.
// Of the spacing (1): gaps up to it are contacts, as a solve may close them. More: more springs
// that do nothing; less: more rounds. Chosen.
constexpr double kNearGap = 0.25;
// Of the spacing (1): tools that go so far at most meet the tissue, in the first solve, at the
// places of the last search, if all are so thick; the second where any is a mesh, whose searches
// are dear. More of these: fewer searches; new touches are found after that solve only. Less of the
// third: jams of thin tools end otherwise. Chosen: 0.25 mm an update at 5 mm is more than the first
// and less than the second. At 0.055 a hand of meshes takes 0.76 of the time that it does at 0.04,
// a lying cylinder 1.5 times.
constexpr double kKnownPlaces = 0.04;
constexpr double kKnownPlacesOnMesh = 0.055;
constexpr double kThickForPlaces = 0.5;
// Of the spacing (1): a touch farther from its tool is forgotten. Chosen.
constexpr double kReach = 1.0;
// Of the spacing (1): off a tool, the distance from which its edges look round, so that the normal
// does not jump there. More: rounder edges. Chosen.
constexpr double kOffEdge = 0.03;
// The same where the link touches a smooth surface: what it touches first along an edge is a point
// between vertices, and so far beside it a vertex is pushed as that is. Less: an edge is pushed
// aside by each vertex that it passes. Chosen.
constexpr double kOffSharpEdge = 0.2;
// The way out across the surface may be so much longer than the nearest one (1), and so much of the
// lesser of spacing and thickness (1). More: points behind thin tools go out in front. Chosen.
constexpr double kDetour = 2.0;
constexpr double kDetourBeyond = 0.5;
// Cosine of two normals that look to the same side. Chosen.
constexpr double kSameSide = 0.3;
// An edge of a link is sharp where from so far (spacings) on one side of it to so far on the other,
// and as far off the link, the nearest way out turns by more than 40 degrees (cosine). Chosen.
constexpr double kBesideEdge = 0.1;
constexpr double kSharpTurn = 0.766;
// Smoothness (1) of the surface that a link touches, from which its edges wander. Chosen.
constexpr double kMostlySmooth = 0.5;
// Of the spacing (1): a touch that wanders is followed by itself unless one was found so near on
// its link. More: two deepest points that are beside each other take turns. 0.02 to 0.5 measured:
// the 99th percentile of an edge and a corner falls to 0.3 to 0.6 by any of these, and is least by
// it.
constexpr double kFoundNear = 0.1;
// Of the way to where it was found (1), which a touch that wanders goes from round to round; and
// where that is so much of the spacing (1) deep. More: more rounds, as the shape follows; less: it
// stays beside what is deepest. From four starts an edge, a corner, a lying cylinder take 3,489,
// 3,175, 2,783 cycles, at most 0.42, 0.39, 0.40 mm deep; by half of the way everywhere 3,887,
// 3,414, 2,908 and 0.50, 0.38, 0.41 mm, by a quarter 3,080, 3,005, 2,586 and 0.58, 0.64, 0.47 mm,
// by 0.8 of it 5,016, 3,671, 3,417.
constexpr double kWander = 0.25;
constexpr double kWanderWhereDeep = 0.5;
constexpr double kDeepToWander = 0.05;
// Of the spacing (1): farther off in the surface, a touch is not where one was found before.
// Chosen.
constexpr double kFarthestBefore = 0.5;
// Barycentric weight (1): with more of one corner, a touch that wanders has come to a vertex.
// Chosen.
constexpr double kAtVertex = 0.99;
// Barycentric weight (1): with more of each corner, a point is on no edge of its triangle. Chosen.
constexpr double kInsideTriangle = 1e-3;

// Where a triangle's curved surface is deepest: looked for where it is no farther off the link than
// so much of the spacing (1), by steps in the weights of its corners (1) from the first to the last
// of these, each so much (1) of the one before that led nowhere deeper, as long as the slope
// promises so much of the spacing (1), at most so often. Chosen.
constexpr double kDeepenedFrom = 0.1;
constexpr double kFirstDeepening = 0.2;
constexpr double kLastDeepening = 0.02;
constexpr double kShorterDeepening = 0.4;
constexpr double kLeastDeepening = 0.001;
constexpr int kDeepenings = 10;

// Contacts: rims of flat faces.
// Of the spacing (1): how far from a point edges of its face are looked for. Less: the other side
// of a face is not seen. Chosen: more than kWideFace.
constexpr double kRimReach = 2.5;
// Of the spacing (1): a vertex so far inside all edges is joined to the face firmly, as the shift
// of no motion is greater (core's rim_law.h).
constexpr double kFirmDepth = 0.3;
// Of the spacing (1): a vertex so near to a face's plane is on it. Chosen.
constexpr double kOnFace = 0.3;
// Of a length at rest (1): less of it along a face is none. Chosen.
constexpr double kLevel = 0.3;
// Cosine of the angle between a face and the surface around its link: rims of a face are left out
// where it is tilted by 35 degrees, and are there in full up to 15. More: they fade sooner. Chosen.
constexpr double kTiltedFace = 0.819;
constexpr double kFlatFace = 0.966;
// Likewise of a face that is met facet by facet: up to 25 degrees, as the surface around a dragged
// tool leans. Less: facets round off under it, and let its edge in. Chosen.
constexpr double kLevelFace = 0.906;
// Cosine of the angle between a face and its link's force, likewise: 35 and 20 degrees. A tool that
// ploughs presses forwards, too, and tissue lies against its front; one that slides with a friction
// up to 0.36 does not. Less: that is held by its rim as by teeth. Chosen.
constexpr double kTiltedPush = 0.819;
constexpr double kStraightPush = 0.94;
// Of the spacing (1): the same of a face's width. Chosen: two columns of nodes in any place.
constexpr double kNarrowFace = 1.0;
constexpr double kWideFace = 2.0;
// Of the way to an edge (1) by which a vertex beside it is drawn aside. Less: the edge stands in
// what is drawn; all of it: triangles between two that are drawn there may have no area. Chosen.
constexpr double kDrawnAside = 0.98;
// Cosine of the outward normals of an edge, as seen from two vertices a spacing apart: that of a
// round end turns. More: ends of few spacings are cut off by what is drawn. Chosen.
constexpr double kSameEdge = 0.5;
// Of the spacing (1): two that are drawn on a round edge leave out what is farther from the line
// between them. More: the edge stands in what is drawn. Chosen.
constexpr double kLeftOut = 0.1;
// Of the spacing (1): what is farther from an edge is not drawn there. Less: where tissue is
// stretched the edge stands in what is drawn; more: triangles beside are drawn out. Chosen.
constexpr double kFarthestDrawn = 1.0;
// Cosine of the outward normals of two edges, also of opposite ones, that have no corner. Chosen.
constexpr double kParallelEdges = 0.9;
// Spacings inside an edge: from here on, a vertex beside a face comes to be shown in its plane, and
// is so in full. Of the law a vertex has a push from -1 on; the edge would stand in what is drawn
// where the last vertex is a little inside it and the next one not yet shown. Chosen.
constexpr double kNotShown = -1.15;
constexpr double kShown = -1.05;
// Share (1): the most that it changes by in a load step. More: forces jump where rims come and go.
// Chosen.
constexpr double kMostOfShare = 0.1;
// Rims on meshes. Spacings inside a face's edge: up to here, a touch tells where the columns of
// nodes around it are. Chosen: a column that gives way is 0.3 inside at most, and a touch is no
// farther from it than the diagonal of a cell.
constexpr double kTellsColumn = 1.5;
// Spacings: what is beyond an edge by more is beside the face. Rounding of edges.
constexpr double kBesideFace = -0.1;
// Bilinear weight (1) that is none. Rounding.
constexpr double kNoWeight = 1e-6;
// Of the shear modulus times the spacing (1): columns are no softer, a thousandth of one right at
// the edge. More: a column that an edge has left holds the tissue; less: points between columns
// that are all but free go far into the tool before they are pushed. Chosen.
constexpr double kSoftestColumn = 0.01;
// Cosine of two edges of a face that are on opposite sides. Chosen.
constexpr double kOppositeEdges = -0.7;
// Of their spread along it (1): points that spread less across a line are on it. Rounding.
constexpr double kOnALine = 1e-3;
// Share (1) of a touch that rims bear; more is all. Chosen.
constexpr double kAllOfIt = 0.98;
// Likewise (1): from here on, all of its depth is the rims'. Less is firm but for some percent.
constexpr double kSomeOfIt = 0.2;

// Contacts: how far tissue goes between two looks at them.
// Of the spacing (1): the longest way of a vertex beside a tool. More: fewer rounds, but what slips
// meets the tool again elsewhere. Chosen.
constexpr double kLongestWay = 0.5;
// Of the thickness (1): where a vertex is looked for in the link on that way. More: fewer looks,
// but tissue springs past a thin tool. Chosen.
constexpr double kStrideOfThickness = 0.25;
// Of the spacing and of the thickness (1), whichever is less: how deep a point may go on it. From a
// link's middle on, its nearest way out leads to the wrong side. Chosen.
constexpr double kDeepestOnWay = 0.1;
constexpr double kDeepestOfThickness = 0.2;
// Of that depth (1): a point that was deeper already may go so much deeper. Chosen.
constexpr double kDepthGrowth = 0.1;
// Times that the way is halved to get less deep. Chosen.
constexpr int kDepthTrials = 4;

// Of the stiffness (1): tissue that became so much softer at once is met anew. More: friction is
// forgotten more often; less: pushes of the stiffer tissue throw it away, at 1e-3 of it and less.
constexpr double kFarSofter = 0.1;

// Graspers and reports.
// Cosine between the ways out of two jaws: below it, they lead to opposite sides. Chosen.
constexpr double kOpposed = -0.5;
// Of what a touched point is carried by (1): nodes with so much go with the jaws. As each corner of
// a cell has it of the middle. Less: on meshes nodes beside the jaws are held, too.
constexpr double kGripped = 0.125;
// Of the spacing (1): jaws that are nearer to each other have no room for tissue between them.
// More: jaws that appear closed around little tissue come down on it. Chosen: no shape is so thin.
constexpr double kShut = 0.1;
// m, and of a turn (1): jaws that moved less relative to each other stand as they did. Rounding.
constexpr double kSameOpening = 1e-12;
// Of the pushes (1): a sum of them that has no direction, as where they cancel. Rounding.
constexpr double kCancelled = 1e-6;

// Spacings: a tool that is deeper than that where it appears is in the tissue. Rounding of where it
// touches.
constexpr double kOverlapRounding = 1e-6;
// Halvings of a step on its way out, at most, until it meets the surface that it goes through.
// More: surfaces are found that cross the tool by less. Chosen: to the rounding above.
constexpr int kMostHalvings = 20;

// Blades and burrs.
// Of the spacing (1): what a blade swept on so much of its way is cut at once. More: fewer solves,
// but what gives way as it is cut is met where it was. Chosen: no spring is passed in one.
constexpr double kBladeStride = 0.25;
// Of the farthest point of a blade from its edge (1): with the middle of its shapes nearer to it,
// the way from the edge to the middle does not tell how the blade lies. More: blades that are not
// flat have their sides where they are narrowest, too. Chosen: a blade with one edge has 0.5.
constexpr double kEdgeInMiddle = 0.1;
// Directions in half a turn in which such a blade's width is measured first. More: a narrow width
// between two of them is found surely, when tools are set only. Chosen.
constexpr int kSideDirections = 180;
// Radians: as exact is the direction. Less: more widths. Chosen.
constexpr double kSideTurn = 1e-5;
// Spacings: a blade that cut nothing on so much of its way begins another stroke. From one layer of
// springs to the next it is one, or little more. More: strokes near one another are one to take
// back.
constexpr double kStrokeEnds = 2.0;
// Looks at what an edge presses, in a stride. More: it goes in nearer to its resistance, by more
// solves. Chosen: a load step each.
constexpr int kLooksInStride = 4;
// Of the spacing (1): radius of the bar with which an edge touches before it cuts. Less: shorter
// load steps; more: it touches that much too early. Chosen.
constexpr double kEdgeRadius = 0.125;
// Of the spacing (1): the deepest dent before an edge of its own that it has force for goes in; the
// line that it presses would turn cells over. More: deeper, slower dents. Chosen.
constexpr double kDeepestDent = 1.0;
// Poses on the way of an edge since it touched, all of which it cuts along when it goes in; of
// more, as of one that trembles for hours, every other one goes. More: what bent ways swept is cut
// nearer to them. Chosen: a dent is some ten looks deep.
constexpr std::size_t kMostOfDent = 256;
// Of the spacing (1): how far a lip of a wound may be from where the blade cut, as springs part in
// their middles.
constexpr double kPlaceOfLip = 0.5;
// Cosine between a lip and the sides of the blade in the wound: below it, it looks ahead. Chosen.
constexpr double kLipLooksAside = 0.5;
// Of the spacing (1): edges of scissors so near to each other have met. Rounding.
constexpr double kEdgesMeet = 1e-3;
// Of the thickness (1) of a burr: its longest stride, within that of a blade. More: cells that a
// thin one passes slip between two strides. Chosen. And of the spacing (1): its shortest, so that
// hairs need not drill for hours.
constexpr double kStrideOfBurr = 0.5;
constexpr double kLeastStride = 0.01;
// Of a stride (1): so little short of its end is rounding.
constexpr double kStrideRounding = 1e-6;
// rad: of a turn that is swept as one plane piece. More: the sagitta, reach * (1 - cos(arc / 2)),
// is 0.2 % of the reach; it grows with the square. Chosen.
constexpr double kLongestArc = 0.125;

// Tools that a force drives.
// Corrections in one update. More: the force is met sooner, by longer updates. Chosen.
constexpr int kMostCorrections = 12;
// Calls in a row after which a tool whose force was met is pushed off by other tools, and goes on
// (1). Down: tools that press beside each other end off their forces. Chosen.
constexpr int kMostPushedOff = 20;
// Of the force (1): near enough. Chosen.
constexpr double kForceMet = 0.005;
// Of the force (1): with as much, the tissue answers with it. More: tools that are nearly there are
// told of as unanswered. Chosen.
constexpr double kAnswered = 0.95;
// Load steps (1): the first motion, from which the stiffness is learned. Chosen.
constexpr double kFirstCorrection = 0.1;
// Of what the force was off where the last corrections ended (1): with more, these led nowhere, as
// where tissue slips or tears under the tool, and it is looked for no further. Chosen.
constexpr double kNearerForce = 0.7;
// Load steps (1): a tool that finds nothing to push stops so far from its pose. Chosen.
constexpr double kFarthestPush = 200.0;

// Updates in a row that no shape followed, after which the tools that are behind let go and come in
// anew from outside. Less: a tool that slips for a moment lets go; more: jams last longer. Of 226
// lost updates of three tools at random in 1,000, 130, 139, 157, 185 are left with 1, 2, 3, 4.
constexpr int kMostLostInARow = 3;

// Updates in a row in which a tool that is clear of the tissue is behind in it, after which that is
// let go. Less: tissue snaps off a tool that leaves fast; more: it hangs on that for longer.
// Chosen.
constexpr int kMostClearInARow = 3;

// Wrenches between solves (WrenchPrediction).
// m: arm of a turn, at least, for tools that are all at their origin. Chosen.
constexpr double kLeastArm = 1e-3;
// Of a wrench (1): how exact a solved one is. More: the stiffness lags behind; less: it is noisier.
// And m: the way on which a stiffness of one wrench a way may change by as much. More: as more of
// the first. A pressed and a circling sphere: 0.5 to 2 % and 5 to 10 mm differ by a tenth.
constexpr double kWrenchError = 0.01;
constexpr double kWayOfStiffness = 0.01;
// m: a longer step teaches nothing, as the contact became another. More: secants of jumps. Chosen.
constexpr double kFarthestLearned = 5e-3;
// m: the farthest that is predicted. More: bolder where a solve takes long; the error grows with
// the square. Chosen: twice what is asked for.
constexpr double kFarthestPredicted = 1e-3;
// s: the longest that is predicted. More: a control loop goes on for longer by what may no longer
// be so; less: a solve that takes its time interrupts the prediction. Chosen: two updates of 0.1 s,
// as a solve begins while the one before is told.
constexpr double kLongestPredicted = 0.2;

// Of the spacing (1): least stride along a line that leaves a tool. More: coarser.
constexpr double kExitStride = 0.1;

// Time.
// s: of a time step while a tool is there. Touches are solved to some micrometers, which over the
// square of the step are accelerations: of shorter steps the forces would be noise. Longer: contact
// begins late. Chosen.
constexpr double kShortestTimeStep = 1e-3;
// Of a time step (1): the next one, where its error is too great, or no shape followed it while
// nothing touched; and how much longer it may be after each that is taken. More of the first: more
// tries. Chosen, as core's.
constexpr double kShorterTimeStep = 0.3;
constexpr double kLongerTimeStep = 2.0;
// Of a time step (1): so little more than whole ones is rounding. Chosen.
constexpr double kTimeRounding = 1e-6;

// Tissue that comes to lie (Landing).
// Iterations in which what lies is in balance: a block on a table takes 8 to 18, an organ that
// rolls 140 to 820, to no end. More: what has to be followed waits longer. Less: what lies is
// followed.
constexpr int kIterationsOfLying = 60;
// Of the time in which a wave crosses the tissue (1): its viscosity. More: what rolls is slower;
// less: it swings longer. Chosen.
constexpr double kLandingDamping = 0.5;
// Its solver.tolerance, at least. More: faster, but what bounces comes to lie elsewhere. Chosen.
constexpr double kLandingTolerance = 1e-2;
// s: what has not come to rest by then, as on a slope, does not. And after which it is looked at.
constexpr double kLongestLanding = 30.0;
constexpr double kLandingPause = 0.05;
// Of the spacing (1): what is as slow as after a fall from that height may lie; whether it does is
// looked at, each time after so many times the time (1). More of the first: more looks in vain.
constexpr double kSlowLanding = 1e-3;
constexpr double kLaterLook = 1.5;
// Of the time in which the tissue would fall about its extent (1): the first such look. Less: what
// is about to topple is left standing. Chosen.
constexpr double kFirstLook = 5.0;
// Of the work that is forborne in a scene (1), what may be spent on one landing. More: what bounces
// and trembles for long is followed longer before it is given up. Chosen.
constexpr double kLandingPatience = 5.0;
// Spacings: what is balanced farther from where it came to lie was thrown away. Chosen.
constexpr double kMostToLie = 2.0;
// Of the tissue's extent (1): likewise what goes farther on the way, as down a slope. Chosen.
constexpr double kFarthestLanding = 20.0;

}  // namespace robot_tissue::tuning
