#include "robot_tissue/scene/map_reader.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "robot_tissue/scene/value_text.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Levenshtein distance: letters to put in, take out or change.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t change = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, change});
    }
  }
  return row[b.size()];
}

}  // namespace

std::string nearestWord(const std::string& word, const std::vector<std::string>& allowed) {
  std::string nearest;
  if (word.size() > tuning::kLongestWord) return nearest;
  std::size_t smallest = 3;
  for (const std::string& candidate : allowed) {
    const std::size_t distance = editDistance(word, candidate);
    if (distance < smallest && distance < candidate.size() / 2 + 1) {
      smallest = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

MapReader::MapReader(const Entry& map, std::vector<std::string> keys)
    : map_(map), keys_(std::move(keys)) {
  const std::string allowed = keys_.empty() ? "" : " of " + joined(keys_);
  if (!map_.given() || !map_.node().IsMap()) {
    map_.fail(keys_.empty() ? "must be {}" : "must be a map" + allowed);
  }
  std::set<std::string> seen;
  for (const auto& item : map_.node()) {
    if (!item.first.IsScalar()) map_.fail("every key must be a word");
    const std::string& key = item.first.Scalar();
    const Entry entry = map_.child(item.second, key.empty() ? "\"\"" : shortText(key));
    if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) {
      const std::string nearest = nearestWord(key, keys_);
      entry.fail("unknown key" + (nearest.empty() ? "" : ", did you mean " + nearest + "?") +
                 (keys_.empty() ? ", no key is allowed here" : ", must be one" + allowed));
    }
    if (!seen.insert(key).second) entry.fail("the key stands here twice, must stand once");
  }
}

Entry MapReader::operator[](const std::string& key) const {
  if (std::find(keys_.begin(), keys_.end(), key) == keys_.end()) {
    throw std::logic_error("scene key '" + key + "' is read but not allowed");
  }
  for (const auto& item : map_.node()) {
    if (item.first.Scalar() == key) return map_.child(item.second, key);
  }
  return map_.child(YAML::Node(YAML::NodeType::Undefined), key);
}

Box MapReader::box(const Range& range, FlatBox flat) const {
  const bool strict = flat == FlatBox::kRefused;
  const Box box{(*this)["min"].vec3(range), (*this)["max"].vec3(range)};
  const std::vector<Entry> upper = (*this)["max"].list(3, "numbers");
  for (int axis = 0; axis < 3; ++axis) {
    if (box.max()[axis] > box.min()[axis] || (!strict && box.max()[axis] == box.min()[axis]))
      continue;
    upper[static_cast<std::size_t>(axis)].fail(std::string("must be ") + (strict ? "> " : ">= ") +
                                               "min[" + std::to_string(axis) +
                                               "] = " + numberText(box.min()[axis]));
  }
  return box;
}

}  // namespace robot_tissue
