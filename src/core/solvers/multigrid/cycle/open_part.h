// Which part of the finest lattice is solved for: a box around what acts (the seeds) and so many
// layers more; beyond, coarse levels tell (CompositeGrid).
#pragma once

#include <vector>

#include "solvers/multigrid/cycle/solve_context.h"

namespace robot_tissue {

class OpenPart {
 public:
  OpenPart(const Lattice& lattice, double tolerance);

  // Drops what earlier solves taught: the layers, what they missed, the nodes that were loaded.
  void forget();
  // Of these, the nodes: the cells are others, and so are nodes' numbers.
  void forgetLoads() {
    loaded_.clear();
    last_seeds_.clear();
  }

  // The seeds: nodes in patches and contacts, now and in the last solve, and disturbed ones.
  void findSeeds(const SolveContext& solve, const std::vector<int>& disturbed);
  void seedAll() { seeds_ = wholeOf(lattice_.size()); }  // as where all nodes move in time
  bool isEmpty() const { return seeds_.isEmpty(); }
  const GridBox& seeds() const { return seeds_; }  // around them
  GridBox box() const;  // the part, in grid points; may reach beyond the lattice
  int layers() const { return static_cast<int>(layers_); }
  // Nodes in patches and contacts of this solve.
  const std::vector<int>& loaded() const { return loaded_; }

  // Given what coarse lattices miss beyond the part, over the displacement
  // (CompositeShape::missedBeyond). True: it is so much that there are more layers now.
  bool raise(double missed);
  double missed() const { return missed_; }
  // The error that a solve may have beside that: (tolerance^2 - missed^2)^1/2.
  double allowedError() const;

  // Of the part that is open in the end: layers around the seeds, nodes that may move.
  int layersIn(const GridBox& open) const;
  int nodesIn(const GridBox& open, const DofConstraints& hold) const;

 private:
  double firstLayers() const;
  void addSeed(const CellSet& cells, int node);

  const Lattice& lattice_;
  double tolerance_;
  GridBox seeds_;
  double layers_;
  // By the lattice's nodes: ghosts of the last solve may be gone after a cut or an undo.
  std::vector<int> last_seeds_;
  std::vector<int> loaded_;
  double missed_ = 0.0;
};

}  // namespace robot_tissue
