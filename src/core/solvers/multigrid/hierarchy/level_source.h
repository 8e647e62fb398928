// What the levels of a block are made of (own): the moduli of each level's cells, what cuts left of
// them, and where the next coarser level has lost some of what they say.
#pragma once

#include <array>
#include <vector>

#include "material/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "solvers/multigrid/hierarchy/listed_cells.h"

namespace robot_tissue {

struct LevelSource {
  std::array<int, 3> size{};  // grid points
  // Per cell, x fastest (E0); one value where all are alike.
  std::vector<double> shear;
  std::vector<double> bulk;
  std::vector<double> stiffening;  // of the law `fung`; means are weighted with the shear modulus
  // A box around what the next coarser level does not resolve: coarse cells whose eight cells
  // differ in modulus, and fixed nodes of which not all carriers in P are fixed, or the other way
  // round. Empty: low above high.
  GridBox rough;
  ListedCells listed;               // none where nothing is cut
  double uncut_stiffness = 0.0;     // the greatest of a lattice of equal cells; 0: not known
  double greatest_stiffness = 0.0;  // with what is cut; 0: not known

  // More than tuning::kThick points along the shortest side, and at most tuning::kMostSlender times
  // that along the longest. Thinner or longer blocks bend, and few trilinear cells are too stiff in
  // bending (shear locking): there a coarse level does not stand for the finer one (model.md).
  bool isThick() const;
  GridBox whole() const { return wholeOf(size); }
  // Of the cells between these points, placed from its low corner, with all nodes beside the grid;
  // and of the block's, as if nothing was cut.
  std::vector<LevelCell> cellsIn(const GridBox& points, const LevelGrid& grid) const;
  std::vector<LevelCell> uncutIn(const GridBox& points, const LevelGrid& grid) const;
  bool isUniform() const { return shear.size() == 1; }
  std::size_t cellAt(int i, int j, int k) const {
    return shear.size() == 1 ? 0 : at(i + (size[0] - 1) * (j + (size[1] - 1) * k));
  }
};

// From the finest on, down to `fewest` points along the longest side, of what of the block is
// between these points, as if nothing was cut. Empty where the tissue was no block before cuts, or
// has a weight, which is no load of a part: then all levels are open as a whole.
std::vector<LevelSource> levelSources(const Lattice& lattice, const ElasticModel& model,
                                      const GridBox& between, double modulus, int fewest);

// Lists in each of them what is cut.
void listCuts(const Lattice& lattice, const ElasticModel& model, const CellSet& cells,
              double modulus, std::vector<LevelSource>& sources);

}  // namespace robot_tissue
