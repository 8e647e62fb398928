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

}  // namespace robot_tissue
