// Where the tissue is in time: at rest, between two time steps, or in one.
//
// The model's forces are those of a time step from its begin on, also after its end, until the next
// one begins, the tissue comes to rest, another shape is taken or, between two steps, the cells
// change: the term of a step is of the nodes that there were (material/inertial_term.h). Nobody
// else gives the model a term, or takes it away.
#pragma once

#include <memory>
#include <optional>

#include "robot_tissue/core/scene.h"
#include "tissue/body.h"
#include "tissue/time_integrator.h"

namespace robot_tissue {

class SolverMethod;

class TissueMotion {
 public:
  // At rest, but awake under gravity or a pressure.
  TissueMotion(const TissueConfig& tissue, const SolverConfig& solver, Body& body);

  bool hasTime() const { return integrator_ != nullptr; }
  bool isInTime() const { return in_time_; }
  bool isMoving() const { return hasTime() && in_time_ && integrator_->moves(); }
  bool isInTimeStep() const { return in_step_; }
  bool expectsTimeStep() const { return expects_step_; }
  bool goesInTime() const { return in_step_ || expects_step_; }
  // Whether loads that go and cuts leave the shape as it is, to be moved by time.
  bool takesNoTime() const { return hasTime() && !in_step_ && !stands_; }
  // Null: at rest.
  TimeIntegrator::Motion nodes() const { return hasTime() ? integrator_->motion() : nullptr; }
  const TimeIntegrator& integrator() const { return *integrator_; }  // where it has time

  void expectStep(double duration, Touched touched);  // s
  void beginStep(double duration, Touched touched, SolverMethod& method);
  void leaveStep() { in_step_ = expects_step_ = false; }
  // The step ended in the present shape, with these velocities where the method has found them.
  void end(const std::vector<Vec3>* velocities) { integrator_->end(body_.state(), velocities); }
  void wake();               // loads or cells are others, the shape is not yet
  void wakeUnderBodyLoad();  // the rest shape is not the one under gravity or a pressure
  void noteOtherCells();     // cuts or removals made them, maybe within a time step
  void halt();               // velocities are zero; between two steps
  void stop();
  // While one lives time stands still: what changes comes to balance at once, at rest.
  class Standstill {
   public:
    explicit Standstill(TissueMotion& motion) : motion_(motion) {
      motion_.stop();
      motion_.stands_ = true;
    }
    ~Standstill() { motion_.stands_ = false; }
    Standstill(const Standstill&) = delete;
    Standstill& operator=(const Standstill&) = delete;

   private:
    TissueMotion& motion_;
  };
  void restore(TimeIntegrator::Motion motion, bool in_time);  // of another shape
  void setTolerance(double tolerance);

 private:
  // The model has the term for as long as this lives.
  class StepOfModel {
   public:
    StepOfModel(Body& body, const InertialTerm& term);
    ~StepOfModel();
    StepOfModel(const StepOfModel&) = delete;
    StepOfModel& operator=(const StepOfModel&) = delete;

   private:
    Body& body_;  // its model may be made anew, which has no term then
  };

  Body& body_;
  std::unique_ptr<TimeIntegrator> integrator_;  // null: there is no time
  std::optional<StepOfModel> step_of_model_;
  // Since the last stop there was a time step, or there are forces for one.
  bool in_time_ = false;
  bool in_step_ = false;
  bool expects_step_ = false;
  bool stands_ = false;
};

}  // namespace robot_tissue
