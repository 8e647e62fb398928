// For functions whose loops the compiler turns into vector instructions: made once for each kind of
// processor that matters, chosen when the program starts. Elsewhere made once.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && __GNUC__ >= 12
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
// What such a function calls has to become part of it.
#define ROBOT_TISSUE_INLINE inline __attribute__((always_inline))
// Short loops over lanes would be unrolled before they can become vectors.
#define ROBOT_TISSUE_ROLLED _Pragma("GCC unroll 1")
