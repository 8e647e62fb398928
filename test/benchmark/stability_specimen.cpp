#include "stability_specimen.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "cutting/cut.h"
#include "loads/patch_rim.h"

namespace robot_tissue {

Specimen::Specimen(TissueConfig tissue, const SolverConfig& solver)
    : tissue_(std::move(tissue)),
      solver_(solver),
      lattice_(std::make_unique<Lattice>(tissue_)),
      state_(lattice_->restState()) {
  makeMethod();
}

void Specimen::makeMethod() {
  method_.reset();
  model_ = makeModel(tissue_, *lattice_);
  method_ = robot_tissue::makeMethod(solver_, *lattice_, *model_);
}

void Specimen::setGravity(const Vec3& gravity) {
  if (tissue_.gravity == gravity) return;
  tissue_.gravity = gravity;
  is_disturbed_ = true;
  makeMethod();
}

void Specimen::addPatch(const Box& box) {
  LoadingPatch patch;
  patch.name = "patch" + std::to_string(patches_.size());
  patch.nodes = lattice_->nodesIn(box);
  for (const int node : patch.nodes) patch.displacement.push_back(state_.displacement[at(node)]);
  boxes_.push_back(box);
  patches_.push_back(std::move(patch));
}

void Specimen::move(std::size_t index, const Vec3& displacement) {
  LoadingPatch& patch = patches_[index];
  if (patch.rim.empty() && method_->findsEquilibrium()) {
    patch.rim = rimOf(*lattice_, *model_, state_, boxes_[index], patch.nodes);
  }
  for (Vec3& of_node : patch.displacement) of_node = displacement;
  for (RimSpring& spring : patch.rim) spring.anchor = displacement;
}

void Specimen::turn(std::size_t index, const Vec3& turn, const Vec3& displacement) {
  LoadingPatch& patch = patches_[index];
  patch.rim.clear();
  const Vec3 center = centerOf(index);
  const double angle = turn.norm();
  const Vec3 axis = angle > 0.0 ? Vec3(turn / angle) : Vec3::UnitZ();
  const Eigen::Matrix3d rotation = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    const Vec3 arm = lattice_->restPosition(patch.nodes[i]) - center;
    patch.displacement[i] = displacement + rotation * arm - arm;
  }
}

void Specimen::cut(const std::vector<Vec3>& corners) {
  sever(*lattice_, springsAcross(*lattice_, state_, corners), state_, model_->splitCells());
  is_disturbed_ = true;
}

void Specimen::solve() {
  std::vector<int> disturbed;
  const int nodes = std::exchange(is_disturbed_, false) ? state_.cells->nodeCount() : 0;
  for (int node = 0; node < nodes; ++node) {
    if (!isFixed(*lattice_, *state_.cells, node)) disturbed.push_back(node);
  }
  method_->beginStep(state_);
  const SolveReport report = method_->solve(patches_, disturbed, state_);
  answers_ = report.patches;
  ++course_.solves;
  course_.iterations += report.iterations;
  course_.ms += report.wall_ms;
  course_.worst = std::max(course_.worst, report.status);
  if (report.status != SolveStatus::kOk) ++course_.unconverged;
  course_.error_estimate = std::max(course_.error_estimate, report.error_estimate);
  course_.residual = std::max(course_.residual, report.residual);
  const bool all_finite = std::all_of(state_.displacement.begin(), state_.displacement.end(),
                                      [](const Vec3& u) { return u.allFinite(); });
  course_.finite = course_.finite && all_finite && std::isfinite(report.error_estimate) &&
                   std::isfinite(report.residual);
  for (const PatchAnswer& answer : answers_) {
    course_.finite = course_.finite && answer.force.allFinite() && answer.torque.allFinite();
  }
}

void Specimen::release() {
  patches_.clear();
  boxes_.clear();
  setGravity(Vec3::Zero());
  method_->forget();
  is_disturbed_ = true;
  solve();
}

void Specimen::releaseFromRest() {
  patches_.clear();
  boxes_.clear();
  method_->forget();
  is_disturbed_ = true;
  std::fill(state_.displacement.begin(), state_.displacement.end(), Vec3::Zero());
  solve();
}

Vec3 Specimen::centerOf(std::size_t patch) const {
  Vec3 center = Vec3::Zero();
  for (const int node : patches_[patch].nodes) center += lattice_->restPosition(node);
  return center / static_cast<double>(patches_[patch].nodes.size());
}

double Specimen::force(std::size_t patch) const { return answers_.at(patch).force.norm(); }

double Specimen::torque(std::size_t patch) const {
  const PatchAnswer& answer = answers_.at(patch);
  return (answer.torque - centerOf(patch).cross(answer.force)).norm();
}

// Nodes that cells hold together, or, where a cut has left no cells, springs; single nodes that
// nothing holds are none.
std::vector<std::vector<int>> Specimen::pieces() const {
  std::vector<int> root(state_.displacement.size());
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int node) {
    while (root[at(node)] != node) node = root[at(node)] = root[at(root[at(node)])];
    return node;
  };
  for (const Cell& cell : state_.cells->all()) {
    for (const int node : cell.nodes) root[at(find(node))] = find(cell.nodes[0]);
  }
  if (model_->splitCells() == SplitCells::kLost) {
    for (std::size_t i = 0; i < lattice_->springs().size(); ++i) {
      const Spring& spring = lattice_->springs()[i];
      if (!state_.severed[i]) root[at(find(spring.a))] = find(spring.b);
    }
  }
  std::vector<std::vector<int>> groups(root.size());
  for (int node = 0; node < static_cast<int>(root.size()); ++node) {
    groups[at(find(node))].push_back(node);
  }
  groups.erase(std::remove_if(groups.begin(), groups.end(),
                              [](const std::vector<int>& group) { return group.size() < 2; }),
               groups.end());
  return groups;
}

double Specimen::distanceFromRest() const {
  double farthest = 0.0;
  if (!course_.finite) return std::numeric_limits<double>::infinity();
  for (const std::vector<int>& piece : pieces()) {
    const bool held = std::any_of(piece.begin(), piece.end(), [&](int node) {
      return isFixed(*lattice_, *state_.cells, node);
    });
    farthest = std::max(farthest, held ? farthestOf(piece) : deformationOf(piece));
  }
  return farthest;
}

double Specimen::farthestOf(const std::vector<int>& piece) const {
  double farthest = 0.0;
  for (const int node : piece) {
    farthest = std::max(farthest, state_.displacement[at(node)].norm());
  }
  return farthest;
}

// The rotation that fits best: Kabsch 1976.
double Specimen::deformationOf(const std::vector<int>& piece) const {
  const double count = static_cast<double>(piece.size());
  const auto rest = [&](int node) { return restPosition(*lattice_, *state_.cells, node); };
  Vec3 rest_center = Vec3::Zero(), way = Vec3::Zero();
  double moved = 0.0;
  for (const int node : piece) {
    rest_center += rest(node) / count;
    way += state_.displacement[at(node)] / count;
    moved += state_.displacement[at(node)].squaredNorm();
  }
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const int node : piece) {
    const Vec3 arm = rest(node) - rest_center;
    spread += (arm + state_.displacement[at(node)] - way) * arm.transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(spread, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs = Vec3::Ones();
  signs.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d rotation = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  double left = 0.0;
  for (const int node : piece) {
    const Vec3 arm = rest(node) - rest_center;
    left += (arm + state_.displacement[at(node)] - way - rotation * arm).squaredNorm();
  }
  return std::max(std::sqrt(left / count) - solver_.tolerance * std::sqrt(moved / count), 0.0);
}

}  // namespace robot_tissue
