// Adaptive dynamic relaxation (Underwood 1983, "Dynamic relaxation", in: Computational methods for
// transient analysis; Papadrakakis 1981): explicit time steps without physical mass or time. Each
// node has the mass that puts it at the limit of stability, and the damping is critical for the
// frequency that the motion shows (Rayleigh's quotient), so that it dies out at the best rate.
#pragma once

#include "solvers/baselines/relaxation_method.h"

namespace robot_tissue {

class ExplicitMethod : public RelaxationMethod {
 public:
  ExplicitMethod(const Lattice& lattice, const ElasticModel& model,
                 const RelaxationOptions& options);

  void forget() override;

 private:
  void begin(int care) override;
  void iterate() override;
  int stride() const override { return 8; }
  double shrinkage() const override;

  void weigh();
  void findFastest();
  double takePower();
  void rollPatches(double keep, double push);

  double fastest_ = 8.0;  // greatest eigenvalue of stiffness over mass
  double slowest_ = 0.0;  // the motion's
  int steps_ = 0;         // since begin()
  std::vector<Motion::OfPatch> patch_steps_;
  std::vector<double> contact_stiffness_;  // per node, all contacts closed (N/m)
  std::vector<std::uint8_t> held_;         // what fastest_ was found for
  std::shared_ptr<const CellSet> cells_;
};

}  // namespace robot_tissue
