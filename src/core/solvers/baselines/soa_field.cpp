#include "solvers/baselines/soa_field.h"

#include <algorithm>
#include <new>
#include <utility>

namespace robot_tissue {
namespace {

constexpr int kArrays = 3 * (5 + kSpareArrays) + 4;
constexpr std::size_t kAlignment = 4096;
// Blocks between arrays beyond whole pages: what stands in the same place of several arrays must
// not fall on the same lines of the cache.
constexpr int kApart = 5;

bool isLane(const CellSet& cells, const Cell& cell) {
  return cell.fill == nullptr && std::none_of(cell.nodes.begin(), cell.nodes.end(),
                                              [&](int node) { return cells.isGhost(node); });
}

}  // namespace

SoaField::SoaField(const Lattice& lattice, const ElasticModel& model, Inertia inertia)
    : lattice_(lattice),
      model_(model),
      grid_(lattice),
      unit_(4.0 * lattice.spacing()),
      takes_inertia_(inertia) {
  for (const Cell& cell : lattice.cells()) {
    const Moduli moduli = model.cellModuli(cell);
    rest_modulus_ = std::max({rest_modulus_, moduli.shear, moduli.bulk});
    stiffens_ = stiffens_ || moduli.stiffening > 0.0;
  }
  takeInertia();
}

// Moduli are stored over the greatest: what a time step scales all of them by is in the units.
void SoaField::takeInertia() {
  inertia_ = takes_inertia_ == Inertia::kOfTimeSteps ? model_.inertia() : nullptr;
  modulus_ = rest_modulus_ * (inertia_ == nullptr ? 1.0 : inertia_->elastic_scale);
  force_unit_ = modulus_ * lattice_.spacing() * lattice_.spacing() / 4.0;
}

void SoaField::bind(const ConstrainedState& shape, const DofConstraints& patch_hold) {
  std::vector<int> loads;
  for (std::size_t node = 0; node < shape.state.displacement.size(); ++node) {
    loads.push_back(patch_hold.carrierOf(node));
  }
  loads.insert(loads.end(), patch_hold.touched().begin(), patch_hold.touched().end());
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& spring : patch.rim) loads.push_back(spring.node);
    loads.push_back(-1);
  }
  const bool same_cells = cells_ == shape.state.cells;
  const bool was_in_time = inertia_ != nullptr;
  takeInertia();
  const bool in_time = inertia_ != nullptr;
  const bool same = same_cells && held_ == patch_hold.dirichletMask() && loads_ == loads &&
                    !in_time && !was_in_time;
  if (!same_cells) layOut(shape);
  if (!same_cells || in_time || was_in_time) findCompliance(shape);
  if (!same) hold(shape, patch_hold);
  held_ = patch_hold.dirichletMask();
  loads_ = std::move(loads);
  take(shape.state, all_);
  if (same) {
    takeRims(shape);
  } else {
    sortOut(shape, patch_hold);
  }
  findSqueezed();
}

void SoaField::allocate() {
  constexpr int kPage = static_cast<int>(kAlignment / sizeof(float));
  const int pitch = (size_ + kPage - 1) / kPage * kPage + kApart * kLanes;
  const int more = (stiffens_ ? 1 : 0) + (model_.movesInTime() ? 3 : 0);
  const std::size_t floats = at(pitch) * at(kArrays + more);
  const std::size_t bytes = sizeof(float) * floats;
  buffer_.reset(static_cast<float*>(
      std::aligned_alloc(kAlignment, (bytes + kAlignment - 1) / kAlignment * kAlignment)));
  if (buffer_ == nullptr) throw std::bad_alloc();
  float* next = buffer_.get();
  std::fill(next, next + floats, 0.0F);
  const auto take_array = [&](float*& array) {
    array = next;
    next += pitch;
  };
  for (Arrays* arrays : {&moved_, &load_, &free_, &lane_free_, &force_}) {
    for (float*& array : *arrays) take_array(array);
  }
  for (float** array : {&shear_, &bulk_, &compliance_, &tightest_}) take_array(*array);
  for (int spare = 0; spare < kSpareArrays + (model_.movesInTime() ? 1 : 0); ++spare) {
    for (float*& array : spare_[at(spare)]) take_array(array);
  }
  if (stiffens_) take_array(stiffening_);
}

void SoaField::layOut(const ConstrainedState& shape) {
  cells_ = shape.state.cells;
  size_ = grid_.slotCount(static_cast<int>(cells_->ghosts().size()));
  allocate();
  slots_.clear();
  for (int node = 0; node < cells_->nodeCount(); ++node) {
    slots_.push_back(cells_->isGhost(node) ? grid_.ghostSlot(node - cells_->latticeNodeCount())
                                           : grid_.slotAt(lattice_.gridIndex(node)));
  }
  lane_cells_.clear();
  odd_cells_.clear();
  for (std::size_t index = 0; index < cells_->all().size(); ++index) {
    const bool lane = isLane(*cells_, cells_->all()[index]);
    (lane ? lane_cells_ : odd_cells_).push_back(static_cast<int>(index));
  }
  squeezed_cells_.assign(at(size_ / kLanes), 0);
  squeezed_nodes_.assign(at(size_ / kLanes), 0);
  all_.resize(slots_.size());
  for (std::size_t node = 0; node < all_.size(); ++node) all_[node] = static_cast<int>(node);
  scratch_.assign(slots_.size(), Vec3::Zero());
  springs_of_block_.assign(at(size_ / kLanes), -1);
}

void SoaField::findCompliance(const ConstrainedState& shape) {
  const std::vector<double> masses =
      inertia_ == nullptr ? std::vector<double>() : model_.nodeMasses(*cells_);
  for (std::size_t node = 0; node < slots_.size(); ++node) {
    double stiffness = model_.nodeStiffness(shape.state, static_cast<int>(node)).mean();
    if (inertia_ != nullptr) {
      stiffness = inertia_->elastic_scale * stiffness + inertia_->per_mass * masses[node];
    }
    if (stiffness <= 0.0) continue;
    compliance_[slots_[node]] = static_cast<float>(stiffnessUnit() / stiffness);
  }
}

void SoaField::hold(const ConstrainedState& shape, const DofConstraints& patch_hold) {
  movable_.clear();
  for (std::size_t node = 0; node < slots_.size(); ++node) {
    const std::uint8_t held = patch_hold.dirichletMask()[node];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      free_[axis][slots_[node]] = (held >> axis & 1) != 0 ? 0.0F : 1.0F;
    }
    if (held != kAllAxes || patch_hold.carrierOf(node) >= 0) {
      movable_.push_back(static_cast<int>(node));
    }
  }
  std::fill(springs_of_block_.begin(), springs_of_block_.end(), -1);
  springs_.clear();
  const auto have_springs = [&](int node) {
    int& place = springs_of_block_[at(slotOf(node) / kLanes)];
    if (place >= 0) return;
    place = static_cast<int>(springs_.size());
    springs_.emplace_back();
  };
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& spring : patch.rim) have_springs(spring.node);
  }
  if (inertia_ == nullptr) return;
  for (const int node : all_) have_springs(node);
}

void SoaField::take(const LatticeState& state, const std::vector<int>& nodes) {
  for (const int node : nodes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double moved = state.displacement[at(node)][static_cast<Eigen::Index>(axis)];
      moved_[axis][slotOf(node)] = static_cast<float>(moved / unit_);
    }
  }
}

void SoaField::give(const std::vector<int>& nodes, LatticeState& state) const {
  for (const int node : nodes) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (free_[axis][slotOf(node)] == 0.0F) continue;
      state.displacement[at(node)][static_cast<Eigen::Index>(axis)] =
          unit_ * static_cast<double>(moved_[axis][slotOf(node)]);
    }
  }
}

// A rim spring's force K (anchor - u) is a constant force K anchor and a spring K to rest. So is
// inertia: its spring is that of the node's mass.
void SoaField::takeRims(const ConstrainedState& shape) {
  const double stiffness_unit = stiffnessUnit();
  for (SoaSprings& springs : springs_) springs = SoaSprings();
  for (std::size_t node = 0; inertia_ != nullptr && node < slots_.size(); ++node) {
    const int slot = slots_[node];
    SoaSprings& springs = springs_[at(springs_of_block_[at(slot / kLanes)])];
    const double stiffness = inertia_->per_mass * lane_masses_[node];
    for (int axis = 0; axis < 3; ++axis) {
      springs.of[axis][slot % kLanes] += static_cast<float>(stiffness / stiffness_unit);
    }
  }
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& spring : patch.rim) {
      const Vec3 weight = weight_[at(spring.node)];
      for (int axis = 0; axis < 3; ++axis) {
        load_[at(axis)][slotOf(spring.node)] = static_cast<float>(weight[axis] / force_unit_);
      }
    }
  }
  for (const LoadingPatch& patch : shape.patches) {
    for (const RimSpring& spring : patch.rim) {
      const int slot = slotOf(spring.node);
      SoaSprings& springs = springs_[at(springs_of_block_[at(slot / kLanes)])];
      const Eigen::Matrix3d stiffness = stiffnessOf(patch, spring);
      const Vec3 load = stiffness * spring.anchor / force_unit_;
      for (int axis = 0; axis < 3; ++axis) {
        load_[at(axis)][slot] += static_cast<float>(load[axis]);
        springs.of[axis][slot % kLanes] +=
            static_cast<float>(stiffness(axis, axis) / stiffness_unit);
      }
      springs.of[3][slot % kLanes] += static_cast<float>(stiffness(0, 1) / stiffness_unit);
      springs.of[4][slot % kLanes] += static_cast<float>(stiffness(0, 2) / stiffness_unit);
      springs.of[5][slot % kLanes] += static_cast<float>(stiffness(1, 2) / stiffness_unit);
    }
  }
}

// Sorts cells and nodes into those that the vector kernels do and the odd ones, which are done one
// by one: cells filled in part, parts of cut ones, and nodes in contact or in cells that the
// kernels do not do.
void SoaField::sortOut(const ConstrainedState& shape, const DofConstraints& patch_hold) {
  const std::vector<std::uint8_t> has_cell = takeLaneCells();
  std::vector<std::uint8_t> has_node(at(size_), 0), odd(slots_.size(), 0);
  for (const int index : odd_cells_) {
    for (const int node : reachedNodes(cells_->all()[at(index)])) {
      if (node >= 0) odd[at(node)] = 1;
    }
  }
  for (const int node : patch_hold.touched()) odd[at(node)] = 1;
  odd_nodes_.clear();
  for (std::size_t node = 0; node < slots_.size(); ++node) {
    const int slot = slots_[node];
    const bool lane = odd[node] == 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double weight = weight_[node][static_cast<Eigen::Index>(axis)];
      load_[axis][slot] = static_cast<float>(weight / force_unit_);
      lane_free_[axis][slot] = lane ? free_[axis][slot] : 0.0F;
    }
    if (patch_hold.dirichletMask()[node] == kAllAxes) continue;
    if (lane) has_node[at(slot)] = 1;
    if (!lane) odd_nodes_.push_back(static_cast<int>(node));
  }
  for (int color = 0; color < kColors; ++color) {
    cell_blocks_[at(color)] = blocksWith(has_cell, color);
    node_blocks_[at(color)] = blocksWith(has_node, color);
  }
  takeRims(shape);
  watch(shape, patch_hold);
  if (inertia_ != nullptr) takeFreeMotion();
}

// Moduli, weights and masses of the cells that the vector kernels do. Their slots are 1.
std::vector<std::uint8_t> SoaField::takeLaneCells() {
  std::vector<std::uint8_t> has_cell(at(size_), 0);
  weight_.assign(slots_.size(), Vec3::Zero());
  if (inertia_ != nullptr) weight_ = inertia_->force;
  lane_masses_.assign(inertia_ == nullptr ? 0 : slots_.size(), 0.0);
  for (const int index : lane_cells_) {
    const Cell& cell = cells_->all()[at(index)];
    const int slot = slotOf(cell.nodes[0]);
    const Moduli moduli = model_.cellModuli(cell);
    shear_[slot] = static_cast<float>(moduli.shear / rest_modulus_);
    bulk_[slot] = static_cast<float>(moduli.bulk / rest_modulus_);
    if (stiffens_) stiffening_[slot] = static_cast<float>(moduli.stiffening);
    has_cell[at(slot)] = 1;
    const Vec3 weight = model_.cornerWeight(cell, 0);  // alike at all corners
    for (const int node : cell.nodes) weight_[at(node)] += weight;
    if (inertia_ == nullptr) continue;
    for (const int node : cell.nodes) lane_masses_[at(node)] += model_.cornerMass(cell, 0);
  }
  return has_cell;
}

void SoaField::takeFreeMotion() {
  for (std::size_t node = 0; node < slots_.size(); ++node) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double moved = inertia_->free_motion[node][static_cast<Eigen::Index>(axis)];
      spare_[kFreeMotion][axis][slots_[node]] = static_cast<float>(moved / unit_);
    }
  }
}

std::vector<int> SoaField::blocksWith(const std::vector<std::uint8_t>& slots, int color) const {
  std::vector<int> blocks;
  for (int block = grid_.firstBlock(color); block < grid_.lastBlock(color); block += kLanes) {
    const auto first = slots.begin() + block;
    if (std::any_of(first, first + kLanes, [](std::uint8_t has) { return has != 0; })) {
      blocks.push_back(block);
    }
  }
  return blocks;
}

void SoaField::watch(const ConstrainedState& shape, const DofConstraints& patch_hold) {
  std::vector<std::uint8_t> watched(slots_.size(), 0);
  const auto watch_cell = [&](std::size_t cell) {
    for (const int node : reachedNodes(cells_->all()[cell])) {
      if (node >= 0) watched[at(node)] = 1;
    }
  };
  const auto look_around = [&](int node) {
    watched[at(node)] = 1;
    cells_->visitAround(node, [&](const CellSet::Meeting& met) { watch_cell(met.cell); });
  };
  for (const int node : odd_nodes_) look_around(node);
  for (const int index : odd_cells_) watch_cell(at(index));
  for (std::size_t patch = 0; patch < shape.patches.size(); ++patch) {
    for (const ContactSpring& spring : shape.patches[patch].contacts) {
      for (const NodeWeight& carrier : spring.carriers) watched[at(carrier.node)] = 1;
    }
    if (!byForce(shape.patches[patch])) continue;
    for (const int node : patch_hold.hardOf(patch)) look_around(node);
    for (const RimSpring& spring : shape.patches[patch].rim) watched[at(spring.node)] = 1;
  }
  watched_.clear();
  for (std::size_t node = 0; node < watched.size(); ++node) {
    if (watched[node] != 0) watched_.push_back(static_cast<int>(node));
  }
}

double SoaField::restStiffness(int node) const {
  const double compliance = static_cast<double>(compliance_[slotOf(node)]);
  return compliance > 0.0 ? stiffnessUnit() / compliance : 0.0;
}

void SoaField::giveAll(int node, LatticeState& state) const {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    state.displacement[at(node)][static_cast<Eigen::Index>(axis)] =
        unit_ * static_cast<double>(moved_[axis][slotOf(node)]);
  }
}

}  // namespace robot_tissue
