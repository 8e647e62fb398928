#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <cmath>

#include "bullet_elasticity.h"
#include "bullet_nodes.h"

namespace robot_tissue {
namespace {

// With how many iterations a step may take, and with nodes that are held along some axes.
class Solver : public btDeformableBodySolver {
 public:
  Solver(const BulletNodes& nodes, int iterations) : nodes_(nodes) {
    m_cg.m_maxIterations = iterations;
  }

  void setProjection() override {
    btDeformableBodySolver::setProjection();
    for (const int node : nodes_.sliding()) {
      btAlignedObjectArray<btVector3> axes;
      for (int axis = 0; axis < 3; ++axis) {
        btVector3 unit(0, 0, 0);
        unit[axis] = 1;
        if (nodes_.heldAxes(node)[at(axis)]) axes.push_back(unit);
      }
      m_objective->m_projection.m_projectionsDict.insert(nodes_.place(node), axes);
    }
  }

 private:
  const BulletNodes& nodes_;
};

class BulletDeformable : public BulletBody {
 public:
  BulletDeformable(const Lattice& lattice, const std::vector<Axes>& held, const Material& material,
                   const BulletSettings& settings)
      : nodes_(lattice, held),
        dispatcher_(&configuration_),
        solver_(nodes_, settings.iterations),
        world_(&dispatcher_, &broadphase_, &constraint_solver_, &configuration_, &solver_),
        time_step_(static_cast<btScalar>(settings.time_step)) {
    constraint_solver_.setDeformableSolver(&solver_);
    world_.setGravity(btVector3(0, 0, 0));
    world_.setImplicit(true);
    world_.setLineSearch(false);
    world_.setUseProjection(true);
    body_ =
        nodes_.makeBody(world_.getWorldInfo(), material.density * std::pow(lattice.spacing(), 3));
    for (const auto& corners : tetrahedraOf(lattice)) {
      body_->appendTetra(nodes_.place(corners[0]), nodes_.place(corners[1]),
                         nodes_.place(corners[2]), nodes_.place(corners[3]));
    }
    body_->initializeDmInverse();
    body_->m_tetraScratches.resize(body_->m_tetras.size());
    body_->m_tetraScratchesTn.resize(body_->m_tetras.size());
    world_.addSoftBody(body_.get());
    setModuli(material, stiffness_);
    world_.addForce(body_.get(), &stiffness_);
  }
  ~BulletDeformable() override { world_.removeSoftBody(body_.get()); }

  void hold(int node, const Vec3& displacement) override {
    nodes_.hold(*body_, node, displacement);
  }

  void step() override { world_.stepSimulation(time_step_, 0); }

  Vec3 displacement(int node) const override {
    return fromBullet(nodes_.of(*body_, node).m_x) - nodes_.rest(node);
  }

  std::optional<Vec3> force(const std::vector<int>& nodes) override {
    body_->updateDeformation();
    btAlignedObjectArray<btVector3> forces;
    forces.resize(body_->m_nodes.size(), btVector3(0, 0, 0));
    stiffness_.addScaledElasticForce(1, forces);
    Vec3 sum = Vec3::Zero();
    for (const int node : nodes) sum -= fromBullet(forces[nodes_.place(node)]);
    return sum;
  }

 private:
  BulletNodes nodes_;
  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_;
  btDbvtBroadphase broadphase_;
  btDeformableMultiBodyConstraintSolver constraint_solver_;
  Solver solver_;
  btDeformableMultiBodyDynamicsWorld world_;
  btDeformableNeoHookeanForce stiffness_;
  btScalar time_step_;
  mutable std::unique_ptr<btSoftBody> body_;
};

}  // namespace

std::unique_ptr<BulletBody> makeBulletDeformable(const Lattice& lattice,
                                                 const std::vector<BulletBody::Axes>& held,
                                                 const Material& material,
                                                 const BulletSettings& settings) {
  return std::make_unique<BulletDeformable>(lattice, held, material, settings);
}

}  // namespace robot_tissue
