// The nearest of many points, without looking at all of them (k-d tree; Bentley 1975).
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

class PointTree {
 public:
  struct Entry {
    Vec3 point = Vec3::Zero();  // m
    std::size_t id = 0;
  };
  struct Nearest {
    double off = 0.0;  // m
    std::size_t id = 0;

    // Of points that are as near, the one with the lower number.
    bool isBefore(const Nearest& other) const {
      return off < other.off || (off == other.off && id < other.id);
    }
  };
  using Counts = std::function<bool(const Entry&)>;

  PointTree() = default;
  explicit PointTree(std::vector<Entry> entries);

  std::size_t size() const { return nodes_.size(); }
  // Among those that count; nothing where none does.
  std::optional<Nearest> nearest(const Vec3& point, const Counts& counts) const;

 private:
  struct Node {
    Entry entry;
    int axis = 0;  // across which it parts those before it from those after it
  };

  void part(std::size_t begin, std::size_t end);
  void look(std::size_t begin, std::size_t end, const Vec3& point, const Counts& counts,
            std::optional<Nearest>& found) const;

  std::vector<Node> nodes_;  // each range is parted by the node in its middle
};

}  // namespace robot_tissue
