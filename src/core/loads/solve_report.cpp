#include "robot_tissue/core/solve_report.h"

namespace robot_tissue {

const char* toString(SolveStatus status) {
  switch (status) {
    case SolveStatus::kOk:
      return "OK";
    case SolveStatus::kLate:
      return "LATE";
    case SolveStatus::kUnconverged:
      return "UNCONVERGED";
    case SolveStatus::kInverted:
      return "INVERTED";
  }
  return "UNCONVERGED";
}

}  // namespace robot_tissue
