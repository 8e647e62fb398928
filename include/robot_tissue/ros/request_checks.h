// Checks of what a service's request may say. Each throws InputError with one short line that names
// the field, the value and what is allowed.
#pragma once

#include <string>

#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/map_reader.h"

namespace robot_tissue {

constexpr double kFarthestPoint = kFarAway;  // m
constexpr double kGreatestForce = 1e6;       // N

// No component beyond `most`, in this unit.
void requireWithin(const Vec3& vector, double most, const std::string& unit,
                   const std::string& field);

// min below max along every axis; where it may be flat, at most max.
void requireBelow(const Vec3& min, const Vec3& max, FlatBox flat);

}  // namespace robot_tissue
