// One value of a scene with its key's full path, and the typed, ranged ways to read it.
// Every reading function throws InputError with one line that names the source, the path, the
// value as written and what is allowed. Nothing is clipped or converted in silence.
#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Allowed numbers: an interval, its ends among them. What each key may be: ranges.h.
struct Range {
  double lowest = 0.0;
  double highest = 0.0;
  std::string unit;

  bool contains(double value) const;
  std::string text() const;  // "a number from 0.25 to 0.49"
};

constexpr std::size_t kMostEntries = 10000;  // of a list

class Entry {
 public:
  // `source`: file or node that the value stands in. `path`: of the key, empty for the whole scene.
  // An undefined node is a missing entry: reading it fails with what would be allowed.
  Entry(const YAML::Node& node, std::string path, std::string source, int parent_line = 0);

  bool given() const { return node_.IsDefined(); }
  const YAML::Node& node() const { return node_; }
  const std::string& path() const { return path_; }
  Entry child(const YAML::Node& node, const std::string& key) const;

  double number(const Range& range) const;
  double numberOr(double otherwise, const Range& range) const;
  int integer(int lowest, int highest) const;
  int integerOr(int otherwise, int lowest, int highest) const;
  bool truth() const;                                  // true or false
  std::string word(const std::string& allowed) const;  // not empty, `allowed` says what it is
  Vec3 vec3(const Range& range) const;
  Vec3 vec3Or(const Vec3& otherwise, const Range& range) const;
  std::string choice(const std::vector<std::string>& allowed) const;
  // `what` names the entries, e.g. "patches".
  std::vector<Entry> list(std::size_t at_least, const std::string& what,
                          std::size_t at_most = kMostEntries) const;
  bool isWord(const std::string& word) const;

  // "scene.yaml:7: tissue.spacing = -1: must be ..."; `reason` is the part after the value.
  [[noreturn]] void fail(const std::string& reason) const;
  std::string line(const std::string& reason) const;

 private:
  YAML::Node node_;
  std::string path_;
  std::string source_;
  int line_ = 0;  // 1-based, 0 = unknown
};

}  // namespace robot_tissue
