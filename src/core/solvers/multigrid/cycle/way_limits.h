// How far points that nodes carry may go in one solve.
#pragma once

#include <utility>
#include <vector>

#include "solvers/solver_method.h"

namespace robot_tissue {

class WayLimits {
 public:
  void set(std::vector<WayLimit> limits) { limits_ = std::move(limits); }
  // A solve begins there (m).
  void begin(const std::vector<Vec3>& displacement) {
    from_.clear();
    const auto place = [&](int node) { return displacement[at(node)]; };
    for (const WayLimit& limit : limits_) from_.push_back(placeOf(limit, place));
  }
  // displacementOf(node) is where a node is now (m).
  template <typename DisplacementOf>
  bool areExceeded(DisplacementOf displacementOf) const {
    for (std::size_t i = 0; i < limits_.size(); ++i) {
      const Vec3 way = placeOf(limits_[i], displacementOf) - from_[i];
      if (way.norm() > limits_[i].longest) return true;
    }
    return false;
  }

 private:
  template <typename DisplacementOf>
  static Vec3 placeOf(const WayLimit& limit, DisplacementOf displacementOf) {
    return carriedFrom(Vec3::Zero(), limit.carriers, displacementOf);
  }

  std::vector<WayLimit> limits_;
  std::vector<Vec3> from_;
};

}  // namespace robot_tissue
