#include "tissue/body.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <utility>

#include "cutting/split_cells.h"
#include "material/tissue_model.h"
#include "robot_tissue/core/body_load.h"
#include "robot_tissue/core/method_names.h"
#include "surface/mesh_surface.h"
#include "tissue/registry.h"

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

Body::Body(const TissueConfig& tissue)
    : lattice_(tissue),
      state_(lattice_.restState()),
      model_(makeModel(tissue, lattice_)),
      has_body_load_(robot_tissue::hasBodyLoad(tissue)),
      gravity_(tissue.gravity) {
  if (tissue.mesh) mesh_ = refined(*tissue.mesh, tissue.spacing);
  rebuildSurface();
  planMembranes(tissue);
  weigh();
}

Body::~Body() = default;

Tissue::Displacements Body::displacements() const {
  if (!kept_) kept_ = std::make_shared<const std::vector<Vec3>>(state_.displacement);
  return kept_;
}

LatticeState& Body::change() {
  kept_.reset();
  return state_;
}

std::unique_ptr<TissueModel> Body::remake(const TissueConfig& tissue) {
  lattice_.weigh(tissue);
  std::unique_ptr<TissueModel> earlier = std::exchange(model_, makeModel(tissue, lattice_));
  if (membranes_) {
    membranes_ =
        std::make_unique<MembranePlan>(tissue.membranes, membranes_->asMade(), tissue.spacing);
    model_->setMembrane(membranes_->on(surface_));
  }
  return earlier;
}

void Body::weigh() { weight_ = model_->weight(state_); }

double Body::volumeRatio() const { return enclosedVolume(surface_, vertices_) / rest_volume_; }

void Body::rebuildSurface() {
  surface_ = mesh_.triangles.empty() ? extractSurface(lattice_, state_)
                                     : meshSurface(lattice_, state_, mesh_);
  shrinkToFit(surface_);
  surface_.revision = newRevision();
  rest_volume_ = enclosedVolume(surface_, surface_.rest);
  showRest();
  if (membranes_) model_->setMembrane(membranes_->on(surface_));
}

void Body::showRest() {
  vertices_ = surface_.rest;
  bounds_ = boundsOf(vertices_);
}

// Nodes at rims, and their displacements as patches and tools have them (m), the last of a node
// counts; of_tools: where a tool's spring is shown off its point. Of several at a node, as of a
// tool's edge and of its side, the one counts that is farthest off.
std::vector<std::pair<int, Vec3>> Body::shownAsTheirOwn(const std::vector<LoadingPatch>& patches,
                                                        OffPoint of_tools) const {
  std::vector<std::pair<int, Vec3>> own, offs;
  for (const LoadingPatch& patch : patches) {
    if (!patch.rim.empty()) {
      const std::vector<Vec3> shown = ownDisplacement(patch, state_.displacement);
      for (std::size_t i = 0; i < shown.size(); ++i) own.emplace_back(patch.nodes[i], shown[i]);
    }
    for (const ContactSpring& spring : patch.contacts) {
      const Vec3 off = of_tools(spring, state_.displacement);
      if (off.isZero(0.0) && spring.carrier_ways.empty()) continue;
      for (std::size_t i = 0; i < spring.carriers.size(); ++i) {
        const double way = spring.carrier_ways.empty() ? 0.0 : spring.carrier_ways[i];
        offs.emplace_back(spring.carriers[i].node, off + way * spring.normal);
      }
    }
  }
  std::stable_sort(offs.begin(), offs.end(), [](const auto& one, const auto& other) {
    return one.second.squaredNorm() < other.second.squaredNorm();
  });
  for (const auto& [node, off] : offs) own.emplace_back(node, state_.displacement[at(node)] + off);
  return own;
}

std::vector<Vec3> Body::shownDisplacement(const std::vector<LoadingPatch>& patches) const {
  std::vector<Vec3> shown = state_.displacement;
  for (const auto& [node, own] : shownAsTheirOwn(patches, shownOff)) shown[at(node)] = own;
  return shown;
}

void Body::deform(const std::vector<LoadingPatch>& patches, OffPoint of_tools) {
  std::vector<std::pair<int, Vec3>> own = shownAsTheirOwn(patches, of_tools);
  const auto exchange = [&](std::pair<int, Vec3>& of_node) {
    std::swap(state_.displacement[at(of_node.first)], of_node.second);
  };
  std::for_each(own.begin(), own.end(), exchange);
  bounds_ = robot_tissue::deform(surface_, state_.displacement, vertices_);
  std::for_each(own.rbegin(), own.rend(), exchange);
}

// On the surface as it was made.
void Body::planMembranes(const TissueConfig& tissue) {
  if (tissue.membranes.empty()) return;
  if (!traitsOfModel(tissue.model).has_membranes || tissue.time) {
    throw InputError("tissue.membranes: allowed with tissue.model " +
                     modelsWith(&ModelTraits::has_membranes) + ", without tissue.time");
  }
  membranes_ = std::make_unique<MembranePlan>(tissue.membranes, surface_, tissue.spacing);
  model_->setMembrane(membranes_->on(surface_));
}

std::vector<int> Body::freeNodes() const {
  std::vector<int> nodes;
  for (int node = 0; node < lattice_.nodeCount(); ++node) {
    if (!lattice_.isFixed(node) && !isRemoved(state_, node)) nodes.push_back(node);
  }
  return nodes;
}

Vec3 Body::nodePosition(int node) const {
  return restPosition(lattice_, *state_.cells, node) + state_.displacement[at(node)];
}

double Body::nodeStiffness(int node) const { return model_->nodeStiffness(state_, node).mean(); }

}  // namespace robot_tissue
