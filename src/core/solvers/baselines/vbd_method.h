// Vertex Block Descent (Chen, Liu, Yang, Yuksel 2024, "Vertex Block Descent", ACM Transactions on
// Graphics 43(4)), without inertia: Gauss-Seidel sweeps over the nodes, each moved by one Newton
// step in its exact 3 x 3 block, color after color (by the parity of the grid index; nodes of one
// color share no cell).
//
// Sweeps are accelerated by Chebyshev's semi-iteration, as in the paper, or (own choice, default)
// by over-relaxation: here a sweep's eigenvalues are complex, which Chebyshev's method takes ill.
#pragma once

#include "solvers/baselines/relaxation_method.h"

namespace robot_tissue {

struct VbdOptions : RelaxationOptions {
  enum class Acceleration { kNone, kChebyshev, kOverRelaxed };
  Acceleration acceleration = Acceleration::kOverRelaxed;
  double node_step = 0.5;  // of a node in one visit, in spacings
};

class VbdMethod : public RelaxationMethod {
 public:
  VbdMethod(const Lattice& lattice, const ElasticModel& model, const VbdOptions& options);

 private:
  void begin(int care) override;
  void iterate() override;
  int stride() const override { return 2; }
  int usualIterations() const override;
  double shrinkage() const override;

  using Acceleration = VbdOptions::Acceleration;

  void sweep();
  void relaxNode(int node);
  void extrapolate();

  VbdOptions vbd_;
  double relaxation_ = 1.0;  // of a node's step
  double radius_ = 0.0;      // a sweep's spectral radius as Chebyshev's method has it
  double weight_ = 1.0;      // its omega
  int sweeps_ = 0;           // since begin()
  std::vector<Motion::OfPatch> patch_moves_;  // of the last iteration
  std::vector<Motion::OfPatch> patch_steps_;  // of this one's sweep
};

}  // namespace robot_tissue
