#include "tissue/piece_registry.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "cutting/cell_division.h"
#include "lattice/connectivity.h"
#include "robot_tissue/core/disjoint_sets.h"
#include "tissue/tuning.h"

namespace robot_tissue {

PieceRegistry::PieceRegistry(const Body& body, const StandingLoads& loads, const Threads& threads,
                             bool drops_free)
    : body_(body), loads_(loads), threads_(threads), drops_free_(drops_free) {
  take(std::make_shared<const PieceNumbers>(body.lattice(), body.state()));
}

void PieceRegistry::take(std::shared_ptr<const PieceNumbers> numbers) {
  numbers_ = std::move(numbers);
  of_nodes_of_.reset();
  if (drops_free_) left_free_ = freePieces(touched());
}

void PieceRegistry::renumber() {
  numbers_ = std::make_shared<const PieceNumbers>(numbers_->after(body_.lattice(), body_.state()));
  of_nodes_of_.reset();
}

void PieceRegistry::renumberWithout(const std::vector<int>& pieces) {
  numbers_ = std::make_shared<const PieceNumbers>(
      numbers_->after(body_.lattice(), body_.state()).without(pieces));
  of_nodes_of_.reset();
}

const std::vector<int>& PieceRegistry::ofNodes() const {
  if (of_nodes_of_ != nullptr && of_nodes_of_ == body_.state().cells) return of_nodes_;
  of_nodes_ = pieceOfNodes(body_.lattice(), body_.state());
  const std::vector<int>& of_parts = numbers_->names().of_parts;
  for (int& piece : of_nodes_) {
    if (piece >= 0) piece = of_parts[at(piece)];
  }
  of_nodes_of_ = body_.state().cells;
  at_rest_.clear();
  return of_nodes_;
}

// By number, without what holds them; centers at rest.
const std::vector<TissuePiece>& PieceRegistry::allAtRest() const {
  const Lattice& lattice = body_.lattice();
  const std::vector<int>& piece_of = ofNodes();
  if (!at_rest_.empty()) return at_rest_;
  at_rest_.resize(at(numbers_->names().next));
  volume_at_node_.assign(at(lattice.nodeCount()), 0.0);
  const double cell_volume = std::pow(lattice.spacing(), 3);
  for (const Cell& cell : lattice.cells()) {
    const auto fills = cornerFills(lattice, body_.state(), cell);
    for (int corner = 0; corner < kCorners; ++corner) {
      if (isTaken(body_.state(), cell.place, corner)) continue;
      const int node = cell.nodes[at(corner)];
      const FillIntegrals& fill = fills[at(corner)];
      TissuePiece& piece = at_rest_[at(piece_of[at(node)])];
      piece.fixed = piece.fixed || lattice.isFixed(node);
      volume_at_node_[at(node)] += cell_volume * fill.volume;
      piece.volume += fill.volume;
      piece.center += fill.volume * lattice.cellCenter(cell) + lattice.spacing() * fill.first;
    }
  }
  for (TissuePiece& piece : at_rest_) {
    if (piece.volume > 0.0) piece.center /= piece.volume;
    piece.volume *= cell_volume;
  }
  return at_rest_;
}

std::vector<TissuePiece> PieceRegistry::atRest() const {
  const std::vector<char> is_held = findHolds(near(), GivenForces::kHold).held;
  std::vector<int> numbers = numbers_->names().of_parts;
  std::sort(numbers.begin(), numbers.end());
  std::vector<TissuePiece> pieces;
  for (const int number : numbers) {
    pieces.push_back(allAtRest()[at(number)]);
    pieces.back().number = number;
    pieces.back().held = is_held[at(number)] != 0;
  }
  return pieces;
}

std::vector<TissuePiece> PieceRegistry::deformed() const {
  const std::vector<int>& piece_of = ofNodes();
  std::vector<Vec3> moved(at(numbers_->names().next), Vec3::Zero());
  std::vector<TissuePiece> pieces = atRest();
  for (int node = 0; node < body_.lattice().nodeCount(); ++node) {
    const double volume = volume_at_node_[at(node)];
    if (volume > 0.0) moved[at(piece_of[at(node)])] += volume * body_.displacement()[at(node)];
  }
  for (TissuePiece& piece : pieces) piece.center += moved[at(piece.number)] / piece.volume;
  return pieces;
}

std::vector<int> PieceRegistry::near() const {
  return carriersOf([](const ContactSpring&) { return true; });
}

std::vector<int> PieceRegistry::touched() const {
  if (!drops_free_) return {};
  return carriersOf([this](const ContactSpring& contact) { return touches(contact); });
}

std::vector<int> PieceRegistry::carriersOf(
    const std::function<bool(const ContactSpring&)>& counts) const {
  std::vector<int> nodes;
  for (const LoadingPatch& patch : loads_.patches()) {
    for (const ContactSpring& contact : patch.contacts) {
      if (!counts(contact)) continue;
      for (const NodeWeight& carrier : contact.carriers) nodes.push_back(carrier.node);
    }
  }
  return nodes;
}

// Where it pushes, or has only just been found in touch. What gravity takes there comes to lie.
bool PieceRegistry::touches(const ContactSpring& contact) const {
  const std::vector<Vec3>& displacement = body_.displacement();
  const auto is_gone = [&](const NodeWeight& carrier) {
    return at(carrier.node) >= displacement.size();
  };
  if (std::any_of(contact.carriers.begin(), contact.carriers.end(), is_gone)) return true;
  return normalForceOf(contact, displacement) > 0.0 || contact.normal.dot(body_.gravity()) < 0.0 ||
         gapOf(contact, displacement) <= tuning::kTouchingGap * body_.lattice().spacing();
}

// Touches may still be of the surface before a change, on ghosts that are gone.
PieceRegistry::Holds PieceRegistry::findHolds(const std::vector<int>& touched,
                                              GivenForces forces) const {
  const std::vector<int>& piece_of = ofNodes();
  const auto piece = [&](int node) { return at(node) < piece_of.size() ? piece_of[at(node)] : -1; };
  DisjointSets joined(at(numbers_->names().next));
  const auto join = [&](int a, int b) {
    if (piece(a) >= 0 && piece(b) >= 0) joined.join(piece(a), piece(b));
  };
  for (const SutureThread& thread : threads_.all()) {
    if (!thread.broken) {
      join(thread.from.carriers.front().node, thread.to.carriers.front().node);
    }
  }
  for (const LoadingPatch& patch : loads_.patches()) {
    for (const int node : patch.nodes) join(patch.nodes.front(), node);
  }
  Holds holds;
  holds.held.assign(at(numbers_->names().next), 0);
  const auto hold = [&](int node) {
    if (piece(node) >= 0) holds.held[at(joined.lowest(piece(node)))] = 1;
  };
  for (std::size_t number = 0; number < holds.held.size(); ++number) {
    holds.group.push_back(joined.lowest(static_cast<int>(number)));
    if (allAtRest()[number].fixed) holds.held[at(holds.group.back())] = 1;
  }
  for (const LoadingPatch& patch : loads_.patches()) {
    if (forces == GivenForces::kLetGo && byForce(patch)) continue;
    std::for_each(patch.nodes.begin(), patch.nodes.end(), hold);
  }
  std::for_each(touched.begin(), touched.end(), hold);
  for (std::size_t number = 0; number < holds.held.size(); ++number) {
    holds.held[number] = holds.held[at(holds.group[number])];
  }
  return holds;
}

// Ascending.
std::vector<int> PieceRegistry::freePieces(const std::vector<int>& touched) const {
  const std::vector<char> is_held = findHolds(touched, GivenForces::kHold).held;
  std::vector<int> numbers = numbers_->names().of_parts;
  numbers.erase(std::remove_if(numbers.begin(), numbers.end(),
                               [&](int number) { return is_held[at(number)] != 0; }),
                numbers.end());
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<int> PieceRegistry::nodesOf(const std::vector<int>& pieces) const {
  std::vector<int> nodes;
  if (pieces.empty()) return nodes;
  const std::vector<int>& piece_of = ofNodes();
  for (std::size_t node = 0; node < piece_of.size(); ++node) {
    if (std::binary_search(pieces.begin(), pieces.end(), piece_of[node])) {
      nodes.push_back(static_cast<int>(node));
    }
  }
  return nodes;
}

std::vector<int> PieceRegistry::nodesOfFree() const { return nodesOf(freePieces(near())); }

// Per group, by its lowest piece, whether given forces, with gravity, move it without end.
std::vector<char> PieceRegistry::drifting(const Holds& holds) const {
  const std::vector<int>& piece_of = ofNodes();
  std::vector<Vec3> net(holds.held.size(), Vec3::Zero());
  std::vector<double> given(holds.held.size(), 0.0);
  std::vector<char> drifting(holds.held.size(), 0);
  for (const LoadingPatch& patch : loads_.patches()) {
    if (!byForce(patch)) continue;
    const int piece = piece_of[at(patch.nodes.front())];
    if (piece < 0 || holds.held[at(piece)] != 0) continue;
    const std::size_t group = at(holds.group[at(piece)]);
    net[group] += patch.force;
    given[group] += patch.force.norm();
    drifting[group] = 1;
  }
  const bool any = std::count(drifting.begin(), drifting.end(), 1) > 0;
  const Lattice& lattice = body_.lattice();
  for (int node = 0; any && !body_.gravity().isZero(0.0) && node < lattice.nodeCount(); ++node) {
    const int piece = piece_of[at(node)];
    if (piece >= 0) net[at(holds.group[at(piece)])] += lattice.mass(node) * body_.gravity();
  }
  for (std::size_t group = 0; group < drifting.size(); ++group) {
    if (net[group].norm() <= tuning::kAdrift * given[group]) drifting[group] = 0;
  }
  return drifting;
}

PieceRegistry::Adrift PieceRegistry::adrift() const {
  Adrift adrift;
  const std::vector<LoadingPatch>& patches = loads_.patches();
  if (std::none_of(patches.begin(), patches.end(), byForce)) return adrift;
  const Holds holds = findHolds(near(), GivenForces::kLetGo);
  const std::vector<char> drifts = drifting(holds);
  std::vector<int> pieces;
  for (std::size_t number = 0; number < holds.group.size(); ++number) {
    if (drifts[at(holds.group[number])] != 0) pieces.push_back(static_cast<int>(number));
  }
  adrift.nodes = nodesOf(pieces);
  const auto is_adrift = [&](int node) {
    return std::binary_search(adrift.nodes.begin(), adrift.nodes.end(), node);
  };
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (byForce(patches[i]) && is_adrift(patches[i].nodes.front())) adrift.patches.push_back(i);
  }
  return adrift;
}

std::vector<int> PieceRegistry::freed(const std::vector<int>& touched) {
  if (!drops_free_ || body_.state().pieces == 1) return {};
  const std::vector<int> now_free = freePieces(touched);
  std::vector<int> freed;
  if (now_free.size() == at(body_.state().pieces)) {
    left_free_ = now_free;
    return freed;
  }
  std::vector<int> still_free;
  std::set_difference(now_free.begin(), now_free.end(), left_free_.begin(), left_free_.end(),
                      std::back_inserter(freed));
  std::set_intersection(now_free.begin(), now_free.end(), left_free_.begin(), left_free_.end(),
                        std::back_inserter(still_free));
  left_free_ = std::move(still_free);
  return freed;
}

void PieceRegistry::findLoose() {
  const std::shared_ptr<const CellSet>& cells = body_.state().cells;
  if (loose_of_ == cells) return;
  loose_of_ = cells;
  const std::vector<int>& pieces = ofNodes();
  std::vector<bool> has_fixed;
  loose_.clear();
  for (std::size_t node = 0; node < pieces.size(); ++node) {
    if (pieces[node] < 0) continue;
    const std::size_t piece = at(pieces[node]);
    if (loose_.size() <= piece) loose_.resize(piece + 1);
    has_fixed.resize(loose_.size(), false);
    loose_[piece].push_back(static_cast<int>(node));
    if (isFixed(body_.lattice(), *cells, static_cast<int>(node))) has_fixed[piece] = true;
  }
  for (std::size_t piece = 0; piece < has_fixed.size(); ++piece) {
    if (has_fixed[piece]) loose_[piece].clear();
  }
}

std::vector<const std::vector<int>*> PieceRegistry::falling() {
  findLoose();
  std::vector<int> touched = threads_.nodes();
  for (const LoadingPatch& patch : loads_.patches()) {
    touched.insert(touched.end(), patch.nodes.begin(), patch.nodes.end());
    for (const ContactSpring& contact : patch.contacts) {
      for (const NodeWeight& carrier : contact.carriers) touched.push_back(carrier.node);
    }
  }
  std::sort(touched.begin(), touched.end());
  const auto is_touched = [&](int node) {
    return std::binary_search(touched.begin(), touched.end(), node);
  };
  std::vector<const std::vector<int>*> falling;
  for (const std::vector<int>& nodes : loose_) {
    if (!nodes.empty() && std::none_of(nodes.begin(), nodes.end(), is_touched)) {
      falling.push_back(&nodes);
    }
  }
  return falling;
}

}  // namespace robot_tissue
