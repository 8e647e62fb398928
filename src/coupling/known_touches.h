// What is asked of all touches for each contact, answered without looking at all of them.
//
// It is made for one pass over contacts. In that, touches may be added at the end; those that are
// there stay on their vertex or triangle, and of one that goes elsewhere on its link this is told.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <unsupported/Eigen/BVH>
#include <vector>

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {

class KnownTouches {
 public:
  using Touch = SlidingContacts::ContactConstraint;

  explicit KnownTouches(std::vector<Touch>& touches) : touches_(touches) {}

  // The touch that a contact is of: the same vertex or, within a triangle, the nearest within
  // kSamePoint. What a vertex beside a face touches besides, as the tool's side, is another.
  Touch* find(const Contact& contact, const TissueSurface& surface);
  // All of the link that are on the contact's vertex or in its triangle, the newest first.
  std::vector<std::size_t> touchesAt(const Contact& contact, const TissueSurface& surface);
  // Friction over normal force of the link's touch that pushes and is nearest to the point; zero
  // when none does.
  Vec3 frictionRatioNear(int link, const Vec3& point);
  void moved(const Touch& touch);

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  struct Pushing {
    Vec3 tool_point;  // m, as it was taken
    std::size_t touch;
    friend Box bounding_box(const Pushing& pushing) { return Box(pushing.tool_point); }
  };
  class NearestPushing;

  static std::uint64_t placeOf(int link, int vertex, int triangle);
  std::size_t newestAt(std::uint64_t place);
  void treePushing();

  std::vector<Touch>& touches_;
  std::unordered_map<std::uint64_t, std::size_t> newest_;  // touch at a link's place
  std::vector<std::size_t> before_;                        // per touch: the next older one there
  bool has_trees_ = false;
  std::size_t pushing_ = 0;                                // in `trees_`, or all in `strays_`
  std::map<int, Eigen::KdBVH<double, 3, Pushing>> trees_;  // per link: where those that push were
  std::vector<std::size_t> strays_;                        // moved since, or all, if few
};

}  // namespace robot_tissue
