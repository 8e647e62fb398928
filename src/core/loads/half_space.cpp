#include "loads/half_space.h"

#include <algorithm>
#include <cmath>

namespace robot_tissue {

Vec3 halfSpaceMotion(const Vec3& off, const Vec3& direction, const SurfaceModuli& moduli) {
  const double depth = std::max(0.0, off.dot(direction));
  const Vec3 aside = off - off.dot(direction) * direction;
  const double distance = off.norm(), squared = off.squaredNorm(), nu = moduli.poisson_ratio;
  const double inwards = depth * depth / squared + 2.0 * (1.0 - nu);
  const double outwards = depth / squared - (1.0 - 2.0 * nu) / (distance + depth);
  return (inwards * direction + outwards * aside) / (4.0 * M_PI * moduli.shear * distance);
}

}  // namespace robot_tissue
