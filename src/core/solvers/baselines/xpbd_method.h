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
//
// A time step is gone through in small steps of one iteration with physical masses (2019), with
// Rayleigh's dissipation of the constraints (2016). What they end off is in proportion to the
// square of a small step; it is chosen by the tolerance (own).
#pragma once

#include "solvers/baselines/contact_passage.h"
#include "solvers/baselines/relaxation_method.h"

namespace robot_tissue {

class XpbdMethod : public RelaxationMethod {
 public:
  XpbdMethod(const Lattice& lattice, const ElasticModel& model, const RelaxationOptions& options);

  const std::vector<Vec3>* velocities() const override {
    return velocity_.empty() ? nullptr : &velocity_;
  }

 private:
  void begin(int care) override;
  void iterate() override;
  bool settles(double& to_go) override;
  bool balances() const override { return false; }
  int stride() const override { return 8; }
  int usualIterations() const override;
  double shrinkage() const override;

  SolveStatus goThrough(int& steps) override;
  struct SmallStep {
    double duration;      // s
    double end;           // share of the time step that is gone after it
    double share;         // of the time step
    double damping_time;  // s
  };
  void makeSmallStep(const SmallStep& step, const std::vector<double>& masses,
                     ContactPassage& contacts);
  void predict(double step, const std::vector<double>& masses);
  void keepPlaces(int spare);
  double smallStep(const std::vector<double>& masses) const;
  void weigh();
  void takeStep(double stretch);
  void coast();
  void pushPatches();
  void projectOddCells();
  void projectRims();
  void projectContacts();
  void pushTouches(ContactPassage& contacts, const ContactPassage::SmallStep& step);
  Vec3 mobilityOf(int node) const;
  Vec3 wayOf(int node) const;
  void push(int node, const Vec3& force, double share);
  void move(int node, const Vec3& motion);  // m

  double stretch_ = 1.0;        // square of the time step, in node stiffnesses over masses
  double keep_ = 0.0;           // of the velocity
  int sweeps_ = 0;              // since the step was shortened
  bool offered_ = false;        // the shape, since then
  int refinements_ = 0;         // of the step, since begin()
  std::vector<Vec3> weight_;    // per node, gravity (N)
  double damping_ = 0.0;        // of a small step: damping time over it
  std::vector<Vec3> velocity_;  // at the end of the last time step (m/s)
};

}  // namespace robot_tissue
