#include "tissue/front_ties.h"

#include <utility>

#include "config/material.h"
#include "cutting/cut_front.h"
#include "loads/rim_law.h"

namespace robot_tissue {

// A plate's rim is one to one half of the tissue; a front is between two of them, so half as stiff.
std::vector<ContactSpring> tiesOfFronts(const Lattice& lattice, const LatticeState& state,
                                        const TissueModel& model) {
  constexpr double kOfBothHalves = 0.5, kOfSpacing = 0.5;  // a tie's part of the front (1)
  std::vector<ContactSpring> ties;
  for (FrontTie& tie : frontTies(lattice, state)) {
    const Moduli moduli = model.moduliIn(lattice.cells()[at(tie.place)]);
    const double stiffness = rimStiffness(slidingRim(poissonRatio(moduli)), tie.depth);
    if (!(stiffness * moduli.shear > 0.0)) continue;
    ContactSpring spring;
    spring.is_thread = true;
    spring.carriers = std::move(tie.carriers);
    spring.stiffness = kOfBothHalves * kOfSpacing * stiffness * moduli.shear * lattice.spacing();
    ties.push_back(std::move(spring));
  }
  return ties;
}

}  // namespace robot_tissue
