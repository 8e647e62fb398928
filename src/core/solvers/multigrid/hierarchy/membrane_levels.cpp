#include "solvers/multigrid/hierarchy/membrane_levels.h"

#include <algorithm>
#include <utility>

#include "solvers/multigrid/hierarchy/tuning.h"

namespace robot_tissue {
namespace {

namespace tuning = hierarchy_tuning;

}  // namespace

template <typename Real>
void MembraneLevels<Real>::add(LevelMembrane<Real> membrane,
                               const std::vector<GridTransfer<Real>>& transfers,
                               Levels& levels) const {
  levels.front().setMembrane(std::move(membrane));
  for (std::size_t level = 1; level < levels.size(); ++level) {
    std::vector<NodeShares> carriers(at(levels[level - 1].count()));
    for (const int entry : levels[level - 1].membrane()->entries()) {
      carriers[at(entry)] = transfers[level - 1].carriersOf(entry);
    }
    levels[level].setMembrane({*levels[level - 1].membrane(), carriers});
  }
}

// Coarse ones by what holds the nodes of finer ones. False: that is as it was.
template <typename Real>
bool MembraneLevels<Real>::bind(Levels& levels) {
  bool is_new = false;
  held_.resize(levels.size());
  for (std::size_t level = 0; level < levels.size(); ++level) {
    if (is_new) levels[level].bindMembrane(levels[level - 1]);
    is_new = is_new || held_[level] != levels[level].dirichletMask();
    held_[level] = levels[level].dirichletMask();
  }
  return is_new;
}

template <typename Real>
bool MembraneLevels<Real>::areNew(const GridLevel<Real>& finest) const {
  if (displacement_.front().empty()) return false;
  double farthest = 0.0;
  for (const int entry : finest.membrane()->entries()) {
    const Vec3 moved = vectorAt(finest.displacement, entry) - vectorAt(displacement_, entry);
    farthest = std::max(farthest, moved.squaredNorm());
  }
  return farthest <= tuning::kSameMembrane * tuning::kSameMembrane;
}

template <typename Real>
bool MembraneLevels<Real>::renew(Levels& levels) {
  if (!levels.front().membrane()) return false;
  if (!bind(levels) && areNew(levels.front())) return false;
  for (GridLevel<Real>& level : levels) level.renewMembrane();
  displacement_ = levels.front().displacement;
  return true;
}

template <typename Real>
void MembraneLevels<Real>::forget(Levels& levels) {
  displacement_ = Field<Real>();
  for (GridLevel<Real>& level : levels) {
    if (level.membrane()) level.membrane()->forget();
  }
}

template <typename Real>
void MembraneLevels<Real>::couple(bool together, Levels& levels) const {
  for (GridLevel<Real>& level : levels) level.coupleMembrane(together);
}

template class MembraneLevels<float>;
template class MembraneLevels<double>;

}  // namespace robot_tissue
