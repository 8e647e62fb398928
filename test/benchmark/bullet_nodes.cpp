#include "bullet_nodes.h"

namespace robot_tissue {

BulletNodes::BulletNodes(const Lattice& lattice, const std::vector<BulletBody::Axes>& held)
    : held_(held), place_(held.size()) {
  int next = 0;
  for (const bool whole : {false, true}) {
    for (std::size_t node = 0; node < held.size(); ++node) {
      if (isWhole(held[node]) == whole) place_[node] = next++;
    }
  }
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    rest_.push_back(lattice.restPosition(node));
    const BulletBody::Axes& axes = held[at(node)];
    if (!isWhole(axes) && (axes[0] || axes[1] || axes[2])) sliding_.push_back(node);
  }
}

std::unique_ptr<btSoftBody> BulletNodes::makeBody(btSoftBodyWorldInfo& world, double mass) const {
  std::vector<btVector3> places(rest_.size());
  std::vector<btScalar> masses(rest_.size());
  for (std::size_t node = 0; node < rest_.size(); ++node) {
    const auto place = static_cast<std::size_t>(place_[node]);
    places[place] = toBullet(rest_[node]);
    masses[place] = static_cast<btScalar>(isWhole(held_[node]) ? 0.0 : mass);
  }
  auto body = std::make_unique<btSoftBody>(&world, static_cast<int>(rest_.size()), places.data(),
                                           masses.data());
  body->m_cfg.collisions = 0;
  body->setActivationState(DISABLE_DEACTIVATION);
  return body;
}

void BulletNodes::hold(btSoftBody& body, int node, const Vec3& displacement) const {
  btSoftBody::Node& moved = of(body, node);
  const btVector3 target = toBullet(rest(node) + displacement);
  for (int axis = 0; axis < 3; ++axis) {
    if (!held_[at(node)][at(axis)]) continue;
    moved.m_x[axis] = target[axis];
    moved.m_q[axis] = target[axis];
    moved.m_v[axis] = 0;
    moved.m_vn[axis] = 0;
  }
}

}  // namespace robot_tissue
