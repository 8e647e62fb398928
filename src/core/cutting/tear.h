// Tearing (own): springs that are stretched too far sever, the weakest first.
#pragma once

#include <vector>

#include "cutting/blade_surface.h"
#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/lattice_state.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Strain (1) of a spring of this material beyond which it severs; 0: it never does. With a
// tear_length L: (tear_stretch - 1) sqrt(L / h) at spacing h. Ahead of a crack the strain goes with
// 1 / sqrt(distance) (Irwin 1957), and the first cell ahead of it sees it half a spacing off: so
// lattices of any spacing tear at the same stress intensity, and under the same force.
double tearStrain(const Material& material, double spacing);

// Of each spring, by the material at its middle; empty when none of the tissue's tears.
std::vector<double> tearStrains(const Lattice& lattice, const TissueConfig& config);

// The springs that go next. A spring bears its strain or, where it is at the front of a crack, the
// mean of it and of the strain at the front, where the last spring went. First goes the one that is
// farthest over what it may bear, of equal ones that of the
// lowest number, and those beside it in the same layer of springs that are nearly as far over, and
// so on from these. So a crack goes on in its own plane, and where all springs are stretched alike
// one section goes. Empty when none is over.
std::vector<int> weakestSprings(const Lattice& lattice, const LatticeState& state,
                                const std::vector<double>& tear_strains);
// The same where they part: those that would leave crumbs (crumbs.h) hold, whatever they bear.
std::vector<Crossing> tearingNext(const Lattice& lattice, const LatticeState& state,
                                  const std::vector<double>& tear_strains);

}  // namespace robot_tissue
