// Brings standing patches on along their ramps, in increments of a size that the method follows
// well, each with what tears of it. Reports are the last increment's, with the worst status of all.
#pragma once

#include <vector>

#include "tissue/load_ramp.h"
#include "tissue/surgery.h"

namespace robot_tissue {

class LoadStepping {
 public:
  LoadStepping(TissueData& data, LoadStepSolver& solver, Surgery& surgery)
      : data_(data), solver_(solver), surgery_(surgery) {}

  double foreseenSteps(const std::vector<LoadRamp>& ramps) const;
  SolveReport stepLoadsByItself(const std::vector<LoadRamp>& ramps,
                                const Tissue::OnIncrement& on_increment);
  SolveReport stepLoads(const std::vector<LoadRamp>& ramps, int increments,
                        const Tissue::OnIncrement& on_increment);

 private:
  bool isHopeless(const SolveReport& report) const;
  bool stopsOnTheWay(const std::vector<LoadRamp>& ramps);
  bool goInSteps(const std::vector<LoadRamp>& ramps, int increment, int increments,
                 SolveReport& report);
  SolveReport goTo(const std::vector<LoadRamp>& ramps, double share);

  TissueData& data_;
  LoadStepSolver& solver_;
  Surgery& surgery_;
};

}  // namespace robot_tissue
