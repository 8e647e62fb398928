// How far each rung is from the continuum, what it costs, and which is the one to take (own).
//
// The limit of displacements and forces as the spacing goes to zero is extrapolated from the
// tightest runs at the three finest spacings; a rung's error is its distance to that limit, so that
// it holds the error of the lattice and the solver's. Measured at points that all lattices hold:
//   displacement: greatest L2 distance at the end of a step / greatest L2 of the limit there
//   force: greatest distance of a patch's or tool's force / greatest force of the limit
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "richardson.h"
#include "trial.h"

namespace robot_tissue {

struct Assessed {
  Rung rung;
  std::string gap;  // why nothing is known of it, one line
  int nodes = 0;
  SolveStatus worst = SolveStatus::kOk;
  double field_error = 0.0;   // relative
  double force_error = 0.0;   // relative
  double solver_error = 0.0;  // relative: to the tightest run at this spacing, of both the greater
  double median_ms = 0.0;     // of an update
  double greatest_ms = 0.0;

  double error() const { return field_error > force_error ? field_error : force_error; }
  double rate() const { return median_ms > 0.0 ? 1e3 / median_ms : 1e6; }  // Hz
  bool usable() const { return gap.empty() && worst == SolveStatus::kOk; }
};

struct Assessment {
  std::vector<Assessed> rows;  // in the order of the trials
  int lattices = 0;            // that the limit is from; below 2: no error is known
  Limit field;                 // without forces in it, of no length when nothing is known
  Limit force;
  std::size_t points = 0;  // where displacements are compared
};

// All trials are of the same steps and points. Throws InputError when nothing moves in them.
Assessment assessed(const std::vector<Trial>& trials);

// Indices into the rows.
struct Choice {
  std::optional<std::size_t> best;           // the cheapest that meets error and rate
  std::optional<std::size_t> nearest;        // misses them by the smallest factor
  std::optional<std::size_t> fastest;        // of those that meet the error
  std::optional<std::size_t> most_accurate;  // of those that meet the rate
};

Choice choose(const std::vector<Assessed>& rows, double error, double rate);

}  // namespace robot_tissue
