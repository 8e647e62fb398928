// Tools that drill: tissue whose center their shapes cover on their way is gone.
//
// At the end of each stride of the way (strides.h) the cells go, and parts of cells, that have
// their center in a shape then, as the tissue is then; what is left comes to balance. What is
// removed in one stretch is taken back as one cut.
#pragma once

#include <cstddef>
#include <vector>

#include "strides.h"
#include "world.h"

namespace robot_tissue {

// Of one tool; nothing of it is used for tools that do not drill.
struct BurrState {
  Strides strides;           // of all links
  double way = 0.0;          // since it removed something last (m)
  bool is_drilling = false;  // it removed something within a spacing of its way
  bool is_refused = false;   // it would have taken all of the tissue that is left
};

class Burrs {
 public:
  // The states, one a tool, are kept by the caller.
  Burrs(World& world, std::vector<BurrState>& states) : world_(world), states_(states) {}

  // They stand nowhere.
  void forget() {
    states_.assign(world_.tools.size(), BurrState());
    world_.report.would_take_all.clear();
  }
  // What is removed next is a change of its own.
  void endStrokes();

  // As Blades::goTo. A tool that would take all that is left removes nothing more until it comes in
  // anew.
  bool goTo(RobotPose& pose);

 private:
  bool goTo(std::size_t tool, RobotPose& pose);
  double strideOf(std::size_t tool) const;
  void drill(std::size_t tool, BurrState& state);

  World& world_;
  std::vector<BurrState>& states_;
};

}  // namespace robot_tissue
