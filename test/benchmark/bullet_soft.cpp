#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include <map>
#include <utility>

#include "bullet_nodes.h"

namespace robot_tissue {
namespace {

class BulletSoft : public BulletBody {
 public:
  BulletSoft(const Lattice& lattice, const std::vector<Axes>& held, const BulletSettings& settings)
      : nodes_(lattice, held),
        dispatcher_(&configuration_),
        world_(&dispatcher_, &broadphase_, &solver_, &configuration_),
        time_step_(static_cast<btScalar>(settings.time_step)) {
    world_.setGravity(btVector3(0, 0, 0));
    world_.getWorldInfo().m_gravity = btVector3(0, 0, 0);
    body_ = nodes_.makeBody(world_.getWorldInfo(), 1.0);
    body_->m_cfg.piterations = settings.iterations;
    body_->m_cfg.kDP = static_cast<btScalar>(settings.damping);
    join(lattice, settings.stiffness);
    body_->updateConstants();
    body_->m_bUpdateRtCst =
        false;  // a step would take the pressed shape's lengths for those of rest
    world_.addSoftBody(body_.get());
  }
  ~BulletSoft() override { world_.removeSoftBody(body_.get()); }

  void hold(int node, const Vec3& displacement) override {
    nodes_.hold(*body_, node, displacement);
    if (!nodes_.isHeld(node)) sliding_[node] = displacement;
  }

  void step() override {
    world_.stepSimulation(time_step_, 0);
    for (const auto& [node, displacement] : sliding_) nodes_.hold(*body_, node, displacement);
  }

  Vec3 displacement(int node) const override {
    return fromBullet(nodes_.of(*body_, node).m_x) - nodes_.rest(node);
  }

  std::optional<Vec3> force(const std::vector<int>& /*nodes*/) override { return {}; }

 private:
  // Every edge and both diagonals of every face of the cells. Equal springs along both make a cubic
  // lattice isotropic, with Poisson's ratio 0.25; a cell has a share of each that it has with
  // others: a quarter of an edge, half of a face's diagonals.
  void join(const Lattice& lattice, double stiffness) {
    std::map<std::pair<int, int>, double> shares;
    for (const Cell& cell : lattice.cells()) {
      for (int a = 0; a < kCorners; ++a) {
        for (int b = a + 1; b < kCorners; ++b) {
          const int axes = __builtin_popcount(static_cast<unsigned>(a ^ b));
          if (axes == 3) continue;
          const auto ends = std::minmax(cell.nodes[at(a)], cell.nodes[at(b)]);
          shares[ends] += axes == 1 ? 0.25 : 0.5;
        }
      }
    }
    // A link moves two free ends by half of what it asks for each, and a free one at a held one by
    // all of it: there it needs half the stiffness to be as strong.
    std::map<double, btSoftBody::Material*> materials;
    for (const auto& [ends, share] : shares) {
      const bool held_a = nodes_.isHeld(ends.first);
      const bool held_b = nodes_.isHeld(ends.second);
      if (held_a && held_b) continue;
      const double own = stiffness * share * (held_a || held_b ? 0.5 : 1.0);
      btSoftBody::Material*& material = materials[own];
      if (material == nullptr) {
        material = body_->appendMaterial();
        material->m_kLST = static_cast<btScalar>(own);
      }
      body_->appendLink(nodes_.place(ends.first), nodes_.place(ends.second), material);
    }
  }

  BulletNodes nodes_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_;
  btScalar time_step_;
  mutable std::unique_ptr<btSoftBody> body_;
  std::map<int, Vec3> sliding_;  // displacements of nodes that Bullet moves freely
};

}  // namespace

std::unique_ptr<BulletBody> makeBulletSoft(const Lattice& lattice,
                                           const std::vector<BulletBody::Axes>& held,
                                           const BulletSettings& settings) {
  return std::make_unique<BulletSoft>(lattice, held, settings);
}

}  // namespace robot_tissue
