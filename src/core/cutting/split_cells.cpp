#include "cutting/split_cells.h"

#include <algorithm>
#include <utility>

#include "cutting/cell_division.h"
#include "cutting/cut_front.h"
#include "lattice/held_layers.h"
#include "lattice/slivers.h"
#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

using Parts = std::array<int, kCorners>;

using PartFills = std::array<FillIntegrals, kCorners>;  // by the lowest corners of parts

PartFills partFills(const Lattice& lattice, const LatticeState& state, const Cell& cell,
                    const Parts& parts) {
  const auto of_corners = cornerFills(lattice, state, cell);
  PartFills fills;
  for (std::size_t corner = 0; corner < kCorners; ++corner) {
    fills[at(parts[corner])] += of_corners[corner];
  }
  const double least = leastShare(cell);
  FillIntegrals& greatest = *std::max_element(
      fills.begin(), fills.end(),
      [](const auto& one, const auto& other) { return one.volume < other.volume; });
  for (int part = 0; part < kCorners; ++part) {
    FillIntegrals& fill = fills[at(part)];
    if (parts[at(part)] != part || fill.volume >= least) continue;
    const double lack = least - fill.volume;
    fill = fill.scaledBy(least / fill.volume);
    greatest = greatest.scaledBy(1.0 - lack / greatest.volume);
  }
  return fills;
}

// Gives the parts' lost corners their nodes. A lost corner has the number (nodes of the lattice) +
// 8 * cell + corner until then, so that a set that holds a node of the lattice becomes that node.
class GhostMaker {
 public:
  GhostMaker(const Lattice& lattice, const LatticeState& state, std::vector<Cell> cells)
      : lattice_(lattice),
        state_(state),
        before_(*state.cells),
        cells_(std::move(cells)),
        same_(at(lattice.nodeCount()) + kCorners * cells_.size()),
        ghosts_(state.cells->ghosts()) {}

  std::shared_ptr<const CellSet> make() {
    for (std::size_t index = 0; index < cells_.size(); ++index) {
      if (!cells_[index].isPart()) continue;
      joinToNeighbors(index);
      joinAhead(index);
    }
    for (Ghost& ghost : ghosts_) ghost.fixed = false;
    ghost_of_.assign(kCorners * cells_.size(), -1);
    taken_.assign(ghosts_.size(), 0);
    for (std::size_t index = 0; index < cells_.size(); ++index) {
      if (cells_[index].isPart()) number(index);
    }
    stiffenSlivers(cells_, lattice_.nodeCount() + static_cast<int>(ghosts_.size()));
    return std::make_shared<const CellSet>(std::move(cells_), lattice_.nodeCount(),
                                           std::move(ghosts_));
  }

 private:
  int numberOf(std::size_t index, int corner) const {
    const Cell& cell = cells_[index];
    if (cell.owns(corner)) return cell.nodes[at(corner)];
    return lattice_.nodeCount() + kCorners * static_cast<int>(index) + corner;
  }

  void joinToNeighbors(std::size_t index) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        const Cell& whole = lattice_.cells()[at(cells_[index].place)];
        std::array<int, 3> beside = lattice_.gridIndex(whole.nodes.front());
        beside[at(axis)] += side == 1 ? 1 : -1;
        const int place = lattice_.cellAt(beside);
        if (place < 0) continue;
        const auto before = [](const Cell& cell, int other) { return cell.place < other; };
        auto other = std::lower_bound(cells_.begin(), cells_.end(), place, before);
        for (; other != cells_.end() && other->place == place; ++other) {
          joinAcross(index, static_cast<std::size_t>(other - cells_.begin()), axis, side);
        }
      }
    }
  }

  void joinAcross(std::size_t index, std::size_t other, int axis, int side) {
    std::array<int, 4> face{};
    std::size_t count = 0;
    bool common = false;
    for (int corner = 0; corner < kCorners; ++corner) {
      if ((corner >> axis & 1) != side) continue;
      face[count++] = corner;
      common = common || (cells_[index].owns(corner) && cells_[other].owns(corner ^ 1 << axis));
    }
    if (!common) return;
    for (const int corner : face) {
      same_.join(numberOf(index, corner), numberOf(other, corner ^ 1 << axis));
    }
  }

  // At a front what the blade left whole is one: its part has no ghosts at both ends of springs
  // ahead.
  void joinAhead(std::size_t index) {
    if (state_.ahead.empty()) return;
    const Cell& whole = lattice_.cells()[at(cells_[index].place)];
    if (isOnePart(frontParts(lattice_, state_, whole))) return;
    for (int corner = 0; corner < kCorners; ++corner) {
      for (int axis = 0; axis < 3; ++axis) {
        if (corner >> axis & 1) continue;
        const int spring = lattice_.springOf(whole.nodes[at(corner)], 2 * axis + 1);
        if (state_.severed[at(spring)] != 0 || aheadAt(state_, spring) == nullptr) continue;
        for (const int end : {corner, corner | 1 << axis}) {
          same_.join(numberOf(index, end), whole.nodes[at(end)]);
        }
      }
    }
  }

  void number(std::size_t index) {
    Cell& cell = cells_[index];
    const auto originals = lattice_.cells()[at(cell.place)].nodes;
    bool holds_fixed = false;
    for (int corner = 0; corner < kCorners; ++corner) {
      holds_fixed = holds_fixed || (cell.owns(corner) && lattice_.isFixed(originals[at(corner)]));
    }
    for (int corner = 0; corner < kCorners; ++corner) {
      if (cell.owns(corner)) continue;
      const int lowest = same_.lowest(numberOf(index, corner));
      const int original = originals[at(corner)];
      cell.nodes[at(corner)] = original;
      if (lowest < lattice_.nodeCount()) continue;
      int& ghost = ghost_of_[at(lowest - lattice_.nodeCount())];
      if (ghost < 0) ghost = ghostFor(cell, corner, original);
      cell.nodes[at(corner)] = lattice_.nodeCount() + ghost;
      if (holds_fixed && lattice_.isFixed(original)) ghosts_[at(ghost)].fixed = true;
    }
  }

  // Number of the ghost for a set of lost corners: the one that an earlier cut put there, if no
  // other set has taken it; else a new one.
  int ghostFor(const Cell& part, int corner, int original) {
    const Cell* earlier = before_.owner(part.place, part.lowestOwn());
    const int node = earlier != nullptr ? earlier->nodes[at(corner)] : original;
    if (before_.isGhost(node)) {
      const int known = node - lattice_.nodeCount();
      if (taken_[at(known)] == 0) {
        taken_[at(known)] = 1;
        return known;
      }
    }
    ghosts_.push_back({original, false});
    return static_cast<int>(ghosts_.size()) - 1;
  }

  const Lattice& lattice_;
  const LatticeState& state_;
  const CellSet& before_;
  std::vector<Cell> cells_;
  DisjointSets same_;
  std::vector<Ghost> ghosts_;
  std::vector<int> ghost_of_;  // per lost corner that stands for its set, -1 = none yet
  std::vector<char> taken_;    // per ghost that was there before
};

}  // namespace

namespace {

// Of a cell (1). More: thin parts are too stiff and heavy; less: their nodes are so soft that
// solves take longer. Chosen, as for cells that a mesh fills.
constexpr double kLeastShare = 1e-3;

}  // namespace

double leastShare(const Cell& cell) { return std::min(kLeastShare, cell.share() / kCorners); }

bool isOnePart(const std::array<int, kCorners>& parts) {
  return std::all_of(parts.begin(), parts.end(), [](int part) { return part == 0; });
}

std::array<int, kCorners> cellParts(const Lattice& lattice, const LatticeState& state,
                                    const std::array<int, kCorners>& corners) {
  std::array<int, kCorners> parts{};
  if (state.springs_cut == 0) return parts;
  for (int corner = 0; corner < kCorners; ++corner) parts[at(corner)] = corner;
  for (int corner = 0; corner < kCorners; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      if (corner >> axis & 1) continue;
      const int other = corner | 1 << axis;
      if (state.severed[at(lattice.springOf(corners[at(corner)], 2 * axis + 1))] != 0) continue;
      const int from = std::max(parts[at(corner)], parts[at(other)]);
      const int to = std::min(parts[at(corner)], parts[at(other)]);
      std::replace(parts.begin(), parts.end(), from, to);
    }
  }
  return parts;
}

namespace {

// What springs that may be severed leave of the lattice's cell, on its nodes.
void addLeft(const Lattice& lattice, const LatticeState& state, SplitCells split, const Cell& cell,
             std::vector<Cell>& left) {
  Parts parts = cellParts(lattice, state, cell.nodes);
  if (isOnePart(parts) && split == SplitCells::kParted) parts = frontParts(lattice, state, cell);
  if (isOnePart(parts)) {
    if (takenOf(state, cell.place) == 0) left.push_back(cell);
    return;
  }
  if (split == SplitCells::kLost) return;
  const PartFills fills = partFills(lattice, state, cell, parts);
  for (int part = 0; part < kCorners; ++part) {
    if (parts[at(part)] != part || isTaken(state, cell.place, part)) continue;
    Cell parted = cell;
    parted.own = 0;
    for (int corner = part; corner < kCorners; ++corner) {
      if (parts[at(corner)] == part) parted.own |= static_cast<std::uint8_t>(1 << corner);
    }
    parted.fill = SharedConst<CellFill>(partOfLayer(cell, parted, fillOf(fills[at(part)])));
    left.push_back(parted);
  }
}

// A part of the cell as it was made: without its ghosts, and no sliver yet.
Cell asMade(const Cell& cell, const Cell& part) {
  Cell made = cell;
  if (!part.isPart()) return made;
  made.own = part.own;
  made.fill = unraised(part.fill);
  return made;
}

}  // namespace

std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state,
                                         SplitCells split) {
  const std::vector<char> has_severed = cellsWithSevered(lattice, state);
  std::vector<Cell> left;
  left.reserve(state.cells->all().size());
  for (const Cell& cell : lattice.cells()) {
    if (has_severed[at(cell.place)] != 0) {
      addLeft(lattice, state, split, cell, left);
    } else if (takenOf(state, cell.place) == 0) {
      left.push_back(cell);
    }
  }
  return GhostMaker(lattice, state, std::move(left)).make();
}

std::shared_ptr<const CellSet> cellsLeft(const Lattice& lattice, const LatticeState& state,
                                         SplitCells split, const std::vector<int>& severed) {
  std::vector<char> has_severed(lattice.cells().size(), 0);
  for (const int spring : severed) {
    for (const int cell : cellsAround(lattice, lattice.springs()[at(spring)])) {
      if (cell >= 0) has_severed[at(cell)] = 1;
    }
  }
  std::vector<Cell> left;
  left.reserve(state.cells->all().size() + kCorners * severed.size());
  auto known = state.cells->all().begin();
  const auto end = state.cells->all().end();
  for (const Cell& cell : lattice.cells()) {
    const bool is_cut = has_severed[at(cell.place)] != 0;
    for (; known != end && known->place == cell.place; ++known) {
      if (!is_cut) left.push_back(asMade(cell, *known));
    }
    if (is_cut) addLeft(lattice, state, split, cell, left);
  }
  return GhostMaker(lattice, state, std::move(left)).make();
}

std::vector<Vec3> carriedOver(const CellSet& from, const std::vector<Vec3>& displacement,
                              const CellSet& to) {
  std::vector<Vec3> carried(displacement.begin(), displacement.begin() + to.latticeNodeCount());
  carried.resize(at(to.nodeCount()), Vec3::Zero());
  for (const Cell& part : to.all()) {
    if (!part.isPart()) continue;
    const Cell* earlier = from.owner(part.place, part.lowestOwn());
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      if (!to.isGhost(part.nodes[corner]) || earlier == nullptr) continue;
      carried[at(part.nodes[corner])] = displacement[at(earlier->nodes[corner])];
    }
  }
  // One that was free may have come to stand for a fixed node.
  for (std::size_t ghost = 0; ghost < to.ghosts().size(); ++ghost) {
    if (to.ghosts()[ghost].fixed) carried[at(to.latticeNodeCount()) + ghost].setZero();
  }
  return carried;
}

}  // namespace robot_tissue
