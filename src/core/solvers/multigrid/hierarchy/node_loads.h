// What acts on the nodes of levels that are open as a whole, besides cells and what holds them:
// gravity, and inertia in a time step (InertialTerm).
//
// In each level's units; h and E0 are those of the finest one.
#pragma once

#include <vector>

#include "material/elastic_model.h"
#include "solvers/multigrid/hierarchy/grid_transfer.h"
#include "solvers/multigrid/level/grid_level.h"

namespace robot_tissue {

// The levels, from the finest on, the transfers between them, and the entry of each of the tissue's
// nodes in the finest one's fields.
template <typename Real>
struct WholeLevels {
  std::vector<GridLevel<Real>>& levels;
  const std::vector<GridTransfer<Real>>& transfers;
  const std::vector<int>& entries;
  double spacing = 1.0;  // h (m)
  double modulus = 1.0;  // E0 (Pa)
};

template <typename Real>
class NodeLoads {
 public:
  // No loads before this.
  void find(const ElasticModel& model, const CellSet& cells, const WholeLevels<Real>& on);
  // Solves are of a time step from now on; null: they are not. True: they were, or are.
  bool takeTimeStep(const InertialTerm* inertia, const WholeLevels<Real>& on);

  // On nodes of the finest level (E0 h^2), as they are now; empty: none.
  const Field<Real>& onFinest() const { return is_in_step_ ? load_of_step_ : weight_; }
  // Times which E0 counts now.
  double scale() const { return scale_; }

 private:
  void findWeight(const ElasticModel& model, const CellSet& cells, const WholeLevels<Real>& on);
  void findMasses(const ElasticModel& model, const CellSet& cells, const WholeLevels<Real>& on);
  void findRateFrom(const InertialTerm& inertia, const WholeLevels<Real>& on);
  void findLoadOfStep(const InertialTerm& inertia, const WholeLevels<Real>& on);

  Field<Real> weight_;                       // gravity
  std::vector<std::vector<double>> masses_;  // of the nodes of each level (kg); empty: not needed
  double scale_ = 1.0;
  bool is_in_step_ = false;
  Field<Real> load_of_step_;
  bool damps_ = false;                  // the strain that the step adds
  std::vector<Field<Real>> rate_from_;  // per level, displacements that it is added to
};

extern template class NodeLoads<float>;
extern template class NodeLoads<double>;

}  // namespace robot_tissue
