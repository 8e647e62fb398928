// The balance of a loaded shape in its unknowns: potential, unbalanced forces, second derivative
// (own).
//
// potential = energy of the tissue + of the rims' springs and those in contact - work of the
// patches' forces
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <vector>

#include "loads/constrained_state.h"
#include "material/energy_model.h"
#include "solvers/newton/dof_map.h"

namespace robot_tissue {

struct Balance {
  double potential = 0.0;      // J
  Eigen::VectorXd unbalanced;  // minus the potential's gradient, per unknown (N)
  double holding = 0.0;        // L2 of the forces that hold the tissue (N)
};

double potentialOf(const EnergyModel& model, const ConstrainedState& shape);

Balance balanceOf(const EnergyModel& model, const DofMap& unknowns, const ConstrainedState& shape);

// The potential's second derivative, lower triangle. `convex`: of each cell without its negative
// curvatures, and of patches that turn without what their forces add. `moved`: motion of the held
// components (m); `carried`: the force it puts on the unknowns (N).
struct TangentStiffness {
  Eigen::SparseMatrix<double> matrix;
  Eigen::VectorXd carried;
};
TangentStiffness tangentStiffnessOf(const EnergyModel& model, const DofMap& unknowns,
                                    const ConstrainedState& shape, const std::vector<Vec3>& moved,
                                    bool convex);

}  // namespace robot_tissue
