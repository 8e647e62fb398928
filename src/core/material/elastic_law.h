// What is chosen in the law of model `elastic` (doc/model.md), for all that computes it: the cell,
// the lean way, the kernels.
#pragma once

namespace robot_tissue {
namespace elastic_law {

// J below which a(J) is its quadratic Taylor form: greater, a flat cell is softer.
constexpr double kFlattest = 0.1;
// Corner determinant where the barrier begins: greater, it is felt in milder presses.
constexpr double kSqueezed = 0.3;
// Its height, in shear moduli, at a flat corner: greater, corners turn inside out later.
constexpr double kBarrier = 10.0 / 3.0;

}  // namespace elastic_law
}  // namespace robot_tissue
