// What a time step adds to the energy that a solve makes least (doc/time.md), with E the energy of
// the cells and m_i the mass of a node:
//
//   elastic_scale E(u) + per_mass / 2 sum m_i |u_i|^2 - sum force_i . u_i
//
// or, with V what damps strain (material/viscosity.h) for the elastic moduli,
//
//   E(u) + (elastic_scale - 1) V(u; rate_from) + ...
#pragma once

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct InertialTerm {
  double elastic_scale = 1.0;     // so much stiffer are the cells, with what damps
  double per_mass = 0.0;          // stiffness that a kilogram has against motion (1/s^2)
  std::vector<Vec3> force;        // per node, ghosts last (N)
  std::vector<Vec3> free_motion;  // displacements to which nodes would go without a force (m)
  // Least length that a solve's error is relative to, otherwise the way from the free motion; as a
  // vector of all nodes (m).
  double least_way = 0.0;
  // Damping of the strain that the step adds, by methods that take it so: of what elastic_scale is
  // above 1, which then is not of the cells' energy, but of material/viscosity.h, from these
  // displacements on. Else empty: it is of the energy, and `force` has its part.
  std::vector<Vec3> rate_from;  // m
  bool dampsStrain() const { return !rate_from.empty(); }
  double viscosity() const { return elastic_scale - 1.0; }
  bool beside_contacts = false;  // a step of first order (doc/time.md)
  // What the terms above are made of, for methods that go through the step in shorter ones.
  double duration = 0.0;       // s
  double damping_time = 0.0;   // s: stress is elastic and so much of its rate
  std::vector<Vec3> velocity;  // at the step's start (m/s)
};

}  // namespace robot_tissue
