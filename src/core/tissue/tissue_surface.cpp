// The surface that is shown and touched: what the lattice's nodes carry of it.
#include <algorithm>
#include <atomic>
#include <utility>

#include "material/tissue_model.h"
#include "membrane/membrane_plan.h"
#include "robot_tissue/core/method_names.h"
#include "surface/mesh_surface.h"
#include "tissue/tissue_parts.h"

namespace robot_tissue {
namespace {

// A number that no surface has had since the program began.
std::uint64_t newRevision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

void shrinkToFit(TissueSurface& surface) {
  surface.rest.shrink_to_fit();
  surface.carriers.shrinkToFit();
  surface.node.shrink_to_fit();
  surface.triangles.shrink_to_fit();
  surface.opened.shrink_to_fit();
}

}  // namespace

double TissueParts::volumeRatio() const {
  return enclosedVolume(surface_, vertices_) / rest_volume_;
}

// Nodes at rims, and their displacements as patches and tools have them (m); of_tools: where a
// tool's spring is shown off its point.
std::vector<std::pair<int, Vec3>> TissueParts::shownAsTheirOwn(OffPoint of_tools) const {
  std::vector<std::pair<int, Vec3>> own;
  for (const LoadingPatch& patch : patches_) {
    if (!patch.rim.empty()) {
      const std::vector<Vec3> shown = ownDisplacement(patch, state_.displacement);
      for (std::size_t i = 0; i < shown.size(); ++i) own.emplace_back(patch.nodes[i], shown[i]);
    }
    for (const ContactSpring& spring : patch.contacts) {
      const Vec3 off = of_tools(spring, state_.displacement);
      if (off.isZero(0.0)) continue;
      for (const NodeWeight& carrier : spring.carriers) {
        own.emplace_back(carrier.node, state_.displacement[at(carrier.node)] + off);
      }
    }
  }
  return own;
}

std::vector<Vec3> TissueParts::shownDisplacement() const {
  std::vector<Vec3> shown = state_.displacement;
  for (const auto& [node, own] : shownAsTheirOwn(shownOff)) shown[at(node)] = own;
  return shown;
}

void TissueParts::deformSurface(OffPoint of_tools) {
  std::vector<std::pair<int, Vec3>> own = shownAsTheirOwn(of_tools);
  const auto exchange = [&](std::pair<int, Vec3>& of_node) {
    std::swap(state_.displacement[at(of_node.first)], of_node.second);
  };
  std::for_each(own.begin(), own.end(), exchange);
  bounds_ = deform(surface_, state_.displacement, vertices_);
  std::for_each(own.rbegin(), own.rend(), exchange);
}

// On the surface as it was made.
void TissueParts::planMembranes(const TissueConfig& tissue) {
  if (tissue.membranes.empty()) return;
  if (!traitsOfModel(tissue.model).has_membranes || tissue.time) {
    throw InputError("tissue.membranes: allowed with tissue.model " +
                     modelsWith(&ModelTraits::has_membranes) + ", without tissue.time");
  }
  membranes_ = std::make_unique<MembranePlan>(tissue.membranes, surface_, tissue.spacing);
  model_->setMembrane(membranes_->on(surface_));
}

void TissueParts::rebuildSurface() {
  renewTies();
  surface_ = mesh_.triangles.empty() ? extractSurface(lattice_, state_)
                                     : meshSurface(lattice_, state_, mesh_);
  shrinkToFit(surface_);
  surface_.revision = newRevision();
  rest_volume_ = enclosedVolume(surface_, surface_.rest);
  vertices_ = surface_.rest;
  bounds_ = boundsOf(vertices_);
  if (membranes_) model_->setMembrane(membranes_->on(surface_));
  rebindThreads();
}

}  // namespace robot_tissue
