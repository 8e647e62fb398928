// Tissue: its pieces, and what becomes of those that nothing holds.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cutting/cell_division.h"
#include "cutting/removal.h"
#include "lattice/connectivity.h"
#include "lattice/piece_numbers.h"
#include "material/tissue_model.h"
#include "robot_tissue/core/disjoint_sets.h"
#include "tissue/history.h"
#include "tissue/threads.h"
#include "tissue/tissue_parts.h"
#include "tissue/topology_change.h"

namespace robot_tissue {

// What is free now stays so: nothing was let go of.
void TissueParts::takePieces(std::shared_ptr<const PieceNumbers> numbers) {
  piece_numbers_ = std::move(numbers);
  piece_of_nodes_of_.reset();
  if (drops_free_) left_free_ = freePieces();
}

void TissueParts::renumberPieces() {
  piece_numbers_ =
      std::make_shared<const PieceNumbers>(piece_numbers_->after(body_.lattice(), body_.state()));
  piece_of_nodes_of_.reset();
}

const std::vector<int>& TissueParts::pieceOfNodes() const {
  if (piece_of_nodes_of_ != nullptr && piece_of_nodes_of_ == body_.state().cells)
    return piece_of_nodes_;
  piece_of_nodes_ = robot_tissue::pieceOfNodes(body_.lattice(), body_.state());
  const std::vector<int>& of_parts = piece_numbers_->names().of_parts;
  for (int& piece : piece_of_nodes_) {
    if (piece >= 0) piece = of_parts[at(piece)];
  }
  piece_of_nodes_of_ = body_.state().cells;
  pieces_at_rest_.clear();
  return piece_of_nodes_;
}

const std::vector<int>& TissueParts::droppedPieces() const {
  return piece_numbers_->names().dropped;
}

// By number, without what holds them; centers at rest.
const std::vector<TissuePiece>& TissueParts::piecesAtRest() const {
  const std::vector<int>& piece_of = pieceOfNodes();
  if (!pieces_at_rest_.empty()) return pieces_at_rest_;
  pieces_at_rest_.resize(at(piece_numbers_->names().next));
  volume_at_node_.assign(at(body_.lattice().nodeCount()), 0.0);
  const double cell_volume = std::pow(body_.lattice().spacing(), 3);
  for (const Cell& cell : body_.lattice().cells()) {
    const auto fills = cornerFills(body_.lattice(), body_.state(), cell);
    for (int corner = 0; corner < kCorners; ++corner) {
      if (isTaken(body_.state(), cell.place, corner)) continue;
      const int node = cell.nodes[at(corner)];
      const FillIntegrals& fill = fills[at(corner)];
      TissuePiece& piece = pieces_at_rest_[at(piece_of[at(node)])];
      piece.fixed = piece.fixed || body_.lattice().isFixed(node);
      volume_at_node_[at(node)] += cell_volume * fill.volume;
      piece.volume += fill.volume;
      piece.center +=
          fill.volume * body_.lattice().cellCenter(cell) + body_.lattice().spacing() * fill.first;
    }
  }
  for (TissuePiece& piece : pieces_at_rest_) {
    if (piece.volume > 0.0) piece.center /= piece.volume;
    piece.volume *= cell_volume;
  }
  return pieces_at_rest_;
}

std::vector<TissuePiece> TissueParts::restingPieces() const {
  const std::vector<char> held = heldPieces();
  std::vector<int> numbers = piece_numbers_->names().of_parts;
  std::sort(numbers.begin(), numbers.end());
  std::vector<TissuePiece> pieces;
  for (const int number : numbers) {
    pieces.push_back(piecesAtRest()[at(number)]);
    pieces.back().number = number;
    pieces.back().held = held[at(number)] != 0;
  }
  return pieces;
}

std::vector<TissuePiece> TissueParts::pieces() const {
  const std::vector<int>& piece_of = pieceOfNodes();
  std::vector<Vec3> moved(at(piece_numbers_->names().next), Vec3::Zero());
  std::vector<TissuePiece> pieces = restingPieces();
  for (int node = 0; node < body_.lattice().nodeCount(); ++node) {
    const double volume = volume_at_node_[at(node)];
    if (volume > 0.0) moved[at(piece_of[at(node)])] += volume * body_.displacement()[at(node)];
  }
  for (TissuePiece& piece : pieces) piece.center += moved[at(piece.number)] / piece.volume;
  return pieces;
}

// Per number. What threads join is held together. Touches may still be of the surface before a
// change, on ghosts that are gone.
std::vector<char> TissueParts::heldPieces() const {
  const std::vector<int>& piece_of = pieceOfNodes();
  const auto piece = [&](int node) { return at(node) < piece_of.size() ? piece_of[at(node)] : -1; };
  DisjointSets joined(at(piece_numbers_->names().next));
  for (const SutureThread& thread : threads_->all()) {
    if (thread.broken) continue;
    const int from = piece(thread.from.carriers.front().node);
    const int to = piece(thread.to.carriers.front().node);
    if (from >= 0 && to >= 0) joined.join(from, to);
  }
  std::vector<char> held(at(piece_numbers_->names().next), 0);
  const auto hold = [&](int node) {
    if (piece(node) >= 0) held[at(joined.lowest(piece(node)))] = 1;
  };
  for (std::size_t number = 0; number < held.size(); ++number) {
    if (piecesAtRest()[number].fixed) held[at(joined.lowest(static_cast<int>(number)))] = 1;
  }
  for (const LoadingPatch& patch : loads_.patches()) {
    std::for_each(patch.nodes.begin(), patch.nodes.end(), hold);
    for (const ContactSpring& contact : patch.contacts) {
      for (const NodeWeight& carrier : contact.carriers) hold(carrier.node);
    }
  }
  for (std::size_t number = 0; number < held.size(); ++number) {
    held[number] = held[at(joined.lowest(static_cast<int>(number)))];
  }
  return held;
}

std::vector<int> TissueParts::freePieces() const {
  const std::vector<char> held = heldPieces();
  std::vector<int> numbers = piece_numbers_->names().of_parts;
  numbers.erase(std::remove_if(numbers.begin(), numbers.end(),
                               [&](int number) { return held[at(number)] != 0; }),
                numbers.end());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

// Of pieces that gravity pulls and nothing bears; ascending.
std::vector<int> TissueParts::hangingNodes() const {
  if (body_.gravity().isZero(0.0) || goesInTime() || isMoving()) return {};
  const std::vector<int> free = freePieces();
  std::vector<int> hanging;
  if (free.empty()) return hanging;
  const std::vector<int>& piece_of = pieceOfNodes();
  for (std::size_t node = 0; node < piece_of.size(); ++node) {
    if (std::binary_search(free.begin(), free.end(), piece_of[node])) {
      hanging.push_back(static_cast<int>(node));
    }
  }
  return hanging;
}

// For one solve, as a patch that keeps them where they are. False: there are none.
bool TissueParts::holdHanging() {
  LoadingPatch patch;
  patch.nodes = hangingNodes();
  if (patch.nodes.empty()) return false;
  for (const int node : patch.nodes) patch.displacement.push_back(body_.displacement()[at(node)]);
  loads_.patches().push_back(std::move(patch));
  return true;
}

// What would have to hold them is no answer to a load.
void TissueParts::letHangingBe(SolveReport& report) {
  loads_.patches().pop_back();
  report.patches.resize(loads_.patches().size());
}

// Those that were held when this was asked last, or are new, and are free now. While nothing holds
// any of the tissue it floats, and all of it stays.
std::vector<int> TissueParts::freedPieces() {
  if (!drops_free_ || body_.state().pieces == 1) return {};
  const std::vector<int> free = freePieces();
  std::vector<int> freed;
  if (free.size() == at(body_.state().pieces)) {
    left_free_ = free;
    return freed;
  }
  std::vector<int> still_free;
  std::set_difference(free.begin(), free.end(), left_free_.begin(), left_free_.end(),
                      std::back_inserter(freed));
  std::set_intersection(free.begin(), free.end(), left_free_.begin(), left_free_.end(),
                        std::back_inserter(still_free));
  left_free_ = std::move(still_free);
  return freed;
}

void TissueParts::takeOut(const std::vector<int>& pieces) {
  const std::vector<int>& piece_of = pieceOfNodes();
  std::vector<std::uint8_t> cells(body_.lattice().cells().size(), 0);
  for (const Cell& cell : body_.lattice().cells()) {
    unsigned bits = 0;
    for (int corner = 0; corner < kCorners; ++corner) {
      const int piece = piece_of[at(cell.nodes[at(corner)])];
      const bool goes = std::binary_search(pieces.begin(), pieces.end(), piece);
      if (goes && !isTaken(body_.state(), cell.place, corner)) bits |= 1U << corner;
    }
    cells[at(cell.place)] = static_cast<std::uint8_t>(bits);
  }
  removeCells(body_.lattice(), cells, body_.model().splitCells(), body_.change());
  body_.weigh();
  piece_numbers_ = std::make_shared<const PieceNumbers>(
      piece_numbers_->after(body_.lattice(), body_.state()).without(pieces));
  piece_of_nodes_of_.reset();
  dropLostLoads();
}

// Within a change of the topology, before its balance. The surface, and with it the ends of
// threads, may still be that of before.
void TissueParts::dropFreed() {
  if (!drops_free_ || body_.state().pieces == 1) return;
  if (threads_->anyWhole()) rebuildSurface();
  const std::vector<int> freed = freedPieces();
  if (!freed.empty()) takeOut(freed);
}

// By tools, loads or threads that hold them no longer.
void TissueParts::dropLetGo() {
  const std::vector<int> freed = freedPieces();
  if (freed.empty()) return;
  const TopologyChange change(*this, History::Kind::kByItself);
  takeOut(freed);
  changeTopology({});
}

}  // namespace robot_tissue
