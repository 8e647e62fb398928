// Viscosity of model `elastic` in a time step (doc/time.md): stress that the rate of strain makes,
// isotropic with damping_time times the shear modulus and the bulk modulus.
//
// Over the step from displacements u_0, with F_0 the deformation gradient there, strain grows by
// the symmetric part D of (F - F_0) F_0^-1, and what is dissipated, V [mu |D|^2 + lambda / 2 tr
// D^2] times the step's factor, is never negative: where the tissue would buckle, too. (The rate of
// the whole elastic force would drive what buckles.) D is linear in the way of the step: a turn by
// x counts as a contraction by x^2 / 2, so that steps are to turn by little
// (TimeIntegrator::turnOf). Bending and twisting of a cell have the viscosity that they have at
// rest.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>

namespace robot_tissue::viscosity {

// J below which the inverse of F is that of a cell of this volume: greater, flat cells are damped
// less.
constexpr double kFlattest = 0.1;

// Of the deformation gradient.
inline Eigen::Matrix3d inverseOf(const Eigen::Matrix3d& strain) {
  Eigen::Matrix3d cofactors;
  cofactors.col(0) = strain.col(1).cross(strain.col(2));
  cofactors.col(1) = strain.col(2).cross(strain.col(0));
  cofactors.col(2) = strain.col(0).cross(strain.col(1));
  const double volume = strain.col(0).dot(cofactors.col(0));
  return cofactors.transpose() / std::max(volume, kFlattest);
}

}  // namespace robot_tissue::viscosity
