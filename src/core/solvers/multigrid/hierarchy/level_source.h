// What the lattices of several spacings of a block that is all there are made of (own): the moduli
// of each lattice's cells, and where a coarser one tells less than they do.
#pragma once

#include <array>
#include <vector>

#include "material/elastic_model.h"
#include "robot_tissue/core/lattice.h"
#include "solvers/multigrid/level/lattice_coarsening.h"

namespace robot_tissue {

struct LevelSource {
  std::array<int, 3> size{};  // grid points
  // Per cell, x fastest (E0); one value where all are alike.
  std::vector<double> shear;
  std::vector<double> bulk;
  // Points beside which the eight cells of a coarse one differ, or nodes are held that no coarse
  // node stands for. Empty: low above high.
  GridBox rough;
  double greatest_stiffness = 0.0;  // of a lattice of equal cells, 0 = not known

  // Whether the block is so thick, in its cells and beside its length, that these bend as finer
  // ones do, and cycles see it.
  bool isThick() const;
  GridBox whole() const { return wholeOf(size); }
  // Of the cells between these points, placed from its low corner.
  std::vector<LevelCell> cellsIn(const GridBox& points, const LevelGrid& grid) const;
  bool isUniform() const { return shear.size() == 1; }
  std::size_t cellAt(int i, int j, int k) const {
    return shear.size() == 1 ? 0 : at(i + (size[0] - 1) * (j + (size[1] - 1) * k));
  }
};

// From the finest on, up to `fewest` points along the longest side. Empty where the tissue is no
// block, is cut, or has a weight: there a coarse lattice alone does not tell enough.
std::vector<LevelSource> levelSources(const Lattice& lattice, const ElasticModel& model,
                                      const CellSet& cells, double modulus, int fewest);

}  // namespace robot_tissue
