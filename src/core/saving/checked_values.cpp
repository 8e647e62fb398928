#include "saving/checked_values.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/name_rules.h"

namespace robot_tissue {
namespace {

constexpr double kLargest = 1e15;  // of any number of a load or suture; none is as large

}  // namespace

void failAsDamaged(const std::string& what) { refuseBytes("is damaged: " + what); }

double takeNumber(ByteReader& in) {
  const double value = in.f64();
  if (!(std::abs(value) <= kLargest)) failAsDamaged("a number is beyond all bounds");
  return value;
}

Vec3 takeVector(ByteReader& in) {
  Vec3 value;
  for (double& component : value) component = takeNumber(in);
  return value;
}

bool takeTruth(ByteReader& in) {
  const std::uint8_t value = in.u8();
  if (value > 1) failAsDamaged("a truth is neither true nor false");
  return value == 1;
}

std::string takeName(ByteReader& in) {
  const std::string name = in.text();
  if (name.empty() || name.size() > kLongestName ||
      !std::all_of(name.begin(), name.end(), mayBeInName)) {
    failAsDamaged("a name is none that a scene allows");
  }
  return name;
}

int takeNode(int node_count, ByteReader& in) {
  const std::uint32_t node = in.u32();
  if (node >= static_cast<std::uint32_t>(node_count))
    failAsDamaged("it names a node that is not there");
  return static_cast<int>(node);
}

}  // namespace robot_tissue
