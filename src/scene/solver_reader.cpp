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

void requireMembranes(const Entry& entry, const std::string& method) {
  if (traitsOf(method).takes_membranes) return;
  entry.fail("with tissue.membranes must be " + methodsWithMembranes() + ": " + method +
             " knows no membranes");
}

struct SolverReading {
  const TissueConfig& tissue;
  const SolverOverrides& overrides;
  Remarks& remarks;
  SolverConfig solver;
};

void readMethod(const Entry& entry, SolverReading& reading) {
  const Entry method = overridden(entry, reading.overrides.method, "--method");
  if (!method.given()) return;
  reading.solver.method = method.choice(methodNames());
  requireFit(method, reading.solver.method, reading.tissue.model);
  if (!reading.tissue.membranes.empty()) requireMembranes(method, reading.solver.method);
}

void readTolerance(const Entry& entry, SolverReading& reading) {
  SolverConfig& solver = reading.solver;
  const Entry tolerance = overridden(entry, reading.overrides.tolerance, "--tolerance");
  solver.tolerance = tolerance.numberOr(solver.tolerance, ranges::tolerance());
  if (tolerance.given() && !traitsOf(solver.method).uses_tolerance) {
    reading.remarks.push_back(
        tolerance.line("ignored, method " + solver.method + " solves exactly"));
  }
}

void readThreads(const Entry& entry, SolverReading& reading) {
  SolverConfig& solver = reading.solver;
  const Entry threads = overridden(entry, reading.overrides.threads, "--threads");
  solver.threads = threads.integerOr(solver.threads, 1, 256);
  if (solver.threads > 1 && !traitsOf(solver.method).uses_threads) {
    reading.remarks.push_back(
        threads.line("ignored, method " + solver.method + " uses one thread"));
  }
}

const KeyTable<SolverReading> kSolverKeys = {
    {"method", readMethod},
    {"tolerance", readTolerance},
    {"max_ms",
     [](const Entry& entry, SolverReading& reading) {
       reading.solver.max_ms = entry.numberOr(reading.solver.max_ms, ranges::budget());
     }},
    {"max_iterations",
     [](const Entry& entry, SolverReading& reading) {
       if (!entry.given()) return;
       reading.solver.max_iterations = entry.integer(0, ranges::kMostIterations);
     }},
    {"threads", readThreads},
};

}  // namespace

SolverConfig readSolver(const Entry& entry, const TissueConfig& tissue,
                        const SolverOverrides& overrides, Remarks& remarks) {
  const Entry map_entry = entry.given() ? entry : entry.child(YAML::Node(YAML::NodeType::Map), "");
  SolverReading reading{tissue, overrides, remarks, {}};
  reading.solver.method = methodsFor(tissue.model).front();
  readKeys(MapReader(map_entry, namesOf(kSolverKeys)), kSolverKeys, reading);
  return reading.solver;
}

}  // namespace robot_tissue
