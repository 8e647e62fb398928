#include "cutting/removal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "base/text_of.h"
#include "cutting/cell_division.h"
#include "cutting/cut_front.h"
#include "cutting/split_cells.h"
#include "lattice/connectivity.h"

namespace robot_tissue {
namespace {

constexpr unsigned kWholeCell = 0xff;
// Of the spacing: places that are the same but for the last digits.
constexpr double kRounding = 1e-9;
// Of means of neighbors, over what is there again. More: what is many cells wide bends less, and
// takes longer; less: it has kinks, from which strongly stretched `fung` tissue finds no balance.
// Chosen: what is n cells wide needs about n^2.
constexpr int kSweeps = 100;

void requireSpace(const RemovedSpace& space) {
  if (const PlacedBox* placed = std::get_if<PlacedBox>(&space)) {
    const Box& box = placed->box;
    const bool finite =
        box.min().allFinite() && box.max().allFinite() && placed->tissue_T_box.matrix().allFinite();
    if (!finite || !(box.max().array() > box.min().array()).all()) {
      throw InputError("box: " + textOf(box) + " m; allowed: min below max along x, y and z");
    }
    return;
  }
  if (!std::holds_alternative<Sphere>(space)) return;
  const Sphere& sphere = std::get<Sphere>(space);
  if (!sphere.center.allFinite() || !std::isfinite(sphere.radius) || !(sphere.radius > 0.0)) {
    std::ostringstream radius;
    radius << sphere.radius;
    throw InputError("sphere: at " + textOf(sphere.center) + " m, of radius " + radius.str() +
                     "; allowed: a finite center, and a radius above 0 m");
  }
}

// Eighths of the part that the corner is of.
unsigned bitsOfPart(const std::array<int, kCorners>& parts, int part) {
  unsigned bits = 0;
  for (int corner = 0; corner < kCorners; ++corner) {
    if (parts[at(corner)] == part) bits |= 1U << corner;
  }
  return bits;
}

// Of the material in these eighths, deformed (m). A part that the model has lost goes with its own
// corners.
Vec3 centerOf(const Lattice& lattice, const LatticeState& state, const Cell& cell, unsigned bits,
              int part) {
  const Cell* there = state.cells->owner(cell.place, part);
  const auto fills = cornerFills(lattice, state, cell);
  double volume = 0.0;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    if ((bits >> corner & 1U) != 0) volume += fills[corner].volume;
  }
  Vec3 center = Vec3::Zero();
  for (int eighth = 0; eighth < kCorners; ++eighth) {
    if ((bits >> eighth & 1U) == 0) continue;
    const FillIntegrals& fill = fills[at(eighth)];
    const Vec3 place = fill.first / fill.volume;
    for (int corner = 0; corner < kCorners; ++corner) {
      double weight = fill.volume / volume;
      for (int axis = 0; axis < 3; ++axis) {
        weight *= 0.5 + ((corner >> axis & 1) != 0 ? place[axis] : -place[axis]);
      }
      center += weight * lattice.restPosition(cell.nodes[at(corner)]);
      const int mover = there != nullptr ? there->nodes[at(corner)] : cell.nodes[at(eighth)];
      center += weight * state.displacement[at(mover)];
    }
  }
  return center;
}

Box boundsOf(const RemovedSpace& space) {
  if (const auto* sphere = std::get_if<Sphere>(&space)) {
    const Vec3 radius = Vec3::Constant(sphere->radius);
    return {sphere->center - radius, sphere->center + radius};
  }
  if (const auto* covered = std::get_if<CoveredSpace>(&space)) return covered->bounds;
  const auto& placed = std::get<PlacedBox>(space);
  Box bounds;
  for (int corner = 0; corner < kCorners; ++corner) {
    bounds.extend(placed.tissue_T_box * placed.box.corner(static_cast<Box::CornerType>(corner)));
  }
  return bounds;
}

// Around the part's deformed corners, its center is within it; of one that the model has lost
// nothing is known: everywhere.
bool mayReach(const Box& bounds, const Lattice& lattice, const LatticeState& state,
              const Cell& cell, int part) {
  const Cell* there = state.cells->owner(cell.place, part);
  if (there == nullptr) return true;
  Box around;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    around.extend(lattice.restPosition(cell.nodes[corner]) +
                  state.displacement[at(there->nodes[corner])]);
  }
  return around.intersects(bounds);
}

// Springs of which no cell has both ends any more are severed; that parts no material.
void severBareSprings(const Lattice& lattice, LatticeState& state) {
  std::vector<std::uint8_t> bare(state.severed.size(), 1);
  for (const Cell& cell : lattice.cells()) {
    const unsigned there = ~takenOf(state, cell.place);
    for (int corner = 0; corner < kCorners; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        const int other = corner | 1 << axis;
        if (other == corner || (there >> corner & there >> other & 1U) == 0) continue;
        bare[at(lattice.springOf(cell.nodes[at(corner)], 2 * axis + 1))] = 0;
      }
    }
  }
  state.parted_at.resize(bare.size(), 0.5);
  for (std::size_t spring = 0; spring < bare.size(); ++spring) {
    if (bare[spring] == 0 || state.severed[spring] != 0) continue;
    state.severed[spring] = 1;
    state.parted_at[spring] = 0.0;
  }
  state.springs_cut = static_cast<int>(std::count(state.severed.begin(), state.severed.end(), 1));
}

void weighNodes(const Lattice& lattice, LatticeState& state) {
  std::vector<double> all(at(lattice.nodeCount()), 0.0), there(all);
  for (const Cell& cell : lattice.cells()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const std::size_t node = at(cell.nodes[at(corner)]);
      all[node] += cell.share();
      if (!isTaken(state, cell.place, corner)) there[node] += cell.share();
    }
  }
  for (std::size_t node = 0; node < all.size(); ++node) there[node] /= all[node];
  state.left = std::move(there);
}

// Per node and ghost of `state`: it was there before, stands, or is not there.
std::vector<char> areKnown(const Lattice& lattice, const LatticeState& before,
                           const LatticeState& state) {
  std::vector<char> is_known(state.displacement.size(), 0);
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    is_known[at(node)] = lattice.isFixed(node) || !isGone(before, node) || isGone(state, node);
  }
  for (std::size_t ghost = 0; ghost < state.cells->ghosts().size(); ++ghost) {
    if (state.cells->ghosts()[ghost].fixed) is_known[at(lattice.nodeCount()) + ghost] = 1;
  }
  for (const Cell& cell : state.cells->all()) {
    if (before.cells->owner(cell.place, cell.lowestOwn()) == nullptr) continue;
    for (const int node : cell.nodes) {
      if (state.cells->isGhost(node)) is_known[at(node)] = 1;
    }
  }
  return is_known;
}

struct Beside {
  int from = 0, to = 0;  // nodes at an edge of a cell
};

// To nodes that are not known, from those that are there.
std::vector<Beside> besideUnknown(const std::vector<char>& is_known, const LatticeState& state) {
  std::vector<Beside> edges;
  for (const Cell& cell : state.cells->all()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      const int to = cell.nodes[at(corner)];
      if (is_known[at(to)] != 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const int from = cell.nodes[at(corner ^ 1 << axis)];
        if (state.cells->isGhost(from) || !isGone(state, from)) edges.push_back({from, to});
      }
    }
  }
  return edges;
}

}  // namespace

std::vector<std::uint8_t> cellsWithin(const Lattice& lattice, const LatticeState& state,
                                      const RemovedSpace& space) {
  requireSpace(space);
  const Box bounds = grownBy(kRounding * lattice.spacing(), boundsOf(space));
  std::vector<std::uint8_t> within(lattice.cells().size(), 0);
  bool any = false;
  for (const Cell& cell : lattice.cells()) {
    const auto parts = cellParts(lattice, state, cell.nodes);
    for (int part = 0; part < kCorners; ++part) {
      if (parts[at(part)] != part || isTaken(state, cell.place, part)) continue;
      if (!mayReach(bounds, lattice, state, cell, part)) continue;
      const unsigned bits = bitsOfPart(parts, part);
      if (!holds(space, centerOf(lattice, state, cell, bits, part))) continue;
      within[at(cell.place)] = static_cast<std::uint8_t>(within[at(cell.place)] | bits);
      any = true;
    }
  }
  if (!any) within.clear();
  return within;
}

void noteTaken(const Lattice& lattice, LatticeState& state) {
  severBareSprings(lattice, state);
  weighNodes(lattice, state);
  state.pieces = countPieces(lattice, state);
}

void removeCells(const Lattice& lattice, const std::vector<std::uint8_t>& cells, SplitCells split,
                 LatticeState& state) {
  state.taken.resize(lattice.cells().size(), 0);
  for (std::size_t place = 0; place < cells.size(); ++place) {
    state.taken[place] = static_cast<std::uint8_t>(state.taken[place] | cells[place]);
  }
  noteTaken(lattice, state);
  state.ahead = stillAhead(lattice, state);
  const auto there = cellsLeft(lattice, state, split);
  state.displacement = carriedOver(*state.cells, state.displacement, *there);
  state.cells = there;
  restRemoved(state);
}

void restRemoved(LatticeState& state) {
  for (int node = 0; node < state.cells->nodeCount(); ++node) {
    if (isGone(state, node)) state.displacement[at(node)].setZero();
  }
}

void moveWithNeighbors(const Lattice& lattice, const LatticeState& before, LatticeState& state) {
  std::vector<char> is_known = areKnown(lattice, before, state);
  const std::vector<Beside> edges = besideUnknown(is_known, state);
  for (int sweep = 0; sweep < kSweeps && !edges.empty(); ++sweep) {
    std::vector<int> beside(is_known.size(), 0);
    std::vector<Vec3> sum(is_known.size(), Vec3::Zero());
    for (const Beside& edge : edges) {
      if (is_known[at(edge.from)] == 0) continue;
      sum[at(edge.to)] += state.displacement[at(edge.from)];
      ++beside[at(edge.to)];
    }
    for (std::size_t node = 0; node < is_known.size(); ++node) {
      if (beside[node] == 0) continue;
      state.displacement[node] = sum[node] / beside[node];
      is_known[node] = 1;
    }
  }
}

bool isOfWholeParts(const Lattice& lattice, const LatticeState& state) {
  for (const Cell& cell : lattice.cells()) {
    const unsigned taken = takenOf(state, cell.place);
    if (taken == 0 || taken == kWholeCell) continue;
    const auto parts = cellParts(lattice, state, cell.nodes);
    for (int corner = 0; corner < kCorners; ++corner) {
      const unsigned bits = bitsOfPart(parts, parts[at(corner)]);
      if ((taken & bits) != 0 && (taken & bits) != bits) return false;
    }
  }
  return true;
}

std::vector<int> nodesAround(const Lattice& lattice, const std::vector<std::uint8_t>& cells,
                             const LatticeState& state) {
  std::vector<int> nodes;
  for (const Cell& cell : lattice.cells()) {
    if (cells[at(cell.place)] == 0) continue;
    for (const int node : cell.nodes) {
      if (!isRemoved(state, node)) nodes.push_back(node);
    }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

double volumeOf(const Lattice& lattice, const LatticeState& state,
                const std::vector<std::uint8_t>& cells) {
  double volume = 0.0;
  for (const Cell& cell : lattice.cells()) {
    const unsigned bits = cells[at(cell.place)];
    if (bits == 0) continue;
    const auto fills = cornerFills(lattice, state, cell);
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      if ((bits >> corner & 1U) != 0) volume += fills[corner].volume;
    }
  }
  return volume * std::pow(lattice.spacing(), 3);
}

}  // namespace robot_tissue
