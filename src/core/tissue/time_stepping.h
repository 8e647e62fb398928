// Steps of time (s), where tissue.time is set: their begin and end, and time that goes by while no
// tool moves.
#pragma once

#include <vector>

#include "tissue/surgery.h"

namespace robot_tissue {

class TimeStepping {
 public:
  TimeStepping(TissueData& data, LoadStepSolver& solver, Surgery& surgery)
      : data_(data), solver_(solver), surgery_(surgery) {}

  // As of Tissue.
  void beginTimeStep(double duration, Touched touched);
  void endTimeStep();
  SolveReport wait(double duration);

 private:
  void shift(const std::vector<int>& nodes, const Vec3& way);  // m, tissue frame
  void predict();

  TissueData& data_;
  LoadStepSolver& solver_;
  Surgery& surgery_;
};

}  // namespace robot_tissue
