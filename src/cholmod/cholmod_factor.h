// Sparse factorization by CHOLMOD. Its supernodal part is under the GPL: a library of its own, for
// programs only.
#pragma once

#include <memory>

#include "solvers/newton/sparse_factor.h"

namespace robot_tissue {

std::unique_ptr<SparseFactor> makeCholmodFactor();

}  // namespace robot_tissue
