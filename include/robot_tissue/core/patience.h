// Whether it is worth going on where load steps take long: counted in iterations, so that the same
// scene ends alike on every machine.
#pragma once

#include <limits>

namespace robot_tissue {

// Counts what load steps take beyond the iterations that are usual. A slip or two are forgiven by
// and by; tissue that is crushed between tools, or tears beside one, asks for hundreds in every
// other load step, for as long as it goes on.
class Patience {
 public:
  // Iterations that a load step usually takes at most; a method that does not know them is never
  // out of patience.
  explicit Patience(int usual = std::numeric_limits<int>::max()) : usual_(usual) {}

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

  // From here on it is for all of a scene, and once it is over load steps have no more than the
  // usual iterations; before, it is for one way of the tools, counts what did not converge alone,
  // and bounds no solve.
  void limit() { is_for_scene_ = true; }
  void forget() { spent_ = spent_by_trials_ = 0; }
  // A way begins, or went on by a whole load step.
  void forgetWay() {
    if (!is_for_scene_) spent_ = 0;
  }

  // What is solved: in a time step contacts begin and end at speed, so it may take several times as
  // many, and counts the less.
  enum class Of { kLoadStep, kTimeStep };
  void note(int iterations, bool converged, Of what = Of::kLoadStep);  // of a solve
  // Iterations that the load step may still take.
  int left(Of what = Of::kLoadStep) const;
  // Iterations that one takes at most, bounded or not.
  int mostOfLoadStep() const;
  bool isOver() const { return spent_ >= most(); }
  // It is over, and load steps have the usual iterations alone.
  bool cutsOff() const { return is_for_scene_ && isOver(); }

  // Of trials, which spend nothing of what is counted but may have none left: goes on with what
  // they have spent, and back.
  void beginTrial();
  void endTrial();

 private:
  int most() const;
  int timesUsual(double times) const;
  void endSolve();
  void endLoadStep();

  int usual_;
  bool is_for_scene_ = false;
  int depth_ = 0;          // of load steps
  int taken_ = 0;          // iterations, in the load step under way
  int unsettled_ = 0;      // likewise, in the solve under way
  bool converged_ = true;  // its last solve, if there was any
  int spent_ = 0;          // iterations
  int spent_by_trials_ = 0;
  int before_trial_ = 0;  // spent_
};

}  // namespace robot_tissue
