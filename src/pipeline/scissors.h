// Tools of two jaws with an edge each, which cut where the edges have passed each other.
//
// A place of one edge meets that of the other at the same length from its first point. A piece of
// the edges that has passed cuts what both swept of it since the jaws were widest apart, where the
// tool is then: what is between open jaws goes with them. That is looked at where the strides of
// the way end (strides.h), and where the last piece passes. Jaws that open, or go without closing,
// cut nothing. What one closing cuts is taken back as one cut. The jaws push nothing, and no net
// force is on the tool: what cuts acts between its jaws.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "strides.h"
#include "world.h"

namespace robot_tissue {

// Of one tool; nothing of it is used for tools that do not shear.
struct ScissorsState {
  using Jaws = std::array<Pose, 2>;  // tool_T_jaw

  Strides strides;          // of all links
  std::vector<Jaws> path;   // since they were widest apart, and were closer each time
  std::size_t passed = 0;   // pieces, from the first point of the edges on
  bool is_cutting = false;  // they cut something since then

  const Pose& tool() const { return strides.stands.front(); }  // tissue_T_tool
};

class Scissors {
 public:
  // The states, one a tool, are kept by the caller.
  Scissors(World& world, std::vector<ScissorsState>& states) : world_(world), states_(states) {}

  // They stand nowhere.
  void forget() { states_.assign(world_.tools.size(), ScissorsState()); }
  // What is cut next is a change of its own.
  void endStrokes();

  // As Blades::goTo.
  bool goTo(RobotPose& pose);

 private:
  using Jaws = ScissorsState::Jaws;
  using Places = std::array<Vec3, 2>;  // of the edges, in the jaws' frames (m)
  struct Piece {
    Places from, to;
  };

  bool goTo(std::size_t tool, RobotPose& pose);
  double gapAt(std::size_t tool, const Jaws& jaws, const Places& places) const;
  std::size_t passedAt(std::size_t tool, const Jaws& jaws, const std::vector<Piece>& pieces) const;
  bool areClosed(std::size_t tool) const;
  Places tipsOf(std::size_t tool) const;
  void beginAt(std::size_t tool, const Jaws& jaws);
  void close(std::size_t tool);
  void cut(std::size_t tool, const std::vector<CutTriangle>& swept);
  std::vector<Piece> piecesOf(std::size_t tool) const;

  World& world_;
  std::vector<ScissorsState>& states_;
};

}  // namespace robot_tissue
