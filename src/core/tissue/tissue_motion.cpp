#include "tissue/tissue_motion.h"

#include <utility>
#include <vector>

#include "material/elastic_model.h"
#include "solvers/solver_method.h"

namespace robot_tissue {
namespace {

// Only this model has masses; others are refused where there is time.
const ElasticModel& elasticModel(const Body& body) {
  return dynamic_cast<const ElasticModel&>(body.model());
}

}  // namespace

TissueMotion::StepOfModel::StepOfModel(Body& body, const InertialTerm& term) : body_(body) {
  body_.model().setInertia(&term);
}

TissueMotion::StepOfModel::~StepOfModel() { body_.model().setInertia(nullptr); }

TissueMotion::TissueMotion(const TissueConfig& tissue, const SolverConfig& solver, Body& body)
    : body_(body) {
  if (!tissue.time) return;
  integrator_ =
      std::make_unique<TimeIntegrator>(tissue.time->damping_time, tissue.spacing, solver.tolerance);
  wakeUnderBodyLoad();
}

void TissueMotion::expectStep(double duration, Touched touched) {
  using Scheme = TimeIntegrator::Scheme;
  expects_step_ = true;
  integrator_->expect(
      duration, touched == Touched::kByTools ? Scheme::kBackwardEuler : Scheme::kGeneralizedAlpha,
      body_.state(), elasticModel(body_).nodeMasses(body_.cells()));
}

void TissueMotion::beginStep(double duration, Touched touched, SolverMethod& method) {
  expectStep(duration, touched);
  in_time_ = in_step_ = true;
  step_of_model_.reset();  // the cells' forces at its begin are those of the shape alone
  using Damping = TimeIntegrator::Damping;
  step_of_model_.emplace(
      body_, integrator_->begin(
                 body_.state(), method.dampsStrain() ? Damping::kOfStrain : Damping::kOfForces,
                 [&](const LatticeState& shape) { return elasticModel(body_).cellForces(shape); }));
}

void TissueMotion::wake() {
  in_time_ = true;
  integrator_->wake(body_.state());
}

void TissueMotion::wakeUnderBodyLoad() {
  if (hasTime() && body_.hasBodyLoad()) wake();
}

void TissueMotion::noteOtherCells() {
  if (takesNoTime()) step_of_model_.reset();
}

void TissueMotion::halt() {
  if (!isMoving()) return;
  integrator_->rest();
  wake();
}

void TissueMotion::stop() {
  if (!hasTime()) return;
  in_time_ = false;
  leaveStep();
  integrator_->rest();
  step_of_model_.reset();
}

void TissueMotion::restore(TimeIntegrator::Motion motion, bool in_time) {
  if (hasTime()) integrator_->take(std::move(motion));
  in_time_ = in_time;
  leaveStep();
  step_of_model_.reset();  // of the step that is given up
}

void TissueMotion::setTolerance(double tolerance) {
  if (hasTime()) integrator_->setTolerance(tolerance);
}

}  // namespace robot_tissue
