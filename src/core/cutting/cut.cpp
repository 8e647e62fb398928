#include "cutting/cut.h"

#include <cmath>

#include "cutting/blade_surface.h"
#include "cutting/split_cells.h"
#include "lattice/connectivity.h"

namespace robot_tissue {
namespace {

// Of the spacing (1): what is nearer to the blade's plane or outline is on it. More: more springs
// are severed along the outline; less: nodes in the plane fall to either side by rounding. Chosen.
constexpr double kOnPlane = 1e-3;

// A polygon on its mean plane.
class CutPolygon {
 public:
  CutPolygon(const std::vector<Vec3>& corners, double spacing) : slack_(kOnPlane * spacing) {
    if (corners.size() < 3) {
      throw InputError("corners: " + std::to_string(corners.size()) + " given; allowed: 3 or more");
    }
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (!corners[i].allFinite()) {
        throw InputError("corners[" + std::to_string(i) + "]: not finite; allowed: finite numbers");
      }
      center_ += corners[i] / static_cast<double>(corners.size());
    }
    Vec3 twice_area = Vec3::Zero();
    for (std::size_t i = 0; i < corners.size(); ++i) {
      twice_area += (corners[i] - center_).cross(corners[(i + 1) % corners.size()] - center_);
    }
    if (!(twice_area.norm() > 2.0 * slack_ * slack_)) {
      throw InputError("corners: the polygon has no area; allowed: corners that span one");
    }
    normal_ = twice_area.normalized();
    along_ = normal_.unitOrthogonal();
    across_ = normal_.cross(along_);
    for (const Vec3& corner : corners) {
      is_flat_ = is_flat_ && std::abs(normal_.dot(corner - center_)) <= slack_;
      outline_.emplace_back(along_.dot(corner - center_), across_.dot(corner - center_));
    }
  }

  bool isFlat() const { return is_flat_; }

  // Whether the segment crosses; its ends count as on the positive side when on the plane.
  bool crosses(const Vec3& from, const Vec3& to) const {
    const double height_from = normal_.dot(from - center_) + slack_;
    const double height_to = normal_.dot(to - center_) + slack_;
    if ((height_from >= 0.0) == (height_to >= 0.0)) return false;
    const double share = height_from / (height_from - height_to);
    const Vec3 point = from + share * (to - from) - center_;
    return contains({along_.dot(point), across_.dot(point)});
  }

 private:
  // Closed, with slack: a point on the outline is inside.
  bool contains(const Eigen::Vector2d& point) const {
    bool inside = false;
    for (std::size_t i = 0, j = outline_.size() - 1; i < outline_.size(); j = i++) {
      const Eigen::Vector2d& a = outline_[i];
      const Eigen::Vector2d& b = outline_[j];
      const Eigen::Vector2d edge = b - a;
      const double share = std::min(
          1.0, std::max(0.0, (point - a).dot(edge) / std::max(edge.squaredNorm(), 1e-300)));
      if ((a + share * edge - point).norm() <= slack_) return true;
      const bool straddles = (a.y() > point.y()) != (b.y() > point.y());
      if (straddles && point.x() < a.x() + (point.y() - a.y()) / edge.y() * edge.x()) {
        inside = !inside;
      }
    }
    return inside;
  }

  double slack_;
  bool is_flat_ = true;
  Vec3 center_ = Vec3::Zero();
  Vec3 normal_ = Vec3::Zero();
  Vec3 along_ = Vec3::Zero();
  Vec3 across_ = Vec3::Zero();
  std::vector<Eigen::Vector2d> outline_;
};

}  // namespace

std::vector<int> springsAcross(const Lattice& lattice, const LatticeState& state,
                               const std::vector<Vec3>& corners) {
  const CutPolygon polygon(corners, lattice.spacing());
  std::vector<int> crossing;
  if (!polygon.isFlat()) {
    const BladeSurface surface = BladeSurface::of(corners, lattice.spacing());
    for (const Crossing& each : surface.crossings(lattice, state)) crossing.push_back(each.spring);
    return crossing;
  }
  const auto position = [&](int node) -> Vec3 {
    return lattice.restPosition(node) + state.displacement[at(node)];
  };
  for (std::size_t index = 0; index < lattice.springs().size(); ++index) {
    const Spring& spring = lattice.springs()[index];
    if (state.severed[index] == 0 && polygon.crosses(position(spring.a), position(spring.b))) {
      crossing.push_back(static_cast<int>(index));
    }
  }
  return crossing;
}

void sever(const Lattice& lattice, const std::vector<int>& springs, LatticeState& state,
           SplitCells split) {
  for (const int spring : springs) state.severed[at(spring)] = 1;
  state.springs_cut += static_cast<int>(springs.size());
  state.pieces = countPieces(lattice, state);
  const auto left = cellsLeft(lattice, state, split);
  state.displacement = carriedOver(*state.cells, state.displacement, *left);
  state.cells = left;
}

}  // namespace robot_tissue
