// Model `elastic` (core/material/elastic_cell.h) for kLanes nodes or cells at a time, in single
// precision. As core/material/cell_modes.h, in units in which no factor is left:
//
//   displacements   4h
//   moduli          a modulus M that all are divided by
//   forces          M h^2 / 4
//   stiffness       M h / 16
#pragma once

#include "solvers/baselines/kernels/colored_layout.h"

namespace robot_tissue {

// What a lattice of slots is made of; one array an axis.
struct SoaArrays {
  float* moved[3];     // displacement
  const float* shear;  // of the cell whose lowest corner is at the slot; 0 = none
  const float* bulk;
  const float* stiffening;  // likewise, of the law `fung`; null: neo-Hookean
  const float* load[3];     // constant force
  const float* free[3];     // 1 where the component moves, 0 where it is held
};

// Symmetric, of springs from a node to where it is held: xx, yy, zz, xy, xz, yz.
struct SoaSprings {
  float of[6][kLanes] = {};
};

// Moves the nodes of a block, all of one color, to where the forces balance: one Newton step in
// each node's 3 x 3 block, of at most `most`, times `relaxation`. `springs` may be null;
// `squeezed`: the barrier of a cell of theirs may rise.
void relaxBlock(const SoaArrays& lanes, const std::array<ColoredLayout::Around, kCorners>& around,
                int block, const SoaSprings* springs, bool squeezed, float relaxation, float most);

// Writes one over a bound of each node's stiffness in its block (greatest sum of a row).
void softnessOfBlock(const SoaArrays& lanes,
                     const std::array<ColoredLayout::Around, kCorners>& around, int block,
                     const SoaSprings* springs, bool squeezed, float* softness);

// Adds the forces of a block of cells, all of one color, on their corners.
void addForcesOfBlock(const SoaArrays& lanes, const ColoredLayout::Around& above, int block,
                      bool squeezed, float* const force[3]);

// One step of XPBD for a block of cells, all of one color: each moves its corners by two
// constraints of compliance 1, sqrt(2 x energy against a change of shape) and sqrt(K)(J - 1).
// `mobility`: of a node's components, square of the time step over mass (1 / stiffness). `damping`
// may be null.
struct SoaDamping {
  float share;             // damping time over the time step
  const float* before[3];  // displacement at the step's start
};
void projectBlock(const SoaArrays& lanes, const float* const mobility[3],
                  const ColoredLayout::Around& above, int block, bool squeezed,
                  const SoaDamping* damping);

// Adds the forces of springs on the nodes of a block.
void addSpringForces(const SoaArrays& lanes, const SoaSprings& springs, int block,
                     float* const force[3]);

// Writes what the edges span at the tightest corner of each cell, over its rest volume.
void squeezeOfBlock(const SoaArrays& lanes, const ColoredLayout::Around& above, int block,
                    float* tightest);

// Of the products' entries, over whole arrays; the count is one of whole blocks.
double squaredProduct(const float* a, const float* b, const float* c, int count);

// Rayleigh's quotient of a motion is work over mass: motion . change of force, and motion^2 /
// softness.
struct QuotientSums {
  double work = 0.0;
  double mass = 0.0;
};
// Adds those of the motion along one axis from one shape to another, and makes that one the first.
void addQuotient(int count, const float* moved, const float* force, const float* softness,
                 const float* free, float* from, float* from_force, QuotientSums& sums);

// A step of the heavy ball along one axis: velocity = keep velocity + push softness force free, cut
// at `most`, added to moved. Adds to the sums, for the velocity before and what it did to the force
// (last - force, then last becomes force).
void roll(float keep, float push, float most, int count, const float* force, const float* softness,
          const float* free, float* last, float* velocity, float* moved, QuotientSums& sums);

// moved += keep free (moved - before); before becomes what moved was.
void coast(float keep, int count, const float* free, float* before, float* moved);

// moved = before + share (moved - before); then before becomes last and last becomes moved.
void extrapolate(float share, int count, float* moved, float* last, float* before);

}  // namespace robot_tissue
