#include "robot_tissue/coupling/press_growth.h"

#include <algorithm>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

void PressGrowth::note(const std::vector<Pose>& links, std::vector<Press> presses) {
  links_before_ = std::exchange(links_, links);
  presses_before_ = std::exchange(presses_, std::move(presses));
}

bool PressGrowth::isKnown(std::size_t link) const {
  return link < links_before_.size() && link < links_.size() && presses_before_[link].force > 0.0 &&
         presses_[link].force > 0.0;
}

double PressGrowth::shareOfLastWay(std::size_t link, const Pose& pose) const {
  if (!isKnown(link)) return 0.0;
  const Vec3& place = presses_[link].place;
  const Vec3 on_link = links_[link].inverse() * place;
  const Vec3 last_way = place - links_before_[link] * on_link;
  const Vec3 way = pose * on_link - place;
  const double far = place.norm() + links_[link].translation().norm();
  if (last_way.norm() <= tuning::kStoodStill * far) return 0.0;
  return std::clamp(way.dot(last_way) / last_way.squaredNorm(), -1.0, 1.0);
}

double PressGrowth::times(std::size_t link, const Pose& pose) const {
  const double share = shareOfLastWay(link, pose);
  if (share == 0.0) return 1.0;
  const double before = presses_before_[link].force, now = presses_[link].force;
  const double growth = share * (now - before) / now;
  return 1.0 + std::clamp(growth, -tuning::kMostGrowth, tuning::kMostGrowth);
}

}  // namespace robot_tissue
