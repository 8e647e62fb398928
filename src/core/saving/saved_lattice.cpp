#include "saving/saved_lattice.h"

#include <algorithm>
#include <utility>

#include "cutting/cut.h"
#include "cutting/cut_front.h"
#include "cutting/removal.h"
#include "saving/checked_values.h"

namespace robot_tissue {
namespace {

constexpr double kFarthestFront = 1e4;  // spacings; none is as far

// Ghosts hang on the severed springs and on what was removed, but for their numbers: those hang on
// the order of the cuts. Cells and ghosts as one cut would have left them.
CellSet cellsOfOneCut(const Lattice& lattice, const LatticeState& state, SplitCells split) {
  LatticeState whole = lattice.restState();
  whole.severed = state.severed;
  whole.springs_cut = state.springs_cut;
  whole.parted_at = state.parted_at;
  whole.ahead = state.ahead;
  whole.taken = state.taken;
  return *cellsLeft(lattice, whole, split);
}

// Per ghost of `from`, its number in `to`, which has the same cells.
std::vector<int> renumbering(const CellSet& from, const CellSet& to) {
  std::vector<int> number(from.ghosts().size(), -1);
  for (std::size_t cell = 0; cell < from.all().size(); ++cell) {
    for (std::size_t corner = 0; corner < kCorners; ++corner) {
      const int ghost = from.all()[cell].nodes[corner];
      if (!from.isGhost(ghost)) continue;
      number[at(ghost - from.latticeNodeCount())] =
          to.all()[cell].nodes[corner] - to.latticeNodeCount();
    }
  }
  return number;
}

std::shared_ptr<const CellSet> renumbered(const CellSet& cells, const std::vector<int>& number,
                                          std::vector<Ghost> ghosts) {
  const int nodes = cells.latticeNodeCount();
  std::vector<Cell> all = cells.all();
  for (Cell& cell : all) {
    for (int& node : cell.nodes) {
      if (node >= nodes) node = nodes + number[at(node - nodes)];
    }
  }
  for (std::size_t ghost = 0; ghost < number.size(); ++ghost) {
    ghosts[at(number[ghost])].fixed = cells.ghosts()[ghost].fixed;
  }
  return std::make_shared<const CellSet>(std::move(all), nodes, std::move(ghosts));
}

}  // namespace

void putSevered(const LatticeState& state, ByteWriter& out) {
  const std::vector<std::uint8_t>& flags = state.severed;
  for (std::size_t first = 0; first < flags.size(); first += 8) {
    unsigned bits = 0;
    for (std::size_t i = first; i < std::min(first + 8, flags.size()); ++i) {
      if (flags[i] != 0) bits |= 1U << (i - first);
    }
    out.u8(static_cast<std::uint8_t>(bits));
  }
}

void takeSevered(std::size_t springs, LatticeState& state, ByteReader& in) {
  state.severed.assign(springs, 0);
  for (std::size_t first = 0; first < springs; first += 8) {
    const unsigned bits = in.u8();
    for (std::size_t i = 0; i < 8; ++i) {
      if ((bits >> i & 1U) == 0) continue;
      if (first + i >= springs) failAsDamaged("a flag of nothing is set");
      state.severed[first + i] = 1;
    }
  }
  state.springs_cut = static_cast<int>(std::count(state.severed.begin(), state.severed.end(), 1));
}

void putPartings(const LatticeState& state, ByteWriter& out) {
  for (std::size_t spring = 0; spring < state.severed.size(); ++spring) {
    if (state.severed[spring] != 0) out.f64(state.parted_at[spring]);
  }
}

void takePartings(LatticeState& state, ByteReader& in) {
  state.parted_at.assign(state.severed.size(), 0.5);
  for (std::size_t spring = 0; spring < state.severed.size(); ++spring) {
    if (state.severed[spring] == 0) continue;
    const double along = in.f64();
    if (along != 0.0 && !(along >= kEnd && along <= 1.0 - kEnd)) {
      failAsDamaged("a spring is parted beyond its ends");
    }
    state.parted_at[spring] = along;
  }
}

void putFronts(const LatticeState& state, ByteWriter& out) {
  out.count(state.ahead.size());
  for (const SpringAhead& each : state.ahead) {
    out.index(each.spring);
    out.f64(each.along);
    out.f64(each.distance);
  }
}

void takeFronts(const Lattice& lattice, LatticeState& state, ByteReader& in) {
  const int springs = static_cast<int>(state.severed.size());
  state.ahead.resize(in.count(sizeof(std::uint32_t) + 2 * sizeof(double)));
  for (SpringAhead& each : state.ahead) {
    each.spring = takeNode(springs, in);
    each.along = in.f64();
    each.distance = in.f64();
    const bool is_place = each.along >= kEnd && each.along <= 1.0 - kEnd;
    if (!is_place || !(each.distance >= 0.0 && each.distance <= kFarthestFront)) {
      failAsDamaged("the front of a cut is nowhere");
    }
  }
  const auto not_before = [](const SpringAhead& one, const SpringAhead& other) {
    return one.spring >= other.spring;
  };
  const bool ascends =
      std::adjacent_find(state.ahead.begin(), state.ahead.end(), not_before) == state.ahead.end();
  if (!ascends || stillAhead(lattice, state).size() != state.ahead.size()) {
    failAsDamaged("the front of a cut does not fit its severed springs");
  }
}

void putRemovals(const LatticeState& state, ByteWriter& out) {
  for (const std::uint8_t bits : state.taken) out.u8(bits);
}

void takeRemovals(const Lattice& lattice, LatticeState& state, ByteReader& in) {
  state.taken.resize(lattice.cells().size());
  for (std::uint8_t& bits : state.taken) bits = in.u8();
  const auto is_there = [](unsigned bits) { return bits < 0xff; };
  if (std::none_of(state.taken.begin(), state.taken.end(), is_there)) {
    failAsDamaged("nothing is left of the tissue");
  }
  const std::vector<std::uint8_t> severed = state.severed;
  noteTaken(lattice, state);
  if (state.severed != severed || !isOfWholeParts(lattice, state)) {
    failAsDamaged("what was removed does not fit its severed springs");
  }
}

void putGhosts(const Lattice& lattice, SplitCells split, const LatticeState& state,
               ByteWriter& out) {
  out.count(state.cells->ghosts().size());
  for (const Ghost& ghost : state.cells->ghosts()) out.index(ghost.original);
  if (state.cells->ghosts().empty()) return;
  for (const int number : renumbering(cellsOfOneCut(lattice, state, split), *state.cells)) {
    out.index(number);
  }
}

std::shared_ptr<const CellSet> takeCells(const Lattice& lattice, SplitCells split,
                                         const LatticeState& state, ByteReader& in) {
  std::vector<Ghost> ghosts(in.count(sizeof(std::uint32_t)));
  for (Ghost& ghost : ghosts) ghost.original = takeNode(lattice.nodeCount(), in);
  if (isAsMade(state) && ghosts.empty()) return lattice.restState().cells;
  const CellSet cells = cellsOfOneCut(lattice, state, split);
  std::vector<int> number;
  std::vector<char> taken(ghosts.size(), 0);
  for (const Ghost& ghost : cells.ghosts()) {
    number.push_back(takeNode(static_cast<int>(ghosts.size()), in));
    char& is_taken = taken[at(number.back())];
    if (is_taken != 0 || ghosts[at(number.back())].original != ghost.original) {
      failAsDamaged("its nodes do not fit its severed springs");
    }
    is_taken = 1;
  }
  return renumbered(cells, number, std::move(ghosts));
}

void takeDisplacement(const Lattice& lattice, LatticeState& state, ByteReader& in) {
  state.displacement.resize(at(state.cells->nodeCount()));
  for (int node = 0; node < state.cells->nodeCount(); ++node) {
    const Vec3 displacement = takeVector(in);
    const bool is_ghost = state.cells->isGhost(node);
    const bool stands = isFixed(lattice, *state.cells, node) || (!is_ghost && isGone(state, node));
    if (stands && !displacement.isZero(0.0)) failAsDamaged("a fixed or removed node is displaced");
    state.displacement[at(node)] = displacement;
  }
}

}  // namespace robot_tissue
