#include "round_tips.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "tuning.h"

namespace robot_tissue {
namespace {

// A ball through points p, by least squares in |p|^2 = 2 c p + (r^2 - |c|^2), which is linear in
// the center c and the bracket.
class BallFit {
 public:
  BallFit(const Vec3& origin, double length) : origin_(origin), length_(length) {}

  void add(const Vec3& point) {
    Eigen::Vector4d row;
    row << 2.0 * (point - origin_) / length_, 1.0;
    const double square = (point - origin_).squaredNorm() / (length_ * length_);
    squares_ += row * row.transpose();
    right_ += square * row;
  }

  // None of points in a plane.
  std::optional<Ball> best() const {
    const Eigen::Vector4d found = squares_.ldlt().solve(right_);
    const Vec3 center = found.head<3>();
    const double radius = std::sqrt(found[3] + center.squaredNorm());
    if (!(radius > 0.0) || !(radius < tuning::kFlattestTip)) return std::nullopt;
    return Ball{origin_ + length_ * center, length_ * radius};
  }

 private:
  Vec3 origin_;    // what is near the points (m)
  double length_;  // as they are apart (m)
  Eigen::Matrix4d squares_ = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right_ = Eigen::Vector4d::Zero();
};

class TipFinder {
 public:
  explicit TipFinder(const ToolMesh& mesh)
      : mesh_(mesh), is_seen_(mesh.vertices().size(), 0), part_of_(mesh.vertices().size(), kNone) {}

  std::vector<Ball> find() {
    std::vector<Ball> balls;
    for (int seed = 0; seed < static_cast<int>(is_seen_.size()); ++seed) {
      if (is_seen_[at(seed)] != 0) continue;
      const std::optional<Ball> ball = growFrom(seed);
      if (ball && turnsFar()) balls.push_back(*ball);
    }
    return balls;
  }

 private:
  static constexpr int kNone = -1;

  // The part that is grown, ring by ring; the last ring that fits no ball with the others is left
  // out.
  std::optional<Ball> growFrom(int seed) {
    part_.clear();
    BallFit fit(place(seed), reachOf(seed));
    std::vector<int> ring = {seed};
    ring.insert(ring.end(), mesh_.neighbors()[at(seed)].begin(), mesh_.neighbors()[at(seed)].end());
    std::optional<Ball> ball;
    while (!ring.empty()) {
      const std::size_t before = part_.size();
      for (const int vertex : ring) {
        part_of_[at(vertex)] = seed;
        part_.push_back(vertex);
        fit.add(place(vertex));
      }
      const std::optional<Ball> now = fit.best();
      const auto fits = [&](int vertex) { return isOn(*now, vertex, seed); };
      if (!now || !std::all_of(part_.begin(), part_.end(), fits)) {
        for (std::size_t i = before; i < part_.size(); ++i) part_of_[at(part_[i])] = kNone;
        part_.resize(before);
        break;
      }
      ball = now;
      ring = nextRing(*ball, seed);
    }
    for (const int vertex : part_) is_seen_[at(vertex)] = 1;
    return ball;
  }

  std::vector<int> nextRing(const Ball& ball, int seed) {
    std::vector<int> ring;
    for (const int vertex : part_) {
      for (const int other : mesh_.neighbors()[at(vertex)]) {
        if (part_of_[at(other)] == seed || !isOn(ball, other, seed)) continue;
        part_of_[at(other)] = seed;
        ring.push_back(other);
      }
    }
    for (const int vertex : ring) part_of_[at(vertex)] = kNone;
    return ring;
  }

  // With its normal, and its edges to the part.
  bool isOn(const Ball& ball, int vertex, int seed) const {
    const Vec3 out = place(vertex) - ball.center;
    const double off = std::abs(out.norm() - ball.radius);
    if (!(off <= tuning::kOffTip * ball.radius)) return false;
    if (!(mesh_.vertexNormals()[at(vertex)].dot(out) >= tuning::kTipNormal * out.norm())) {
      return false;
    }
    const std::vector<int>& others = mesh_.neighbors()[at(vertex)];
    return std::all_of(others.begin(), others.end(), [&](int other) {
      const Vec3 middle = 0.5 * (place(vertex) + place(other));
      return part_of_[at(other)] != seed ||
             (middle - ball.center).norm() >= (1.0 - tuning::kFacetOfTip) * ball.radius;
    });
  }

  // Some of the part's normals are far from their mean.
  bool turnsFar() const {
    Vec3 mean = Vec3::Zero();
    for (const int vertex : part_) mean += mesh_.vertexNormals()[at(vertex)];
    return std::any_of(part_.begin(), part_.end(), [&](int vertex) {
      return mesh_.vertexNormals()[at(vertex)].dot(mean) <= tuning::kLeastTip * mean.norm();
    });
  }

  double reachOf(int seed) const {
    double reach = 0.0;
    for (const int other : mesh_.neighbors()[at(seed)]) {
      reach = std::max(reach, (place(other) - place(seed)).norm());
    }
    return reach;
  }

  const Vec3& place(int vertex) const { return mesh_.vertices()[at(vertex)]; }

  const ToolMesh& mesh_;
  std::vector<std::uint8_t> is_seen_;  // per vertex: was in a part
  std::vector<int> part_of_;           // per vertex: seed of the part that is grown
  std::vector<int> part_;              // its vertices
};

}  // namespace

std::vector<Ball> roundTips(const ToolMesh& mesh) { return TipFinder(mesh).find(); }

}  // namespace robot_tissue
