// Foretells how hard links press in the next load step (own): if a link goes on along its last way,
// its normal force grows, or falls, in proportion to how far, as it did on that way. Multipliers
// and bounds of friction begin with that, as the solver's first guess of the shape goes on
// likewise.
#pragma once

#include <cstddef>
#include <vector>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

class PressGrowth {
 public:
  // Of a link: the sum of its normal forces (N), and their mean place (m).
  struct Press {
    double force = 0.0;
    Vec3 place = Vec3::Zero();
  };

  // At the end of a load step; one press a link.
  void note(const std::vector<Pose>& links, std::vector<Press> presses);
  // Whether it pressed at the ends of both of the last two load steps.
  bool isKnown(std::size_t link) const;
  // What the link presses with, once it has gone to that pose, over what it pressed with at the end
  // of the last load step.
  double times(std::size_t link, const Pose& pose) const;
  // How far the link goes on along its last way, to that pose, over how far it went (1), within 1
  // to either side; zero where it pressed nothing.
  double shareOfLastWay(std::size_t link, const Pose& pose) const;

 private:
  std::vector<Pose> links_, links_before_;
  std::vector<Press> presses_, presses_before_;
};

}  // namespace robot_tissue
