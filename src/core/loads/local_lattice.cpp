#include "loads/local_lattice.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "loads/half_space.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {
namespace {

// Cells: so far from the middle node others move on their own. 2, 3, 4: 1, 5, 15 ms on a block; 2,
// 3: 5, 15 ms on an organ.
constexpr int kRings = 2;

// Of moduli (1), and between Poisson's ratios: a difference that is none. Rounding.
constexpr double kSameModuli = 1e-6;
// Spacings: so deep there has to be tissue, which from there on goes as a half-space does, and so
// far aside a node there may be. Less: walls count as half-spaces. Chosen.
constexpr double kDeep = 1.6;
constexpr double kAside = 1.0;

// Of a cell (1): one with no more tells nothing of where tissue is, as what a surface only grazes
// counts as filled by a thousandth all over (filled_grid.cpp).
constexpr double kGrazed = 0.002;

struct Component {
  int of_cell;   // row of its stiffness
  int of_piece;  // 3 of each node
  int unknown;
};

int heaviest(const std::vector<NodeWeight>& shares) {
  const auto is_less = [](const NodeWeight& a, const NodeWeight& b) {
    return a.weight < b.weight || (a.weight == b.weight && a.node > b.node);
  };
  return std::max_element(shares.begin(), shares.end(), is_less)->node;
}

bool isNear(const SurfaceModuli& a, const SurfaceModuli& b) {
  return std::abs(a.shear - b.shear) <= kSameModuli * b.shear &&
         std::abs(a.poisson_ratio - b.poisson_ratio) <= kSameModuli;
}

// Pa, of the material that fills the cell, as if it filled all of it.
Moduli materialIn(const Cell& cell, const ElasticModel& model) {
  Moduli moduli = model.moduliIn(cell);
  moduli.shear /= cell.stiffnessShare();
  moduli.bulk /= cell.stiffnessShare();
  return moduli;
}

}  // namespace

std::optional<std::uint8_t> axesHeldBy(const std::vector<LoadingPatch>& patches, int node) {
  std::optional<std::uint8_t> held;
  for (const LoadingPatch& patch : patches) {
    if (!std::binary_search(patch.nodes.begin(), patch.nodes.end(), node)) continue;
    unsigned mask = held.value_or(0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (holds(patch, axis)) mask |= 1U << axis;
    }
    held = static_cast<std::uint8_t>(mask);
  }
  return held;
}

std::optional<SurfaceModuli> LocalLattice::moduliUnder(const std::vector<NodeWeight>& shares,
                                                       const CellSet& cells,
                                                       const ElasticModel& model) {
  const CellSet::Meetings around = cells.meetings(heaviest(shares));
  if (around.isEmpty()) return std::nullopt;
  const Moduli material = materialIn(cells.all()[at(around.begin()->cell)], model);
  if (!(material.shear > 0.0)) return std::nullopt;
  return SurfaceModuli{material.shear, poissonRatio(material)};
}

bool LocalLattice::isAround(const std::vector<NodeWeight>& shares,
                            const LatticeState& state) const {
  return cells_ == state.cells && middle_ == heaviest(shares);
}

bool LocalLattice::take(const std::vector<NodeWeight>& shares, const Vec3& axis,
                        const SurfaceModuli& moduli, const std::vector<LoadingPatch>& patches,
                        const Lattice& lattice, const LatticeState& state,
                        const ElasticModel& model) {
  const CellSet& cells = *state.cells;
  const HeldAt held_at = [&](int node) {
    return isFixed(lattice, cells, node) ? kAllAxes
                                         : axesHeldBy(patches, node).value_or(std::uint8_t{0});
  };
  if (!isAround(shares, state) || !isNear(moduli, moduli_) || !isAsHeld(held_at)) {
    cells_ = state.cells;
    spacing_ = lattice.spacing();
    moduli_ = moduli;
    middle_ = heaviest(shares);
    findNodes(lattice, cells, held_at);
    is_deep_.clear();
  }
  if (moving_count_ == 0 || !isOfOneMaterial(cells, model)) return false;
  inwards_ = turn(state.displacement).transpose() * axis;
  place_ = Vec3::Zero();
  for (const NodeWeight& share : shares) {
    place_ += share.weight * restPosition(lattice, cells, share.node);
  }
  holdDeep(cells, model);
  return unknown_count_ > 0 && factor_.info() == Eigen::Success &&
         std::all_of(shares.begin(), shares.end(),
                     [this](const NodeWeight& share) { return numbers_.count(share.node) != 0; });
}

// All corners of its cells are among its nodes.
bool LocalLattice::isAsHeld(const HeldAt& held_at) const {
  return std::all_of(nodes_.begin(), nodes_.end(),
                     [&](const PieceNode& one) { return one.held == held_at(one.node); });
}

// By cells, so that what a cut has parted is apart.
void LocalLattice::findNodes(const Lattice& lattice, const CellSet& cells, const HeldAt& held_at) {
  nodes_.clear();
  numbers_.clear();
  const auto add = [&](int node, bool is_around) {
    const std::uint8_t held = held_at(node);
    if (held == kAllAxes && !is_around) return false;
    if (!numbers_.try_emplace(node, static_cast<int>(nodes_.size())).second) return false;
    nodes_.push_back({node, restPosition(lattice, cells, node), held});
    return true;
  };
  std::set<int> met;
  std::vector<int> ring = {middle_};
  add(middle_, false);
  for (int number = 0; number <= kRings; ++number) {
    std::vector<int> next;
    for (const int node : ring) {
      for (const CellSet::Meeting& meeting : cells.meetings(node)) {
        const int cell = static_cast<int>(meeting.cell);
        if (!met.insert(cell).second || number == kRings) continue;
        for (const int corner : cells.all()[at(cell)].nodes) {
          if (add(corner, false)) next.push_back(corner);
        }
      }
    }
    ring = std::move(next);
  }
  own_cells_.assign(met.begin(), met.end());
  moving_count_ = static_cast<int>(nodes_.size());
  for (const int number : own_cells_) {
    for (const int node : reachedNodes(cells.all()[at(number)])) {
      if (node >= 0) add(node, true);
    }
  }
}

// What is deep does not move on its own, so that nothing hangs on what is below it.
void LocalLattice::holdDeep(const CellSet& cells, const ElasticModel& model) {
  std::vector<bool> is_deep;
  is_deep.reserve(nodes_.size());
  for (const PieceNode& node : nodes_) {
    is_deep.push_back((node.place - place_).dot(inwards_) >= kDeep * spacing_);
  }
  if (is_deep == is_deep_) return;
  is_deep_ = std::move(is_deep);
  unknowns_.assign(nodes_.size(), {{kNone, kNone, kNone}});
  unknown_count_ = 0;
  for (int number = 0; number < moving_count_; ++number) {
    if (is_deep_[at(number)]) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool is_held = (nodes_[at(number)].held >> axis & 1U) != 0;
      if (!is_held) unknowns_[at(number)][axis] = unknown_count_++;
    }
  }
  if (unknown_count_ > 0) factor_.compute(stiffness(cells, model));
}

// Of what moves on its own; to what does not, that is coupling_.
LocalLattice::Matrix LocalLattice::stiffness(const CellSet& cells, const ElasticModel& model) {
  std::vector<Eigen::Triplet<double>> own, others;
  for (const int number : own_cells_) {
    const Cell& cell = cells.all()[at(number)];
    std::vector<Component> components, unknowns;
    const auto reached = reachedNodes(cell);
    for (int i = 0; i < static_cast<int>(reached.size()); ++i) {
      if (reached[at(i)] < 0) continue;
      const int node = numbers_.at(reached[at(i)]);
      for (int axis = 0; axis < 3; ++axis) {
        components.push_back({3 * i + axis, 3 * node + axis, unknowns_[at(node)][at(axis)]});
        if (components.back().unknown != kNone) unknowns.push_back(components.back());
      }
    }
    if (unknowns.empty()) continue;
    const CellHessian hessian = model.stiffnessAtRest(cell);
    for (const Component& row : unknowns) {
      for (const Component& column : components) {
        const double entry = hessian(row.of_cell, column.of_cell);
        if (column.unknown != kNone) {
          own.emplace_back(row.unknown, column.unknown, entry);
        } else {
          others.emplace_back(row.unknown, column.of_piece, entry);
        }
      }
    }
  }
  coupling_.resize(unknown_count_, 3 * static_cast<Eigen::Index>(nodes_.size()));
  coupling_.setFromTriplets(others.begin(), others.end());
  Matrix matrix(unknown_count_, unknown_count_);
  matrix.setFromTriplets(own.begin(), own.end());
  return matrix;
}

// A ball feels a layer that begins a spacing below it otherwise than a half-space.
bool LocalLattice::isOfOneMaterial(const CellSet& cells, const ElasticModel& model) const {
  return std::all_of(own_cells_.begin(), own_cells_.end(), [&](int number) {
    const Moduli material = materialIn(cells.all()[at(number)], model);
    return isNear({material.shear, poissonRatio(material)}, moduli_);
  });
}

// The rotation in the best linear map of the places to where they are.
Eigen::Matrix3d LocalLattice::turn(const std::vector<Vec3>& displacement) const {
  Vec3 middle_at_rest = Vec3::Zero(), middle = Vec3::Zero();
  const auto moving = nodes_.begin() + moving_count_;
  for (auto one = nodes_.begin(); one != moving; ++one) {
    middle_at_rest += one->place;
    middle += one->place + displacement[at(one->node)];
  }
  middle_at_rest /= static_cast<double>(moving_count_);
  middle /= static_cast<double>(moving_count_);
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (auto one = nodes_.begin(); one != moving; ++one) {
    const Vec3 now = one->place + displacement[at(one->node)] - middle;
    products += now * (one->place - middle_at_rest).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d turn = svd.matrixU() * svd.matrixV().transpose();
  if (turn.determinant() < 0.0) {
    Eigen::Matrix3d flipped = svd.matrixU();
    flipped.col(2) *= -1.0;
    turn = flipped * svd.matrixV().transpose();
  }
  return turn;
}

// By what cells hold, not by their nodes, of which a thin wall has some that are as far.
bool LocalLattice::isDeep(const Lattice& lattice) const {
  const CellFill full;
  return std::any_of(own_cells_.begin(), own_cells_.end(), [&](int number) {
    const Cell& cell = cells_->all()[at(number)];
    const CellFill& fill = cell.fill == nullptr ? full : *cell.fill;
    const Vec3 center = lattice.cellCenter(lattice.cells()[at(cell.place)]);
    const Vec3 off = (center - place_) / spacing_ + fill.centroid;
    const double depth = off.dot(inwards_), aside = (off - depth * inwards_).norm();
    return cell.share() > kGrazed && aside <= kAside && depth + fill.reachAlong(inwards_) >= kDeep;
  });
}

// Of what does not move on its own, 3 each.
Eigen::VectorXd LocalLattice::motionAround() const {
  Eigen::VectorXd motion = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(nodes_.size()));
  for (int number = 0; number < static_cast<int>(nodes_.size()); ++number) {
    const PieceNode& node = nodes_[at(number)];
    if (!is_deep_[at(number)] && number < moving_count_) continue;
    const Vec3 along = halfSpaceMotion(node.place - place_, inwards_, moduli_);
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_held = (node.held >> axis & 1U) != 0;
      if (is_deep_[at(number)] || !is_held) motion[3 * number + axis] = along[axis];
    }
  }
  return motion;
}

double LocalLattice::compliance(const std::vector<NodeWeight>& shares) const {
  const Eigen::VectorXd around = motionAround();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(unknown_count_);
  double way = 0.0;
  for (const NodeWeight& share : shares) {
    const int number = numbers_.at(share.node);
    for (int axis = 0; axis < 3; ++axis) {
      const int unknown = unknowns_[at(number)][at(axis)];
      const double part = share.weight * inwards_[axis];
      if (unknown != kNone) force[unknown] += part;
      if (unknown == kNone) way += part * around[3 * number + axis];
    }
  }
  return way + force.dot(factor_.solve(force - coupling_ * around));
}

}  // namespace robot_tissue
