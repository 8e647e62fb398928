// Sums over the rows of sparse matrices, of vectors of three numbers, in vector instructions: one
// takes a vector, with a fourth number that is not looked at.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "robot_tissue/core/types.h"
#include "simd/numbers.h"

namespace robot_tissue {

// Four numbers each: a vector, and 0.
Numbers<double> padded(const std::vector<Vec3>& vectors);

// The shares or blocks of a row are those from first[row] on, before first[row + 1]. `of`: padded.
// sums[row] = sum of weight * of[node].
void sumShares(const int* first, const NodeWeight* shares, int rows, const double* of, Vec3* sums);
// sums[row] = sum of block * of[column]; blocks by columns, nine numbers each, and what is behind
// the last one's can be read.
void sumBlocks(const int* first, const int* columns, const double* blocks, int rows,
               const double* of, Vec3* sums);

// Numbers that a symmetric matrix takes: xx, yy, zz, yz, xz, xy, and two that are 0.
constexpr int kPaddedSymmetric = 8;
// sums of node += own[node] * weight * matrix, of these shares. The matrix is symmetric.
void addShared(const Eigen::Matrix3d& matrix, const double* own, const NodeWeight* begin,
               const NodeWeight* end, double* sums);

}  // namespace robot_tissue
