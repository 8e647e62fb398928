// Points and boxes in words, for messages.
#pragma once

#include <sstream>
#include <string>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// "(1, 2, 3)", without a unit.
inline std::string textOf(const Vec3& point) {
  std::ostringstream text;
  text << "(" << point.x() << ", " << point.y() << ", " << point.z() << ")";
  return text.str();
}

// "(0, 0, 0) to (1, 2, 3)", without a unit.
inline std::string textOf(const Box& box) { return textOf(box.min()) + " to " + textOf(box.max()); }

}  // namespace robot_tissue
