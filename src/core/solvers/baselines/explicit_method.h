// Adaptive dynamic relaxation (Underwood 1983, "Dynamic relaxation", in: Computational methods for
// transient analysis; Papadrakakis 1981): explicit time steps without physical mass or time. Each
// node has the mass that puts it at the limit of stability, and the damping is critical for the
// frequency that the motion shows (Rayleigh's quotient), so that it dies out at the best rate.
//
// A time step is gone through with physical masses by central differences in Verlet's form, in as
// many steps as stability asks for: with w the greatest frequency, of a step h
//
//   h <= 2 / w ((1 + s^2)^(1/2) - s),   s = damping_time w / 2 (Belytschko, Liu and Moran 2000)
#pragma once

#include "solvers/baselines/contact_passage.h"
#include "solvers/baselines/relaxation_method.h"

namespace robot_tissue {

class ExplicitMethod : public RelaxationMethod {
 public:
  ExplicitMethod(const Lattice& lattice, const ElasticModel& model,
                 const RelaxationOptions& options);

  void forget() override;

  const std::vector<Vec3>* velocities() const override {
    return velocity_.empty() ? nullptr : &velocity_;
  }

 private:
  void begin(int care) override;
  SolveStatus goThrough(int& steps) override;
  void iterate() override;
  int stride() const override { return 8; }
  int usualIterations() const override;
  double shrinkage() const override;

  // One time step on its way.
  struct Passage;
  SolveStatus pass(Passage& passage, int steps);
  void accelerate(Passage& passage, double step);
  void findForcesOn(Passage& passage);
  void pushTouches(Passage& passage, const ContactPassage::SmallStep& step);
  double longestStableStep(const std::vector<double>& masses, double damping_time) const;

  void measureContacts();
  void weigh();
  void findFastest();
  double takePower();
  void rollPatches(double keep, double push);

  double measured_ = 8.0;  // greatest eigenvalue of stiffness over mass
  double fastest_ = 8.0;   // the one that steps are made for
  double slowest_ = 0.0;   // the motion's
  int steps_ = 0;          // since begin()
  std::vector<Motion::OfPatch> patch_steps_;
  std::vector<double> contact_stiffness_;  // per node, all contacts closed (N/m)
  std::vector<Vec3> velocity_;             // at the end of the last time step (m/s)
  std::vector<std::uint8_t> held_;         // what measured_ was found for
  std::shared_ptr<const CellSet> cells_;
};

}  // namespace robot_tissue
