#include "robot_tissue/ros/request_checks.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kLongestName = 64;  // bytes

}  // namespace

void requireName(const std::string& name) {
  const bool is_plain = std::all_of(name.begin(), name.end(), [](char c) {
    return c != ',' && c != '"' && static_cast<unsigned char>(c) >= 0x20 && c != 0x7f;
  });
  if (!name.empty() && name.size() <= kLongestName && is_plain) return;
  throw InputError("name: '" + shortText(name) + "'; allowed: a name of at most " +
                   std::to_string(kLongestName) +
                   " bytes without commas, quotes and control characters");
}

void requireWithin(const Vec3& vector, double most, const std::string& unit,
                   const std::string& field) {
  for (const double component : vector) {
    if (std::abs(component) <= most) continue;
    throw InputError(field + ": " + numberText(component) + "; allowed: numbers from -" +
                     numberText(most) + " to " + numberText(most) + " " + unit);
  }
}

}  // namespace robot_tissue
