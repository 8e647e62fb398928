#include "solvers/multigrid/hierarchy/grid_hierarchy.h"

#include <cmath>
#include <utility>

#include "simd/field_kernel.h"

namespace robot_tissue {

template <typename Real>
GridHierarchy<Real>::GridHierarchy(const Lattice& lattice, const ElasticModel& model,
                                   const CellSet& cells, Workers* workers, KnownLevels known)
    : grid_(lattice, model, cells, workers, std::move(known)),
      displacements_(grid_),
      constraints_(grid_),
      restriction_(grid_, constraints_),
      uncovered_(grid_, restriction_),
      correction_(grid_, restriction_, uncovered_) {}

template <typename Real>
bool GridHierarchy<Real>::open(const GridBox& box, int layers,
                               const std::vector<Vec3>& displacement) {
  if (!grid_.open(box, layers)) return false;
  constraints_.reset();
  restriction_.reset();
  correction_.reset();
  displacements_.take(displacement, std::vector<std::uint8_t>(displacement.size(), 0));
  displacements_.takeCoarse(displacement);
  return true;
}

template <typename Real>
bool GridHierarchy<Real>::isFinite() const {
  double sum = 0.0;
  for (std::size_t index = 0; index < grid_.levelCount(); ++index) {
    const GridLevel<Real>& level = grid_.level(index);
    for (const auto& values : level.displacement) {
      sum += dotOf(values.data(), values.data(), level.count());
    }
  }
  for (const auto& values : finest().force) {
    sum += dotOf(values.data(), values.data(), finest().count());
  }
  for (const GroupVector& vector : finest().constrained.motion) sum += vector.squaredNorm();
  return std::isfinite(sum);
}

template class GridHierarchy<float>;
template class GridHierarchy<double>;

}  // namespace robot_tissue
