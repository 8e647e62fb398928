// Extended position based dynamics (Macklin, Mueller, Chentanez 2016, "XPBD: position-based
// simulation of compliant constrained dynamics") in small steps of one iteration each (Macklin et
// al. 2019, "Small steps in physics simulation"), without physical mass or time.
//
// A cell is two constraints (after Macklin and Mueller 2021, "A constraint-based formulation of
// stable neo-Hookean materials"), each the root of twice a part of its energy, with compliance 1:
//
//   sqrt(2 (h^3 (a(J) I1 - 3 mu) / 2 + barrier)),   sqrt(h^3 K) (J - 1)
//
// So the energy is that of the model. What the steps go to is its equilibrium only as the step goes
// to zero: it is taken ever shorter, and the last change tells the distance (own).
#pragma once

#include "solvers/baselines/relaxation_method.h"

namespace robot_tissue {

class XpbdMethod : public RelaxationMethod {
 public:
  XpbdMethod(const Lattice& lattice, const ElasticModel& model, const RelaxationOptions& options);

 private:
  void begin(int care) override;
  void iterate() override;
  bool settles(double& to_go) override;
  bool balances() const override { return false; }
  int stride() const override { return 8; }
  double shrinkage() const override;

  void takeStep(double stretch);
  void coast();
  void pushPatches();
  void projectOddCells();
  void projectRims();
  void projectContacts();
  Vec3 mobilityOf(int node) const;
  void push(int node, const Vec3& force, double share);

  double stretch_ = 1.0;      // square of the time step, in node stiffnesses over masses
  double keep_ = 0.0;         // of the velocity
  int sweeps_ = 0;            // since the step was shortened
  bool offered_ = false;      // the shape, since then
  int refinements_ = 0;       // of the step, since begin()
  std::vector<Vec3> weight_;  // per node, gravity (N)
};

}  // namespace robot_tissue
