// Which of SoaField's further arrays holds what. RelaxationMethod uses its own beside those of the
// method that is built on it, so these begin at kOfMethod.
#pragma once

namespace robot_tissue {

enum SpareArray : int {
  kMark,         // displacements when wayFromMark was last asked
  kBest,         // displacements of the best shape so far
  kLooked,       // displacements of the last look at the waves that are left
  kLookedForce,  // forces on the nodes then
  kOfMethod,
  kSpareArrays = kOfMethod + 4
};

}  // namespace robot_tissue
