// SoaField: what its kernels do, color after color, and the odd cells beside them.
#include <algorithm>

#include "material/elastic_law.h"
#include "solvers/baselines/soa_field.h"
#include "solvers/baselines/tuning.h"

namespace robot_tissue {
namespace {

constexpr float kSqueezed = static_cast<float>(elastic_law::kSqueezed);
// Of the colors: of all orders one of those whose over-relaxed sweeps converge fastest (over waves
// in an endless lattice at rest; doc/baselines.md).
constexpr int kOrder[kColors] = {0, 1, 7, 2, 5, 3, 6, 4};

}  // namespace

bool SoaField::findSqueezed() {
  const SoaArrays arrays = lanes(free_);
  bool unexpected = false;
  std::fill(squeezed_nodes_.begin(), squeezed_nodes_.end(), 0);
  for (int color = 0; color < kColors; ++color) {
    const ColoredLayout::Around& above = grid_.around(color)[kCorners - 1];
    for (const int block : cell_blocks_[at(color)]) {
      squeezeOfBlock(arrays, above, block, tightest_);
      const auto tightest = std::min_element(tightest_ + block, tightest_ + block + kLanes);
      std::uint8_t& squeezed = squeezed_cells_[at(block / kLanes)];
      unexpected = unexpected || (squeezed == 0 && *tightest < kSqueezed);
      squeezed = *tightest < tuning::kSoonSqueezed ? 1 : 0;
      if (squeezed == 0) continue;
      for (const int corner : above.corner) {
        squeezed_nodes_[at((block + corner) / kLanes)] = 1;
        squeezed_nodes_[at((block + corner + kLanes - 1) / kLanes)] = 1;
      }
    }
  }
  return unexpected;
}

SoaArrays SoaField::lanes(const Arrays& free) const {
  SoaArrays lanes{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lanes.moved[axis] = moved_[axis];
    lanes.load[axis] = load_[axis];
    lanes.free[axis] = free[axis];
  }
  lanes.shear = shear_;
  lanes.bulk = bulk_;
  lanes.stiffening = stiffening_;
  return lanes;
}

void SoaField::relax(float relaxation, float most) {
  const SoaArrays arrays = lanes(lane_free_);
  for (const int color : kOrder) {
    for (const int block : node_blocks_[at(color)]) {
      const int springs = springs_of_block_[at(block / kLanes)];
      relaxBlock(arrays, grid_.around(color), block, springs < 0 ? nullptr : &springs_[at(springs)],
                 squeezed_nodes_[at(block / kLanes)] != 0, relaxation, most);
    }
  }
}

void SoaField::findSoftness(float* softness) const {
  const SoaArrays arrays = lanes(lane_free_);
  for (int color = 0; color < kColors; ++color) {
    for (const int block : node_blocks_[at(color)]) {
      const int springs = springs_of_block_[at(block / kLanes)];
      softnessOfBlock(arrays, grid_.around(color), block,
                      springs < 0 ? nullptr : &springs_[at(springs)],
                      squeezed_nodes_[at(block / kLanes)] != 0, softness);
    }
  }
}

void SoaField::project(const Arrays& mobility, const SoaDamping* damping) {
  const SoaArrays arrays = lanes(free_);
  for (int color = 0; color < kColors; ++color) {
    const ColoredLayout::Around& above = grid_.around(color)[kCorners - 1];
    for (const int block : cell_blocks_[at(color)]) {
      projectBlock(arrays, mobility.data(), above, block, squeezed_cells_[at(block / kLanes)] != 0,
                   damping);
    }
  }
}

void SoaField::findForces(const LatticeState& state) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::copy(load_[axis], load_[axis] + size_, force_[axis]);
  }
  for (std::size_t block = 0; block < springs_of_block_.size(); ++block) {
    const int springs = springs_of_block_[block];
    if (springs < 0) continue;
    addSpringForces(lanes(free_), springs_[at(springs)], static_cast<int>(block) * kLanes,
                    force_.data());
  }
  const SoaArrays arrays = lanes(free_);
  for (int color = 0; color < kColors; ++color) {
    const ColoredLayout::Around& above = grid_.around(color)[kCorners - 1];
    for (const int block : cell_blocks_[at(color)]) {
      addForcesOfBlock(arrays, above, block, squeezed_cells_[at(block / kLanes)] != 0,
                       force_.data());
    }
  }
  if (odd_cells_.empty()) return;
  for (const int node : watched_) scratch_[at(node)].setZero();
  if (inertia_ != nullptr || model_.inertia() == nullptr) {
    model_.addForces(state, odd_cells_, scratch_);
  } else {
    model_.addElasticForces(state, odd_cells_, scratch_);
    for (const int index : odd_cells_) {
      const Cell& cell = cells_->all()[at(index)];
      for (int corner = 0; corner < kCorners; ++corner) {
        scratch_[at(cell.nodes[at(corner)])] += model_.cornerWeight(cell, corner);
      }
    }
  }
  for (const int node : watched_) {
    for (int axis = 0; axis < 3; ++axis) {
      force_[at(axis)][slotOf(node)] += static_cast<float>(scratch_[at(node)][axis] / force_unit_);
    }
  }
}

Vec3 SoaField::forceOn(int node) const {
  const int slot = slotOf(node);
  return force_unit_ * Vec3(static_cast<double>(force_[0][slot]),
                            static_cast<double>(force_[1][slot]),
                            static_cast<double>(force_[2][slot]));
}

void SoaField::addForce(int node, const Vec3& force) {
  for (int axis = 0; axis < 3; ++axis) {
    force_[at(axis)][slotOf(node)] += static_cast<float>(force[axis] / force_unit_);
  }
}

}  // namespace robot_tissue
