// The time of a tissue that moves (tissue.time): it goes on from pose to pose as their stamps do,
// and stands still while the robot is silent, or the tissue is too far behind.
#pragma once

#include <ros/time.h>

namespace robot_tissue {

class TissueClock {
 public:
  // period: of the first pose (s), and longest: time that may go by from one pose to the next (s).
  TissueClock(double period, double longest) : usual_(period), longest_(longest) {}

  // The tissue's time (s) at a pose of that stamp, which is followed; `reached`: what the tissue
  // has come to of the time told before. What rests goes on as if the pose before were a usual gap
  // away: nobody followed those at which it rested.
  double advance(const ros::Time& stamp, bool moves, double reached);
  double now() const { return now_; }
  // Of the last gap, what the tissue's time left out (s); 0: nothing.
  double leftOut() const { return left_out_; }

 private:
  double usual_, longest_;
  double now_ = 0.0, left_out_ = 0.0;
  ros::Time last_;
};

}  // namespace robot_tissue
