#include "lattice/piece_numbers.h"

#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "lattice/connectivity.h"

namespace robot_tissue {
namespace {

// Of the cells that each part has (millionths of an eighth).
std::vector<std::int64_t> sizesOf(const Lattice& lattice, const LatticeState& state,
                                  const std::vector<int>& part_of_node) {
  std::vector<std::int64_t> sizes(at(state.pieces), 0);
  for (const Cell& cell : lattice.cells()) {
    const std::int64_t eighth = millionthsOf(cell);
    for (int corner = 0; corner < kCorners; ++corner) {
      if (isTaken(state, cell.place, corner)) continue;
      sizes[at(part_of_node[at(cell.nodes[at(corner)])])] += eighth;
    }
  }
  return sizes;
}

}  // namespace

std::int64_t millionthsOf(const Cell& cell) { return std::llround(1e6 * cell.share()); }

bool PieceNumbers::Names::areCounted() const {
  for (std::size_t part = 0; part < of_parts.size(); ++part) {
    if (of_parts[part] != static_cast<int>(part)) return false;
  }
  return at(next) == of_parts.size() && dropped.empty();
}

PieceNumbers::Names PieceNumbers::counted(int parts) {
  Names names;
  names.of_parts.resize(at(parts));
  std::iota(names.of_parts.begin(), names.of_parts.end(), 0);
  names.next = parts;
  return names;
}

PieceNumbers::PieceNumbers(const Lattice& lattice, const LatticeState& state, Names names)
    : PieceNumbers(lattice, std::move(names), pieceOfNodes(lattice, state)) {}

PieceNumbers::PieceNumbers(const Lattice& lattice, Names names, std::vector<int> parts)
    : names_(std::move(names)) {
  if (names_.of_parts.size() == 1) return;
  of_nodes_ = std::move(parts);
  of_nodes_.resize(at(lattice.nodeCount()));
  for (int& of_node : of_nodes_) {
    if (of_node >= 0) of_node = names_.of_parts[at(of_node)];
  }
}

PieceNumbers PieceNumbers::after(const Lattice& lattice, const LatticeState& state) const {
  std::vector<int> parts = pieceOfNodes(lattice, state);
  const std::vector<std::int64_t> sizes = sizesOf(lattice, state, parts);
  std::vector<int> earlier(at(state.pieces), -1);  // number of what each part was of
  for (std::size_t node = 0; node < at(lattice.nodeCount()); ++node) {
    if (parts[node] >= 0) earlier[at(parts[node])] = numberAt(node);
  }
  std::vector<int> heirs(at(names_.next), -1);
  for (int part = 0; part < state.pieces; ++part) {
    int& heir = heirs[at(earlier[at(part)])];
    if (heir < 0 || sizes[at(part)] > sizes[at(heir)]) heir = part;
  }
  Names names = names_;
  names.of_parts.resize(at(state.pieces));
  for (int part = 0; part < state.pieces; ++part) {
    const int number = earlier[at(part)];
    names.of_parts[at(part)] = heirs[at(number)] == part ? number : names.next++;
  }
  return {lattice, std::move(names), std::move(parts)};
}

PieceNumbers PieceNumbers::without(const std::vector<int>& dropped) const {
  PieceNumbers rest = *this;
  rest.names_.dropped.insert(rest.names_.dropped.end(), dropped.begin(), dropped.end());
  return rest;
}

}  // namespace robot_tissue
