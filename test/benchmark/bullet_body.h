// A block of tissue as Bullet (E. Coumans, bulletphysics.org) solves it: the nodes of a lattice,
// some of them held, joined by Bullet's own elements. An outside peer; nothing in the package needs
// it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "robot_tissue/core/lattice.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// What of Bullet can be chosen.
struct BulletSettings {
  double time_step = 0.0;  // s
  int iterations = 0;      // a step: over the links, or of conjugate gradients at most
  int ramp = 1;            // steps in which an increment's load comes, in equal parts
  double damping = 0.0;    // bullet_soft: kDP, share of the velocity that a step takes away
  double stiffness = 0.0;  // bullet_soft: kLST of a link inside the block
};

// Methods: "bullet_soft" is btSoftBody in a btSoftRigidDynamicsWorld, links alone, position based;
// "bullet_deformable" is btDeformableNeoHookeanForce on tetrahedra, implicit.
const std::vector<std::string>& bulletMethods();

// What did best of all that was tried (doc/baselines.md). Throws InputError on an unknown method.
BulletSettings bestSettings(const std::string& method, const Lattice& lattice);

class BulletBody {
 public:
  using Axes = std::array<bool, 3>;

  virtual ~BulletBody() = default;

  // Displacement of a held node along the axes it is held along (m, from rest).
  virtual void hold(int node, const Vec3& displacement) = 0;
  virtual void step() = 0;
  virtual Vec3 displacement(int node) const = 0;  // m
  // Of what holds the nodes on the tissue (N); empty where Bullet's stiffness has no unit.
  virtual std::optional<Vec3> force(const std::vector<int>& nodes) = 0;
};

// Five a cell, four nodes each, positive volumes; mirrored in every other cell, so that the
// diagonals of common faces meet.
std::vector<std::array<int, 4>> tetrahedraOf(const Lattice& lattice);

// `held`, per node: the axes along which it does not move by itself.
std::unique_ptr<BulletBody> makeBulletSoft(const Lattice& lattice,
                                           const std::vector<BulletBody::Axes>& held,
                                           const BulletSettings& settings);
std::unique_ptr<BulletBody> makeBulletDeformable(const Lattice& lattice,
                                                 const std::vector<BulletBody::Axes>& held,
                                                 const Material& material,
                                                 const BulletSettings& settings);

}  // namespace robot_tissue
