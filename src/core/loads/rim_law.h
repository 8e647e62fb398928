// The springs that join the nodes at the rim of a bonded flat patch to it, in model `elastic` (own;
// doc/model.md, "The rim").
//
// Joined rigidly, the lattice acts as if the patch were wider by a shift on every side. A spring of
// stiffness k to the rim nodes, whose own compliance is c, takes 1 / (1 + k c) spacings of it back.
// The patch's edge then seems to be where it is, `depth` spacings beyond the node, for
// shift - 1 / (1 + k c) = depth.
#pragma once

namespace robot_tissue {

// Shear modulus times spacing (1): a rim spring is no stiffer. More: edges near the patch's hard
// nodes are held more firmly, and iterations take longer. Chosen.
constexpr double kHardestRim = 1000.0;

struct RimMode {
  double shift = 0.0;      // spacings
  double stiffness = 0.0;  // of a node right at the edge, in shear modulus times spacing
};

// By the patch's motion: in its plane along or across the rim, or normal to the surface.
struct RimLaw {
  RimMode along;
  RimMode across;
  RimMode normal;
};

// Linear between the ratios that were measured (doc/data/rim_strip.csv), as at the nearest one
// outside 0.25 to 0.49.
RimLaw rimLaw(double poisson_ratio);

// Of a plate that slides on the tissue without friction, for motion normal to the surface: by
// symmetry what the front of a cut is to each of its sides.
RimMode slidingRim(double poisson_ratio);

// Stiffness of the spring between the patch and a node at a depth inside its edge (spacings,
// negative outside), in shear modulus times spacing; infinity = rigid, 0 = free.
double rimStiffness(const RimMode& mode, double depth);

}  // namespace robot_tissue
