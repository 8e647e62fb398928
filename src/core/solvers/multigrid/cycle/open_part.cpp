#include "solvers/multigrid/cycle/open_part.h"

#include <algorithm>
#include <cmath>

#include "solvers/multigrid/cycle/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = cycle_tuning;

}  // namespace

OpenPart::OpenPart(const Lattice& lattice, double tolerance)
    : lattice_(lattice), tolerance_(tolerance), layers_(firstLayers()) {}

void OpenPart::forget() {
  layers_ = firstLayers();
  forgetLoads();
  missed_ = 0.0;
}

// What coarse levels miss is about inverse to the number of layers.
double OpenPart::firstLayers() const {
  return std::clamp(tuning::kLayersOfError / tolerance_, tuning::kFewestLayers,
                    tuning::kEnoughLayers);
}

void OpenPart::addSeed(const CellSet& cells, int node) {
  const std::array<int, 3> place = lattice_.gridIndex(cells.original(node));
  seeds_ = joined(seeds_, {place, place});
}

void OpenPart::findSeeds(const SolveContext& solve, const std::vector<int>& disturbed) {
  const CellSet& cells = *solve.shape.state.cells;
  seeds_ = {lattice_.size(), {-1, -1, -1}};
  for (const int node : last_seeds_) addSeed(cells, node);
  last_seeds_.clear();
  loaded_.clear();
  for (std::size_t index = 0; index < solve.shape.patches.size(); ++index) {
    const std::vector<int>& hard = solve.hold.hardOf(index);
    loaded_.insert(loaded_.end(), hard.begin(), hard.end());
    for (const RimSpring& spring : solve.shape.patches[index].rim) loaded_.push_back(spring.node);
  }
  const std::vector<int>& touched = solve.hold.touched();
  loaded_.insert(loaded_.end(), touched.begin(), touched.end());
  for (const int node : loaded_) {
    addSeed(cells, node);
    last_seeds_.push_back(cells.original(node));
  }
  for (const int node : disturbed) addSeed(cells, node);
}

GridBox OpenPart::box() const {
  if (tolerance_ < tuning::kLeastOfPart) return wholeOf(lattice_.size());
  GridBox box = seeds_;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.low[axis] -= layers();
    box.high[axis] += layers();
  }
  return box;
}

bool OpenPart::raise(double missed) {
  missed_ = missed;
  if (missed_ <= tuning::kMostMissed * tolerance_) return false;
  layers_ = std::ceil(tuning::kMoreLayers * layers_);
  return true;
}

double OpenPart::allowedError() const {
  const double missed = std::min(missed_, tuning::kMostMissed * tolerance_);
  return std::sqrt(tolerance_ * tolerance_ - missed * missed);
}

int OpenPart::layersIn(const GridBox& open) const {
  int layers = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    layers =
        std::max({layers, seeds_.low[axis] - open.low[axis], open.high[axis] - seeds_.high[axis]});
  }
  return layers;
}

int OpenPart::nodesIn(const GridBox& open, const DofConstraints& hold) const {
  const auto moves = [&hold](std::size_t node) {
    return hold.dirichletMask()[node] != kAllAxes || hold.carrierOf(node) >= 0 ? 1 : 0;
  };
  int count = 0;
  const auto ghosts = at(lattice_.nodeCount());  // which are all in the part
  for (std::size_t node = ghosts; node < hold.dirichletMask().size(); ++node) count += moves(node);
  if (open == wholeOf(lattice_.size())) {
    for (std::size_t node = 0; node < ghosts; ++node) count += moves(node);
    return count;
  }
  for (int k = open.low[2]; k <= open.high[2]; ++k) {
    for (int j = open.low[1]; j <= open.high[1]; ++j) {
      for (int i = open.low[0]; i <= open.high[0]; ++i) count += moves(at(lattice_.node(i, j, k)));
    }
  }
  return count;
}

}  // namespace robot_tissue
