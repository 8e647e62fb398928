// RelaxationMethod: how slow the slowest wave is, and how far time takes the nodes.
#include <algorithm>
#include <cmath>

#include "solvers/baselines/relaxation_method.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {
namespace {

constexpr double kPi = 3.14159265358979;

}  // namespace

// Fixed nodes; without any, hard nodes of the first patch that has some.
std::vector<int> RelaxationMethod::heldNodes() const {
  const CellSet& cells = *shape_.state.cells;
  std::vector<int> held;
  for (int node = 0; node < cells.nodeCount(); ++node) {
    if (isFixed(lattice_, cells, node)) held.push_back(node);
  }
  for (std::size_t patch = 0; held.empty() && patch < shape_.patches.size(); ++patch) {
    held = hold_.hardOf(patch);
  }
  return held;
}

// Depth: cells from what holds the tissue to what is farthest from it, breadth first. It tells how
// slow the slowest wave is.
void RelaxationMethod::findDepth() {
  const CellSet& cells = *shape_.state.cells;
  std::vector<int> layer = heldNodes(), next;
  if (depth_of_ == shape_.state.cells && depth_from_ == layer) return;
  depth_of_ = shape_.state.cells;
  depth_from_ = layer;
  std::vector<std::uint8_t> seen(at(cells.nodeCount()), 0);
  for (const int node : layer) seen[at(node)] = 1;
  for (depth_ = 0.0; !layer.empty(); layer.swap(next)) {
    next.clear();
    for (const int node : layer) {
      for (const CellSet::Meeting& met : cells.meetings(node)) {
        for (const int other : cells.all()[at(met.cell)].nodes) {
          if (seen[at(other)] != 0) continue;
          seen[at(other)] = 1;
          next.push_back(other);
        }
      }
    }
    if (!next.empty()) depth_ += 1.0;
  }
  depth_ = std::max(depth_, 1.0);
  // Eigenvalue of a shear wave with a quarter of its length in the depth, over a node's stiffness:
  // mu h (pi / 2 depth)^2 / (h (17/6 mu + K/2)), as ElasticModel::nodeStiffness is inside the
  // tissue. Where moduli differ: the harmonic mean of mu above, as soft cells move most; plain
  // means below.
  const double wave = soft_shear_ * std::pow(0.5 * kPi / depth_, 2);
  shear_wave_ = wave / (17.0 / 6.0 * mean_.shear + 0.5 * mean_.bulk);
}

// A time step adds i = per_mass m to every node's stiffness e, and to that of every wave.
void RelaxationMethod::findWave() {
  wave_ = shear_wave_;
  const InertialTerm* inertia = model_.inertia();
  if (inertia == nullptr) return;
  const double h = lattice_.spacing();
  const double e = inertia->elastic_scale * h * (17.0 / 6.0 * mean_.shear + 0.5 * mean_.bulk);
  const double i = inertia->per_mass * mean_density_ * h * h * h;
  wave_ = (shear_wave_ * e + i) / (e + i);
}

// Rayleigh's quotient of the way d since forces were looked at before, d.(change of force) / d.D d
// with D the nodes' stiffness: the eigenvalue of the wave that the shape still moves in.
void RelaxationMethod::lookAtWave(WaveLook look) {
  QuotientSums sums;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    addQuotient(field_->size(), field_->moved()[axis], field_->force()[axis], field_->compliance(),
                field_->free()[axis], field_->spare(kLooked)[axis],
                field_->spare(kLookedForce)[axis], sums);
  }
  if (look == WaveLook::kFirst || !(sums.work > 0.0 && sums.mass > 0.0)) return;
  seen_wave_ = std::min(seen_wave_, std::max(sums.work / sums.mass, tuning::kLeastWave));
}

// From where the nodes would go without forces, in a time step (m).
double RelaxationMethod::wayByForces() const {
  double squared = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float* now = field_->moved()[axis];
    const float* free = field_->free()[axis];
    const float* from = field_->spare(SoaField::kFreeMotion)[axis];
    for (int slot = 0; slot < field_->size(); ++slot) {
      const double way = static_cast<double>(free[slot] * (now[slot] - from[slot]));
      squared += way * way;
    }
  }
  return field_->unit() * std::sqrt(squared);
}

}  // namespace robot_tissue
