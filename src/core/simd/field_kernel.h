// Loops over fields (core/solvers/multigrid/level/cell_operator.h) in vector instructions. Sums are
// taken in one order whatever the processor's vectors are, so that they have the same bits each
// time.
#pragma once

namespace robot_tissue {

// whole = below + lower + load; force = whole where `free` is 1, 0 where it is 0.
void sumForces(const float* below, const float* lower, const float* load, const float* free,
               float* whole, float* force, int count);
void sumForces(const double* below, const double* lower, const double* load, const double* free,
               double* whole, double* force, int count);

// As it leaves the force where `whole` is known and `free` alone has changed.
void takeWhereFree(const float* whole, const float* free, float* force, int count);
void takeWhereFree(const double* whole, const double* free, double* force, int count);

// Springs that hold the nodes at zero: whole -= stiffness * displacement, force = free * whole.
void addHolds(const float* stiffness, const float* displacement, const float* free, float* whole,
              float* force, int count);
void addHolds(const double* stiffness, const double* displacement, const double* free,
              double* whole, double* force, int count);

// Where `free` is 1: load += wanted - force, force = wanted: the right-hand side of the full
// approximation scheme, for which a coarse level has the fine one's force to begin with.
void fasRightHandSide(const float* wanted, const float* free, float* load, float* force, int count);
void fasRightHandSide(const double* wanted, const double* free, double* load, double* force,
                      int count);

// Where `free` is 1: load and force grow by wanted - known, where the coarse level's own force is
// known in the place of its whole one.
void fasRightHandSideBeside(const float* wanted, const float* known, const float* free, float* load,
                            float* force, int count);
void fasRightHandSideBeside(const double* wanted, const double* known, const double* free,
                            double* load, double* force, int count);

// to += share * motion where `free` is 1.
void addWhereFree(const float* motion, const float* free, float share, float* to, int count);
void addWhereFree(const double* motion, const double* free, double share, double* to, int count);

// to += share * other.
void addShare(const float* other, float share, float* to, int count);
void addShare(const double* other, double share, double* to, int count);

// difference = share * (a - b).
void subtract(const float* a, const float* b, float share, float* difference, int count);
void subtract(const double* a, const double* b, double share, double* difference, int count);

void meanOf(const float* a, const float* b, float* mean, int count);
void meanOf(const double* a, const double* b, double* mean, int count);

// Linear interpolation of a row of 1 + (count - 1) / 2 coarse nodes, or one more where `count` is
// even, to `count` fine ones: every second is a coarse one, those between are means.
void prolongRow(const float* coarse, float* fine, int count);
void prolongRow(const double* coarse, double* fine, int count);

// coarse_i = fine_2i + (fine_2i-1 + fine_2i+1) / 2. `fine` begins one before, and ends one after.
void restrictRow(const float* fine, float* coarse, int count);
void restrictRow(const double* fine, double* coarse, int count);

// coarse_i = fine_2i / 2.
void injectRow(const float* fine, float* coarse, int count);
void injectRow(const double* fine, double* coarse, int count);

// Sum of the products.
double dotOf(const float* a, const float* b, int count);
double dotOf(const double* a, const double* b, int count);

// Sum of the squares of the differences.
double squaredDistance(const float* a, const float* b, int count);
double squaredDistance(const double* a, const double* b, int count);

double sumOf(const float* values, int count);
double sumOf(const double* values, int count);

// Greatest absolute value.
double greatestOf(const float* values, int count);
double greatestOf(const double* values, int count);

}  // namespace robot_tissue
