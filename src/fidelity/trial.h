// One rung of the ladder, tried: a scene's steps run at one spacing and tolerance.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "field.h"
#include "pacing.h"

namespace robot_tissue {

using Clock = std::chrono::steady_clock;

// What is chosen: the fields of a scene that cost and accuracy hang on.
struct Rung {
  std::string method;
  double spacing = 0.0;  // m
  double tolerance = 0.0;
};

struct Trial {
  Rung rung;
  std::string gap;  // why there is no result, one line; empty: there is one
  int nodes = 0;
  SolveStatus worst = SolveStatus::kOk;  // of all increments
  std::vector<double> update_ms;         // each update that solves: contacts, solve, surface
  std::vector<Field> fields;             // at the end of each step, at the common points
  std::vector<Vec3> forces;  // at the end of each step: of named patches, then of tools (N)
  double seconds = 0.0;      // of one run, with the making of the lattice
};

// Told after each update: how many are done.
using OnUpdate = std::function<void(int done)>;

// Never throws on a rung that cannot be tried: its gap says why. A trial that is not done at
// `deadline` is given up. Short ones are run again, for times that hang less on chance.
Trial tried(const Scene& scene, const Rung& rung, double way_an_update,
            const std::vector<Vec3>& points, Clock::time_point deadline,
            const OnUpdate& on_update = {});

}  // namespace robot_tissue
