#include "clear_points.h"

#include <algorithm>
#include <cmath>

#include "tuning.h"

namespace robot_tissue {

// A surface that is taken from one place to another point by point passes none that is farther from
// it than its longest way.
void ClearPoints::beginLook(const PlacedShape& placed, std::uint64_t tree,
                            const std::vector<Vec3>& vertices, std::size_t points) {
  const bool is_other = tree != tree_ || vertices.size() != vertices_.size();
  vertices_.resize(vertices.size(), Vec3::Zero());
  double longest = 0.0;
  bool is_finite = true;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec3 now = placed.shape_T_tissue * vertices[i];
    const double way = (now - vertices_[i]).squaredNorm();
    is_finite &= std::isfinite(way);
    longest = std::max(longest, way);
    vertices_[i] = now;
  }
  last_way_ = std::sqrt(longest) * (1.0 + tuning::kBeyondRounding) + tuning::kRounding;
  gone_ += last_way_;
  if (!is_other && is_finite && clear_until_.size() == points) return;
  tree_ = tree;
  gone_ = last_way_ = 0.0;
  clear_until_.assign(points, 0.0);
}

}  // namespace robot_tissue
