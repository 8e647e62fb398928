#include "robot_tissue/ros/request_checks.h"

#include <cmath>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {

void requireWithin(const Vec3& vector, double most, const std::string& unit,
                   const std::string& field) {
  for (const double component : vector) {
    if (std::abs(component) <= most) continue;
    throw InputError(field + ": " + numberText(component) + "; allowed: numbers from -" +
                     numberText(most) + " to " + numberText(most) + " " + unit);
  }
}

void requireBelow(const Vec3& min, const Vec3& max, FlatBox flat) {
  const std::string allowed = flat == FlatBox::kRefused ? "above" : "at or above";
  for (int axis = 0; axis < 3; ++axis) {
    if (max[axis] > min[axis] || (flat == FlatBox::kAllowed && max[axis] == min[axis])) continue;
    const std::string name(1, "xyz"[axis]);
    throw InputError("max." + name + ": " + numberText(max[axis]) + "; allowed: " + allowed +
                     " min." + name + ", " + numberText(min[axis]) + " m");
  }
}

}  // namespace robot_tissue
