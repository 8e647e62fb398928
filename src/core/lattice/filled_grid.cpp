#include "robot_tissue/core/filled_grid.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include "geometry/mesh_slicing.h"

namespace robot_tissue {
namespace {

// Of a cell (1): one that the mesh touches counts as filled by as much at least. More: thin ends
// are too stiff and heavy; less: nodes there are so soft that solves take longer. Chosen.
constexpr double kLeastShare = 1e-3;

Grid gridOf(const Box& shape, double spacing) {
  const Vec3 extent = shape.max() - shape.min();
  if (!spacingFits(extent, spacing)) {
    std::ostringstream line;
    line << "tissue.spacing: " << spacing << ": the shape is " << extent.x() << " x " << extent.y()
         << " x " << extent.z() << " m; allowed: a whole number of spacings along each axis";
    throw InputError(line.str());
  }
  return Grid(shape, spacing);
}

}  // namespace

FilledGrid filledGrid(const TissueConfig& config) {
  if (config.mesh == nullptr) {
    const Grid grid = gridOf(config.shape, config.spacing);
    return {grid, std::vector<double>(at(grid.cellCount()), 1.0), {}};
  }
  const Grid whole = gridAround(*config.mesh, config.spacing);
  MeshCells cells = sliced(*config.mesh, whole);
  std::vector<std::pair<int, CellFill>> partial;
  auto known = cells.partial.begin();
  for (std::size_t cell = 0; cell < cells.filled.size(); ++cell) {
    FillIntegrals fill = integralsOf(CellFill()).scaledBy(cells.filled[cell]);
    if (known != cells.partial.end() && known->first == static_cast<int>(cell)) {
      fill = (known++)->second;
    }
    double& filled = cells.filled[cell];
    if (cells.occupied[cell] == 0) filled = 0.0;
    if (cells.occupied[cell] == 0 || filled == 1.0) continue;
    if (filled < kLeastShare) fill += integralsOf(CellFill()).scaledBy(kLeastShare - filled);
    filled = fill.volume = std::max(filled, kLeastShare);
    partial.emplace_back(static_cast<int>(cell), fillOf(fill));
  }
  return {Grid(whole, std::move(cells.occupied)), std::move(cells.filled), std::move(partial)};
}

}  // namespace robot_tissue
