// PieceRegistry: the shape without strain.
#include <Eigen/SVD>
#include <algorithm>
#include <utility>

#include "robot_tissue/core/cells.h"
#include "tissue/piece_registry.h"

namespace robot_tissue {
namespace {

// Of a rigid body's points: x = center + rotation (X - rest_center).
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Vec3 rest_center = Vec3::Zero(), center = Vec3::Zero();
};

struct WeighedPoint {
  Vec3 rest, now;
  double weight = 0.0;
};

// The one that comes nearest to the points, by least squares (Kabsch 1976); their center of mass
// stays where it is.
RigidMotion nearestMotion(const std::vector<WeighedPoint>& points) {
  RigidMotion motion;
  double all = 0.0;
  for (const WeighedPoint& point : points) {
    motion.rest_center += point.weight * point.rest;
    motion.center += point.weight * point.now;
    all += point.weight;
  }
  motion.rest_center /= all;
  motion.center /= all;
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const WeighedPoint& point : points) {
    moments +=
        point.weight * (point.now - motion.center) * (point.rest - motion.rest_center).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(moments, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Matrix3d u = svd.matrixU();
  if ((u * svd.matrixV().transpose()).determinant() < 0.0) u.col(2) = -u.col(2);
  motion.rotation = u * svd.matrixV().transpose();
  return motion;
}

}  // namespace

std::vector<std::vector<int>> PieceRegistry::nodesOfEachFree() const {
  const std::vector<int>& piece_of = ofNodes();
  const std::vector<int> free = freePieces(near());
  std::vector<std::vector<int>> nodes(free.size());
  for (std::size_t node = 0; node < piece_of.size(); ++node) {
    const auto found = std::lower_bound(free.begin(), free.end(), piece_of[node]);
    if (found == free.end() || *found != piece_of[node]) continue;
    nodes[static_cast<std::size_t>(found - free.begin())].push_back(static_cast<int>(node));
  }
  return nodes;
}

std::vector<Vec3> PieceRegistry::relaxed() const {
  const std::vector<Vec3>& displacement = body_.displacement();
  std::vector<Vec3> relaxed(displacement.size(), Vec3::Zero());
  const auto at_rest = [&](int node) { return restPosition(body_.lattice(), body_.cells(), node); };
  for (const std::vector<int>& nodes : nodesOfEachFree()) {
    const auto stays = [&](int node) { return displacement[at(node)].isZero(0.0); };
    if (std::all_of(nodes.begin(), nodes.end(), stays)) continue;
    std::vector<WeighedPoint> points;
    for (const int node : nodes) {
      const double volume = body_.cells().isGhost(node) ? 0.0 : volume_at_node_[at(node)];
      if (volume <= 0.0) continue;
      points.push_back({at_rest(node), at_rest(node) + displacement[at(node)], volume});
    }
    if (points.empty()) continue;
    const RigidMotion motion = nearestMotion(points);
    for (const int node : nodes) {
      const Vec3 rest = at_rest(node);
      relaxed[at(node)] = motion.center + motion.rotation * (rest - motion.rest_center) - rest;
    }
  }
  return relaxed;
}

}  // namespace robot_tissue
