#include "loads/local_lattice.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "loads/ratio_table.h"
#include "robot_tissue/core/cells.h"
#include "robot_tissue/core/lattice.h"

namespace robot_tissue {
namespace {

// Cells: so far from the middle node others move. 2, 3, 4: the dent of a force on a flat surface is
// 9, 7, 5 % less than in all of the tissue, before that is made up for; 1, 5, 15 ms on a block; 2,
// 3: 5, 15 ms on an organ.
constexpr int kRings = 2;

struct Missing {
  double poisson_ratio;
  double compliance;  // in force over shear modulus and spacing
};

// What is missing to a flat surface that goes on (doc/data/point_loads.csv), for a force that four
// nodes share. Of one node it is 0.0005 to 0.0125 more.
constexpr Missing kMissing[] = {{0.25, 0.0530}, {0.35, 0.0516}, {0.45, 0.0570}, {0.49, 0.0651}};

// Of moduli (1), and between Poisson's ratios: a difference that is none. Rounding.
constexpr double kSameModuli = 1e-6;
// Spacings: so deep there has to be tissue, and so far aside a node there may be. Less: walls count
// as half-spaces. Chosen.
constexpr double kDeep = 1.6;
constexpr double kAside = 1.0;

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

HeldAxes axesHeldBy(const std::vector<LoadingPatch>& patches) {
  HeldAxes held;
  for (const LoadingPatch& patch : patches) {
    std::uint8_t mask = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (holds(patch, axis)) mask = static_cast<std::uint8_t>(mask | 1U << axis);
    }
    for (const int node : patch.nodes) held[node] = static_cast<std::uint8_t>(held[node] | mask);
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

bool LocalLattice::take(const std::vector<NodeWeight>& shares, const SurfaceModuli& moduli,
                        const HeldAxes& held_axes, const Lattice& lattice,
                        const LatticeState& state, const ElasticModel& model) {
  const int node = heaviest(shares);
  const CellSet& cells = *state.cells;
  const bool stays = isAround(shares, state) && isNear(moduli, moduli_) && held_axes == held_axes_;
  if (!stays) {
    cells_ = state.cells;
    spacing_ = lattice.spacing();
    moduli_ = moduli;
    held_axes_ = held_axes;
    make(node, lattice, cells, model);
    places_.clear();
    for (const int own : nodes_) places_.push_back(restPosition(lattice, cells, own));
  }
  return unknown_count_ > 0 && factor_.info() == Eigen::Success && isOfOneMaterial(cells, model) &&
         std::all_of(shares.begin(), shares.end(),
                     [this](const NodeWeight& share) { return unknowns_.count(share.node) != 0; });
}

void LocalLattice::make(int middle, const Lattice& lattice, const CellSet& cells,
                        const ElasticModel& model) {
  middle_ = middle;
  findNodes(lattice, cells);
  if (unknown_count_ > 0) factor_.compute(stiffness(cells, model));
}

// By cells, so that what a cut has parted is apart.
void LocalLattice::findNodes(const Lattice& lattice, const CellSet& cells) {
  nodes_.clear();
  unknowns_.clear();
  unknown_count_ = 0;
  std::set<int> met;
  std::size_t first = 0;
  addNode(middle_, lattice, cells);
  for (int ring = 0; ring <= kRings; ++ring) {
    const std::size_t last = nodes_.size();
    for (; first < last; ++first) {
      for (const CellSet::Meeting& meeting : cells.meetings(nodes_[first])) {
        const int number = static_cast<int>(meeting.cell);
        if (!met.insert(number).second || ring == kRings) continue;
        for (const int corner : cells.all()[at(number)].nodes) addNode(corner, lattice, cells);
      }
    }
  }
  own_cells_.assign(met.begin(), met.end());
}

// Unless it is there, or stands.
void LocalLattice::addNode(int node, const Lattice& lattice, const CellSet& cells) {
  const auto found = held_axes_.find(node);
  const std::uint8_t held = found == held_axes_.end() ? std::uint8_t{0} : found->second;
  if (held == kAllAxes || isFixed(lattice, cells, node)) return;
  const auto [unknowns, is_new] = unknowns_.try_emplace(node);
  if (!is_new) return;
  nodes_.push_back(node);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const bool is_held = (held >> axis & 1U) != 0;
    unknowns->second[axis] = is_held ? kNone : unknown_count_++;
  }
}

LocalLattice::Matrix LocalLattice::stiffness(const CellSet& cells,
                                             const ElasticModel& model) const {
  std::vector<Eigen::Triplet<double>> entries;
  for (const int number : own_cells_) {
    const Cell& cell = cells.all()[at(number)];
    const CellHessian hessian = model.stiffnessAtRest(cell);
    const auto reached = reachedNodes(cell);
    const auto count = static_cast<int>(hessian.rows() / 3);
    std::vector<std::pair<int, int>> moving;  // row of the cell's, and of the piece
    for (int i = 0; i < count; ++i) {
      const auto found = unknowns_.find(reached[at(i)]);
      if (found == unknowns_.end()) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const int unknown = found->second[at(axis)];
        if (unknown != kNone) moving.emplace_back(3 * i + axis, unknown);
      }
    }
    for (const auto& [row, row_of_piece] : moving) {
      for (const auto& [column, column_of_piece] : moving) {
        entries.emplace_back(row_of_piece, column_of_piece, hessian(row, column));
      }
    }
  }
  Matrix matrix(unknown_count_, unknown_count_);
  matrix.setFromTriplets(entries.begin(), entries.end());
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
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    middle_at_rest += places_[i];
    middle += places_[i] + displacement[at(nodes_[i])];
  }
  middle_at_rest /= static_cast<double>(nodes_.size());
  middle /= static_cast<double>(nodes_.size());
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Vec3 now = places_[i] + displacement[at(nodes_[i])] - middle;
    products += now * (places_[i] - middle_at_rest).transpose();
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

bool LocalLattice::isDeepAt(const Vec3& place, const Vec3& inwards) const {
  return std::any_of(places_.begin(), places_.end(), [&](const Vec3& other) {
    const double depth = (other - place).dot(inwards);
    const double aside = (other - place - depth * inwards).norm();
    return depth >= kDeep * spacing_ && aside <= kAside * spacing_;
  });
}

double LocalLattice::compliance(const std::vector<NodeWeight>& shares,
                                const Vec3& direction) const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(unknown_count_);
  for (const NodeWeight& share : shares) {
    const std::array<int, 3>& unknowns = unknowns_.at(share.node);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double along = direction[static_cast<Eigen::Index>(axis)];
      if (unknowns[axis] != kNone) force[unknowns[axis]] += share.weight * along;
    }
  }
  const auto [below, above, part] = placeIn(kMissing, moduli_.poisson_ratio);
  const double missing = (1.0 - part) * below.compliance + part * above.compliance;
  return force.dot(factor_.solve(force)) + missing / (moduli_.shear * spacing_);
}

}  // namespace robot_tissue
