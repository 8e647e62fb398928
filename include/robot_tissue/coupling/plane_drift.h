// Foretells how far a touch's plane turns out to be off in the next load step (own): as tissue is
// dented its curved surface bulges otherwise, by nearly as much on each part of a way. A plane that
// is off by more than the slack costs a round.
//
// Lengths (m) along the plane's normal, from the tool into the tissue.
#pragma once

#include <optional>

namespace robot_tissue {

class PlaneDrift {
 public:
  // Where a load step begins: how far the plane is to go into the tissue, as the link goes that
  // share of its last way (1).
  double foresee(double share);
  // In it the plane was found to be so much farther in the tissue than it was taken to be.
  void meet(double farther) { met_ += farther; }
  // At its end: what was foreseen and met is the usual drift, or it tells nothing of the next one.
  void learn();
  void forget();

 private:
  std::optional<double> usual_;  // on a way like the last one; none: not known yet
  double foreseen_ = 0.0;        // in the load step under way
  double met_ = 0.0;             // beyond that
};

}  // namespace robot_tissue
