#include "resolution_sweep.h"

#include <algorithm>
#include <cmath>

#include "ladder.h"
#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Of the solver. The last one also says what the lattice itself answers.
const std::vector<double> kTolerances = {0.1, 0.03, 0.01, 0.003, 0.001};

class ResolutionSweep {
 public:
  ResolutionSweep(const Scene& scene, const SweepOptions& options, const OnRung& on_rung)
      : scene_(scene),
        options_(options),
        on_rung_(on_rung),
        points_(nodesOf(scene.tissue)),
        spacings_(ladderSpacings(scene.tissue, options.coarser, options.finer)),
        begin_(Clock::now()) {
    // Solves exactly whatever the tolerance.
    if (traitsOf(options.method).uses_tolerance) tolerances_ = kTolerances;
    const double own = scene.solver.tolerance;
    const bool tight = own <= kTolerances.back();
    const auto known = std::find(tolerances_.begin(), tolerances_.end(), own);
    if (tolerances_.size() > 1 && !tight && known == tolerances_.end()) tolerances_.push_back(own);
    std::sort(tolerances_.rbegin(), tolerances_.rend());
  }

  std::vector<Trial> run() {
    std::vector<double> order = {scene_.tissue.spacing};
    for (auto spacing = spacings_.rbegin(); spacing != spacings_.rend(); ++spacing) {
      if (*spacing > scene_.tissue.spacing) order.push_back(*spacing);
    }
    for (const double spacing : spacings_) {
      if (spacing < scene_.tissue.spacing) order.push_back(spacing);
    }
    for (const double spacing : order) tryTightest(spacing);
    for (const double spacing : spacings_) tryLooser(spacing);
    std::sort(trials_.begin(), trials_.end(), [](const Trial& a, const Trial& b) {
      if (a.rung.spacing != b.rung.spacing) return a.rung.spacing > b.rung.spacing;
      return a.rung.tolerance > b.rung.tolerance;
    });
    return std::move(trials_);
  }

 private:
  double secondsLeft() const {
    return options_.seconds - std::chrono::duration<double>(Clock::now() - begin_).count();
  }

  // By the nearest coarser lattice that was tried; 0 when there is none.
  double expectedSeconds(double spacing) const {
    const Trial* nearest = nullptr;
    for (const Trial& trial : trials_) {
      if (!trial.gap.empty() || trial.rung.spacing < spacing) continue;
      if (nearest == nullptr || trial.rung.spacing < nearest->rung.spacing) nearest = &trial;
    }
    if (nearest == nullptr) return 0.0;
    const double growth =
        nodesAt(scene_.tissue, spacing) / nodesAt(scene_.tissue, nearest->rung.spacing);
    return nearest->seconds * std::pow(growth, tuning::kCostExponent);
  }

  // Half of what is left, so that something is left for the looser tolerances.
  void tryTightest(double spacing) {
    const double nodes = nodesAt(scene_.tissue, spacing);
    const double allowed = spacing < scene_.tissue.spacing ? 0.5 * secondsLeft() : secondsLeft();
    const double expected = expectedSeconds(spacing);
    const Rung rung{options_.method, spacing, tolerances_.back()};
    if (nodes > mostNodes(freeMemory(), options_.method)) {
      addGap(rung, "not tried: " + numberText(nodes) + " nodes are more than the memory holds");
    } else if (spacing < scene_.tissue.spacing && expected > allowed) {
      addGap(rung, "not tried: would take about " + numberText(std::ceil(expected)) +
                       " s, more than --seconds leaves for it");
    } else {
      add(rung, allowed);
    }
  }

  void tryLooser(double spacing) {
    const auto tightest = std::find_if(trials_.begin(), trials_.end(), [&](const Trial& trial) {
      return trial.rung.spacing == spacing;
    });
    if (tightest == trials_.end() || !tightest->gap.empty()) return;
    const double expected = tightest->seconds;
    for (std::size_t i = 0; i + 1 < tolerances_.size(); ++i) {
      const Rung rung{options_.method, spacing, tolerances_[i]};
      if (expected > secondsLeft()) {
        addGap(rung, "not tried: --seconds leaves no time for it");
      } else {
        add(rung, secondsLeft());
      }
    }
  }

  void addGap(const Rung& rung, const std::string& gap) {
    trials_.emplace_back();
    trials_.back().rung = rung;
    trials_.back().gap = gap;
  }

  void add(const Rung& rung, double seconds) {
    Scene at_spacing = scene_;
    at_spacing.tissue.spacing = rung.spacing;
    const int updates = updateCount(paced(at_spacing, options_.way_an_update));
    const auto tell = [&](int update) {
      const std::size_t all = spacings_.size() * tolerances_.size();
      if (on_rung_) on_rung_(trials_.size(), all, rung, update, updates);
    };
    tell(0);
    const auto time = std::chrono::duration<double>(std::max(seconds, 0.0));
    const auto deadline = Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
    trials_.push_back(tried(scene_, rung, options_.way_an_update, points_, deadline, tell));
  }

  const Scene& scene_;
  const SweepOptions& options_;
  const OnRung& on_rung_;
  std::vector<Vec3> points_;
  std::vector<double> spacings_;
  std::vector<double> tolerances_ = {kTolerances.back()};
  Clock::time_point begin_;
  std::vector<Trial> trials_;
};

}  // namespace

std::vector<Trial> resolutionSweep(const Scene& scene, const SweepOptions& options,
                                   const OnRung& on_rung) {
  return ResolutionSweep(scene, options, on_rung).run();
}

}  // namespace robot_tissue
