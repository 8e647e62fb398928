// The numbers of the node in one place: unit, where each comes from, and what turning it does. What
// a user sets is a parameter (robot_tissue/ros/node_parameters.h). Chosen: by judgment, and kept as
// the node's tests passed; no other value was measured against it.
#pragma once

#include <cstddef>

namespace robot_tissue::tuning {

// Updates.
// s: of one update, where the scene gives the solver no budget. More: fewer LATE, and services wait
// longer. Chosen.
constexpr double kLongestUpdate = 0.1;
// Iterations of `layered` in a load step, where the scene says nothing (doc/contact_measured.md has
// others). More: longer updates where tissue slips; less: more of them are LATE.
constexpr int kMostIterations = 36;
// s: between two times that it is told that tissue still settles. More: who comes meanwhile waits
// for longer. Chosen, as the state comes while nothing changes.
constexpr double kSettlingPeriod = 1.0;
// s: time that goes by for a moving tissue from one pose to the next, at most. More: after a
// silence of the robot an update has to make up for more. Chosen.
constexpr double kLongestGap = 0.1;
// Share of the poses that are due (1): where more are missed, /diagnostics warns. Chosen.
constexpr double kMostMissed = 0.1;
// Increments of a load that a service asks for; what is left when the time of an update is over is
// carried on in the next ones. More: longer loads are solved to their end. Chosen.
constexpr int kMostIncrements = 300;

// Queues, in messages. More: nothing is lost where a reader is slow, and it reads what is older.
// Messages in the queue of the transforms' subscriber: as many as tf2_ros takes.
constexpr unsigned kTransformQueue = 100;
// Messages in the queue of the marker arrays: they tell changes only, so none may be lost. Chosen.
constexpr unsigned kMarkerQueue = 10;
// Messages in the queue of each tool's wrenches: as many as a busy socket may hold up. Chosen.
constexpr unsigned kWrenchQueue = 10;

// Markers. More: larger, and more of the tissue is hidden. Chosen.
// m: width of the lines of the wireframe.
constexpr double kWireWidth = 0.0004;
// m: of the threads of sutures. More: they are seen from farther. Chosen.
constexpr double kThreadWidth = 0.0006;
// m: of the lines along edges that cut.
constexpr double kEdgeWidth = 0.0008;
// m: of the lines along the edges of a wound.
constexpr double kLipWidth = 0.0008;
// Of the spacing (1): how high its arch stands over the skin. More: it hovers; less: a bulge
// between the ends hides it. Chosen.
constexpr double kThreadHeight = 0.3;
constexpr int kThreadParts = 8;  // straight ones of the arch
// Of the spacing (1): diameter of a fixed node; of a loaded one it is twice as much.
constexpr double kNodeDiameter = 0.2;
// Spacings: length of a normal's arrow.
constexpr double kNormalLength = 3.0;
// Of the spacing (1): diameter of an arrow's shaft; its head is twice as wide.
constexpr double kShaftDiameter = 0.25;
// Of the spacing (1): thickness of the box that shows a plane.
constexpr double kPlaneThickness = 0.2;
// N: no arrow up to here, as rviz complains of one without length. More: weak touches show none.
constexpr double kSmallestForce = 1e-9;

// The surface as it is drawn.
// 1: sine of the angle between the planes that meet in a crease; below, their line is uncertain.
constexpr double kLeastSine = 0.2;
// rad: bends of an edge, both ends together, up to which it is drawn straight, and in two pieces;
// in four beyond. More: fewer triangles, and facets that one sees. Chosen: 3 and 10 degrees.
constexpr double kDrawnStraight = 0.05;
constexpr double kDrawnInHalves = 0.17;
// Triangles: beyond, all edges are drawn in halves, and then straight. More: finer, and more bytes:
// 72 a triangle. Chosen: some 4 MB.
constexpr std::size_t kMostDrawn = 60000;

// Colors and labels.
// Of the diagonal of the tissue at rest (1): height of letters, of the legend, its width and its
// distance from the tissue.
constexpr double kTextHeight = 0.035;
constexpr double kLegendHeight = 0.45;
constexpr double kLegendWidth = 0.035;
constexpr double kLegendGap = 0.14;
// Of the letters' height (1): from an arrow to its number.
constexpr double kLabelGap = 1.6;
// Of the letters' height (1): of the list of forces over the tissue's foot; its lines go down.
constexpr double kListHeight = 5.0;
// Strips of the legend.
constexpr int kLegendSteps = 16;
// 1: the scale of colors shrinks when less than this of it is needed. More: it changes more often.
constexpr double kScaleInUse = 0.2;
// mm, % and kPa: the shortest scale; below lies the solver's error. Chosen.
constexpr double kLeastScale = 0.1;
// 1: brightness of a color that looks away from the light. More: flatter.
constexpr double kDarkest = 0.55;
// Of the tissue's diagonal (1): an arrow of a force starts where the tool ends along it, up to
// here; else beside the tool.
constexpr double kFarthestArrow = 0.25;
// 1: a way out of the tool is taken for another when it is shorter by more.
constexpr double kClearlyLess = 0.9;
// s: forces of a pose so long ago are drawn as such. More: a tool that has left shows its last
// force for longer; less: they flicker where every other update is late. Chosen.
constexpr double kOldForce = 0.1;
// 1: of what is drawn then, its gray and its opacity.
constexpr float kGrayOfBehind = 0.6F;
constexpr float kOpacityOfBehind = 0.5F;

// m: arm of a turn in the prediction of wrenches. More: turns teach and foretell less. Chosen, as
// long as tips of instruments are.
constexpr double kArmOfTurn = 0.01;

}  // namespace robot_tissue::tuning
