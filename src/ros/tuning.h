// The numbers of the node in one place: unit, where each comes from, and what turning it does. What
// a user sets is a parameter (robot_tissue/ros/node_parameters.h). Chosen: by judgment, and kept as
// the node's tests passed; no other value was measured against it.
#pragma once

namespace robot_tissue::tuning {

// Updates.
// s: of one update, where the scene gives the solver no budget. More: fewer LATE, and services wait
// longer. Chosen.
constexpr double kLongestUpdate = 0.1;
// s: of the timer while nothing waits for it. More: a scene that stands costs less; a robot that is
// lost is told of later. Chosen.
constexpr double kWatchPeriod = 0.1;
// s: time that goes by for a moving tissue from one pose to the next, at most. More: after a
// silence of the robot an update has to make up for more. Chosen.
constexpr double kLongestGap = 0.1;
// Share of the poses that are due (1): where more are missed, /diagnostics warns. Chosen.
constexpr double kMostMissed = 0.1;
// Increments of a load that a service asks for; what is left when the time of an update is over is
// carried on in the next ones. More: longer loads are solved to their end. Chosen.
constexpr int kMostIncrements = 300;
// Of the force of ~apply_load on a tool (1): with as much, the tissue answers with it. More: tools
// that are nearly there are told of as unanswered. Chosen.
constexpr double kMet = 0.95;

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

// m: arm of a turn in the prediction of wrenches. More: turns teach and foretell less. Chosen, as
// long as tips of instruments are.
constexpr double kArmOfTurn = 0.01;

}  // namespace robot_tissue::tuning
