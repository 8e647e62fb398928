// A part of each program that takes robot_tissue_fast_factor.
#include "cholmod_factor.h"

namespace robot_tissue {
namespace {

const bool cholmod_is_used = [] {
  setSparseFactorMaker(&makeCholmodFactor);
  return true;
}();

}  // namespace
}  // namespace robot_tissue
