// What both of Bullet's solvers share: a soft body's nodes in the place of a lattice's.
#pragma once

#include <BulletSoftBody/btSoftBody.h>

#include "bullet_body.h"

namespace robot_tissue {

inline btVector3 toBullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}
inline Vec3 fromBullet(const btVector3& v) { return Vec3(v.x(), v.y(), v.z()); }

// Bullet 3.24 runs through the forces of the free nodes alone as if they came first
// (btDeformableBackwardEulerObjective::applyForce), so here they do.
class BulletNodes {
 public:
  BulletNodes(const Lattice& lattice, const std::vector<BulletBody::Axes>& held);

  // A body of these nodes and nothing else, each of the given mass (kg); those wholly held have
  // none. It collides with nothing.
  std::unique_ptr<btSoftBody> makeBody(btSoftBodyWorldInfo& world, double mass) const;

  btSoftBody::Node& of(btSoftBody& body, int node) const { return body.m_nodes[place_[at(node)]]; }
  int place(int node) const { return place_[at(node)]; }
  const Vec3& rest(int node) const { return rest_[at(node)]; }
  bool isHeld(int node) const { return isWhole(held_[at(node)]); }
  const BulletBody::Axes& heldAxes(int node) const { return held_[at(node)]; }
  // Those held along some axes only.
  const std::vector<int>& sliding() const { return sliding_; }
  // Puts the node's held axes to the displacement, at rest.
  void hold(btSoftBody& body, int node, const Vec3& displacement) const;

 private:
  static bool isWhole(const BulletBody::Axes& axes) { return axes[0] && axes[1] && axes[2]; }

  std::vector<BulletBody::Axes> held_;
  std::vector<Vec3> rest_;  // m
  std::vector<int> place_;  // in the body, per node
  std::vector<int> sliding_;
};

}  // namespace robot_tissue
