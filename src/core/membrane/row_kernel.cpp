#include "membrane/row_kernel.h"

#include <cstring>

#include "simd/vector_clones.h"

namespace robot_tissue {
namespace {

typedef double Four __attribute__((vector_size(32)));

ROBOT_TISSUE_INLINE void loadFour(const double* from, Four& x) { std::memcpy(&x, from, sizeof x); }

}  // namespace

Numbers<double> padded(const std::vector<Vec3>& vectors) {
  Numbers<double> numbers(4 * vectors.size());
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::memcpy(numbers.data() + 4 * i, vectors[i].data(), sizeof(Vec3));
  }
  return numbers;
}

// Two sums at a time, as an addition waits for the one before it.
ROBOT_TISSUE_CLONES
void sumShares(const int* first, const NodeWeight* shares, int rows, const double* of, Vec3* sums) {
  for (int row = 0; row < rows; ++row) {
    Four one{}, other{}, x, y;
    const int end = first[row + 1];
    int i = first[row];
    for (; i + 1 < end; i += 2) {
      loadFour(of + 4 * shares[i].node, x);
      loadFour(of + 4 * shares[i + 1].node, y);
      one += shares[i].weight * x;
      other += shares[i + 1].weight * y;
    }
    if (i < end) {
      loadFour(of + 4 * shares[i].node, x);
      one += shares[i].weight * x;
    }
    one += other;
    std::memcpy(sums[row].data(), &one, sizeof(Vec3));
  }
}

ROBOT_TISSUE_CLONES
void sumBlocks(const int* first, const int* columns, const double* blocks, int rows,
               const double* of, Vec3* sums) {
  for (int row = 0; row < rows; ++row) {
    Four by_x{}, by_y{}, by_z{}, column;
    for (int i = first[row]; i < first[row + 1]; ++i) {
      const double* block = blocks + 9 * i;
      const double* vector = of + 4 * columns[i];
      loadFour(block, column);
      by_x += vector[0] * column;
      loadFour(block + 3, column);
      by_y += vector[1] * column;
      loadFour(block + 6, column);
      by_z += vector[2] * column;
    }
    by_x += by_y + by_z;
    std::memcpy(sums[row].data(), &by_x, sizeof(Vec3));
  }
}

ROBOT_TISSUE_CLONES
void addShared(const Eigen::Matrix3d& matrix, const double* own, const NodeWeight* begin,
               const NodeWeight* end, double* sums) {
  typedef double Eight __attribute__((vector_size(8 * kPaddedSymmetric)));
  const double* number = matrix.data();
  const Eight numbers = {number[0], number[4], number[8], number[5],
                         number[2], number[1], 0.0,       0.0};
  for (const NodeWeight* share = begin; share != end; ++share) {
    const double factor = own[share->node] * share->weight;
    if (factor == 0.0) continue;
    double* to = sums + kPaddedSymmetric * share->node;
    Eight sum;
    std::memcpy(&sum, to, sizeof sum);
    sum += factor * numbers;
    std::memcpy(to, &sum, sizeof sum);
  }
}

}  // namespace robot_tissue
