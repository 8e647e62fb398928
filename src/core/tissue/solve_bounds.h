// How long a solve may take: time of the wall's clock in ms, and iterations.
//
// Half a time step is no shape that tissue moves through, and what a solve leaves would, over the
// square of the step, be accelerations. So a time step that was begun has some time beyond that.
#pragma once

#include <optional>

#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/patience.h"
#include "robot_tissue/core/solve_report.h"
#include "tissue/tissue_motion.h"

namespace robot_tissue {

class SolveBounds {
 public:
  // max_ms: of a solve, also where a deadline is later; 0: none.
  SolveBounds(const TissueMotion& motion, const Patience& patience, double max_ms)
      : motion_(motion), patience_(patience), max_ms_(max_ms) {}

  Patience& patience() { return patience_; }
  const Patience& patience() const { return patience_; }
  void setMaxMs(double max_ms) { max_ms_ = max_ms; }
  void setDeadline(std::optional<Deadline> deadline) { deadline_ = deadline; }

  bool isTimeOver() const { return deadline_ && deadline_->isOver(); }     // in a time step, too
  bool isBounded() const { return deadline_ && !motion_.isInTimeStep(); }  // by the deadline
  double leftMs() const { return isBounded() ? deadline_->leftMs() : 0.0; }
  double mostMs() const;  // for the next solve; 0: no bound
  // The time step under way has had all its time: no other solve is begun in it.
  bool isTimeStepOver() const;
  int mostIterations(
      double cost) const;       // for the next solve, with the cost of one (Patience::note)
  Patience::Of solved() const;  // what the next solve is of

  // The last solve, if it was late, had to end for the deadline: it is one to carry on in the time
  // that is left. One that max_ms ended has had its time. `solve_ms`: that it took.
  bool wasHurried(double solve_ms) const;
  void noteSolve(const SolveReport& solve);  // the last one
  void noteLook(double ms);                  // how long a look at the contacts took
  // Another solve and the looks before and after it take longer than what is left.
  bool isTooShort(double left_ms) const { return left_ms <= 2.0 * look_ms_ + shortest_ms_; }
  bool isRoundForNextCall() const;  // Tissue::isRoundForNextCall
  // As of a mesh, after a solve that took longer than it was to. What it came to is no shape to
  // show.
  bool isLookForNextCall() const;

 private:
  double leftOfTimeStepMs() const;  // infinite: no bound

  const TissueMotion& motion_;
  Patience patience_;
  double max_ms_;
  std::optional<Deadline> deadline_;
  double look_ms_ = 0.0;      // that looks at the contacts took lately
  double shortest_ms_ = 0.0;  // that the last solve would have taken with one iteration, about
};

}  // namespace robot_tissue
