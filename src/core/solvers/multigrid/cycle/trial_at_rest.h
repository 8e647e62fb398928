// The least factor of ErrorEstimator that a lattice and its cycles have, at least 1: measured where
// the answer is known, on a shape thrown off rest by little, that goes back to it.
#pragma once

#include "solvers/multigrid/cycle/composite_shape.h"

namespace robot_tissue {

// The shape, its right-hand side and holds are lost.
template <typename Real>
double leastErrorFactor(CompositeShape<Real>& shape, const Lattice& lattice,
                        const ElasticModel& model, const LatticeState& state, int smoother_steps);

}  // namespace robot_tissue
