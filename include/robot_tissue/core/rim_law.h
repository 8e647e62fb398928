// The springs that join a bonded patch's rim to the lattice of model `elastic` so that it answers
// as the continuum does (own; doc/model.md, "The rim").
#pragma once

namespace robot_tissue {

// Motion of the patch along its rim, across it, or normal to the surface.
struct RimMode {
  double shift = 0.0;      // by which a patch without the springs acts too wide, in spacings
  double stiffness = 0.0;  // of the spring to a node right at the edge, in shear modulus x spacing
};

struct RimLaw {
  RimMode along;
  RimMode across;
  RimMode normal;
};

// Poisson's ratio 0.25 .. 0.49.
RimLaw rimLaw(double poisson_ratio);

// Stiffness of the spring that joins a node at this depth inside the edge (in spacings, negative
// outside) to the patch, in shear modulus x spacing; infinite = rigid, 0 = free.
double rimStiffness(const RimMode& mode, double depth);

}  // namespace robot_tissue
