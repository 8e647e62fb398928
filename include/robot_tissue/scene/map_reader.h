// A map of a scene: refuses unknown and repeated keys when it is made, so that a misspelled key is
// reported as such and not as the absence of the right one.
#pragma once

#include <string>
#include <vector>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/entry.h"

namespace robot_tissue {

// Whether a box may have no extent along an axis.
enum class FlatBox { kAllowed, kRefused };

class MapReader {
 public:
  MapReader(const Entry& map, std::vector<std::string> keys);

  // Missing keys give an entry that is not given().
  Entry operator[](const std::string& key) const;
  const Entry& entry() const { return map_; }

  // The keys `min` and `max`.
  Box box(const Range& range, FlatBox flat) const;

 private:
  Entry map_;
  std::vector<std::string> keys_;
};

// The allowed word nearest to a misspelled one, empty when none is near.
std::string nearestWord(const std::string& word, const std::vector<std::string>& allowed);

std::string joined(const std::vector<std::string>& words, const std::string& separator = ", ");

}  // namespace robot_tissue
