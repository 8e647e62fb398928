// Points that nodes carry: a point moves by the sum of weight * displacement of node (own).
#pragma once

#include <initializer_list>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Where `place` is moved to (m). displacementOf(node): of a node (m).
template <typename Carriers, typename DisplacementOf>
Vec3 carriedFrom(Vec3 place, const Carriers& carriers, const DisplacementOf& displacementOf) {
  for (const auto& carrier : carriers) place += carrier.weight * displacementOf(carrier.node);
  return place;
}

template <typename Carriers>
Vec3 carriedFrom(const Vec3& place, const Carriers& carriers,
                 const std::vector<Vec3>& displacement) {
  return carriedFrom(place, carriers,
                     [&](int node) -> const Vec3& { return displacement[at(node)]; });
}

// What carries one point, where that is kept; it lasts as long as nothing is added there.
class CarrierRange {
 public:
  CarrierRange() = default;
  CarrierRange(const NodeWeight* begin, const NodeWeight* end) : begin_(begin), end_(end) {}

  const NodeWeight* begin() const { return begin_; }
  const NodeWeight* end() const { return end_; }
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  const NodeWeight& front() const { return *begin_; }
  const NodeWeight& operator[](std::size_t index) const { return begin_[index]; }

 private:
  const NodeWeight* begin_ = nullptr;
  const NodeWeight* end_ = nullptr;
};

// What carries each of many points, in one row: a surface along cuts has tens of thousands.
class CarrierLists {
 public:
  std::size_t size() const { return ends_.size(); }
  CarrierRange operator[](std::size_t point) const {
    const std::size_t first = point == 0 ? 0 : ends_[point - 1];
    return {all_.data() + first, all_.data() + ends_[point]};
  }
  void push_back(const CarrierRange& carriers) {
    all_.insert(all_.end(), carriers.begin(), carriers.end());
    ends_.push_back(all_.size());
  }
  void push_back(const std::vector<NodeWeight>& carriers) {
    push_back(CarrierRange(carriers.data(), carriers.data() + carriers.size()));
  }
  void push_back(std::initializer_list<NodeWeight> carriers) {
    push_back(CarrierRange(carriers.begin(), carriers.end()));
  }

  // Gives back the room that is left for more.
  void shrinkToFit() {
    all_.shrink_to_fit();
    ends_.shrink_to_fit();
  }

  class Iterator {
   public:
    Iterator(const CarrierLists& lists, std::size_t point) : lists_(lists), point_(point) {}
    CarrierRange operator*() const { return lists_[point_]; }
    Iterator& operator++() {
      ++point_;
      return *this;
    }
    bool operator!=(const Iterator& other) const { return point_ != other.point_; }

   private:
    const CarrierLists& lists_;
    std::size_t point_;
  };
  Iterator begin() const { return {*this, 0}; }
  Iterator end() const { return {*this, size()}; }

 private:
  std::vector<NodeWeight> all_;
  std::vector<std::size_t> ends_;  // per point, behind its last one
};

}  // namespace robot_tissue
