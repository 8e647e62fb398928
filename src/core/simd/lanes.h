// How many numbers the kernels' loops take at a time: a vector of the longest kind (AVX-512), in
// single precision.
#pragma once

namespace robot_tissue {

constexpr int kLanes = 16;

}  // namespace robot_tissue
