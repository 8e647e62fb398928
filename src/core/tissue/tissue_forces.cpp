#include "tissue/tissue_forces.h"

#include "loads/narrow_contact.h"
#include "loads/tool_bed.h"
#include "material/elastic_model.h"
#include "material/tissue_model.h"

namespace robot_tissue {
namespace {

Vec3 forceOfPatches(const SolveReport& report) {
  Vec3 force = Vec3::Zero();
  for (const PatchAnswer& answer : report.patches) force += answer.force;
  return force;
}

}  // namespace

Vec3 TissueForces::nodeForce(int node) const {
  return data_.body.model().nodeForce(data_.body.state(), node) +
         data_.threads.forceOn(node, data_.body.displacement());
}

// What pulls at all of a piece's nodes is its weight, as its cells' forces add up to zero.
Vec3 TissueForces::weight() const {
  const std::vector<int> hanging = data_.hangingNodes();
  if (hanging.empty()) return data_.body.weight();
  Vec3 weight = data_.body.weight();
  for (const Vec3& force : data_.body.model().forcesOn(data_.body.state(), hanging))
    weight -= force;
  return weight;
}

// Sum of what holds the fixed nodes: minus the forces of the tissue and of springs in contact on
// them. Where the method does not visit all nodes: by the balance of all forces.
Vec3 TissueForces::forceOfFixedNodes() const {
  if (data_.methods.now().visited() != nullptr) {
    const Vec3 left =
        data_.outcome.is_as_solved ? data_.methods.now().forceLeft() : Vec3(Vec3::Zero());
    return left - weight() - forceOfPatches(data_.outcome.report);
  }
  const CellSet& cells = data_.body.cells();
  std::vector<int> fixed;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (isFixed(data_.body.lattice(), cells, node)) fixed.push_back(node);
  }
  const std::vector<Vec3> on_fixed = data_.body.model().forcesOn(data_.body.state(), fixed);
  Vec3 force = Vec3::Zero();
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    force -= on_fixed[i] + data_.threads.forceOn(fixed[i], data_.body.displacement());
  }
  for (const LoadingPatch& patch : data_.loads.patches()) {
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) {
        if (!isFixed(data_.body.lattice(), cells, carrier.node)) continue;
        force -= carrier.weight * robot_tissue::forceOf(spring, data_.body.displacement());
      }
    }
  }
  return force;
}

double TissueForces::stiffening(int node) const {
  const bool is_solved = data_.motion.expectsTimeStep() && !data_.goesThroughTime();
  const double stiffness = is_solved ? data_.body.nodeStiffness(node) : 0.0;
  if (!(stiffness > 0.0)) return 1.0;
  const TimeIntegrator& integrator = data_.motion.integrator();
  return integrator.stiffness().elastic_scale + integrator.inertia(node) / stiffness;
}

std::optional<RimModuli> TissueForces::rimModuli(int node) const {
  if (!data_.methods.now().findsEquilibrium()) return std::nullopt;
  const CellSet& cells = data_.body.cells();
  double eighths = 0.0;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    eighths += cells.all()[at(met.cell)].eighthsAt(static_cast<int>(met.corner));
  }
  const Moduli moduli = data_.body.model().moduliAt(data_.body.state(), node);
  if (moduli.shear <= 0.0 || eighths <= 0.0) return std::nullopt;
  const double of_four_cells = moduli.shear * data_.body.lattice().spacing();
  return RimModuli{of_four_cells * 4.0 / eighths, poissonRatio(moduli)};
}

// On the surface of full cells; where materials meet, as the node has cells of each.
std::optional<RimCompliance> TissueForces::rimCompliance(int node, double depth) const {
  if (!data_.methods.now().findsEquilibrium()) return std::nullopt;
  const CellSet& cells = data_.body.cells();
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    if (data_.body.lattice().cells()[at(cells.all()[at(met.cell)].place)].share() < 1.0)
      return std::nullopt;
  }
  const Moduli moduli = data_.body.model().moduliAt(data_.body.state(), node);
  if (moduli.shear <= 0.0) return std::nullopt;
  const double unit = moduli.shear * data_.body.lattice().spacing();
  return robot_tissue::rimCompliance({unit, poissonRatio(moduli)}, depth);
}

Vec3 TissueForces::inwardsAround(const SurfacePoint& point, const Vec3& middle) const {
  return surfaces_.inwardsAround(point, middle, data_.body);
}

std::vector<RimSpring> TissueForces::springsUnder(const std::vector<SeatedNode>& nodes) const {
  if (!data_.methods.now().findsEquilibrium()) return {};
  return bedOf(data_.body.lattice(), data_.body.model(), data_.body.state(), nodes);
}

std::optional<Recess> TissueForces::recessUnder(const NarrowPress& press) const {
  const auto* elastic = dynamic_cast<const ElasticModel*>(&data_.body.model());
  if (elastic == nullptr || !data_.methods.now().findsEquilibrium()) return std::nullopt;
  const std::optional<PressedSurface> surface =
      surfaces_.under(press, data_.body, *elastic, data_.loads.patches());
  return surface ? std::optional<Recess>(robot_tissue::recessUnder(press, *surface)) : std::nullopt;
}

}  // namespace robot_tissue
