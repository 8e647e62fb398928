#include "robot_tissue/scene/entry.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

bool isPlainScalar(const YAML::Node& node) { return node.IsScalar() && !isText(node); }

std::optional<double> plainNumber(const YAML::Node& node) {
  return isPlainScalar(node) ? parseNumber(node.Scalar()) : std::nullopt;
}

std::string countText(std::size_t at_least, std::size_t at_most) {
  if (at_least == at_most) return "exactly " + std::to_string(at_least) + " ";
  if (at_least == 0) return "up to " + std::to_string(at_most) + " ";
  return std::to_string(at_least) + " to " + std::to_string(at_most) + " ";
}

}  // namespace

// Written so that NaN is in none.
bool Range::contains(double value) const { return value >= lowest && value <= highest; }

std::string Range::text() const {
  return "a number from " + numberText(lowest) + " to " + numberText(highest) +
         (unit.empty() ? "" : " in " + unit);
}

Entry::Entry(const YAML::Node& node, std::string path, std::string source, int parent_line)
    : node_(node), path_(std::move(path)), source_(std::move(source)), line_(parent_line) {
  if (!node_.IsDefined()) return;
  const YAML::Mark mark = node_.Mark();
  if (!mark.is_null()) line_ = mark.line + 1;
}

Entry Entry::child(const YAML::Node& node, const std::string& key) const {
  const bool index = !key.empty() && key.front() == '[';
  return Entry(node, path_.empty() || index ? path_ + key : path_ + "." + key, source_, line_);
}

std::string Entry::line(const std::string& reason) const {
  const std::string at = line_ > 0 ? ":" + std::to_string(line_) : "";
  const std::string place = source_.empty() ? "" : onOneLine(source_) + at + ": ";
  const std::string key = path_.empty() ? "the scene" : onOneLine(path_);
  const std::string value = given() ? " = " + valueText(node_) : " is missing";
  return place + key + value + ": " + onOneLine(reason);
}

void Entry::fail(const std::string& reason) const { throw InputError(line(reason)); }

double Entry::number(const Range& range) const {
  const std::optional<double> value = given() ? plainNumber(node_) : std::nullopt;
  if (!value || !range.contains(*value)) fail("must be " + range.text());
  return *value;
}

double Entry::numberOr(double otherwise, const Range& range) const {
  return given() ? number(range) : otherwise;
}

int Entry::integer(int lowest, int highest) const {
  const std::string allowed =
      "must be a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
  const std::optional<double> value = given() ? plainNumber(node_) : std::nullopt;
  if (!value || node_.Scalar().find_first_not_of("+-0123456789") != std::string::npos) {
    fail(allowed);
  }
  if (*value < lowest || *value > highest) fail(allowed);
  return static_cast<int>(*value);
}

int Entry::integerOr(int otherwise, int lowest, int highest) const {
  return given() ? integer(lowest, highest) : otherwise;
}

bool Entry::truth() const {
  const bool plain = given() && isPlainScalar(node_);
  if (plain && isWord("true")) return true;
  if (!plain || !isWord("false")) fail("must be true or false");
  return false;
}

std::string Entry::word(const std::string& allowed) const {
  if (!given() || !node_.IsScalar() || node_.Scalar().empty()) fail("must be " + allowed);
  return node_.Scalar();
}

bool Entry::isWord(const std::string& word) const {
  return given() && node_.IsScalar() && node_.Scalar() == word;
}

Vec3 Entry::vec3(const Range& range) const {
  if (!given() || !node_.IsSequence() || node_.size() != 3) {
    fail("must be a list of 3 numbers, each " + range.text());
  }
  const std::vector<Entry> components = list(3, "numbers");
  Vec3 value;
  for (int axis = 0; axis < 3; ++axis) {
    value[axis] = components[static_cast<std::size_t>(axis)].number(range);
  }
  return value;
}

Vec3 Entry::vec3Or(const Vec3& otherwise, const Range& range) const {
  return given() ? vec3(range) : otherwise;
}

std::string Entry::choice(const std::vector<std::string>& allowed) const {
  const auto is_it = [this](const std::string& name) { return isWord(name); };
  if (std::any_of(allowed.begin(), allowed.end(), is_it)) return node_.Scalar();
  fail(allowed.size() == 1 ? "must be " + allowed.front() : "must be one of " + joined(allowed));
}

std::vector<Entry> Entry::list(std::size_t at_least, const std::string& what,
                               std::size_t at_most) const {
  const bool is_list = given() && node_.IsSequence();
  if (!is_list && at_least == 0) fail("must be a list of " + what);
  if (!is_list || node_.size() < at_least || node_.size() > at_most) {
    fail("must be a list of " + countText(at_least, at_most) + what);
  }
  std::vector<Entry> entries;
  for (const auto& item : node_) {
    entries.push_back(child(item, "[" + std::to_string(entries.size()) + "]"));
  }
  return entries;
}

}  // namespace robot_tissue
