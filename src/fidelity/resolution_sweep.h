// Tries the rungs of the ladder one after the other, as far as the time allows.
#pragma once

#include <functional>
#include <vector>

#include "trial.h"

namespace robot_tissue {

struct SweepOptions {
  std::string method = "layered";
  double way_an_update = 0.001;  // m
  double seconds = 60.0;         // all trials together
  int coarser = 2;               // spacings beside the scene's
  int finer = 2;
};

// Told before and while a rung is tried.
using OnRung = std::function<void(std::size_t done, std::size_t all, const Rung& rung, int update,
                                  int updates)>;

// First the tightest tolerance at every spacing, from the scene's to coarser and finer ones, then
// the others. A trial for which the time does not suffice, by those before it, has a gap that says
// so. Trials come back by falling spacing, then by falling tolerance.
std::vector<Trial> resolutionSweep(const Scene& scene, const SweepOptions& options,
                                   const OnRung& on_rung);

}  // namespace robot_tissue
