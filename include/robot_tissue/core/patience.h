// Whether it is worth going on where load steps take long: counted in iterations, so that the same
// scene ends alike on every machine.
#pragma once

#include <limits>

#include "robot_tissue/core/load_step_bound.h"

namespace robot_tissue {

// Counts the work of load steps beyond what is usual: little where it led to balance, and all the
// work where they do not converge or no shape follows. A slip or two are
// forgiven by and by; tissue that is crushed between tools, or tears beside one, asks for hundreds
// of iterations in every other load step, for as long as it goes on.
//
// Work is in the method's iterations: a solve is as long as those it takes, and what it begins and
// ends with takes as long as a few more.
class Patience {
 public:
  // Iterations that a load step usually takes at most; a method that does not know them is never
  // out of patience. Nodes of the lattice: where they are many, less beyond the usual work is
  // forborne, as it takes the longer, and once it is over less than the usual work.
  explicit Patience(int usual_iterations = std::numeric_limits<int>::max(), int nodes = 1);

  // What is solved while one lives is one load step; one within another is part of it.
  class LoadStep {
   public:
    explicit LoadStep(Patience& patience) : patience_(patience) { ++patience_.depth_; }
    ~LoadStep() {
      patience_.endSolve();
      if (--patience_.depth_ == 0) patience_.endLoadStep();
    }
    LoadStep(const LoadStep&) = delete;
    LoadStep& operator=(const LoadStep&) = delete;

   private:
    Patience& patience_;
  };

  // From here on it is for all of a scene, and once it is over load steps have the usual work at
  // most; before, it is for one way of the tools, counts what did not converge alone, and
  // bounds no solve. `times` that of a scene.
  void limit(double times = 1.0);
  bool isForScene() const { return is_for_scene_; }
  void forget() { spent_ = spent_by_trials_ = 0; }
  // A way begins, or went on by a whole load step.
  void forgetWay() {
    if (!is_for_scene_) spent_ = 0;
  }

  // What is solved: in a time step contacts begin and end at speed, so it may take several times as
  // many, and counts the less. `cost`: of an iteration, over that of one with few touches.
  enum class Of { kLoadStep, kTimeStep };
  void note(int iterations, bool converged, Of what = Of::kLoadStep, double cost = 1.0);
  // Nothing, as of a solve that is an answer however long it took.
  void noteEasy() { converged_ = true; }
  // No shape followed in the load step under way: its solves led nowhere, converged or not.
  void noteLost() { lost_ = true; }
  // Iterations that the next solve of the load step may take; 0: there is to be none.
  int left(Of what = Of::kLoadStep, double cost = 1.0) const;
  // Iterations that one takes at most, bounded or not.
  int mostOfLoadStep() const;
  bool isOver() const { return spent_ >= most(); }
  // It is over, and load steps have the usual iterations alone.
  bool cutsOff() const { return is_for_scene_ && isOver(); }

  // Of the load step under way, however patient the scene is.
  LoadStepBound& bound() { return bound_; }
  const LoadStepBound& bound() const { return bound_; }

  // Of trials, which spend nothing of what is counted but may have none left: goes on with what
  // they have spent, and back.
  void beginTrial();
  void endTrial();

 private:
  double most() const { return is_for_scene_ ? most_ : most_on_a_way_; }
  bool isKnown() const { return usual_ < std::numeric_limits<int>::max(); }
  void spend(double work);
  void endSolve();
  void endLoadStep();

  LoadStepBound bound_;
  int usual_;               // iterations
  double usual_when_over_;  // work, of a load step
  double most_of_scene_;    // work, usually
  double most_;             // work, spent over a scene
  double most_on_a_way_;    // likewise
  bool is_for_scene_ = false;
  int depth_ = 0;           // of load steps
  double taken_ = 0.0;      // work, in the load step under way
  bool in_time_ = false;    // it is a time step
  double unsettled_ = 0.0;  // likewise, in the solve under way
  bool converged_ = true;   // its last solve, if there was any
  bool lost_ = false;       // the load step under way
  double spent_ = 0.0;      // work
  double spent_by_trials_ = 0.0;
  double before_trial_ = 0.0;  // spent_
};

}  // namespace robot_tissue
