#include <algorithm>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/scene/readers.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

// What the command line says takes the place of the scene's own entry.
Entry overridden(const Entry& entry, const std::optional<std::string>& value,
                 const std::string& option) {
  return value ? Entry(YAML::Node(*value), option, "") : entry;
}

void requireFit(const Entry& entry, const std::string& method, const std::string& model) {
  const std::vector<std::string> fit = methodsFor(model);
  if (std::find(fit.begin(), fit.end(), method) != fit.end()) return;
  entry.fail("with tissue.model " + model + " must be " + joined(fit) + ": " + method +
             " does not fit this model");
}

}  // namespace

SolverConfig readSolver(const Entry& entry, const std::string& model,
                        const SolverOverrides& overrides, Remarks& remarks) {
  const Entry map_entry = entry.given() ? entry : entry.child(YAML::Node(YAML::NodeType::Map), "");
  const MapReader map(map_entry, {"method", "tolerance", "max_ms", "threads"});
  SolverConfig solver;
  solver.method = methodsFor(model).front();
  const Entry method = overridden(map["method"], overrides.method, "--method");
  if (method.given()) {
    solver.method = method.choice(methodNames(), {});
    requireFit(method, solver.method, model);
  }
  const Entry tolerance = overridden(map["tolerance"], overrides.tolerance, "--tolerance");
  solver.tolerance = tolerance.numberOr(solver.tolerance, ranges::tolerance());
  if (tolerance.given() && !traitsOf(solver.method).uses_tolerance) {
    remarks.push_back(tolerance.line("ignored, method " + solver.method + " solves exactly"));
  }
  solver.max_ms = map["max_ms"].numberOr(solver.max_ms, ranges::budget());
  const Entry threads = overridden(map["threads"], overrides.threads, "--threads");
  solver.threads = threads.integerOr(solver.threads, 1, 256);
  if (solver.threads > 1 && !traitsOf(solver.method).uses_threads) {
    remarks.push_back(threads.line("ignored, method " + solver.method + " uses one thread"));
  }
  return solver;
}

}  // namespace robot_tissue
