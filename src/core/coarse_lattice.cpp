#include "robot_tissue/core/coarse_lattice.h"

#include <algorithm>
#include <unordered_map>

namespace robot_tissue {
namespace {

constexpr double kHold = 1e-6;  // of the diagonal: keeps what nothing holds from drifting

// Of the coarse nodes around a node: at `offset` (0 or 1 along each axis) from the block's lowest.
std::array<double, kCorners> weightsAt(const std::array<int, 3>& offset) {
  std::array<double, kCorners> weights{};
  for (int coarse = 0; coarse < kCorners; ++coarse) {
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double upper = 0.5 * offset[at(axis)];
      weight *= (coarse >> axis & 1) != 0 ? upper : 1.0 - upper;
    }
    weights[at(coarse)] = weight;
  }
  return weights;
}

Eigen::Matrix3d freeBlock(Eigen::Matrix3d block, unsigned rows_held, unsigned columns_held) {
  for (int axis = 0; axis < 3; ++axis) {
    if ((rows_held >> axis & 1) != 0) block.row(axis).setZero();
    if ((columns_held >> axis & 1) != 0) block.col(axis).setZero();
  }
  return block;
}

bool samePattern(const Eigen::SparseMatrix<double>& a, const Eigen::SparseMatrix<double>& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.outerSize(), b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace

CoarseLattice::CoarseLattice(const Lattice& lattice, const EnergyModel& model)
    : lattice_(lattice), model_(model) {}

void CoarseLattice::build(const LoadedShape& shape, const PatchHold& hold) {
  std::vector<double> springs;
  for (const LoadingPatch& patch : shape.patches) {
    springs.push_back(patch.turns ? -2.0 : -1.0);
    for (const RimSpring& spring : patch.rim) {
      springs.push_back(spring.node);
      springs.insert(springs.end(), spring.stiffness.data(), spring.stiffness.data() + 3);
    }
    for (const ContactSpring& spring : patch.contacts) {
      if (normalForceOf(spring, shape.state.displacement) <= 0.0) continue;
      for (const NodeWeight& carrier : spring.carriers) springs.push_back(carrier.node);
    }
  }
  const bool same_cells = cells_ == shape.state.cells;
  const bool same_hold = held_ == hold.held() && carriers_ == hold.carriers();
  if (same_cells && same_hold && springs_ == springs) return;
  if (!same_cells) {
    lay(shape.state);
    about_ = shape.state;
    std::fill(about_.displacement.begin(), about_.displacement.end(), Vec3::Zero());
  }
  if (fillChanged(shape, hold)) sumBlocks();
  cells_ = shape.state.cells;
  held_ = hold.held();
  carriers_ = hold.carriers();
  springs_ = std::move(springs);
  assemble(shape, hold);
}

// Whether a block is another one now.
bool CoarseLattice::fillChanged(const LoadedShape& shape, const PatchHold& hold) {
  const bool same_cells = cells_ == shape.state.cells;
  bool any = false;
  for (Block& block : blocks_) {
    const auto unchanged = [&](int node) {
      return same_cells && held_[at(node)] == hold.held()[at(node)] &&
             carriers_[at(node)] == hold.carriers()[at(node)];
    };
    const bool same = std::all_of(block.cells.begin(), block.cells.end(), [&](int cell) {
      const auto& nodes = shape.state.cells->all()[at(cell)].nodes;
      return std::all_of(nodes.begin(), nodes.end(), unchanged);
    });
    if (same) continue;
    fill(block, about_, hold);
    any = true;
  }
  return any;
}

void CoarseLattice::renew(const LoadedShape& shape, const PatchHold& hold) {
  about_.displacement = shape.state.displacement;
  for (Block& block : blocks_) fill(block, about_, hold);
  sumBlocks();
  assemble(shape, hold);
  if (usable_) return;
  std::fill(about_.displacement.begin(), about_.displacement.end(), Vec3::Zero());
  for (Block& block : blocks_) fill(block, about_, hold);
  sumBlocks();
  assemble(shape, hold);
}

void CoarseLattice::assemble(const LoadedShape& shape, const PatchHold& hold) {
  numberPatches(shape);
  entries_.clear();
  addCarried(shape, about_, hold);
  addRims(shape, hold);
  addContacts(shape, hold);
  factorize();
}

// Coarse nodes stand where all grid indices are even.
void CoarseLattice::lay(const LatticeState& state) {
  std::unordered_map<int, int> block_at, coarse_at;
  const auto key = [&](int i, int j, int k) {
    const auto& size = lattice_.size();
    return i + (size[0] + 2) * (j + (size[1] + 2) * k);
  };
  blocks_.clear();
  places_.assign(at(state.cells->nodeCount()), {});
  coarse_count_ = 0;
  const std::vector<Cell>& cells = state.cells->all();
  for (std::size_t index = 0; index < cells.size(); ++index) {
    const Cell& cell = cells[index];
    const std::array<int, 3>& low = lattice_.gridIndex(lattice_.cells()[at(cell.place)].nodes[0]);
    const int i = low[0] / 2, j = low[1] / 2, k = low[2] / 2;
    const auto [found, is_new] =
        block_at.try_emplace(key(i, j, k), static_cast<int>(blocks_.size()));
    if (is_new) {
      blocks_.emplace_back();
      for (int corner = 0; corner < kCorners; ++corner) {
        const auto [node, added] = coarse_at.try_emplace(
            key(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1)), coarse_count_);
        if (added) ++coarse_count_;
        blocks_.back().coarse[at(corner)] = node->second;
      }
    }
    blocks_[at(found->second)].cells.push_back(static_cast<int>(index));
    for (int corner = 0; corner < kCorners; ++corner) {
      Place& place = places_[at(cell.nodes[at(corner)])];
      if (place.block >= 0) continue;
      place.block = found->second;
      place.weight = weightsAt({low[0] % 2 + (corner & 1), low[1] % 2 + (corner >> 1 & 1),
                                low[2] % 2 + (corner >> 2 & 1)});
    }
  }
}

bool CoarseLattice::isCarried(const Cell& cell, const PatchHold& hold) const {
  return std::any_of(cell.nodes.begin(), cell.nodes.end(),
                     [&](int node) { return hold.carriers()[at(node)] >= 0; });
}

// Cells without a carried node; the others come with addCarried.
void CoarseLattice::fill(Block& block, const LatticeState& rest, const PatchHold& hold) {
  block.matrix.setZero();
  for (const int index : block.cells) {
    const Cell& cell = rest.cells->all()[at(index)];
    if (isCarried(cell, hold)) continue;
    const std::array<int, 3>& low = lattice_.gridIndex(lattice_.cells()[at(cell.place)].nodes[0]);
    Weights weights;
    for (int corner = 0; corner < kCorners; ++corner) {
      weights[at(corner)] = weightsAt({low[0] % 2 + (corner & 1), low[1] % 2 + (corner >> 1 & 1),
                                       low[2] % 2 + (corner >> 2 & 1)});
    }
    const CellHessian hessian = model_.cellHessian(rest, index);
    for (int i = 0; i < kCorners; ++i) {
      std::array<Eigen::Matrix3d, kCorners> row;
      row.fill(Eigen::Matrix3d::Zero());
      for (int j = 0; j < kCorners; ++j) {
        const Eigen::Matrix3d part =
            freeBlock(hessian.block<3, 3>(3 * i, 3 * j), hold.held()[at(cell.nodes[at(i)])],
                      hold.held()[at(cell.nodes[at(j)])]);
        for (int b = 0; b < kCorners; ++b) {
          if (weights[at(j)][at(b)] > 0.0) row[at(b)] += weights[at(j)][at(b)] * part;
        }
      }
      for (int a = 0; a < kCorners; ++a) {
        const double weight = weights[at(i)][at(a)];
        if (weight == 0.0) continue;
        for (int b = 0; b < kCorners; ++b) {
          block.matrix.block<3, 3>(3 * a, 3 * b) += weight * row[at(b)];
        }
      }
    }
  }
}

void CoarseLattice::numberPatches(const LoadedShape& shape) {
  groups_ = coarse_count_;
  first_group_.clear();
  for (const LoadingPatch& patch : shape.patches) {
    const bool by_force = byForce(patch);
    first_group_.push_back(by_force ? groups_ : -1);
    if (by_force) groups_ += patch.turns ? 2 : 1;
  }
}

std::vector<CoarseLattice::Share> CoarseLattice::sharesOf(const LoadedShape& shape,
                                                          const PatchHold& hold, int node) const {
  std::vector<Share> shares;
  const int carrier = hold.carriers()[at(node)];
  if (carrier >= 0) {
    const int first = first_group_[at(carrier)];
    shares.push_back({first, Eigen::Matrix3d::Identity()});
    if (shape.patches[at(carrier)].turns) {
      shares.push_back({first + 1, -crossMatrix(hold.armOf(shape, at(carrier), node))});
    }
    return shares;
  }
  const Place& place = places_[at(node)];
  for (int corner = 0; place.block >= 0 && corner < kCorners; ++corner) {
    if (place.weight[at(corner)] == 0.0) continue;
    Eigen::Matrix3d weight = place.weight[at(corner)] * Eigen::Matrix3d::Identity();
    shares.push_back(
        {blocks_[at(place.block)].coarse[at(corner)], freeBlock(weight, hold.held()[at(node)], 0)});
  }
  return shares;
}

void CoarseLattice::add(const std::vector<Share>& rows, const std::vector<Share>& columns,
                        const Eigen::Matrix3d& block) {
  for (const Share& row : rows) {
    for (const Share& column : columns) {
      if (row.group < column.group) continue;
      const Eigen::Matrix3d part = row.weight.transpose() * block * column.weight;
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < (row.group == column.group ? i + 1 : 3); ++j) {
          entries_.emplace_back(3 * row.group + i, 3 * column.group + j, part(i, j));
        }
      }
    }
  }
}

void CoarseLattice::addCarried(const LoadedShape& shape, const LatticeState& rest,
                               const PatchHold& hold) {
  for (const Block& block : blocks_) {
    for (const int index : block.cells) {
      const Cell& cell = rest.cells->all()[at(index)];
      if (!isCarried(cell, hold)) continue;
      const CellHessian hessian = model_.cellHessian(rest, index);
      std::array<std::vector<Share>, kCorners> shares;
      for (int i = 0; i < kCorners; ++i) shares[at(i)] = sharesOf(shape, hold, cell.nodes[at(i)]);
      for (int i = 0; i < kCorners; ++i) {
        for (int j = 0; j < kCorners; ++j) {
          add(shares[at(i)], shares[at(j)], hessian.block<3, 3>(3 * i, 3 * j));
        }
      }
    }
  }
}

void CoarseLattice::addRims(const LoadedShape& shape, const PatchHold& hold) {
  for (std::size_t index = 0; index < shape.patches.size(); ++index) {
    const LoadingPatch& patch = shape.patches[index];
    for (const RimSpring& spring : patch.rim) {
      const Eigen::Matrix3d stiffness = stiffnessOf(patch, spring);
      std::vector<Share> stretch = sharesOf(shape, hold, spring.node);
      if (first_group_[index] >= 0) {
        stretch.push_back({first_group_[index], -Eigen::Matrix3d::Identity()});
        if (patch.turns) {
          stretch.push_back(
              {first_group_[index] + 1, crossMatrix(hold.armOf(shape, index, spring.node))});
        }
      }
      add(stretch, stretch, stiffness);
    }
  }
}

void CoarseLattice::addContacts(const LoadedShape& shape, const PatchHold& hold) {
  for (const LoadingPatch& patch : shape.patches) {
    for (const ContactSpring& spring : patch.contacts) {
      const Eigen::Matrix3d stiffness = stiffnessOf(spring, shape.state.displacement);
      if (stiffness.isZero(0.0)) continue;
      std::vector<Share> point;
      for (const NodeWeight& carrier : spring.carriers) {
        for (Share share : sharesOf(shape, hold, carrier.node)) {
          share.weight *= carrier.weight;
          const auto same = std::find_if(point.begin(), point.end(), [&](const Share& other) {
            return other.group == share.group;
          });
          if (same == point.end()) {
            point.push_back(share);
          } else {
            same->weight += share.weight;
          }
        }
      }
      add(point, point, stiffness);
    }
  }
}

void CoarseLattice::sumBlocks() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const Block& block : blocks_) {
    for (int a = 0; a < kCorners; ++a) {
      for (int b = 0; b < kCorners; ++b) {
        const int row = block.coarse[at(a)], column = block.coarse[at(b)];
        if (row < column) continue;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < (row == column ? i + 1 : 3); ++j) {
            entries.emplace_back(3 * row + i, 3 * column + j, block.matrix(3 * a + i, 3 * b + j));
          }
        }
      }
    }
  }
  sum_.resize(3 * coarse_count_, 3 * coarse_count_);
  sum_.setFromTriplets(entries.begin(), entries.end());
}

void CoarseLattice::factorize() {
  Eigen::SparseMatrix<double> of_patches(3 * groups_, 3 * groups_);
  of_patches.setFromTriplets(entries_.begin(), entries_.end());
  Eigen::SparseMatrix<double> matrix = sum_;
  matrix.conservativeResize(3 * groups_, 3 * groups_);
  matrix += of_patches;
  std::vector<Eigen::Triplet<double>> holds;
  const Eigen::VectorXd diagonal = matrix.diagonal();
  const double most = std::max(diagonal.size() > 0 ? diagonal.maxCoeff() : 0.0, 1e-300);
  for (int i = 0; i < 3 * groups_; ++i) {
    const bool empty = diagonal[i] <= 1e-12 * most;  // its nodes are all held
    holds.emplace_back(i, i, empty ? most : kHold * diagonal[i]);
  }
  Eigen::SparseMatrix<double> hold(3 * groups_, 3 * groups_);
  hold.setFromTriplets(holds.begin(), holds.end());
  matrix += hold;
  if (!samePattern(matrix, matrix_)) factor_.analyze(matrix);
  matrix_.swap(matrix);
  usable_ = factor_.factorize(matrix_);
  entries_.clear();
}

void CoarseLattice::solve(const Motion& forces, const LoadedShape& shape, const PatchHold& hold,
                          Motion& motion) const {
  motion.nodes.assign(forces.nodes.size(), Vec3::Zero());
  motion.patches.assign(forces.patches.size(), {});
  if (!usable_) return;
  Eigen::VectorXd gathered = Eigen::VectorXd::Zero(3 * groups_);
  for (std::size_t node = 0; node < places_.size(); ++node) {
    const Place& place = places_[node];
    if (place.block < 0 || hold.held()[node] == kAllHeld) continue;
    const Vec3 force = hold.freePart(static_cast<int>(node), forces.nodes[node]);
    for (int corner = 0; corner < kCorners; ++corner) {
      const double weight = place.weight[at(corner)];
      if (weight == 0.0) continue;
      gathered.segment<3>(3 * blocks_[at(place.block)].coarse[at(corner)]) += weight * force;
    }
  }
  for (std::size_t patch = 0; patch < first_group_.size(); ++patch) {
    if (first_group_[patch] < 0) continue;
    gathered.segment<3>(3 * first_group_[patch]) = forces.patches[patch].shift;
    if (!shape.patches[patch].turns) continue;
    gathered.segment<3>(3 * first_group_[patch] + 3) = forces.patches[patch].turn;
  }
  const Eigen::VectorXd coarse = factor_.solve(gathered);
  for (std::size_t node = 0; node < places_.size(); ++node) {
    const Place& place = places_[node];
    if (place.block < 0 || hold.held()[node] == kAllHeld) continue;
    Vec3 moved = Vec3::Zero();
    for (int corner = 0; corner < kCorners; ++corner) {
      const double weight = place.weight[at(corner)];
      if (weight == 0.0) continue;
      moved += weight * coarse.segment<3>(3 * blocks_[at(place.block)].coarse[at(corner)]);
    }
    motion.nodes[node] = hold.freePart(static_cast<int>(node), moved);
  }
  for (std::size_t patch = 0; patch < first_group_.size(); ++patch) {
    if (first_group_[patch] < 0) continue;
    motion.patches[patch].shift = coarse.segment<3>(3 * first_group_[patch]);
    if (!shape.patches[patch].turns) continue;
    motion.patches[patch].turn = coarse.segment<3>(3 * first_group_[patch] + 3);
  }
}

}  // namespace robot_tissue
