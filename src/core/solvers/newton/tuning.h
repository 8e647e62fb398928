// The numbers of method `newton` in one place: unit, where each comes from, and what turning it
// does. "stiffness" is a node's at rest, mean over all. Chosen: by judgment, and kept as the tests
// passed; no other value was measured against it.
#pragma once

namespace robot_tissue::tuning {

// The factor.
// Of the stiffness (1): added to the matrix's diagonal, which keeps pieces that nothing holds from
// drifting with rounding. More: they drift less, and one more step is needed to take it back.
// Chosen.
constexpr double kHold = 1e-7;
// Of the stiffness (1): the most that is added where the matrix is not positive definite with less.
// More: rougher shapes are solved, by shorter steps. Chosen.
constexpr double kFirmestHold = 1e-2;
// The next that is tried over the last (1). More: fewer factors, which hold back more than needed.
// Chosen.
constexpr double kFirmer = 100.0;

// The search along a step.
// Of the decrease that the slope promises (1): what a step must bring. More: shorter steps; 0:
// steps that bring nothing. Chosen.
constexpr double kShareOfExpected = 1e-4;
// Times that a step is halved before the solve is given up. Less: stiff shapes are given up sooner.
// Chosen.
constexpr int kHalvings = 30;

// Steps of a load step in contact beyond which it is a hard one (a sphere that is dragged takes 5 a
// solve). More: jams are followed for longer. Chosen.
constexpr int kUsualSteps = 30;

// What is lost in rounding.
// Of the stiffness times the spacing (1): a force that is balance, however small the loads.
constexpr double kRoundingForce = 1e-12;
// Of the stiffness times the spacing squared, a node (1): a change of the potential that says
// nothing; there the unbalanced force decides. Less: solves near the end find no step that helps.
constexpr double kRoundingEnergy = 1e-15;

}  // namespace robot_tissue::tuning
