#include "robot_tissue/core/patience.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

constexpr int kNoBound = std::numeric_limits<int>::max();

double timesOf(Patience::Of what) {
  return what == Patience::Of::kTimeStep ? tuning::kTimesInTimeStep : 1.0;
}

// How many times as long iterations take as on a lattice whose load steps have all of the work.
double largeness(int nodes) { return std::max(1.0, nodes / tuning::kManyNodes); }

}  // namespace

Patience::Patience(int usual_iterations, int nodes)
    : usual_(usual_iterations),
      usual_when_over_(tuning::kUsualWork * usual_iterations / largeness(nodes)),
      most_of_scene_(tuning::kMostSpent * usual_iterations / largeness(nodes)),
      most_(most_of_scene_),
      most_on_a_way_(tuning::kMostSpentOnAWay) {}

void Patience::limit(double times) {
  is_for_scene_ = true;
  most_ = times * most_of_scene_;
}

int Patience::mostOfLoadStep() const {
  return isKnown() ? static_cast<int>(std::lround(tuning::kMostOfLoadStep * usual_)) : kNoBound;
}

void Patience::note(int iterations, bool converged, Of what, double cost) {
  const double work = cost * (iterations + tuning::kEndsOfSolve * usual_) / timesOf(what);
  if (what == Of::kLoadStep) bound_.note(iterations);
  taken_ += work;
  unsettled_ += work;
  in_time_ = what == Of::kTimeStep;
  converged_ = converged;
}

int Patience::left(Of what, double cost) const {
  if (!is_for_scene_ || !isKnown()) return kNoBound;
  const double of_load_step =
      isOver() ? usual_when_over_ : std::max<double>(usual_, usual_when_over_ + most_ - spent_);
  const double work = of_load_step - taken_;
  return std::max(0, static_cast<int>(timesOf(what) * work / cost - tuning::kEndsOfSolve * usual_));
}

void Patience::spend(double work) {
  if (isKnown()) spent_ = std::min(spent_ + work, most());
}

void Patience::endSolve() {
  if (!is_for_scene_ && !converged_) spend(unsettled_);
  unsettled_ = 0.0;
}

void Patience::endLoadStep() {
  const double usual = tuning::kUsualWork * usual_;
  const bool settled = converged_ && !lost_;
  if (is_for_scene_ && !settled) {
    spend(taken_);
  } else if (is_for_scene_ && taken_ > usual) {
    spend(tuning::kSpentBySettled * (taken_ - usual));
  } else if (settled) {
    const double forgiven = tuning::kForgiven * usual;
    spent_ = std::max(spent_ - (in_time_ ? forgiven / tuning::kTimesInTimeStep : forgiven), 0.0);
  }
  taken_ = 0.0;
  lost_ = false;
  converged_ = true;
}

void Patience::beginTrial() {
  before_trial_ = spent_;
  spent_ = std::max(spent_, spent_by_trials_);
}

void Patience::endTrial() {
  spent_by_trials_ = spent_;
  spent_ = before_trial_;
}

}  // namespace robot_tissue
