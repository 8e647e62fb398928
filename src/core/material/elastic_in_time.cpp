// ElasticModel in a time step: what inertia and damping add (inertial_term.h, viscosity.h).
#include "material/elastic_model.h"
#include "material/reached_displacements.h"

namespace robot_tissue {

double ElasticModel::cornerInertia(const Cell& cell, int corner) const {
  return inertia_ == nullptr || corner >= kCorners ? 0.0
                                                   : inertia_->per_mass * cornerMass(cell, corner);
}

void ElasticModel::addInertia(const Cell& cell, CellHessian& hessian) const {
  for (int corner = 0; corner < kCorners; ++corner) {
    hessian.diagonal().segment<3>(3 * corner).array() += cornerInertia(cell, corner);
  }
}

Vec3 ElasticModel::inertialForce(int node) const {
  return inertia_ == nullptr ? Vec3(Vec3::Zero()) : inertia_->force[at(node)];
}

void ElasticModel::damp(const Cell& cell, ElasticCell& shape) const {
  const Moduli moduli = cellModuli(cell);
  const double viscosity = inertia_->viscosity();
  const ElasticCell from(moduli, lattice_.spacing(), reachedOf(inertia_->rate_from, cell),
                         cell.fill.get(), cell.reach.get());
  shape.damp({viscosity * moduli.shear, viscosity * moduli.bulk, 0.0}, from);
}

}  // namespace robot_tissue
