// FasCgSolver: which nodes are visited.
#include <algorithm>
#include <cmath>

#include "solvers/multigrid/cycle/fas_cg_solver.h"

namespace robot_tissue {
namespace {

constexpr double kFewestLayers = 4.0, kEnoughLayers = 6.0;  // for a start
constexpr double kLayersOfError = 0.06;                     // layers times the tolerance
constexpr double kMoreLayers = 1.5;                         // times those there are
constexpr double kLeastOfPart = 5e-3;                       // tolerance: below it, all is visited

}  // namespace

// What coarse lattices miss falls about as layers grow.
template <typename Real>
double FasCgSolver<Real>::firstLayers() const {
  return std::clamp(kLayersOfError / options_.tolerance, kFewestLayers, kEnoughLayers);
}

template <typename Real>
void FasCgSolver<Real>::addSeed(int node) {
  const std::array<int, 3>& place = lattice_.gridIndex(cells_->original(node));
  seeds_ = joined(seeds_, {place, place});
}

// The box around nodes in patches and contacts, now and in the last solve, and disturbed ones.
template <typename Real>
void FasCgSolver<Real>::findSeeds(const ConstrainedState& shape, const DofConstraints& hold,
                                  const std::vector<int>& disturbed) {
  seeds_ = {lattice_.size(), {-1, -1, -1}};
  for (const int node : loaded_) addSeed(node);
  const auto load = [this](int node) {
    loaded_.push_back(node);
    addSeed(node);
  };
  loaded_.clear();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    for (const int node : hold.hardOf(index)) load(node);
    for (const RimSpring& spring : shape.patches[index].rim) load(spring.node);
  }
  for (const int node : hold.touched()) load(node);
  for (const int node : disturbed) addSeed(node);
}

template <typename Real>
GridBox FasCgSolver<Real>::aroundSeeds() const {
  if (options_.tolerance < kLeastOfPart) return levels_->whole();
  GridBox box = seeds_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= static_cast<int>(layers_);
    box.high[axis] += static_cast<int>(layers_);
  }
  return box;
}

// Whether more layers are needed, as what is beyond them is not as smooth as coarse lattices are.
template <typename Real>
bool FasCgSolver<Real>::raiseLayers() {
  missed_ = 0.0;
  if (levels_->isWhole()) return false;
  const double moved =
      std::sqrt(squared(finest().displacement) + levels_->squaredDisplacementBeyond());
  if (moved == 0.0) return false;
  missed_ = std::sqrt(levels_->squaredRoughnessBeyond()) / moved;
  if (missed_ <= kMostMissed * options_.tolerance) return false;
  layers_ = std::ceil(kMoreLayers * layers_);
  return true;
}

template <typename Real>
int FasCgSolver<Real>::openNodes(const DofConstraints& hold) const {
  const auto moves = [&hold](std::size_t node) {
    return hold.dirichletMask()[node] != kAllAxes || hold.carriers()[node] >= 0;
  };
  int count = 0;
  if (levels_->isWhole()) {
    for (std::size_t node = 0; node < hold.dirichletMask().size(); ++node)
      count += moves(node) ? 1 : 0;
    return count;
  }
  const GridBox& open = levels_->free();
  for (int k = open.low[2]; k <= open.high[2]; ++k) {
    for (int j = open.low[1]; j <= open.high[1]; ++j) {
      for (int i = open.low[0]; i <= open.high[0]; ++i) {
        count += moves(at(lattice_.node(i, j, k))) ? 1 : 0;
      }
    }
  }
  return count;
}

// Around the seeds.
template <typename Real>
int FasCgSolver<Real>::layersRaised() const {
  int layers = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    layers = std::max({layers, seeds_.low[axis] - levels_->free().low[axis],
                       levels_->free().high[axis] - seeds_.high[axis]});
  }
  return layers;
}

template class FasCgSolver<float>;
template class FasCgSolver<double>;

}  // namespace robot_tissue
