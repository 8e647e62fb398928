// What a press costs on this machine: a sphere pressed 1 mm into the tissue.
#pragma once

#include "finding.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct TrialPress {
  int nodes = 0;
  double radius_m = 0.0;
  double force_n = 0.0;    // along the press, at 1 mm
  double update_ms = 0.0;  // mean of the updates, each a quarter of a millimeter
  double memory_mb = 0.0;  // of the process, that the tissue and the press took
  bool converged = true;
  bool ended = true;  // within the time given
};

// Where the surface is farthest from what is fixed. Throws InputError where the scene cannot run.
TrialPress pressOnce(const Scene& scene, double most_seconds);

// The press in words.
Findings checkPress(const Scene& scene, double most_seconds);

}  // namespace robot_tissue
