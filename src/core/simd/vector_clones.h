// For functions whose loops the compiler turns into vector instructions: GCC compiles them once for
// each of these processors, and the program takes one when it starts (target_clones). Where the
// compiler or processor has no such thing, they are compiled once.
#pragma once

#include "robot_tissue/core/compat.h"

#if ROBOT_TISSUE_HAS_TARGET_CLONES
#define ROBOT_TISSUE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
// Likewise of functions that know how long the vectors are: DEFINE(kind, bytes) defines them for
// one kind of processor.
#define ROBOT_TISSUE_FOR_EACH_PROCESSOR(DEFINE)         \
  DEFINE(__attribute__((target("arch=x86-64-v4"))), 64) \
  DEFINE(__attribute__((target("arch=x86-64-v3"))), 32) \
  DEFINE(__attribute__((target("default"))), 16)
#else
#define ROBOT_TISSUE_CLONES
#define ROBOT_TISSUE_FOR_EACH_PROCESSOR(DEFINE) DEFINE(, 16)
#endif
// A function that such a one calls must be inlined into each of its clones, or it would be of the
// plain processor.
#define ROBOT_TISSUE_INLINE inline __attribute__((always_inline))
// Loops over few lanes: GCC would unroll them before it looks for vectors.
#define ROBOT_TISSUE_ROLLED _Pragma("GCC unroll 1")
