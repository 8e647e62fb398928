#include "touch_places.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace robot_tissue {
namespace {

using Touch = SlidingContacts::ContactConstraint;

bool isBefore(const Vec3& a, const Vec3& b) {
  return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// The different corners of the touches' triangles.
class KnownCorners {
 public:
  explicit KnownCorners(const std::vector<Touch>& touches) {
    for (const Touch& touch : touches) {
      for (const Vec3& corner : touch.corners) {
        corners_.push_back(corner);
        bounds_.extend(corner);
      }
    }
    std::sort(corners_.begin(), corners_.end(), isBefore);
    corners_.erase(std::unique(corners_.begin(), corners_.end()), corners_.end());
  }
  std::size_t count() const { return corners_.size(); }
  // -1: it is none of them.
  int numberOf(const Vec3& corner) const {
    if (!bounds_.contains(corner)) return -1;
    const auto place = std::lower_bound(corners_.begin(), corners_.end(), corner, isBefore);
    const bool is_known = place != corners_.end() && *place == corner;
    return is_known ? static_cast<int>(place - corners_.begin()) : -1;
  }

 private:
  std::vector<Vec3> corners_;
  Box bounds_;
};

// Where the touches of another surface are on this one.
class PlacesOn {
 public:
  PlacesOn(const TissueSurface& surface, const std::vector<Touch>& touches)
      : known_(touches), places_(known_.count()), vertices_(known_.count(), 0) {
    std::vector<int> numbers;  // per vertex
    numbers.reserve(surface.rest.size());
    for (const Vec3& vertex : surface.rest) {
      numbers.push_back(known_.numberOf(vertex));
      if (numbers.back() >= 0) ++vertices_[at(numbers.back())];
    }
    for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
      MeshTriangle corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = numbers[at(surface.triangles[triangle][k])];
        if (corners[k] < 0) continue;
        places_[at(corners[k])] = {static_cast<int>(triangle), Vec3::Unit(static_cast<int>(k))};
      }
      if (*std::min_element(corners.begin(), corners.end()) < 0) continue;
      triangles_.emplace(corners, static_cast<int>(triangle));
    }
  }

  std::optional<SurfacePoint> of(const Touch& touch) const {
    MeshTriangle corners{};
    for (std::size_t k = 0; k < 3; ++k) corners[k] = known_.numberOf(touch.corners[k]);
    Eigen::Index nearest = 0;
    touch.contact.place.barycentric.maxCoeff(&nearest);
    const int corner = corners[at(static_cast<int>(nearest))];
    if (touch.vertex >= 0 && vertices_[at(corner)] == 1) return places_[at(corner)];
    const auto found = triangles_.find(corners);
    if (found == triangles_.end()) return std::nullopt;
    return SurfacePoint{found->second, touch.contact.place.barycentric};
  }

 private:
  KnownCorners known_;
  std::vector<SurfacePoint> places_;       // per known corner: of a vertex there
  std::vector<int> vertices_;              // likewise: how many there are
  std::map<MeshTriangle, int> triangles_;  // that have known corners alone, by their numbers
};

}  // namespace

void putContact(const Contact& contact, const TissueSurface& surface, Touch& touch) {
  touch.contact = contact;
  const auto& [a, b, c] = surface.triangles[at(contact.place.triangle)];
  touch.corners = {surface.rest[at(a)], surface.rest[at(b)], surface.rest[at(c)]};
}

void noteSolved(Touch& touch) {
  touch.solved = touch.spring;
  touch.solved_at = touch.contact.place.barycentric;
  touch.solved_bulge = touch.contact.bulge;
}

bool SlidingContacts::takeSurface(const RobotPose& pose, const Tissue& tissue) {
  const TissueSurface& surface = tissue.surface();
  const PlacesOn places(surface, touches_);
  std::vector<ContactConstraint> here;
  for (ContactConstraint& touch : touches_) {
    const std::optional<SurfacePoint> place = places.of(touch);
    const bool is_known = place && !touch.solved.carriers.empty();
    is_settled_ = is_settled_ && (is_known || touch.spring.multiplier <= 0.0);
    if (!place) continue;
    touch.contact.place = *place;
    touch.vertex = vertexAt(surface, *place);
    touch.spring.carriers = carriersAt(surface, *place);
    here.push_back(std::move(touch));
  }
  touches_ = std::move(here);
  if (is_settled_) goOnAsSolved(surface);
  for (ContactConstraint& touch : touches_) showColumns(tissue, touch);
  commit(pose, tissue);
  return is_settled_;
}

// Those that the last solve did not have are found again.
void SlidingContacts::goOnAsSolved(const TissueSurface& surface) {
  const auto is_new = [](const Touch& touch) { return touch.solved.carriers.empty(); };
  touches_.erase(std::remove_if(touches_.begin(), touches_.end(), is_new), touches_.end());
  for (Touch& touch : touches_) {
    if (touch.vertex < 0) touch.contact.place.barycentric = touch.solved_at;
    touch.contact.bulge = touch.solved_bulge;
    touch.spring = touch.solved;
    touch.spring.carriers = carriersAt(surface, touch.contact.place);
  }
}

}  // namespace robot_tissue
