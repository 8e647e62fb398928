// The limit of a quantity as the spacing goes to zero, from its values at two or three spacings
// (Richardson 1911, "The approximate arithmetical solution by finite differences"; the order by the
// differences as in Roache 1998, "Verification of codes and calculations").
//
//   q(h) = q(0) + C h^p,   |q(h1) - q(h2)| / |q(h2) - q(h3)| = (h1^p - h2^p) / (h2^p - h3^p)
#pragma once

#include <Eigen/Core>
#include <vector>

namespace robot_tissue {

struct Sample {
  double spacing = 0.0;   // m
  Eigen::VectorXd value;  // of the same length at every spacing
};

// A lattice of trilinear cells is of second order at best; where the stress is singular, as at the
// edge of a bonded patch, of first and below. Outside of these the differences are not those of a
// power of the spacing, and the nearer of the two is taken.
constexpr double kLowestOrder = 0.5;
constexpr double kHighestOrder = 2.0;

struct Limit {
  Eigen::VectorXd value;
  double order = 1.0;  // that was used
  double observed =
      1.0;  // by the differences, -1 .. 4; as `order` where there are two samples only
};

// Two or three samples, the finest last, spacings falling. Of two the order is taken as 1.
Limit limitOf(const std::vector<Sample>& samples);

}  // namespace robot_tissue
