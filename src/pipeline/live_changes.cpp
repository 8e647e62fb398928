// Pipeline: numbers that change while tools are in the tissue.
#include "landing.h"
#include "pipeline_parts.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "tuning.h"

namespace robot_tissue {

void Pipeline::retune(const TissueConfig& tissue, const SolverConfig& solver) {
  const double before = stiffnessUnderTools();
  if (!world_.tissue.retune(tissue, solver)) return;
  // Pushes of far stiffer tissue would throw this one away: links are met anew.
  if (stiffnessUnderTools() < tuning::kFarSofter * before) world_.sliding.clear();
  landing_ = Landing::ofScene(tissue, solver, supports_);
  balance();
  touch();
}

// Of the nodes of what touches (N/m), all together.
double Pipeline::stiffnessUnderTools() const {
  double sum = 0.0;
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    for (const NodeWeight& carrier : touch.spring.carriers) {
      sum += world_.tissue.nodeStiffness(carrier.node);
    }
  }
  return sum;
}

void Pipeline::setFriction(double friction) {
  world_.tools.setFriction(friction);
  for (std::size_t tool = 0; tool < world_.tools.size(); ++tool) {
    world_.sliding.setFriction(static_cast<int>(tool), friction);
  }
  touch();
}

}  // namespace robot_tissue
