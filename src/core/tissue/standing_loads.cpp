#include "tissue/standing_loads.h"

#include <algorithm>
#include <iterator>

#include "robot_tissue/core/lattice.h"

namespace robot_tissue {
namespace {

// Drops the nodes of the patch that are gone; of ghosts, which tools' patches may be on, the
// patches that follow tell.
void loseNodes(const LatticeState& state, LoadingPatch& patch) {
  std::vector<int> nodes;
  std::vector<Vec3> displacement;
  for (std::size_t i = 0; i < patch.nodes.size(); ++i) {
    if (isGone(state, patch.nodes[i])) continue;
    nodes.push_back(patch.nodes[i]);
    if (!byForce(patch)) displacement.push_back(patch.displacement[i]);
  }
  patch.nodes = std::move(nodes);
  patch.displacement = std::move(displacement);
  patch.rim.erase(
      std::remove_if(patch.rim.begin(), patch.rim.end(),
                     [&](const RimSpring& spring) { return isGone(state, spring.node); }),
      patch.rim.end());
}

bool isOf(const LoadingPatch& patch, int node) {
  return std::binary_search(patch.nodes.begin(), patch.nodes.end(), node);
}

// No tissue is left between the node, beside the patch, and the patch's own ones.
bool isPartedFrom(const LoadingPatch& patch, int node, const CellSet& cells) {
  if (isOf(patch, node)) return false;
  for (const CellSet::Meeting& met : cells.meetings(node)) {
    const Cell& cell = cells.all()[at(met.cell)];
    if (!cell.owns(static_cast<int>(met.corner))) continue;
    for (int corner = 0; corner < kCorners; ++corner) {
      if (cell.owns(corner) && isOf(patch, cell.nodes[at(corner)])) return false;
    }
  }
  return true;
}

std::ptrdiff_t offset(std::size_t number) { return static_cast<std::ptrdiff_t>(number); }

}  // namespace

bool areOnALine(const Lattice& lattice, const std::vector<int>& nodes) {
  if (nodes.empty()) return true;
  const auto place = [&](int node) -> Eigen::Vector3i {
    const auto index = lattice.gridIndex(node);
    return {index[0], index[1], index[2]};
  };
  const Eigen::Vector3i first = place(nodes.front()), way = place(nodes.back()) - first;
  return std::all_of(nodes.begin(), nodes.end(),
                     [&](int node) { return (place(node) - first).cross(way).isZero(); });
}

Vec3 restCenter(const Lattice& lattice, const std::vector<int>& nodes) {
  Vec3 center = Vec3::Zero();
  for (const int node : nodes) {
    center += lattice.restPosition(node) / static_cast<double>(nodes.size());
  }
  return center;
}

// For all x, c' + d' + R (x - c') = c + d + R (x - c).
PatchPlace placeAbout(const Vec3& center, const LoadingPatch& patch) {
  if (center == patch.center) return patch.place;
  PatchPlace place = patch.place;
  const Vec3 moved = center - patch.center;
  place.displacement += place.rotation * moved - moved;
  return place;
}

std::vector<LoadingPatch> StandingLoads::namedLoads() const {
  return {patches_.begin(), patches_.begin() + offset(named_)};
}

std::optional<std::size_t> StandingLoads::numberOf(const std::string& name) const {
  for (std::size_t number = 0; number < named_; ++number) {
    if (patches_[number].name == name) return number;
  }
  return std::nullopt;
}

const LoadingPatch* StandingLoads::find(const std::string& name) const {
  const std::optional<std::size_t> number = numberOf(name);
  return number ? &patches_[*number] : nullptr;
}

PatchAnswer StandingLoads::answerOf(const std::string& name, const SolveReport& report) const {
  const std::optional<std::size_t> number = numberOf(name);
  return number && *number < report.patches.size() ? report.patches[*number] : PatchAnswer();
}

bool StandingLoads::isOneLeftBy(const std::vector<LoadingPatch>& of_tools) const {
  return std::any_of(
      patches_.begin() + offset(named_), patches_.end(), [&](const LoadingPatch& earlier) {
        return std::none_of(of_tools.begin(), of_tools.end(),
                            [&](const LoadingPatch& now) { return now.name == earlier.name; });
      });
}

std::size_t StandingLoads::place(const LoadingPatch& patch) {
  if (const std::optional<std::size_t> number = numberOf(patch.name)) {
    patches_[*number] = patch;
    return *number;
  }
  patches_.insert(patches_.begin() + offset(named_), patch);
  return named_++;
}

void StandingLoads::putToolPatches(std::vector<LoadingPatch> of_tools) {
  patches_.erase(patches_.begin() + offset(named_), patches_.end());
  std::move(of_tools.begin(), of_tools.end(), std::back_inserter(patches_));
}

void StandingLoads::remove(std::size_t number) {
  dropDue(patches_[number].name);
  patches_.erase(patches_.begin() + offset(number));
  --named_;
}

void StandingLoads::take(std::vector<LoadingPatch> named_loads, std::vector<LoadingPatch> due) {
  patches_ = std::move(named_loads);
  named_ = patches_.size();
  due_ = std::move(due);
  are_coming_back_ = false;
}

void StandingLoads::restore(const std::vector<LoadingPatch>& patches, std::size_t named) {
  patches_ = patches;
  named_ = named;
}

void StandingLoads::putBack(const std::vector<LoadingPatch>& before, std::size_t named) {
  patches_.insert(patches_.begin(), before.begin(), before.end());
  named_ = named;
}

std::vector<std::string> StandingLoads::loseGoneNodes(const LatticeState& state,
                                                      std::vector<PatchAnswer>& answers) {
  forEach([&](LoadingPatch& patch) { loseNodes(state, patch); });
  std::vector<std::string> lost;
  for (std::size_t number = named_; number-- > 0;) {
    if (!patches_[number].nodes.empty()) continue;
    lost.push_back(patches_[number].name);
    if (number < answers.size()) answers.erase(answers.begin() + offset(number));
    remove(number);
  }
  return lost;
}

void StandingLoads::loseParted(const CellSet& cells) {
  forEach([&](LoadingPatch& patch) {
    const auto is_parted = [&](const RimSpring& spring) {
      return isPartedFrom(patch, spring.node, cells);
    };
    patch.rim.erase(std::remove_if(patch.rim.begin(), patch.rim.end(), is_parted), patch.rim.end());
  });
}

void StandingLoads::forEach(const std::function<void(LoadingPatch&)>& change) {
  std::for_each(patches_.begin(), patches_.end(), change);
  std::for_each(due_.begin(), due_.end(), change);
}

void StandingLoads::makeDue(const LoadingPatch& target) {
  const auto is_it = [&](const LoadingPatch& patch) { return patch.name == target.name; };
  if (std::none_of(due_.begin(), due_.end(), is_it)) due_.push_back(target);
}

void StandingLoads::dropDue(const std::string& name) {
  const auto is_it = [&](const LoadingPatch& patch) { return patch.name == name; };
  due_.erase(std::remove_if(due_.begin(), due_.end(), is_it), due_.end());
  if (due_.empty()) are_coming_back_ = false;
}

}  // namespace robot_tissue
