#include "trial.h"

#include <algorithm>

#include "run_scene.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

struct OutOfTime {};

double milliseconds(Clock::duration time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

Scene sceneAt(const Scene& scene, const Rung& rung) {
  Scene at_rung = scene;
  at_rung.tissue.spacing = rung.spacing;
  at_rung.solver.method = rung.method;
  at_rung.solver.tolerance = rung.tolerance;
  at_rung.solver.max_ms = 0.0;  // what a budget cuts short has no error of its own
  at_rung.solver.max_iterations.reset();
  return at_rung;
}

// Adds up the increments of each update.
class Stopwatch {
 public:
  Stopwatch(const PacedScene& paced, Clock::time_point deadline, const OnUpdate& on_update)
      : paced_(paced), deadline_(deadline), on_update_(on_update) {}

  void start() { last_ = Clock::now(); }

  void stop(const IncrementRow& row, Trial& trial) {
    const Clock::time_point now = Clock::now();
    const int parts = paced_.parts[at(row.step)];
    sum_ms_ += milliseconds(now - last_);
    solved_ = solved_ || row.report.wall_ms > 0.0;
    if (parts > 0 && row.increment % parts == 0) {
      if (solved_) trial.update_ms.push_back(sum_ms_);
      sum_ms_ = 0.0;
      solved_ = false;
      if (on_update_) on_update_(++updates_);
    }
    if (now > deadline_) throw OutOfTime();
    start();
  }
  // Between steps nothing is timed.
  void startStep() {
    sum_ms_ = 0.0;
    solved_ = false;
    start();
  }

 private:
  const PacedScene& paced_;
  Clock::time_point deadline_;
  const OnUpdate& on_update_;
  Clock::time_point last_ = Clock::now();
  double sum_ms_ = 0.0;
  bool solved_ = false;  // no tool far from the tissue
  int updates_ = 0;
};

// At the end of each step.
std::vector<Vec3> forcesOf(const RunResult& result) {
  const auto last = [&](int step, int increment) {
    const auto later = [&](const IncrementRow& row) {
      return row.step == step && row.increment > increment;
    };
    return std::none_of(result.increments.begin(), result.increments.end(), later);
  };
  std::vector<Vec3> forces;
  for (const PatchRow& row : result.patches) {
    if (last(row.step, row.increment)) forces.push_back(row.answer.force);
  }
  for (const ToolRow& row : result.tools) {
    if (last(row.step, row.increment)) forces.push_back(row.force);
  }
  return forces;
}

enum class Keep { kTimes, kTimesAndAnswers };

void run(const PacedScene& paced, const std::vector<Vec3>& points, Keep keep, Stopwatch& watch,
         Trial& trial) {
  watch.start();
  const RunResult result = runScene(
      paced.scene, [&](const IncrementRow& row, int) { watch.stop(row, trial); },
      [&](int, const Tissue& tissue) {
        trial.nodes = tissue.lattice().nodeCount();
        if (keep == Keep::kTimesAndAnswers) trial.fields.push_back(fieldAt(tissue, points));
        watch.startStep();
      });
  for (const IncrementRow& row : result.increments) {
    trial.worst = std::max(trial.worst, row.report.status);
  }
  if (keep == Keep::kTimesAndAnswers) trial.forces = forcesOf(result);
}

void repeatForTimes(const PacedScene& paced, double seconds_of_one, Clock::time_point deadline,
                    Trial& trial) {
  const OnUpdate silent;
  Stopwatch watch(paced, deadline, silent);
  try {
    double seconds = seconds_of_one;
    while (trial.update_ms.size() < tuning::kEnoughUpdates &&
           seconds + seconds_of_one < tuning::kShortSeconds) {
      run(paced, {}, Keep::kTimes, watch, trial);
      seconds += seconds_of_one;
    }
  } catch (const OutOfTime&) {
  }
}

}  // namespace

Trial tried(const Scene& scene, const Rung& rung, double way_an_update,
            const std::vector<Vec3>& points, Clock::time_point deadline,
            const OnUpdate& on_update) {
  Trial trial;
  trial.rung = rung;
  const Clock::time_point begin = Clock::now();
  try {
    const PacedScene paced_scene = paced(sceneAt(scene, rung), way_an_update);
    Stopwatch watch(paced_scene, deadline, on_update);
    run(paced_scene, points, Keep::kTimesAndAnswers, watch, trial);
    trial.seconds = 1e-3 * milliseconds(Clock::now() - begin);
    repeatForTimes(paced_scene, trial.seconds, deadline, trial);
  } catch (const OutOfTime&) {
    trial.gap = "out of time";
  } catch (const InputError& error) {
    trial.gap = error.what();
  } catch (const std::exception& error) {
    trial.gap = error.what();
  }
  return trial;
}

}  // namespace robot_tissue
