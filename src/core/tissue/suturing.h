// Sutures: threads that are put into the tissue, and drawn in to their rest lengths. Lengths in m,
// forces in N; points in the tissue's frame. That threads break is LoadStepSolver's.
#pragma once

#include <vector>

#include "robot_tissue/core/suture.h"
#include "tissue/load_step_solver.h"
#include "tissue/surgery.h"

namespace robot_tissue {

class Suturing {
 public:
  Suturing(TissueData& data, LoadStepSolver& solver, Surgery& surgery)
      : data_(data), solver_(solver), surgery_(surgery) {}

  SutureResult suture(const SutureConfig& config);  // Tissue::suture
  std::vector<SutureReport> sutures() const;
  // To their rest lengths, in steps that the method follows well. Out of time they are there at
  // once, and what is left to balance is due.
  SolveReport drawThreadsIn();

 private:
  SutureReport reportOf(const std::string& name) const;
  SolveReport drawnIn();
  SutureThread threadOf(const SutureConfig& config) const;
  bool solveOnThreads(SolveReport& report);

  TissueData& data_;
  LoadStepSolver& solver_;
  Surgery& surgery_;
};

}  // namespace robot_tissue
