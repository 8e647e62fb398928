// The tissue's pieces: their numbers, and which of them something holds.
//
// A piece has its number for as long as it lasts. What is found once for the cells there are is
// kept until these are others; whoever changes the cells calls `renumber` where pieces come apart.
// Centers in m, in the tissue's frame; volumes in m^3.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "lattice/piece_numbers.h"
#include "robot_tissue/core/tissue.h"
#include "tissue/body.h"
#include "tissue/standing_loads.h"
#include "tissue/threads.h"

namespace robot_tissue {

class PieceRegistry {
 public:
  // What given forces move without end, as nothing else holds it or touches it.
  struct Adrift {
    std::vector<int> nodes;            // of these pieces, ascending
    std::vector<std::size_t> patches;  // that move them, ascending
  };

  // drops_free: pieces that nothing holds any more are to be taken out.
  PieceRegistry(const Body& body, const StandingLoads& loads, const Threads& threads,
                bool drops_free);

  const std::shared_ptr<const PieceNumbers>& numbers() const { return numbers_; }
  const std::vector<int>& dropped() const { return numbers_->names().dropped; }
  const std::vector<int>& ofNodes() const;    // Tissue::pieceOfNodes
  std::vector<TissuePiece> atRest() const;    // by number; centers at rest
  std::vector<TissuePiece> deformed() const;  // by number
  std::vector<int> nodesOfFree() const;       // of pieces that nothing holds; ascending
  Adrift adrift() const;
  // Displacements (m) without strain: zero where something holds the piece; one that is free stays
  // where it is, but is rigid.
  std::vector<Vec3> relaxed() const;  // relaxed_pieces.cpp
  // Nodes of each piece that no fixed node holds and nothing holds or touches; its center of mass
  // goes as gravity says.
  std::vector<const std::vector<int>*> falling();

  // What is free now stays so: nothing was let go of.
  void take(std::shared_ptr<const PieceNumbers> numbers);
  void renumber();
  void renumberWithout(const std::vector<int>& pieces);
  bool dropsFree() const { return drops_free_; }
  // Nodes that tools and supports touch: what is across a gap does not, unless gravity closes that.
  // To be asked before the cells change, as touches are of those that there were.
  std::vector<int> touched() const;
  // Those that were held when this was asked last, or are new, and are free now; none where free
  // pieces stay. While nothing holds any of the tissue it floats, and all of it stays.
  std::vector<int> freed(const std::vector<int>& touched);

 private:
  const std::vector<TissuePiece>& allAtRest() const;
  std::vector<int> near() const;  // nodes that tools and supports are near to
  // Nodes of the contacts that count.
  std::vector<int> carriersOf(const std::function<bool(const ContactSpring&)>& counts) const;
  bool touches(const ContactSpring& contact) const;
  // Pieces by number: which of them hang together by threads and patches, named by the lowest, and
  // whether something holds them.
  struct Holds {
    std::vector<int> group;
    std::vector<char> held;
  };
  enum class GivenForces { kHold, kLetGo };
  std::vector<char> drifting(const Holds& holds) const;
  Holds findHolds(const std::vector<int>& touched, GivenForces forces) const;
  std::vector<int> nodesOf(const std::vector<int>& pieces) const;  // ascending, as these are
  std::vector<int> freePieces(const std::vector<int>& touched) const;
  std::vector<std::vector<int>> nodesOfEachFree() const;  // relaxed_pieces.cpp
  void findLoose();

  const Body& body_;
  const StandingLoads& loads_;
  const Threads& threads_;
  bool drops_free_;
  std::shared_ptr<const PieceNumbers> numbers_;
  mutable std::vector<int> of_nodes_;                   // by number
  mutable std::shared_ptr<const CellSet> of_nodes_of_;  // null: to be found
  mutable std::vector<TissuePiece> at_rest_;            // with of_nodes_; by number
  mutable std::vector<double> volume_at_node_;          // of cells, per node of the lattice
  std::vector<int> left_free_;                          // that nothing holds, and that stay
  // Nodes of each piece that no fixed node holds, and the cells that they were found for.
  std::vector<std::vector<int>> loose_;
  std::shared_ptr<const CellSet> loose_of_;
};

}  // namespace robot_tissue
