#include "mesh_formats.h"

#include <algorithm>

#include "robot_tissue/core/compat.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";
constexpr std::size_t kMostCorners = 1000;  // of one polygon

// Words stand in messages.
std::string quoted(std::string_view word) {
  constexpr std::size_t kLongest = 20;
  return "'" + printable(word, kLongest) + "'";
}

template <class Number>
Number parsed(std::string_view word, const char* allowed) {
  std::string_view digits = word;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  Number value{};
  if (compat::parsed(digits, value)) return value;
  const std::string there = word.empty() ? "nothing" : quoted(word);
  throw InputError(there + " stands where " + allowed + " should");
}

// Corners of a polygon, looked at along its normal.
class Ears {
 public:
  Ears(const std::vector<int>& corners, TriangleMesh& mesh) : left_(corners), mesh_(mesh) {
    normal_ = Vec3::Zero();
    const Vec3& origin = place(0);
    for (std::size_t i = 0; i < left_.size(); ++i) {
      normal_ += (place(i) - origin).cross(place(next(i)) - origin);
    }
  }

  // Cuts off corner after corner whose triangle holds no other one.
  void cut() {
    std::size_t at = 0;
    std::size_t refused = 0;
    while (left_.size() > 3) {
      at %= left_.size();
      // Where none is left (it crosses itself), any will do: the checks of the mesh judge it.
      if (refused < left_.size() && !isEar(at)) {
        ++at;
        ++refused;
        continue;
      }
      mesh_.triangles.push_back({left_[before(at)], left_[at], left_[next(at)]});
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
      refused = 0;
    }
    mesh_.triangles.push_back({left_[0], left_[1], left_[2]});
  }

 private:
  std::size_t next(std::size_t i) const { return (i + 1) % left_.size(); }
  std::size_t before(std::size_t i) const { return (i + left_.size() - 1) % left_.size(); }
  const Vec3& place(std::size_t i) const {
    return mesh_.vertices[static_cast<std::size_t>(left_[i])];
  }
  double turn(const Vec3& a, const Vec3& b, const Vec3& c) const {
    return normal_.dot((b - a).cross(c - a));
  }

  bool isEar(std::size_t i) const {
    const Vec3& a = place(before(i));
    const Vec3& b = place(i);
    const Vec3& c = place(next(i));
    if (!(turn(a, b, c) > 0.0)) return false;
    for (std::size_t other = 0; other < left_.size(); ++other) {
      if (other == i || other == next(i) || other == before(i)) continue;
      const Vec3& p = place(other);
      if (p == a || p == b || p == c) continue;  // a corner that is passed twice
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  std::vector<int> left_;
  TriangleMesh& mesh_;
  Vec3 normal_;
};

}  // namespace

std::string printable(std::string_view text, std::size_t longest) {
  std::string line;
  for (const char c : text.substr(0, longest)) line += c >= 0x20 && c < 0x7f ? c : '?';
  return line + (text.size() > longest ? "..." : "");
}

void requireRoomFor(std::size_t triangles, const TriangleMesh& mesh) {
  if (mesh.triangles.size() + triangles <= kMostTriangles) return;
  throw InputError("has more than " + std::to_string(kMostTriangles) + " triangles");
}

void appendPolygon(const std::vector<int>& corners, TriangleMesh& mesh) {
  if (corners.size() < 3) return;  // a point or an edge
  if (corners.size() > kMostCorners) {
    throw InputError("a face has more than " + std::to_string(kMostCorners) + " corners");
  }
  requireRoomFor(corners.size() - 2, mesh);
  Ears(corners, mesh).cut();
}

std::string_view withoutMark(std::string_view text) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";
  if (text.substr(0, kMark.size()) == kMark) text.remove_prefix(kMark.size());
  return text;
}

std::string_view takeWord(std::string_view& text) {
  const std::size_t start = std::min(text.find_first_not_of(kBlanks), text.size());
  const std::size_t end = std::min(text.find_first_of(kBlanks, start), text.size());
  const std::string_view word = text.substr(start, end - start);
  text.remove_prefix(end);
  return word;
}

double toReal(std::string_view word) { return parsed<double>(word, "a number"); }
int toWhole(std::string_view word) { return parsed<int>(word, "a whole number"); }

}  // namespace robot_tissue
