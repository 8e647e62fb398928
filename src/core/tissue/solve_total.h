// What solves that follow each other took together, and the worst status of them.
#pragma once

#include <algorithm>

#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

struct SolveTotal {
  SolveTotal() = default;
  explicit SolveTotal(const SolveReport& report) { add(report); }

  void add(const SolveReport& report) {
    addWork(report);
    worsen(report.status);
  }
  void addWork(const SolveReport& report) {
    wall_ms += report.wall_ms;
    iterations += report.iterations;
  }
  void worsen(SolveStatus status) { worst = std::max(worst, status); }
  // The report of the last solve tells them in the place of its own.
  void tellIn(SolveReport& report) const {
    tellWorkIn(report);
    report.status = worst;
  }
  void tellWorkIn(SolveReport& report) const {
    report.wall_ms = wall_ms;
    report.iterations = iterations;
  }

  SolveStatus worst = SolveStatus::kOk;
  double wall_ms = 0.0;
  int iterations = 0;
};

}  // namespace robot_tissue
