// The surface that is shown and touched: what the lattice's nodes carry of it.
#include <algorithm>
#include <atomic>
#include <utility>

#include "robot_tissue/core/tissue.h"
#include "surface/mesh_surface.h"

namespace robot_tissue {
namespace {

// A number that no surface has had since the program began.
std::uint64_t newRevision() {
  static std::atomic<std::uint64_t> last{0};
  return ++last;
}

}  // namespace

double Tissue::volumeRatio() const { return enclosedVolume(surface_, vertices_) / rest_volume_; }

std::vector<Vec3> Tissue::shownDisplacement() const {
  std::vector<Vec3> shown = state_.displacement;
  for (const LoadingPatch& patch : patches_) {
    if (patch.rim.empty()) continue;
    const std::vector<Vec3> own = ownDisplacement(patch, state_.displacement);
    for (std::size_t i = 0; i < own.size(); ++i) shown[at(patch.nodes[i])] = own[i];
  }
  return shown;
}

// Where patches have rims their nodes are shown as their own (shownDisplacement).
void Tissue::deformSurface() {
  std::vector<std::pair<int, Vec3>> own;
  for (const LoadingPatch& patch : patches_) {
    if (patch.rim.empty()) continue;
    const std::vector<Vec3> shown = ownDisplacement(patch, state_.displacement);
    for (std::size_t i = 0; i < shown.size(); ++i) own.emplace_back(patch.nodes[i], shown[i]);
  }
  const auto exchange = [&](std::pair<int, Vec3>& of_node) {
    std::swap(state_.displacement[at(of_node.first)], of_node.second);
  };
  std::for_each(own.begin(), own.end(), exchange);
  bounds_ = deform(surface_, state_.displacement, vertices_);
  std::for_each(own.rbegin(), own.rend(), exchange);
}

void Tissue::rebuildSurface() {
  surface_ = mesh_.triangles.empty() ? extractSurface(lattice_, state_)
                                     : meshSurface(lattice_, state_, mesh_);
  surface_.revision = newRevision();
  rest_volume_ = enclosedVolume(surface_, surface_.rest);
  vertices_ = surface_.rest;
  bounds_ = boundsOf(vertices_);
  rebindThreads();
}

}  // namespace robot_tissue
