// What a press costs on this machine: each of the scene's tools, or else a sphere, pressed 1 mm
// into the tissue.
#pragma once

#include <string>
#include <vector>

#include "finding.h"
#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

struct TrialPress {
  std::string what;  // is pressed
  int nodes = 0;
  double force_n = 0.0;    // along the press, at 1 mm
  double update_ms = 0.0;  // of the processor: mean of the updates, each a quarter of a millimeter
  double memory_mb = 0.0;  // of the process, that the tissue and the presses up to this one took
  bool converged = true;
  bool ended = true;  // within the time given
};

// Where the surface is farthest from what is fixed; one a tool, by its first link with shapes, the
// end that is farthest from the link's origin first. A sphere where no tool has shapes. Throws
// InputError where the scene cannot run.
std::vector<TrialPress> pressEach(const Scene& scene, const std::vector<ToolGeometry>& tools,
                                  double most_seconds);

// The presses in words.
Findings checkPress(const Scene& scene, const std::vector<ToolGeometry>& tools,
                    double most_seconds);

}  // namespace robot_tissue
