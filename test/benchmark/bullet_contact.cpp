#include "bullet_contact.h"

#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableBodySolver.h>
#include <BulletSoftBody/btDeformableMultiBodyConstraintSolver.h>
#include <BulletSoftBody/btDeformableMultiBodyDynamicsWorld.h>
#include <BulletSoftBody/btDeformableNeoHookeanForce.h>
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "bullet_elasticity.h"
#include "bullet_nodes.h"

namespace robot_tissue {
namespace {

// m: tissue and tool are in contact when they are so near; Bullet's own 40 mm are for bodies of a
// meter.
constexpr btScalar kMargin = 1e-4;
// m: cells of the grid in which Bullet keeps a tool's distances; its own 0.25 m are wider than it.
constexpr btScalar kDistanceCell = 1e-3;

btTransform transformOf(const Pose& pose) {
  const Eigen::Quaterniond turn(pose.linear());
  return btTransform(btQuaternion(static_cast<btScalar>(turn.x()), static_cast<btScalar>(turn.y()),
                                  static_cast<btScalar>(turn.z()), static_cast<btScalar>(turn.w())),
                     toBullet(Vec3(pose.translation())));
}

const ToolShape& onlyShape(const ToolConfig& tool) {
  const std::vector<ToolShape>& shapes = tool.links.front().shapes;
  if (tool.links.size() != 1 || shapes.size() != 1 ||
      (shapes.front().type != ToolShape::Type::kSphere &&
       shapes.front().type != ToolShape::Type::kBox)) {
    throw InputError("tools: Bullet is given one tool of one shape, a sphere or a box");
  }
  return shapes.front();
}

std::unique_ptr<btCollisionShape> shapeOf(const ToolShape& shape) {
  if (shape.type == ToolShape::Type::kSphere) {
    return std::make_unique<btSphereShape>(static_cast<btScalar>(shape.radius));
  }
  auto box = std::make_unique<btBoxShape>(toBullet(Vec3(0.5 * shape.size)));
  box->setMargin(kMargin);
  return box;
}

std::vector<BulletBody::Axes> heldNodes(const Lattice& lattice) {
  std::vector<BulletBody::Axes> held(at(lattice.nodeCount()));
  for (int node = 0; node < lattice.nodeCount(); ++node) {
    held[at(node)].fill(lattice.isFixed(node));
  }
  return held;
}

}  // namespace

struct BulletContact::Impl {
  Impl(const TissueConfig& tissue, const ToolConfig& tool, const Pose& tissue_T_tool,
       const BulletPace& its_pace)
      : lattice(tissue),
        nodes(lattice, heldNodes(lattice)),
        measures(onlyShape(tool)),
        pace(its_pace),
        place(tissue_T_tool),
        dispatcher(&configuration),
        world(&dispatcher, &broadphase, &constraint_solver, &configuration, &solver),
        shape(shapeOf(measures)),
        motion(transformOf(shapePose(tissue_T_tool))),
        rigid(btRigidBody::btRigidBodyConstructionInfo(0, &motion, shape.get())) {
    constraint_solver.setDeformableSolver(&solver);
    world.setGravity(btVector3(0, 0, 0));
    world.getWorldInfo().m_gravity = btVector3(0, 0, 0);
    world.getWorldInfo().m_sparsesdf.setDefaultVoxelsz(kDistanceCell);
    world.getWorldInfo().m_sparsesdf.Reset();
    world.setImplicit(pace.implicit);
    world.setLineSearch(false);
    world.setUseProjection(true);
    makeBody(tissue.material);
    rigid.setCollisionFlags(rigid.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
    rigid.setActivationState(DISABLE_DEACTIVATION);
    rigid.setFriction(static_cast<btScalar>(tool.friction));
    world.addRigidBody(&rigid);
  }

  ~Impl() {
    world.removeSoftBody(body.get());
    world.removeRigidBody(&rigid);
  }

  Pose shapePose(const Pose& tissue_T_tool) const { return tissue_T_tool * measures.pose; }

  void makeBody(const Material& material) {
    body = nodes.makeBody(world.getWorldInfo(), material.density * std::pow(lattice.spacing(), 3));
    appendElements();
    body->initializeDmInverse();
    body->m_tetraScratches.resize(body->m_tetras.size());
    body->m_tetraScratchesTn.resize(body->m_tetras.size());
    body->getCollisionShape()->setMargin(kMargin);
    body->m_cfg.kKHR = 1;  // all of a node's depth in a kinematic body is taken out at once
    body->m_cfg.kDF = 1;   // times the tool's friction
    body->m_cfg.collisions = btSoftBody::fCollision::SDF_RD | btSoftBody::fCollision::SDF_RDN;
    world.addSoftBody(body.get());
    setModuli(material, elasticity);
    world.addForce(body.get(), &elasticity);
  }

  // Bullet finds neighbors by links: without one an edge its tree of nodes is never done. What
  // collides are nodes of faces.
  void appendElements() {
    std::set<std::pair<int, int>> edges;
    std::map<std::array<int, 3>, std::pair<int, std::array<int, 3>>> faces;
    for (const auto& corners : tetrahedraOf(lattice)) {
      std::array<int, 4> places{};
      for (std::size_t i = 0; i < 4; ++i) places[i] = nodes.place(corners[i]);
      body->appendTetra(places[0], places[1], places[2], places[3]);
      for (std::size_t i = 0; i < 4; ++i) {
        for (std::size_t j = 0; j < i; ++j) edges.insert(std::minmax(places[i], places[j]));
        std::array<int, 3> face = {places[(i + 1) % 4], places[(i + 2) % 4], places[(i + 3) % 4]};
        if (i % 2 == 1) std::swap(face[0], face[1]);
        std::array<int, 3> key = face;
        std::sort(key.begin(), key.end());
        auto& [tetrahedra, seen_from_one] = faces[key];
        ++tetrahedra;
        seen_from_one = face;
      }
    }
    for (const auto& [from, to] : edges) body->appendLink(from, to);
    for (const auto& [key, face] : faces) {
      if (face.first == 1) body->appendFace(face.second[0], face.second[1], face.second[2]);
    }
  }

  Lattice lattice;
  BulletNodes nodes;
  ToolShape measures;
  BulletPace pace;
  Pose place;  // of the tool
  btSoftBodyRigidBodyCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btDbvtBroadphase broadphase;
  btDeformableMultiBodyConstraintSolver constraint_solver;
  btDeformableBodySolver solver;
  btDeformableMultiBodyDynamicsWorld world;
  btDeformableNeoHookeanForce elasticity;
  std::unique_ptr<btSoftBody> body;
  std::unique_ptr<btCollisionShape> shape;
  btDefaultMotionState motion;
  btRigidBody rigid;
};

BulletContact::BulletContact(const TissueConfig& tissue, const ToolConfig& tool,
                             const Pose& tissue_T_tool, const BulletPace& pace)
    : impl_(std::make_unique<Impl>(tissue, tool, tissue_T_tool, pace)) {}

BulletContact::~BulletContact() = default;

const Lattice& BulletContact::lattice() const { return impl_->lattice; }

void BulletContact::goTo(const Pose& tissue_T_tool) {
  for (int step = 1; step <= impl_->pace.steps; ++step) {
    const Pose there =
        onTheWay(impl_->place, tissue_T_tool, static_cast<double>(step) / impl_->pace.steps);
    impl_->motion.setWorldTransform(transformOf(impl_->shapePose(there)));
    impl_->world.stepSimulation(static_cast<btScalar>(impl_->pace.duration / impl_->pace.steps), 0);
  }
  impl_->place = tissue_T_tool;
}

bool BulletContact::isWhole() const {
  const Box bounds = lattice().bounds();
  const double widest = (bounds.max() - bounds.min()).maxCoeff();
  for (int node = 0; node < lattice().nodeCount(); ++node) {
    if (!(displacement(node).norm() < widest)) return false;
  }
  return true;
}

Vec3 BulletContact::displacement(int node) const {
  return fromBullet(impl_->nodes.of(*impl_->body, node).m_x) - impl_->nodes.rest(node);
}

Vec3 BulletContact::forceOnTool() const {
  btAlignedObjectArray<btVector3> forces;
  forces.resize(impl_->body->m_nodes.size(), btVector3(0, 0, 0));
  impl_->body->updateDeformation();
  impl_->elasticity.addScaledElasticForce(1, forces);
  Vec3 sum = Vec3::Zero();
  for (int node = 0; node < lattice().nodeCount(); ++node) {
    if (impl_->nodes.isHeld(node)) sum -= fromBullet(forces[impl_->nodes.place(node)]);
  }
  return sum;
}

double BulletContact::penetration() const {
  const Pose shape_T_tissue = impl_->shapePose(impl_->place).inverse();
  double deepest = 0.0;
  for (int node = 0; node < lattice().nodeCount(); ++node) {
    const Vec3 point = shape_T_tissue * (impl_->nodes.rest(node) + displacement(node));
    const double depth = impl_->measures.type == ToolShape::Type::kSphere
                             ? impl_->measures.radius - point.norm()
                             : (0.5 * impl_->measures.size - point.cwiseAbs()).minCoeff();
    deepest = std::max(deepest, depth);
  }
  return deepest;
}

int BulletContact::contacts() const { return impl_->body->m_nodeRigidContacts.size(); }

}  // namespace robot_tissue
