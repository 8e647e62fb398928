#include "tissue/registry.h"

#include "material/elastic_model.h"
#include "material/six_spring_model.h"
#include "solvers/baselines/explicit_method.h"
#include "solvers/baselines/vbd_method.h"
#include "solvers/baselines/xpbd_method.h"
#include "solvers/multigrid/cycle/layered_method.h"
#include "solvers/newton/newton_method.h"
#include "solvers/paper/paper_method.h"

namespace robot_tissue {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list;
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

const ElasticModel& requireElastic(const TissueModel& model, const std::string& method) {
  if (const auto* elastic = dynamic_cast<const ElasticModel*>(&model)) return *elastic;
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

}  // namespace

const std::vector<std::string>& modelNames() {
  static const std::vector<std::string> names = {"elastic", "six_spring"};
  return names;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"layered", "newton", "paper",
                                                 "vbd",     "xpbd",   "explicit"};
  return names;
}

// The six-spring lattice holds many shapes without a force: no method can name its equilibrium. The
// paper's method moves along springs, which do not reach the ghosts that cuts give the cells.
std::vector<std::string> methodsFor(const std::string& model) {
  if (model == "six_spring") return {"paper"};
  return {"layered", "newton", "vbd", "xpbd", "explicit"};
}

std::unique_ptr<TissueModel> makeModel(const TissueConfig& config, const Lattice& lattice) {
  if (config.model == "six_spring") {
    return std::make_unique<SixSpringModel>(lattice, config.gravity);
  }
  if (config.model == "elastic") return std::make_unique<ElasticModel>(lattice, config);
  throw InputError("tissue.model: '" + config.model +
                   "' is unknown; allowed: " + listed(modelNames()));
}

std::unique_ptr<SolverMethod> makeMethod(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model) {
  if (config.method == "layered") return makeLayered(config, lattice, model);
  if (config.method == "paper") return makePaper(config, lattice, model);
  if (config.method == "explicit") return makeExplicit(config, lattice, model);
  if (config.method == "xpbd") return makeXpbd(config, lattice, model);
  if (config.method == "vbd") return makeVbd(config, lattice, model);
  if (config.method == "newton") return makeNewton(config, lattice, model);
  throw InputError("solver.method: '" + config.method +
                   "' is unknown; allowed: " + listed(methodNames()));
}

}  // namespace robot_tissue
