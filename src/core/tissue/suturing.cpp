#include "tissue/suturing.h"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/text_of.h"
#include "robot_tissue/core/suture_ranges.h"
#include "surface/nearest_point.h"
#include "tissue/load_ramp.h"
#include "tissue/registry.h"
#include "tissue/solve_total.h"
#include "tissue/topology_change.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

[[noreturn]] void refuseSuture(const std::string& suture, const std::string& problem,
                               const std::string& allowed) {
  throw InputError("suture '" + suture + "': " + problem + "; allowed: " + allowed);
}

// `longest` (m): of its lengths.
void requireNumbers(const SutureConfig& config, double longest) {
  if (config.name.empty()) refuseSuture(config.name, "no name", "a name");
  const auto require_finite = [&](const Vec3& point, const char* key) {
    if (point.allFinite()) return;
    refuseSuture(config.name, std::string(key) + " is not finite", "finite coordinates");
  };
  const auto require = [&](double value, double least, double most, const char* key,
                           const char* unit) {
    if (value >= least && value <= most) return;
    std::ostringstream problem, allowed;
    problem << key << " = " << value;
    allowed << least << " to " << most << ' ' << unit;
    refuseSuture(config.name, problem.str(), allowed.str());
  };
  require_finite(config.from, "from");
  require_finite(config.to, "to");
  require(config.rest_length, 0.0, longest, "rest_length", "m");
  require(config.stiffness, kSoftestSuture, kStiffestSuture, "stiffness", "N/m");
  require(config.break_force, 0.0, kStrongestSuture, "break_force", "N (0: never)");
  require(config.bite, 0.0, longest, "bite", "m");
}

}  // namespace

SutureResult Suturing::suture(const SutureConfig& config) {
  requireNumbers(config, longestSuture(data_.body.lattice().bounds()));
  if (!data_.methods.now().findsEquilibrium()) {
    std::string allowed;
    for (const std::string& name : methodsFor("elastic")) {
      allowed += (allowed.empty() ? "solver.method " : ", ") + name;
    }
    refuseSuture(config.name, "this method finds no equilibrium that a thread could pull to",
                 allowed);
  }
  if (data_.threads.has(config.name)) {
    refuseSuture(config.name, "a suture of this name is there", "another name");
  }
  SutureThread thread = threadOf(config);
  const TopologyChange change(data_, History::Kind::kByItself);
  SutureResult result;
  if (data_.motion.takesNoTime()) {
    data_.threads.add(std::move(thread));
    result.solve = data_.asItIs();
  } else {
    const double now = robot_tissue::reportOf(thread, data_.body.displacement()).length;
    const double same = tuning::kSameDistance * data_.body.lattice().spacing();
    const bool is_slack = now <= thread.rest_length + same;
    if (!is_slack) thread.length = now;
    data_.threads.add(std::move(thread));
    result.solve = is_slack ? data_.outcome.report : drawnIn();
  }
  result.suture = reportOf(config.name);
  return result;
}

// The end at the surface's point that is nearest in the deformed shape.
SutureThread Suturing::threadOf(const SutureConfig& config) const {
  const double spacing = data_.body.lattice().spacing();
  SutureThread thread;
  const auto place = [&](const char* key, const Vec3& point, SutureThread::End& end) {
    const auto nearest = nearestPoint(data_.body.surface(), data_.body.vertices(), point);
    if (!nearest || nearest->distance > tuning::kReachOfSuture * spacing) {
      refuseSuture(config.name,
                   key + (" = " + textOf(point)) + " m is nowhere at the tissue's surface",
                   "a point within a spacing of it");
    }
    end.rest = restOf(data_.body.surface(), nearest->on);
    end.inside =
        innerPlace(data_.body.surface(), nearest->on.triangle, tuning::kInnerDepth * spacing);
    bindEnd(data_.body.surface(), spacing, config.bite, end);
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

// And what tears of that.
SolveReport Suturing::drawnIn() {
  drawThreadsIn();
  return surgery_.tear();
}

// Broken: it went with tissue that tore.
SutureReport Suturing::reportOf(const std::string& name) const {
  for (const SutureReport& report : sutures()) {
    if (report.name == name) return report;
  }
  SutureReport gone;
  gone.name = name;
  gone.broken = true;
  return gone;
}

std::vector<SutureReport> Suturing::sutures() const {
  std::vector<SutureReport> reports;
  for (const SutureThread& thread : data_.threads.all()) {
    reports.push_back(robot_tissue::reportOf(thread, data_.body.displacement()));
  }
  return reports;
}

// To their rest lengths, in steps that the method follows well. Out of time they are there at once,
// and what is left to balance is due.
SolveReport Suturing::drawThreadsIn() {
  data_.threads.soften(
      [this](int node) { return tuning::kSoftThread * data_.body.nodeStiffness(node); },
      data_.body.displacement());
  const int steps = wholeParts(data_.threads.wayLeft() / data_.methods.now().patchStep());
  SolveReport report;
  bool in_time = true;
  for (int step = 1; step <= steps && in_time; ++step) {
    data_.threads.drawIn(1.0 / (steps - step + 1));
    in_time = solveOnThreads(report);
  }
  const double same = tuning::kSameDistance * data_.body.lattice().spacing();
  bool changes = data_.threads.wayLeft() > 0.0;
  if (!in_time) changes = changes || data_.threads.correct(data_.body.displacement()) > same;
  for (int round = 1; round <= tuning::kRoundsOfThread && in_time; ++round) {
    if (data_.threads.correct(data_.body.displacement()) <= same) break;
    changes = true;
    in_time = solveOnThreads(report);
  }
  changes = data_.threads.harden(data_.body.displacement()) || changes;
  if (in_time && changes) {
    solveOnThreads(report);
  } else if (changes) {
    const std::vector<int> due = data_.threads.nodes();
    data_.outcome.disturbed.insert(data_.outcome.disturbed.end(), due.begin(), due.end());
    data_.outcome.forgetGhosts(data_.body.cells());
    data_.outcome.is_late = true;
    report.status = std::max(report.status, SolveStatus::kLate);
  }
  data_.outcome.report = report;
  return report;
}

// The report is of this solve and those before it. False: the time is over.
bool Suturing::solveOnThreads(SolveReport& report) {
  SolveTotal total(report);
  report = solver_.solve(data_.threads.nodes());
  total.add(report);
  total.tellIn(report);
  return !data_.bounds.isTimeOver();
}

}  // namespace robot_tissue
