#include "shape_judge.h"

#include <algorithm>

#include "robot_tissue/core/carriers.h"
#include "tuning.h"

namespace robot_tissue {

bool ShapeJudge::isLost(const Checkpoint& good) const {
  return leaptFrom(good) || turnedOver(good) || wentThrough(good.depths) ||
         isSwallowed(good.contacts) || SlidingContacts::pushesAbsurdly(world_.tissue);
}

bool ShapeJudge::isOfNoTissue() const {
  return wentThrough({}) || SlidingContacts::pushesAbsurdly(world_.tissue);
}

bool ShapeJudge::isUnsettled() const {
  if (world_.tissue.goesThroughTime() || !world_.tissue.areContactsSettled()) return false;
  if (contact_update_.leftInside() > tuning::kTooDeep * world_.tissue.lattice().spacing()) {
    return true;
  }
  if (world_.tissue.lastReport().status != SolveStatus::kUnconverged) return false;
  const ForceBalance forces = forceBalanceOf(world_);
  return forces.unbalanced().norm() > tuning::kMostUnbalanced * forces.tools.norm();
}

// Whether a vertex of the surface went farther than kMostLeap spacings: no load step moves tissue
// that tools hold so far, so the solve threw it away.
bool ShapeJudge::leaptFrom(const Checkpoint& good) const {
  if (world_.tissue.isUntouched()) return false;
  const std::vector<Vec3>& now = world_.tissue.state().displacement;
  const std::vector<Vec3>& before = *good.shape.displacement;
  double farthest = 0.0;
  for (const CarrierRange carriers : world_.tissue.surface().carriers) {
    const Vec3 way = carriedFrom(
        Vec3::Zero(), carriers, [&](int node) -> Vec3 { return now[at(node)] - before[at(node)]; });
    farthest = std::max(farthest, way.squaredNorm());
  }
  const double leap = tuning::kMostLeap * world_.tissue.lattice().spacing();
  return farthest > leap * leap;
}

// More cells than before are inside out.
bool ShapeJudge::turnedOver(const Checkpoint& good) const {
  return world_.tissue.resistsInversion() &&
         world_.tissue.lastReport().inverted_cells > good.shape.report.inverted_cells;
}

// Whether a link or support is deeper in tissue that gives way than throughAt, and than it was. Of
// tools with rigid patches LoadStepper tells (deepestInRigid).
bool ShapeJudge::wentThrough(const std::vector<double>& depths_before) const {
  const std::vector<double>& depths = touch_finder_.depths();
  for (std::size_t tool = 0; tool < world_.tools.sizeWithSupports(); ++tool) {
    if (world_.tools.isRigid(static_cast<int>(tool))) continue;
    const std::size_t end = std::min(world_.tools.endLink(tool), depths.size());
    for (std::size_t link = world_.tools.firstLink(tool); link < end; ++link) {
      const double before = link < depths_before.size() ? depths_before[link] : 0.0;
      if (depths[link] > std::max(throughAt(link, world_.pose), before)) return true;
    }
  }
  return false;
}

// Whether a link that touched touches nothing any more and stands in the tissue all the same:
// contacts are found beside the surface, so one that is all inside has none.
bool ShapeJudge::isSwallowed(const SlidingContacts& contacts_before) const {
  std::vector<std::size_t> links;
  for (const SlidingContacts::ContactConstraint& touch : contacts_before.touches()) {
    const auto link = at(touch.contact.link);
    if (!world_.isInWound(link)) links.push_back(link);
  }
  std::sort(links.begin(), links.end());
  links.erase(std::unique(links.begin(), links.end()), links.end());
  const auto touches = [&](std::size_t link) {
    const auto& all = world_.sliding.touches();
    return std::any_of(all.begin(), all.end(),
                       [&](const auto& touch) -> bool { return at(touch.contact.link) == link; });
  };
  links.erase(std::remove_if(links.begin(), links.end(), touches), links.end());
  return !links.empty() && isAnyThrough(links, world_.pose);
}

bool ShapeJudge::isAnyThrough(const std::vector<std::size_t>& links, const RobotPose& pose) const {
  const std::vector<double> depths =
      world_.finder.penetrations(links, pose, world_.tissue.surface(), world_.tissue.vertices());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (depths[i] > throughAt(links[i], pose)) return true;
  }
  return false;
}

// Depth in the surface (m) beyond which a link is on its way to the other side of it.
double ShapeJudge::throughAt(std::size_t link, const RobotPose& pose) const {
  return std::min(tuning::kThrough * world_.tissue.lattice().spacing(),
                  tuning::kThroughOfThickness * world_.thicknessNear(link, pose.links[link]));
}

}  // namespace robot_tissue
