// For functions whose loops the compiler turns into vector instructions: made once for each kind of
// processor that matters, chosen when the program starts. Elsewhere made once.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define ROBOT_TISSUE_CLONES \
  __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define ROBOT_TISSUE_CLONES
#endif
// What such a function calls has to become part of it.
#define ROBOT_TISSUE_INLINE inline __attribute__((always_inline))
