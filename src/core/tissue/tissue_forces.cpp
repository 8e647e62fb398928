// Tissue: forces on it.
#include <algorithm>
#include <optional>

#include "loads/narrow_contact.h"
#include "loads/rim_law.h"
#include "material/tissue_model.h"
#include "solvers/solver_method.h"
#include "tissue/threads.h"
#include "tissue/time_integrator.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {
namespace {

Vec3 forceOfPatches(const SolveReport& report) {
  Vec3 force = Vec3::Zero();
  for (const PatchAnswer& answer : report.patches) force += answer.force;
  return force;
}

// A node with four cells, none of which is filled, or left by cuts, in part alone.
bool isInFlatSurface(const CellSet& cells, int node) {
  if (cells.isGhost(node)) return false;
  int whole = 0;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    if (cells.all()[at(met.cell)].share() < 1.0) return false;
    ++whole;
  }
  return whole == 4;
}

// Whether the full cells beside and below the node are all of the same: a ball feels a layer that
// begins a spacing below it otherwise than a half-space.
bool isUniformAround(const CellSet& cells, const TissueModel& model, int node) {
  std::optional<Moduli> all;
  const auto is_other = [&](const Cell& cell) {
    if (cell.share() < 1.0) return false;
    const Moduli moduli = model.moduliIn(cell);
    if (!all) all = moduli;
    return moduli.shear != all->shear || moduli.bulk != all->bulk;
  };
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    for (const int corner : cells.all()[at(met.cell)].nodes) {
      for (const CellSet::Meeting& beside : cells.meetings(corner)) {
        if (is_other(cells.all()[at(beside.cell)])) return false;
      }
    }
  }
  return true;
}

// Of named loads. What moves as one piece gives way otherwise than a node by itself.
bool isInOne(const StandingLoads& loads, int node) {
  const std::vector<LoadingPatch>& patches = loads.patches();
  const auto end = patches.begin() + static_cast<std::ptrdiff_t>(loads.named());
  return std::any_of(patches.begin(), end, [node](const LoadingPatch& patch) {
    return std::find(patch.nodes.begin(), patch.nodes.end(), node) != patch.nodes.end();
  });
}

}  // namespace

Vec3 TissueParts::nodeForce(int node) const {
  return body_.model().nodeForce(body_.state(), node) +
         threads_.forceOn(node, body_.displacement());
}

// What pulls at all of a piece's nodes is its weight, as its cells' forces add up to zero.
Vec3 TissueParts::weight() const {
  const std::vector<int> hanging = hangingNodes();
  if (hanging.empty()) return body_.weight();
  Vec3 weight = body_.weight();
  for (const Vec3& force : body_.model().forcesOn(body_.state(), hanging)) weight -= force;
  return weight;
}

// Sum of what holds the fixed nodes: minus the forces of the tissue and of springs in contact on
// them. Where the method does not visit all nodes: by the balance of all forces.
Vec3 TissueParts::forceOfFixedNodes() const {
  if (methods_.now().visited() != nullptr) {
    const Vec3 left = outcome_.is_as_solved ? methods_.now().forceLeft() : Vec3(Vec3::Zero());
    return left - weight() - forceOfPatches(outcome_.report);
  }
  const CellSet& cells = body_.cells();
  std::vector<int> fixed;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (isFixed(body_.lattice(), cells, node)) fixed.push_back(node);
  }
  const std::vector<Vec3> on_fixed = body_.model().forcesOn(body_.state(), fixed);
  Vec3 force = Vec3::Zero();
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    force -= on_fixed[i] + threads_.forceOn(fixed[i], body_.displacement());
  }
  for (const LoadingPatch& patch : loads_.patches()) {
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) {
        if (!isFixed(body_.lattice(), cells, carrier.node)) continue;
        force -= carrier.weight * robot_tissue::forceOf(spring, body_.displacement());
      }
    }
  }
  return force;
}

std::optional<RimCompliance> TissueParts::rimCompliance(int node, double depth) const {
  if (!methods_.now().findsEquilibrium()) return std::nullopt;
  const CellSet& cells = body_.cells();
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    if (body_.lattice().cells()[at(cells.all()[at(met.cell)].place)].share() < 1.0)
      return std::nullopt;
  }
  const Moduli moduli = body_.model().moduliAt(body_.state(), node);
  if (moduli.shear <= 0.0) return std::nullopt;
  const RimLaw law = rimLaw(poissonRatio(moduli));
  const double unit = moduli.shear * body_.lattice().spacing();
  const auto compliance = [&](const RimMode& mode) {
    return 1.0 / (unit * rimStiffness(mode, depth));
  };
  return RimCompliance{compliance(law.across), compliance(law.along), compliance(law.normal)};
}

std::optional<Recess> TissueParts::recessUnder(const BallPress& press) const {
  if (!methods_.now().findsEquilibrium()) return std::nullopt;
  const CellSet& cells = body_.cells();
  for (const NodeWeight& share : press.shares) {
    if (!isInFlatSurface(cells, share.node)) return std::nullopt;
    if (isInOne(loads_, share.node)) return std::nullopt;
    if (!isUniformAround(cells, body_.model(), share.node)) return std::nullopt;
  }
  const Moduli moduli = body_.model().moduliAt(body_.state(), press.shares.front().node);
  if (moduli.shear <= 0.0) return std::nullopt;
  return robot_tissue::recessUnder(press, body_.lattice(), {moduli.shear, poissonRatio(moduli)});
}

double TissueParts::stiffening(int node) const {
  const bool is_solved = motion_.expectsTimeStep() && !goesThroughTime();
  const double stiffness = is_solved ? body_.nodeStiffness(node) : 0.0;
  if (!(stiffness > 0.0)) return 1.0;
  const TimeIntegrator& integrator = motion_.integrator();
  return integrator.stiffness().elastic_scale + integrator.inertia(node) / stiffness;
}

}  // namespace robot_tissue
