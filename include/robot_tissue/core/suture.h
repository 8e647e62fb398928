// A thread that joins two points of the tissue's surface, as plain data.
#pragma once

#include <string>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Slack it does nothing; longer than its rest length it pulls its ends towards each other with
// stiffness * (length - rest_length).
struct SutureConfig {
  std::string name;
  Vec3 from = Vec3::Zero();  // points of the surface as the shape is now, or near it (m, tissue
  Vec3 to = Vec3::Zero();    // frame)
  double rest_length = 0.0;  // m
  double stiffness = 200.0;  // N/m
  double break_force = 0.0;  // N: pulled harder, in balance, it breaks; 0 = never
  double bite = 0.0;         // m: so far around its point an end holds the surface; 0: there alone
};

// N/m: about what 10 cm of a steel wire of 0.3 mm have; of nylon it is a hundredth. More: single
// precision no longer tells the tension.
constexpr double kStiffestSuture = 1e5;

struct SutureReport {
  std::string name;
  double tension = 0.0;  // N; 0 where it is slack or broken
  double length = 0.0;   // from end to end (m)
  bool broken = false;
  Vec3 from = Vec3::Zero();  // where its ends are now (m, tissue frame)
  Vec3 to = Vec3::Zero();
};

}  // namespace robot_tissue
