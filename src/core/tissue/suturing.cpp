// Tissue: sutures, and how solves have their threads.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "solvers/solver_method.h"
#include "surface/nearest_point.h"
#include "tissue/front_ties.h"
#include "tissue/load_ramp.h"
#include "tissue/registry.h"
#include "tissue/solve_total.h"
#include "tissue/threads.h"
#include "tissue/tissue_parts.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

[[noreturn]] void refuseSuture(const std::string& suture, const std::string& problem,
                               const std::string& allowed) {
  throw InputError("suture '" + suture + "': " + problem + "; allowed: " + allowed);
}

void requireNumbers(const SutureConfig& config) {
  if (config.name.empty()) refuseSuture(config.name, "no name", "a name");
  const auto require_finite = [&](const Vec3& point, const char* key) {
    if (point.allFinite()) return;
    refuseSuture(config.name, std::string(key) + " is not finite", "finite coordinates");
  };
  const auto require = [&](bool holds, double value, const char* key, const char* allowed) {
    if (holds) return;
    std::ostringstream problem;
    problem << key << " = " << value;
    refuseSuture(config.name, problem.str(), allowed);
  };
  require_finite(config.from, "from");
  require_finite(config.to, "to");
  const double length = config.rest_length, stiffness = config.stiffness;
  const double force = config.break_force;
  require(length >= 0.0 && std::isfinite(length), length, "rest_length", "0 m or more");
  require(stiffness > 0.0 && stiffness <= kStiffestSuture, stiffness, "stiffness",
          "more than 0 N/m, at most 1e5 N/m");
  require(force >= 0.0 && std::isfinite(force), force, "break_force", "0 (never), or more N");
  require(config.bite >= 0.0 && std::isfinite(config.bite), config.bite, "bite", "0 m or more");
}

}  // namespace

// The end at the surface's point that is nearest in the deformed shape.
SutureThread TissueParts::threadOf(const SutureConfig& config) const {
  const double spacing = body_.lattice().spacing();
  SutureThread thread;
  const auto place = [&](const char* key, const Vec3& point, SutureThread::End& end) {
    const auto nearest = nearestPoint(body_.surface(), body_.vertices(), point);
    if (!nearest || nearest->distance > tuning::kReachOfSuture * spacing) {
      std::ostringstream where;
      where << key << " = (" << point.x() << ", " << point.y() << ", " << point.z()
            << ") m is nowhere at the tissue's surface";
      refuseSuture(config.name, where.str(), "a point within a spacing of it");
    }
    end.rest = restOf(body_.surface(), nearest->on);
    end.inside = innerPlace(body_.surface(), nearest->on.triangle, tuning::kInnerDepth * spacing);
    bindEnd(body_.surface(), spacing, config.bite, end);
  };
  place("from", config.from, thread.from);
  place("to", config.to, thread.to);
  thread.name = config.name;
  thread.rest_length = thread.length = config.rest_length;
  thread.stiffness = config.stiffness;
  thread.break_force = config.break_force;
  thread.bite = config.bite;
  if (springOf(thread).carriers.empty()) {
    refuseSuture(config.name, "from and to are one point of the surface", "two points");
  }
  return thread;
}

SutureResult TissueParts::suture(const SutureConfig& config) {
  requireNumbers(config);
  if (!methods_.now().findsEquilibrium()) {
    std::string allowed;
    for (const std::string& name : methodsFor("elastic")) {
      allowed += (allowed.empty() ? "solver.method " : ", ") + name;
    }
    refuseSuture(config.name, "this method finds no equilibrium that a thread could pull to",
                 allowed);
  }
  if (threads_.has(config.name)) {
    refuseSuture(config.name, "a suture of this name is there", "another name");
  }
  SutureThread thread = threadOf(config);
  const TopologyChange change(*this, History::Kind::kByItself);
  SutureResult result;
  if (motion_.takesNoTime()) {
    threads_.add(std::move(thread));
    result.solve = asItIs();
  } else {
    const double now = reportOf(thread, body_.displacement()).length;
    const double same = tuning::kSameDistance * body_.lattice().spacing();
    const bool is_slack = now <= thread.rest_length + same;
    if (!is_slack) thread.length = now;
    threads_.add(std::move(thread));
    result.solve = is_slack ? outcome_.report : drawThreadsIn();
  }
  result.suture = sutures().back();
  return result;
}

std::vector<SutureReport> TissueParts::sutures() const {
  std::vector<SutureReport> reports;
  for (const SutureThread& thread : threads_.all()) {
    reports.push_back(reportOf(thread, body_.displacement()));
  }
  return reports;
}

// The report is of this solve and those before it. False: the time is over.
bool TissueParts::solveOnThreads(SolveReport& report) {
  SolveTotal total(report);
  report = solve(threads_.nodes());
  total.add(report);
  total.tellIn(report);
  return !bounds_.isTimeOver();
}

// To their rest lengths, in steps that the method follows well. Out of time they are there at once,
// and what is left to balance is due.
SolveReport TissueParts::drawThreadsIn() {
  threads_.soften([this](int node) { return tuning::kSoftThread * body_.nodeStiffness(node); },
                  body_.displacement());
  const int steps = wholeParts(threads_.wayLeft() / methods_.now().patchStep());
  SolveReport report;
  bool in_time = true;
  for (int step = 1; step <= steps && in_time; ++step) {
    threads_.drawIn(1.0 / (steps - step + 1));
    in_time = solveOnThreads(report);
  }
  const double same = tuning::kSameDistance * body_.lattice().spacing();
  bool changes = threads_.wayLeft() > 0.0;
  if (!in_time) changes = changes || threads_.correct(body_.displacement()) > same;
  for (int round = 1; round <= tuning::kRoundsOfThread && in_time; ++round) {
    if (threads_.correct(body_.displacement()) <= same) break;
    changes = true;
    in_time = solveOnThreads(report);
  }
  threads_.harden();
  if (in_time && changes) {
    solveOnThreads(report);
  } else if (changes) {
    const std::vector<int> due = threads_.nodes();
    outcome_.disturbed.insert(outcome_.disturbed.end(), due.begin(), due.end());
    outcome_.forgetGhosts(body_.cells());
    outcome_.is_late = true;
    report.status = std::max(report.status, SolveStatus::kLate);
  }
  outcome_.report = report;
  return report;
}

// Under gravity and threads alone, these drawn in from where the rest shape has their ends.
SolveReport TissueParts::settleFromRest() {
  SolveReport report;
  threads_.loosen(body_.displacement());
  if (body_.hasBodyLoad()) report = settle();
  return threads_.anyWhole() ? drawThreadsIn() : report;
}

SolveReport TissueParts::solveWithThreads(const std::vector<int>& disturbed, LatticeState& state) {
  if (!threads_.act()) return methods_.now().solve(loads_.patches(), disturbed, state);
  std::vector<LoadingPatch>& patches = loads_.patches();
  patches.push_back(threads_.patch());
  SolveReport report = methods_.now().solve(patches, disturbed, state);
  patches.pop_back();
  report.patches.resize(patches.size());
  return report;
}

// Threads break in balance, one after the other: what one leaves, the others may bear.
SolveReport TissueParts::solveAndBreak(const std::vector<int>& disturbed) {
  SolveReport report = solveInRounds(disturbed);
  while (report.status != SolveStatus::kLate && report.status != SolveStatus::kUnconverged) {
    const std::vector<int> left = threads_.breakOne(body_.displacement());
    if (left.empty()) break;
    SolveTotal total(report);
    report = solveInRounds(left);
    total.addWork(report);
    total.tellWorkIn(report);
    outcome_.report = report;
  }
  return report;
}

void TissueParts::renewTies() {
  threads_.tie(tiesOfFronts(body_.lattice(), body_.state(), body_.model()));
}

void TissueParts::rebindThreads() {
  for (const int node : threads_.rebind(body_.surface(), body_.lattice().spacing())) {
    outcome_.disturbed.push_back(body_.cells().original(node));
  }
}

}  // namespace robot_tissue
