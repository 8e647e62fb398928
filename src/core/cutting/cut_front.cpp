#include "cutting/cut_front.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "cutting/cell_division.h"
#include "cutting/cut.h"
#include "cutting/split_cells.h"

namespace robot_tissue {
namespace {

// Of the spacing (1): nodes so near the blade's surface are on either side of it, as its slack has
// it. Chosen, as for cuts.
constexpr double kBesideBlade = 1e-3;
// Of the way to a point (1): more of it across the blade's surface, and the blade has passed
// beside. Chosen: 30 degrees.
constexpr double kBeside = 0.5;
// Of a distance (1): less is no way that a blade has come. Rounding.
constexpr double kNearer = 1e-6;

using Sides = std::array<bool, kCorners>;

struct CellEdge {
  int corner = 0, other = 0;  // lower and upper end
  int axis = 0;
  int spring = 0;
};

std::array<CellEdge, 12> edgesOf(const Lattice& lattice, const Cell& cell) {
  std::array<CellEdge, 12> edges;
  std::size_t count = 0;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const int spring = lattice.springOf(cell.nodes[at(corner)], 2 * axis + 1);
      edges[count++] = {corner, corner | 1 << axis, axis, spring};
    }
  }
  return edges;
}

bool mayBeAtFront(const Lattice& lattice, const LatticeState& state, const Cell& cell) {
  if (takenOf(state, cell.place) != 0) return false;
  for (int corner = 0; corner < kCorners; ++corner) {
    if (!lattice.hasTissueAt(cell.place, corner)) return false;
  }
  return hasPartedSprings(lattice, state, cell) && isOnePart(cellParts(lattice, state, cell.nodes));
}

Vec3 placeOf(const Lattice& lattice, const LatticeState& state, int node) {
  return lattice.restPosition(node) + state.displacement[at(node)];
}

// The blade's surface at a cell, as it goes on: between the edges along the axis that is nearest to
// its normal, if only such edges are severed, so that nodes that the front leaves together are
// ahead of the blade; else as a plane.
class CellPlane {
 public:
  CellPlane(const Lattice& lattice, const LatticeState& state, const BladeSurface& blade,
            const Cell& cell)
      : edges_(edgesOf(lattice, cell)) {
    Vec3 middle = Vec3::Zero();
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      places_[corner] = placeOf(lattice, state, cell.nodes[corner]);
      middle += places_[corner] / kCorners;
    }
    const BladeSurface::Nearest nearest = blade.nearestTo(middle);
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      heights_[corner] = nearest.normal.dot(places_[corner] - nearest.point);
    }
    if (const std::optional<int> axis = axisAcross(state)) {
      for (int corner = 0; corner < kCorners; ++corner) {
        is_above_[at(corner)] = (corner >> *axis & 1) != 0;
      }
      fits_ = true;
      return;
    }
    const double slack = kBesideBlade * lattice.spacing();
    for (const double shift : {0.0, slack, -slack}) {
      for (std::size_t corner = 0; corner < kCorners; ++corner) {
        is_above_[corner] = heights_[corner] + shift >= 0.0;
      }
      fits_ = fitsSevered(state);
      if (fits_) return;
    }
  }

  // It passes between the ends of all springs that are severed.
  bool fits() const { return fits_; }
  const std::array<CellEdge, 12>& edges() const { return edges_; }
  bool crosses(const CellEdge& edge) const {
    return is_above_[at(edge.corner)] != is_above_[at(edge.other)];
  }
  double along(const CellEdge& edge) const {
    const double low = heights_[at(edge.corner)], high = heights_[at(edge.other)];
    const double share = low == high ? 0.5 : low / (low - high);
    return std::clamp(share, kEnd, 1.0 - kEnd);
  }

 private:
  // The axis of all severed edges, if none is nearer to the normal; of two as near either will do.
  std::optional<int> axisAcross(const LatticeState& state) const {
    Vec3 rise = Vec3::Zero();
    std::set<int> severed;
    for (const CellEdge& edge : edges_) {
      rise[edge.axis] += heights_[at(edge.other)] - heights_[at(edge.corner)];
      if (state.severed[at(edge.spring)] != 0) severed.insert(edge.axis);
    }
    if (severed.size() != 1) return std::nullopt;
    const int axis = *severed.begin();
    const bool is_nearest =
        std::abs(rise[axis]) >= (1.0 - kBesideBlade) * rise.cwiseAbs().maxCoeff();
    return is_nearest ? std::optional<int>(axis) : std::nullopt;
  }

  bool fitsSevered(const LatticeState& state) const {
    return std::all_of(edges_.begin(), edges_.end(), [&](const CellEdge& edge) {
      return state.severed[at(edge.spring)] == 0 || crosses(edge);
    });
  }

  std::array<CellEdge, 12> edges_;
  std::array<Vec3, kCorners> places_;
  std::array<double, kCorners> heights_{};
  Sides is_above_{};
  bool fits_ = false;
};

Vec3 pointOn(const Lattice& lattice, const LatticeState& state, int spring, double along) {
  const Spring ends = lattice.springs()[at(spring)];
  return (1.0 - along) * placeOf(lattice, state, ends.a) + along * placeOf(lattice, state, ends.b);
}

double distanceTo(const BladeSurface& blade, const Lattice& lattice, const LatticeState& state,
                  int spring, double along) {
  const Vec3 point = pointOn(lattice, state, spring, along);
  return (blade.nearestTo(point).point - point).norm() / lattice.spacing();
}

// The point is beyond the blade's end rather than beside its surface.
bool goesOnTo(const BladeSurface& blade, const Vec3& point) {
  const BladeSurface::Nearest nearest = blade.nearestTo(point);
  const Vec3 way = point - nearest.point;
  return std::abs(nearest.normal.dot(way)) <= kBeside * way.norm();
}

void addFrontOf(const Lattice& lattice, const LatticeState& state, const BladeSurface& blade,
                const Cell& cell, std::map<int, SpringAhead>& ahead) {
  const CellPlane plane(lattice, state, blade, cell);
  if (!plane.fits()) return;
  std::vector<SpringAhead> found;
  for (const CellEdge& edge : plane.edges()) {
    if (!plane.crosses(edge) || state.severed[at(edge.spring)] != 0) continue;
    const double along = plane.along(edge);
    const double distance = distanceTo(blade, lattice, state, edge.spring, along);
    if (distance <= kBesideBlade) return;  // spared, as it holds a crumb
    found.push_back({edge.spring, along, distance});
  }
  for (const SpringAhead& each : found) {
    const auto [known, is_new] = ahead.insert({each.spring, each});
    if (!is_new) known->second.distance = std::min(known->second.distance, each.distance);
  }
}

}  // namespace

const SpringAhead* aheadAt(const LatticeState& state, int spring) {
  const auto found =
      std::lower_bound(state.ahead.begin(), state.ahead.end(), spring,
                       [](const SpringAhead& each, int number) { return each.spring < number; });
  return found != state.ahead.end() && found->spring == spring ? &*found : nullptr;
}

std::array<int, kCorners> frontParts(const Lattice& lattice, const LatticeState& state,
                                     const Cell& cell) {
  std::array<int, kCorners> parts{};
  if (state.ahead.empty() || !mayBeAtFront(lattice, state, cell)) return parts;
  const auto edges = edgesOf(lattice, cell);
  for (int corner = 0; corner < kCorners; ++corner) parts[at(corner)] = corner;
  for (const CellEdge& edge : edges) {
    if (state.severed[at(edge.spring)] != 0 || aheadAt(state, edge.spring) != nullptr) continue;
    const int one = parts[at(edge.corner)], other = parts[at(edge.other)];
    std::replace(parts.begin(), parts.end(), std::max(one, other), std::min(one, other));
  }
  const bool parts_all = std::all_of(edges.begin(), edges.end(), [&](const CellEdge& edge) {
    const bool is_across =
        state.severed[at(edge.spring)] != 0 || aheadAt(state, edge.spring) != nullptr;
    return !is_across || parts[at(edge.corner)] != parts[at(edge.other)];
  });
  const std::set<int> all(parts.begin(), parts.end());
  if (all.size() != 2 || !parts_all) parts.fill(0);
  return parts;
}

std::vector<SpringAhead> springsAhead(const Lattice& lattice, const LatticeState& state,
                                      const BladeSurface& blade,
                                      const std::vector<Crossing>& severed) {
  std::map<int, SpringAhead> ahead;
  for (SpringAhead each : state.ahead) {
    const Vec3 point = pointOn(lattice, state, each.spring, each.along);
    if (goesOnTo(blade, point)) {
      const double distance = distanceTo(blade, lattice, state, each.spring, each.along);
      each.distance = std::min(each.distance, distance);
    }
    ahead[each.spring] = each;
  }
  std::set<int> cells;
  for (const Crossing& crossing : severed) {
    for (const int cell : cellsAround(lattice, lattice.springs()[at(crossing.spring)])) {
      if (cell >= 0) cells.insert(cell);
    }
  }
  for (const int index : cells) {
    const Cell& cell = lattice.cells()[at(index)];
    if (mayBeAtFront(lattice, state, cell)) addFrontOf(lattice, state, blade, cell, ahead);
  }
  std::vector<SpringAhead> all;
  for (const auto& [spring, each] : ahead) all.push_back(each);
  return all;
}

std::vector<SpringAhead> stillAhead(const Lattice& lattice, const LatticeState& state) {
  std::vector<SpringAhead> still;
  for (const SpringAhead& each : state.ahead) {
    if (state.severed[at(each.spring)] != 0) continue;
    const auto cells = cellsAround(lattice, lattice.springs()[at(each.spring)]);
    const bool is_ahead = std::any_of(cells.begin(), cells.end(), [&](int cell) {
      return cell >= 0 && !isOnePart(frontParts(lattice, state, lattice.cells()[at(cell)]));
    });
    if (is_ahead) still.push_back(each);
  }
  return still;
}

bool haveComeNearer(const std::vector<SpringAhead>& before, const std::vector<SpringAhead>& now) {
  return !std::equal(before.begin(), before.end(), now.begin(), now.end(),
                     [](const SpringAhead& one, const SpringAhead& other) {
                       return other.distance > one.distance - kNearer;
                     });
}

namespace {

// On a side of the cell that the blade's surface crosses: from the severed spring to that ahead.
struct Passage {
  CellEdge severed, ahead;
};

Vec3 placeInCell(const CellEdge& edge, double along) {
  Vec3 place(edge.corner & 1, edge.corner >> 1 & 1, edge.corner >> 2 & 1);
  place[edge.axis] = along;
  return place;
}

bool isOnSide(const CellEdge& edge, int axis, int side) {
  return edge.axis != axis && (edge.corner >> axis & 1) == side;
}

std::vector<Passage> passagesOf(const LatticeState& state, const std::array<CellEdge, 12>& edges) {
  std::vector<Passage> passages;
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {0, 1}) {
      const CellEdge *severed = nullptr, *ahead = nullptr;
      for (const CellEdge& edge : edges) {
        if (!isOnSide(edge, axis, side)) continue;
        if (state.severed[at(edge.spring)] != 0) {
          severed = &edge;
        } else if (aheadAt(state, edge.spring) != nullptr) {
          ahead = &edge;
        }
      }
      if (severed != nullptr && ahead != nullptr) passages.push_back({*severed, *ahead});
    }
  }
  return passages;
}

FrontTie tieAt(const Passage& passage, const LatticeState& state, int place) {
  const CellEdge& edge = passage.severed;
  const double along = partedAt(state, edge.spring);
  const SpringAhead& ahead = *aheadAt(state, passage.ahead.spring);
  const double way = (placeInCell(edge, along) - placeInCell(passage.ahead, ahead.along)).norm();
  FrontTie tie;
  tie.place = place;
  tie.depth = std::clamp(ahead.distance - way, -1.0, 0.0);
  std::map<int, double> weights;
  const auto add = [&](const Cell& part, double sign) {
    weights[part.nodes[at(edge.corner)]] += sign * (1.0 - along);
    weights[part.nodes[at(edge.other)]] += sign * along;
  };
  add(*state.cells->owner(place, edge.corner), -1.0);
  add(*state.cells->owner(place, edge.other), 1.0);
  for (const auto& [node, weight] : weights) {
    if (weight != 0.0) tie.carriers.push_back({node, weight});
  }
  return tie;
}

}  // namespace

std::vector<FrontTie> frontTies(const Lattice& lattice, const LatticeState& state) {
  std::set<int> cells;
  for (const SpringAhead& each : state.ahead) {
    for (const int cell : cellsAround(lattice, lattice.springs()[at(each.spring)])) {
      if (cell >= 0) cells.insert(cell);
    }
  }
  std::vector<FrontTie> ties;
  for (const int index : cells) {
    const Cell& cell = lattice.cells()[at(index)];
    if (isOnePart(frontParts(lattice, state, cell))) continue;
    for (const Passage& passage : passagesOf(state, edgesOf(lattice, cell))) {
      FrontTie tie = tieAt(passage, state, cell.place);
      if (!tie.carriers.empty()) ties.push_back(std::move(tie));
    }
  }
  return ties;
}

}  // namespace robot_tissue
