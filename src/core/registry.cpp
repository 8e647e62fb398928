#include "robot_tissue/core/registry.h"

#include "robot_tissue/core/paper_method.h"
#include "robot_tissue/core/six_spring_model.h"

namespace robot_tissue {

const std::vector<std::string>& modelNames() {
  static const std::vector<std::string> names = {"six_spring"};
  return names;
}

const std::vector<std::string>& methodNames() {
  static const std::vector<std::string> names = {"paper"};
  return names;
}

std::unique_ptr<TissueModel> makeModel(const TissueConfig& config, const Lattice& lattice) {
  if (config.model == "six_spring") {
    return std::make_unique<SixSpringModel>(lattice, config.gravity);
  }
  throw InputError("tissue.model: '" + config.model + "' is unknown; allowed: six_spring");
}

std::unique_ptr<SolverMethod> makeMethod(const SolverConfig& config, const Lattice& lattice,
                                         const TissueModel& model) {
  if (config.method == "paper") {
    PaperOptions options;
    options.balance_tolerance = config.tolerance;
    options.max_ms = config.max_ms;
    return std::make_unique<PaperMethod>(lattice, model, options);
  }
  throw InputError("solver.method: '" + config.method + "' is unknown; allowed: paper");
}

}  // namespace robot_tissue
