#include "known_touches.h"

#include <limits>
#include <utility>

#include "tuning.h"

namespace robot_tissue {

// The nearest to a point of those that are still where they were taken; of as near ones the oldest.
class KnownTouches::NearestPushing {
 public:
  using Scalar = double;

  NearestPushing(const std::vector<Touch>& touches, const Vec3& point)
      : touches_(touches), point_(point) {}

  std::size_t touch() const { return touch_; }
  double minimumOnObject(const Pushing& pushing) {
    if (touches_[pushing.touch].tool_point != pushing.tool_point) return off_;
    look(pushing.touch);
    return off_;
  }
  // A little less, so that one that is as near as the nearest is looked at.
  double minimumOnVolume(const Box& box) const {
    using Limits = std::numeric_limits<double>;
    return box.exteriorDistance(point_) * (1.0 - 8.0 * Limits::epsilon()) - Limits::min();
  }
  void look(std::size_t touch) {
    const double off = (touches_[touch].tool_point - point_).norm();
    if (off > off_ || (off == off_ && touch > touch_)) return;
    off_ = off;
    touch_ = touch;
  }

 private:
  const std::vector<Touch>& touches_;
  const Vec3 point_;
  double off_ = kInfinity;  // m
  std::size_t touch_ = kNone;
};

std::uint64_t KnownTouches::placeOf(int link, int vertex, int triangle) {
  const int place = vertex >= 0 ? vertex : -1 - triangle;
  return std::uint64_t{static_cast<std::uint32_t>(link)} << 32 | static_cast<std::uint32_t>(place);
}

std::size_t KnownTouches::newestAt(std::uint64_t place) {
  if (before_.empty()) newest_.reserve(touches_.size());
  while (before_.size() < touches_.size()) {
    const Touch& touch = touches_[before_.size()];
    const std::uint64_t there =
        placeOf(touch.contact.link, touch.vertex, touch.contact.place.triangle);
    const auto [known, is_first] = newest_.emplace(there, before_.size());
    const std::size_t before = is_first ? kNone : std::exchange(known->second, before_.size());
    before_.push_back(before);
  }
  const auto found = newest_.find(place);
  return found == newest_.end() ? kNone : found->second;
}

std::vector<std::size_t> KnownTouches::touchesAt(const Contact& contact,
                                                 const TissueSurface& surface) {
  std::vector<std::size_t> touches;
  const int vertex = vertexAt(surface, contact.place);
  for (std::size_t i = newestAt(placeOf(contact.link, vertex, contact.place.triangle)); i != kNone;
       i = before_[i]) {
    touches.push_back(i);
  }
  return touches;
}

// Of several on a vertex the oldest, as of those in a triangle that are as near.
KnownTouches::Touch* KnownTouches::find(const Contact& contact, const TissueSurface& surface) {
  const int vertex = vertexAt(surface, contact.place);
  Touch* nearest = nullptr;
  double least = tuning::kSamePoint;
  for (std::size_t i = newestAt(placeOf(contact.link, vertex, contact.place.triangle)); i != kNone;
       i = before_[i]) {
    Touch& touch = touches_[i];
    const Rim &known_rim = touch.contact.rim, &rim = contact.rim;
    const bool either_is_at_none = known_rim.edges.empty() || rim.edges.empty();
    if (known_rim.is_beyond != rim.is_beyond && either_is_at_none) continue;
    if (vertex >= 0) {
      nearest = &touch;
      continue;
    }
    const Vec3 way = touch.contact.place.barycentric - contact.place.barycentric;
    const double off = way.cwiseAbs().maxCoeff();
    if (off > least || off >= tuning::kSamePoint) continue;
    least = off;
    nearest = &touch;
  }
  return nearest;
}

// Few are looked at one by one.
void KnownTouches::treePushing() {
  std::map<int, std::vector<Pushing>> of_links;
  strays_.clear();
  for (std::size_t i = 0; i < touches_.size(); ++i) {
    if (touches_[i].spring.multiplier > 0.0) strays_.push_back(i);
  }
  pushing_ = strays_.size();
  trees_.clear();
  has_trees_ = true;
  if (pushing_ <= tuning::kFewTouches) return;
  for (const std::size_t i : strays_) {
    of_links[touches_[i].contact.link].push_back({touches_[i].tool_point, i});
  }
  for (const auto& [link, pushing] : of_links) trees_[link].init(pushing.begin(), pushing.end());
  strays_.clear();
}

// Looking at strays one by one costs no more than trees anew as long as they are few.
void KnownTouches::moved(const Touch& touch) {
  if (!has_trees_ || trees_.empty() || touch.spring.multiplier <= 0.0) return;
  strays_.push_back(static_cast<std::size_t>(&touch - touches_.data()));
  if (strays_.size() * strays_.size() > pushing_) has_trees_ = false;
}

Vec3 KnownTouches::frictionRatioNear(int link, const Vec3& point) {
  if (!has_trees_) treePushing();
  NearestPushing nearest(touches_, point);
  const auto tree = trees_.find(link);
  if (tree != trees_.end()) Eigen::BVMinimize(tree->second, nearest);
  for (const std::size_t stray : strays_) {
    if (touches_[stray].contact.link == link) nearest.look(stray);
  }
  const std::size_t touch = nearest.touch();
  return touch == kNone ? Vec3(Vec3::Zero()) : touches_[touch].friction_ratio;
}

}  // namespace robot_tissue
