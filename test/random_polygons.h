// Numbers and polygons at random, the same ones on every machine.
#pragma once

#include <random>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class RandomNumbers {
 public:
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_()) / 4294967296.0;
  }

 private:
  std::mt19937 engine_{1};
};

// Of three to five corners, with their middle in the bounds.
class RandomPolygons {
 public:
  // size (m): how far corners are from the middle along each axis, at most.
  RandomPolygons(const Box& bounds, double size) : bounds_(bounds), size_(size) {}

  std::vector<Vec3> next() {
    const int corners = 3 + static_cast<int>(numbers_.between(0.0, 3.0));
    Vec3 middle;
    for (int axis = 0; axis < 3; ++axis) {
      middle[axis] = numbers_.between(bounds_.min()[axis], bounds_.max()[axis]);
    }
    std::vector<Vec3> polygon;
    for (int corner = 0; corner < corners; ++corner) {
      const double x = numbers_.between(-size_, size_), y = numbers_.between(-size_, size_);
      polygon.emplace_back(middle + Vec3(x, y, numbers_.between(-size_, size_)));
    }
    return polygon;
  }

 private:
  Box bounds_;
  double size_;
  RandomNumbers numbers_;
};

}  // namespace robot_tissue
