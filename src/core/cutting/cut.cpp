#include "cutting/cut.h"

#include <algorithm>
#include <cmath>

#include "cutting/cut_front.h"
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

  // On the plane's positive side, or on it.
  bool isAbove(const Vec3& point) const { return heightOf(point) >= 0.0; }

  // Where the segment crosses; its ends count as on the positive side when on the plane.
  std::optional<Crossing> crossing(const Vec3& from, const Vec3& to) const {
    const double height_from = heightOf(from), height_to = heightOf(to);
    if ((height_from >= 0.0) == (height_to >= 0.0)) return std::nullopt;
    const double share = height_from / (height_from - height_to);
    const Vec3 point = from + share * (to - from);
    const Vec3 seen = point - center_;
    if (!contains({along_.dot(seen), across_.dot(seen)})) return std::nullopt;
    const double along = share - slack_ / (height_from - height_to);
    return Crossing{-1, along, point, std::abs(normal_.dot((to - from).normalized()))};
  }

 private:
  double heightOf(const Vec3& point) const { return normal_.dot(point - center_) + slack_; }

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

std::vector<Crossing> springsAcross(const Lattice& lattice, const LatticeState& state,
                                    const std::vector<Vec3>& corners) {
  const CutPolygon polygon(corners, lattice.spacing());
  if (!polygon.isFlat()) {
    return BladeSurface::of(corners, lattice.spacing()).crossings(lattice, state);
  }
  const auto position = [&](int node) -> Vec3 {
    return lattice.restPosition(node) + state.displacement[at(node)];
  };
  std::vector<char> is_above(at(lattice.nodeCount()));
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    is_above[at(node)] = polygon.isAbove(position(node)) ? 1 : 0;
  }
  std::vector<Crossing> crossings;
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    const std::array<int, 3> low = lattice.gridIndex(node);
    for (int axis = 0; axis < 3; ++axis) {
      const int spring = lattice.springOf(node, 2 * axis + 1);
      if (spring < 0 || state.severed[at(spring)] != 0) continue;
      std::array<int, 3> high = low;
      ++high[at(axis)];
      const int other = lattice.node(high[0], high[1], high[2]);
      if (is_above[at(node)] == is_above[at(other)]) continue;
      std::optional<Crossing> found = polygon.crossing(position(node), position(other));
      if (!found) continue;
      found->spring = spring;
      crossings.push_back(*found);
    }
  }
  return crossings;
}

void severSprings(const std::vector<Crossing>& crossings, LatticeState& state) {
  if (state.parted_at.empty()) state.parted_at.assign(state.severed.size(), 0.5);
  for (const Crossing& crossing : crossings) {
    state.severed[at(crossing.spring)] = 1;
    state.parted_at[at(crossing.spring)] = std::clamp(crossing.along, kEnd, 1.0 - kEnd);
  }
  state.springs_cut += static_cast<int>(crossings.size());
}

namespace {

// `before`: what was ahead then.
void partCells(const Lattice& lattice, const std::vector<Crossing>& crossings,
               const std::vector<SpringAhead>& before, LatticeState& state, SplitCells split) {
  std::vector<int> springs;
  for (const Crossing& crossing : crossings) springs.push_back(crossing.spring);
  if (!holdTogether(lattice, state, springs)) state.pieces = countPieces(lattice, state);
  state.ahead = stillAhead(lattice, state);
  for (const SpringAhead& each : before) springs.push_back(each.spring);
  for (const SpringAhead& each : state.ahead) springs.push_back(each.spring);
  const auto left = cellsLeft(lattice, state, split, springs);
  state.displacement = carriedOver(*state.cells, state.displacement, *left);
  state.cells = left;
}

}  // namespace

void sever(const Lattice& lattice, const std::vector<Crossing>& crossings, LatticeState& state,
           SplitCells split) {
  const std::vector<SpringAhead> before = state.ahead;
  severSprings(crossings, state);
  partCells(lattice, crossings, before, state, split);
}

void sever(const Lattice& lattice, const std::vector<Crossing>& crossings,
           const BladeSurface& blade, LatticeState& state, SplitCells split) {
  const std::vector<SpringAhead> before = state.ahead;
  severSprings(crossings, state);
  if (!blade.isEmpty() && split == SplitCells::kParted) {
    state.ahead = springsAhead(lattice, state, blade, crossings);
  }
  partCells(lattice, crossings, before, state, split);
}

std::vector<Crossing> halfWay(const std::vector<int>& springs) {
  std::vector<Crossing> crossings(springs.size());
  for (std::size_t i = 0; i < springs.size(); ++i) crossings[i].spring = springs[i];
  return crossings;
}

}  // namespace robot_tissue
