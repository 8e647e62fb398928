#include "tissue/registry.h"

#include <algorithm>

#include "material/elastic_model.h"
#include "material/six_spring_model.h"
#include "solvers/baselines/explicit_method.h"
#include "solvers/baselines/vbd_method.h"
#include "solvers/baselines/xpbd_method.h"
#include "solvers/multigrid/cycle/layered_method.h"
#include "solvers/newton/newton_method.h"
#include "solvers/paper/paper_method.h"
#include "tissue/tuning.h"

namespace robot_tissue {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
}

std::unique_ptr<TissueModel> makeElastic(const TissueConfig& config, const Lattice& lattice) {
  return std::make_unique<ElasticModel>(lattice, config);
}

std::unique_ptr<TissueModel> makeSixSpring(const TissueConfig& config, const Lattice& lattice) {
  return std::make_unique<SixSpringModel>(lattice, config.gravity);
}

std::unique_ptr<SolverMethod> makePaper(const SolverConfig& config, const Lattice& lattice,
                                        const TissueModel& model) {
  if (model.splitCells() == SplitCells::kParted) {
    throw InputError(
        "solver.method: 'paper' goes from node to node along springs, the tissue's model is made "
        "of cells; allowed: newton, or tissue.model six_spring");
  }
  PaperOptions options;
  options.balance_tolerance = config.tolerance;
  options.max_ms = config.max_ms;
  return std::make_unique<PaperMethod>(lattice, model, options);
}

const EnergyModel& requireEnergy(const TissueModel& model, const std::string& method) {
  if (const auto* energy_model = dynamic_cast<const EnergyModel*>(&model)) return *energy_model;
  throw InputError("solver.method: '" + method +
                   "' finds the one equilibrium of an energy, the tissue's model has none; "
                   "allowed: paper, or tissue.model elastic");
}

// For methods that know its cells, and nothing besides.
const ElasticModel& requireElastic(const TissueModel& model, const std::string& method) {
  if (const auto* elastic = dynamic_cast<const ElasticModel*>(&model)) {
    if (!elastic->hasMembranes()) return *elastic;
    throw InputError("solver.method: '" + method + "' knows no membranes; allowed with " +
                     "tissue.membranes: " + methodsWithMembranes());
  }
  throw InputError("solver.method: '" + method +
                   "' knows the cells of tissue.model elastic alone; allowed: paper, or "
                   "tissue.model elastic");
}

std::unique_ptr<SolverMethod> makeLayered(const SolverConfig& config, const Lattice& lattice,
                                          const TissueModel& model) {
  LayeredOptions options;
  options.tolerance = config.tolerance;
  options.max_ms = config.max_ms;
  options.threads = config.threads;
  const auto* elastic = dynamic_cast<const ElasticModel*>(&model);
  if (elastic == nullptr) requireEnergy(model, "layered");
  return std::make_unique<LayeredMethod>(lattice, *elastic, options);
}

std::unique_ptr<SolverMethod> makeNewton(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model) {
  NewtonOptions options;
  options.max_ms = config.max_ms;
  return std::make_unique<NewtonMethod>(lattice, requireEnergy(model, "newton"), options);
}

std::unique_ptr<SolverMethod> makeVbd(const SolverConfig& config, const Lattice& lattice,
                                      const TissueModel& model) {
  VbdOptions options;
  options.tolerance = config.tolerance;
  options.max_ms = config.max_ms;
  return std::make_unique<VbdMethod>(lattice, requireElastic(model, "vbd"), options);
}

std::unique_ptr<SolverMethod> makeExplicit(const SolverConfig& config, const Lattice& lattice,
                                           const TissueModel& model) {
  RelaxationOptions options;
  options.tolerance = config.tolerance;
  options.max_ms = config.max_ms;
  return std::make_unique<ExplicitMethod>(lattice, requireElastic(model, "explicit"), options);
}

std::unique_ptr<SolverMethod> makeXpbd(const SolverConfig& config, const Lattice& lattice,
                                       const TissueModel& model) {
  RelaxationOptions options;
  options.tolerance = config.tolerance;
  options.max_ms = config.max_ms;
  return std::make_unique<XpbdMethod>(lattice, requireElastic(model, "xpbd"), options);
}

using MakeModel = std::unique_ptr<TissueModel> (*)(const TissueConfig&, const Lattice&);
using MakeMethod = std::unique_ptr<SolverMethod> (*)(const SolverConfig&, const Lattice&,
                                                     const TissueModel&);

struct ModelEntry {
  const char* name;
  MakeModel make;
  ModelTraits traits;
};

struct MethodEntry {
  const char* name;
  MakeMethod make;
  std::vector<std::string> models;  // that it fits
  MethodTraits traits;
};

const std::vector<ModelEntry>& models() {
  static const std::vector<ModelEntry> all = {
      {"elastic", makeElastic, {true, false, false, true, true}},
      {"six_spring", makeSixSpring, {false, true, true, false}},
  };
  return all;
}

constexpr MethodTraits kOfField = {true, false, true, false, 0.0, tuning::kFieldBytes};

// Those of a model in the order of its defaults. The six-spring lattice holds many shapes without a
// force: no method can name its equilibrium. The paper's method moves along springs, which do not
// reach the ghosts that cuts give the cells.
const std::vector<MethodEntry>& methods() {
  static const std::vector<MethodEntry> all = {
      {"layered", makeLayered, {"elastic"}, {true, true, true, true, 0.0, tuning::kLevelsBytes}},
      {"newton", makeNewton, {"elastic"}, {false, false, true, true, tuning::kFactorBytes}},
      {"paper", makePaper, {"six_spring"}, {true, false, false, false, 0.0}},
      {"vbd", makeVbd, {"elastic"}, kOfField},
      {"xpbd", makeXpbd, {"elastic"}, kOfField},
      {"explicit", makeExplicit, {"elastic"}, kOfField},
  };
  return all;
}

template <typename Entry>
std::vector<std::string> namesOf(const std::vector<Entry>& entries) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.emplace_back(entry.name);
  return names;
}

template <typename Entry>
const Entry& named(const std::string& name, const std::string& key,
                   const std::vector<Entry>& entries) {
  for (const Entry& entry : entries) {
    if (name == entry.name) return entry;
  }
  throw InputError(key + ": '" + name + "' is unknown; allowed: " + listed(namesOf(entries)));
}

}  // namespace

const std::vector<std::string>& modelNames() {
  static const std::vector<std::string> names = namesOf(models());
  return names;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = namesOf(methods());
  return names;
}

const ModelTraits& traitsOfModel(const std::string& model) {
  return named(model, "tissue.model", models()).traits;
}

std::string modelsWith(bool ModelTraits::*trait) {
  std::vector<std::string> names;
  for (const ModelEntry& model : models()) {
    if (model.traits.*trait) names.emplace_back(model.name);
  }
  return listed(names);
}

const MethodTraits& traitsOf(const std::string& method) {
  return named(method, "solver.method", methods()).traits;
}

std::string methodsWithMembranes() {
  std::vector<std::string> names;
  for (const MethodEntry& method : methods()) {
    if (method.traits.takes_membranes) names.emplace_back(method.name);
  }
  return listed(names);
}

std::vector<std::string> methodsFor(const std::string& model) {
  std::vector<std::string> fit;
  for (const MethodEntry& method : methods()) {
    const auto& fits = method.models;
    if (std::find(fits.begin(), fits.end(), model) != fits.end()) fit.emplace_back(method.name);
  }
  return fit;
}

std::unique_ptr<TissueModel> makeModel(const TissueConfig& config, const Lattice& lattice) {
  return named(config.model, "tissue.model", models()).make(config, lattice);
}

std::unique_ptr<SolverMethod> makeMethod(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model) {
  return named(config.method, "solver.method", methods()).make(config, lattice, model);
}

}  // namespace robot_tissue
