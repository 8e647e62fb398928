// CourseIn: which nodes are visited.
#include <algorithm>
#include <cmath>

#include "course_in.h"
#include "robot_tissue/core/field_kernel.h"

namespace robot_tissue {
namespace {

constexpr double kMoreLayers = 1.5;  // times those there are

}  // namespace

template <typename Real>
LevelBox CourseIn<Real>::wholeBox() const {
  LevelBox box;
  for (std::size_t axis = 0; axis < 3; ++axis) box.high[axis] = lattice_.size()[axis] - 1;
  return box;
}

// Motion (spacings) of a node below which no layer is raised for it.
template <typename Real>
double CourseIn<Real>::layerMotion() const {
  const double mean = std::sqrt(squared(finest().displacement) / (free_nodes_ + 1.0));
  return std::max(options_.layer_share * options_.tolerance * mean, kStill * options_.tolerance);
}

template <typename Real>
void CourseIn<Real>::addSeed(int entry) {
  const std::array<int, 3> place = finest().placeOf(entry);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    seeds_.low[axis] = std::min(seeds_.low[axis], place[axis]);
    seeds_.high[axis] = std::max(seeds_.high[axis], place[axis]);
  }
}

// The box around nodes in patches and contacts, now and in the last solve, disturbed ones, and
// those that are out of balance: of all nodes, where something else than the last solve has moved
// them.
template <typename Real>
void CourseIn<Real>::findSeeds(const LoadedShape& shape, const PatchHold& hold,
                               const std::vector<int>& disturbed, bool others_moved) {
  seeds_ = {lattice_.size(), {-1, -1, -1}};
  for (const int entry : loaded_) addSeed(entry);
  const auto load = [this](int node) {
    loaded_.push_back(levels_->entryOf(node));
    addSeed(loaded_.back());
  };
  loaded_.clear();
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    for (const int node : hold.hardOf(index)) load(node);
    for (const RimSpring& spring : shape.patches[index].rim) load(spring.node);
  }
  for (const int node : hold.touched()) load(node);
  if (!others_moved && disturbed.empty()) return;
  confine(wholeBox());
  finest().findForces(true);
  for (const int entry : finest().nodesOutOfBalance(layerMotion())) addSeed(entry);
  for (const int node : disturbed) addSeed(levels_->entryOf(node));
}

template <typename Real>
LevelBox CourseIn<Real>::aroundSeeds() const {
  LevelBox box = seeds_;
  if (box.high[0] < 0) return {{1, 1, 1}, {0, 0, 0}};
  const int layers = static_cast<int>(layers_);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::max(0, (box.low[axis] - layers) & ~1);
    box.high[axis] = std::min(lattice_.size()[axis] - 1, (box.high[axis] + layers + 1) & ~1);
  }
  return box;
}

template <typename Real>
void CourseIn<Real>::confine(const LevelBox& box) {
  if (box.low != finest().box().low || box.high != finest().box().high) levels_->confine(box);
}

// Whether layers were raised: the outermost moves by more than layerMotion.
template <typename Real>
bool CourseIn<Real>::raiseLayers() {
  const LevelBox& box = finest().box();
  const LevelGrid& grid = finest().grid();
  const double still = layerMotion();
  const auto moves = [&](int i, int j, int k) {
    double squared = 0.0;
    for (const auto& values : levels_->motion) {
      const double moved = static_cast<double>(values[at(grid.index(i, j, k))]);
      squared += moved * moved;
    }
    return squared > still * still;
  };
  if (box.low == wholeBox().low && box.high == wholeBox().high) return false;
  bool any = false;
  for (int k = box.low[2]; k <= box.high[2]; ++k) {
    for (int j = box.low[1]; j <= box.high[1]; ++j) {
      const bool face = isOutermost(2, k) || isOutermost(1, j);
      for (int i = box.low[0]; !any && i <= box.high[0]; ++i) {
        if (face || isOutermost(0, i)) any = moves(i, j, k);
      }
    }
  }
  if (!any) return false;
  layers_ = std::ceil(kMoreLayers * layers_);
  confine(aroundSeeds());
  return true;
}

// On a side of the box that is none of the lattice's, or next to it.
template <typename Real>
bool CourseIn<Real>::isOutermost(std::size_t axis, int place) const {
  const LevelBox& box = finest().box();
  if (box.low[axis] > 0 && place <= box.low[axis] + 1) return true;
  return box.high[axis] < lattice_.size()[axis] - 1 && place >= box.high[axis] - 1;
}

template <typename Real>
int CourseIn<Real>::nodesInBox(const PatchHold& hold) const {
  if (seeds_.high[0] < 0) return 0;
  const bool whole = finest().box().low == wholeBox().low && finest().box().high == wholeBox().high;
  int count = 0;
  for (std::size_t node = 0; node < hold.held().size(); ++node) {
    if (hold.held()[node] == kAllHeld && hold.carriers()[node] < 0) continue;
    if (whole || finest().box().has(finest().placeOf(levels_->entryOf(static_cast<int>(node))))) {
      ++count;
    }
  }
  return count;
}

// Around the seeds.
template <typename Real>
int CourseIn<Real>::layersRaised() const {
  int layers = 0;
  for (std::size_t axis = 0; seeds_.high[0] >= 0 && axis < 3; ++axis) {
    layers = std::max({layers, seeds_.low[axis] - finest().box().low[axis],
                       finest().box().high[axis] - seeds_.high[axis]});
  }
  return layers;
}

template class CourseIn<float>;
template class CourseIn<double>;

}  // namespace robot_tissue
