// What touches are taken to do before a solve shows it: how a load step begins, and planes that go
// to and fro from round to round.
#include <algorithm>
#include <set>
#include <vector>

#include "rim_touch.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "touch_spring.h"
#include "tuning.h"

namespace robot_tissue {

// Forces, and the recesses that hang on them, as they grew or fell along the last way.
void SlidingContacts::growAlongWay(const RobotPose& pose, const Tissue& tissue) {
  const auto asked = [&](std::size_t link) {
    const bool stays = growth_.times(link, pose.links[link]) == 1.0;
    if (stays || !tellsRecesses(tissue) || forms_[link].indenters.empty()) return 0.0;
    return recessAsked(static_cast<int>(link), since_links_[link], tissue).depth;
  };
  std::vector<double> depths;  // of recesses, less what the forces of before ask for
  for (std::size_t link = 0; link < recesses_.size(); ++link) {
    depths.push_back(recesses_[link].depth - asked(link));
  }
  for (ContactConstraint& touch : touches_) {
    const std::size_t link = at(touch.contact.link);
    const double times = growth_.times(link, pose.links[link]);
    touch.spring.multiplier *= times;
    touch.spring.friction_bound *= times;
  }
  for (std::size_t link = 0; link < recesses_.size(); ++link) {
    recesses_[link] = LinkRecess();
    setRecess(static_cast<int>(link), depths[link] + asked(link));
  }
}

// A link that has only just met the tissue has no multipliers, so no bound of friction is known.
// What is in it sticks in the first solve (a bound that is never reached): with none the tissue
// would slide off before it is held. What is near it only does not: it would be drawn along.
void SlidingContacts::stickFirst(const Tissue& tissue) {
  std::set<int> pushing;
  for (const ContactConstraint& touch : touches_) {
    if (touch.spring.multiplier > 0.0) pushing.insert(touch.contact.link);
  }
  for (ContactConstraint& touch : touches_) {
    if (friction_[at(touch.contact.tool)].value_or(0.0) <= 0.0 ||
        pushing.count(touch.contact.link) != 0)
      continue;
    ContactSpring& spring = touch.spring;
    if (gapOf(spring, tissue.state().displacement) >
        tuning::kMayStickFirst * tissue.lattice().spacing())
      continue;
    const double stiffness = frictionStiffness(touch.firm_stiffness);
    spring.friction_stiffness = softened(stiffness, touch.compliance.friction);
    spring.friction_bound = tuning::kMostForce * stiffness * tissue.lattice().spacing();
  }
}

// Between vertices planes are off the surface by its bulge, which the next shape has otherwise:
// near incompressible tissue goes to and fro with it. Where the ways of a link's planes turn back,
// they go by less, the same share of them all: so that nothing would be left if that went on
// (Aitken's relaxation, Irons and Tuck 1969).
void SlidingContacts::calmPlanes(const RobotPose& pose) {
  std::vector<double> along(pose.links.size(), 0.0), squared(pose.links.size(), 0.0);
  for (const ContactConstraint& touch : touches_) {
    if (!touch.way || !touch.last_way) continue;
    const double change = *touch.way - *touch.last_way;
    along[at(touch.contact.link)] -= change * *touch.last_way;
    squared[at(touch.contact.link)] += change * change;
  }
  plane_shares_.resize(pose.links.size(), 1.0);
  for (std::size_t link = 0; link < pose.links.size(); ++link) {
    if (squared[link] <= 0.0) continue;
    const double share = plane_shares_[link] * along[link] / squared[link];
    plane_shares_[link] = std::clamp(share, tuning::kLeastPlaneShare, 1.0);
  }
  for (ContactConstraint& touch : touches_) {
    const double share = plane_shares_[at(touch.contact.link)];
    if (!touch.way || share == 1.0) continue;
    touch.tool_point -= (1.0 - share) * *touch.way * touch.spring.normal;
    putPlane(touch);
    anchor(pose, touch);
  }
}

}  // namespace robot_tissue
