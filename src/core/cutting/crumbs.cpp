#include "cutting/crumbs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <unordered_map>

#include "cutting/cell_division.h"
#include "cutting/cut.h"
#include "cutting/removal.h"
#include "cutting/split_cells.h"
#include "robot_tissue/core/disjoint_sets.h"

namespace robot_tissue {
namespace {

// Whether there is any tissue around a cell's corner: in its eighth, and up to where the blade
// passed as much as a part has at least.
class TissueInCells {
 public:
  TissueInCells(const Lattice& lattice, const LatticeState& state)
      : lattice_(lattice), state_(state) {}

  bool isAt(int place, int corner) {
    if (!lattice_.hasTissueAt(place, corner) || isTaken(state_, place, corner)) return false;
    const Cell& cell = lattice_.cells()[at(place)];
    return cell.fill == nullptr || (cornersOf(cell) >> corner & 1U) != 0;
  }

 private:
  unsigned cornersOf(const Cell& cell) {
    const auto [known, is_new] = corners_.try_emplace(cell.place, 0U);
    if (!is_new) return known->second;
    if (!hasPartedSprings(lattice_, state_, cell)) return known->second = 0xff;
    const auto fills = cornerFills(lattice_, state_, cell);
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      if (fills[corner].volume >= leastShare(cell)) known->second |= 1U << corner;
    }
    return known->second;
  }

  const Lattice& lattice_;
  const LatticeState& state_;
  std::unordered_map<int, unsigned> corners_;  // bits, of cells that are filled in part
};

bool hasTissue(const Lattice& lattice, TissueInCells& tissue, int node) {
  for (int corner = 0; corner < kCorners; ++corner) {
    std::array<int, 3> lowest = lattice.gridIndex(node);
    for (int axis = 0; axis < 3; ++axis) lowest[at(axis)] -= corner >> axis & 1;
    const int place = lattice.cellAt(lowest);
    if (place >= 0 && tissue.isAt(place, corner)) return true;
  }
  return false;
}

// Goes from node to node over springs that are not severed, as far as there is no tissue.
bool isCrumb(const Lattice& lattice, const LatticeState& state, TissueInCells& tissue, int start) {
  std::vector<int> reached = {start};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    if (hasTissue(lattice, tissue, reached[next])) return false;
    for (int direction = 0; direction < kNeighbors; ++direction) {
      const int spring = lattice.springOf(reached[next], direction);
      if (spring < 0 || state.severed[at(spring)] != 0) continue;
      const int other = lattice.neighbor(reached[next], direction);
      if (std::find(reached.begin(), reached.end(), other) == reached.end()) {
        reached.push_back(other);
      }
    }
  }
  return true;
}

// What springs hold together, by the lowest node, and whether there is tissue in it.
class HeldParts {
 public:
  HeldParts(const Lattice& lattice, const LatticeState& state, TissueInCells& tissue)
      : nodes_(at(lattice.nodeCount())), has_tissue_(at(lattice.nodeCount()), 0) {
    for (const Spring ends : lattice.springs()) {
      if (state.severed[at(ends.number)] == 0) nodes_.join(ends.a, ends.b);
    }
    for (const Cell& cell : lattice.cells()) {
      for (int corner = 0; corner < kCorners; ++corner) {
        if (tissue.isAt(cell.place, corner)) has_tissue_[at(of(cell, corner))] = 1;
      }
    }
  }

  int of(int node) { return nodes_.lowest(node); }
  int of(const Cell& cell, int corner) { return of(cell.nodes[at(corner)]); }
  bool isCrumb(int part) const { return has_tissue_[at(part)] == 0; }
  void join(int one, int other) {
    nodes_.join(one, other);
    has_tissue_[at(of(one))] |= has_tissue_[at(std::max(one, other))];
  }

 private:
  DisjointSets nodes_;
  std::vector<char> has_tissue_;  // per part
};

// A crumb and the part that it stays with.
struct Bond {
  int crumb = 0, part = 0;
};

// Of the crumb of the lowest number that these springs would part from anything.
std::optional<Bond> nextBond(const Lattice& lattice, const std::vector<Crossing>& crossings,
                             HeldParts& parts) {
  std::map<int, std::map<int, int>> springs;  // per crumb and part beside it
  for (const Crossing& crossing : crossings) {
    const Spring& ends = lattice.springs()[at(crossing.spring)];
    const int a = parts.of(ends.a), b = parts.of(ends.b);
    if (a == b) continue;
    if (parts.isCrumb(a)) ++springs[a][b];
    if (parts.isCrumb(b)) ++springs[b][a];
  }
  if (springs.empty()) return std::nullopt;
  const auto& [crumb, beside] = *springs.begin();
  const auto most =
      std::max_element(beside.begin(), beside.end(), [&parts](const auto& one, const auto& other) {
        const bool is_crumb = parts.isCrumb(one.first), other_is = parts.isCrumb(other.first);
        return is_crumb != other_is ? is_crumb : one.second < other.second;
      });
  return Bond{crumb, most->first};
}

}  // namespace

std::vector<Crossing> sparingCrumbs(const Lattice& lattice, const LatticeState& state,
                                    std::vector<Crossing> crossings) {
  if (lattice.isFull()) return crossings;
  LatticeState after;  // as far as it is looked at here
  after.severed = state.severed;
  after.parted_at = state.parted_at;
  after.springs_cut = state.springs_cut;
  after.ahead = state.ahead;
  after.taken = state.taken;
  severSprings(crossings, after);
  TissueInCells tissue(lattice, after);
  const bool leaves_any =
      std::any_of(crossings.begin(), crossings.end(), [&](const Crossing& crossing) {
        const Spring& ends = lattice.springs()[at(crossing.spring)];
        return isCrumb(lattice, after, tissue, ends.a) || isCrumb(lattice, after, tissue, ends.b);
      });
  if (!leaves_any) return crossings;
  HeldParts parts(lattice, after, tissue);
  while (const std::optional<Bond> bond = nextBond(lattice, crossings, parts)) {
    const auto joins = [&](const Crossing& crossing) {
      const Spring& ends = lattice.springs()[at(crossing.spring)];
      const int a = parts.of(ends.a), b = parts.of(ends.b);
      return (a == bond->crumb && b == bond->part) || (b == bond->crumb && a == bond->part);
    };
    crossings.erase(std::remove_if(crossings.begin(), crossings.end(), joins), crossings.end());
    parts.join(bond->crumb, bond->part);
  }
  return crossings;
}

std::vector<std::uint8_t> withCrumbs(const Lattice& lattice, const LatticeState& state,
                                     std::vector<std::uint8_t> cells) {
  if (lattice.isFull()) return cells;
  LatticeState after = state;
  after.taken.resize(cells.size(), 0);
  for (std::size_t place = 0; place < cells.size(); ++place) {
    after.taken[place] = static_cast<std::uint8_t>(after.taken[place] | cells[place]);
  }
  noteTaken(lattice, after);
  TissueInCells tissue(lattice, after);
  HeldParts parts(lattice, after, tissue);
  for (const Cell& cell : lattice.cells()) {
    for (int corner = 0; corner < kCorners; ++corner) {
      if (isTaken(after, cell.place, corner) || !parts.isCrumb(parts.of(cell, corner))) continue;
      cells[at(cell.place)] = static_cast<std::uint8_t>(cells[at(cell.place)] | 1U << corner);
    }
  }
  return cells;
}

}  // namespace robot_tissue
