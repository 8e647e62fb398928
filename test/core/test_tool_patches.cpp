// Contacts -> loading patches: nodes are pushed out, ride with their tool, and are let go.
#include <gtest/gtest.h>

#include <cmath>

#include "robot_tissue/core/tool_patches.h"
#include "tissue_fixtures.h"

namespace robot_tissue {
namespace {

constexpr double kSpacing = 0.01;
const TissueConfig kBlock = withFixedBottom(blockOf(6, 6, 3, kSpacing));
const Vec3 kInto(0.0, 0.0, -1.0);  // from a tool above into the tissue

Pose poseAt(const Vec3& position, double angle = 0.0, const Vec3& axis = Vec3::UnitZ()) {
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  pose.translation() = position;
  return pose;
}

class ToolPatchesTest : public ::testing::Test {
 protected:
  ToolPatchesTest()
      : tissue_(kBlock, paperSolver()), patches_(tissue_.lattice(), {"probe", "jaw"}) {
    pose_.tools = {poseAt(Vec3(0.03, 0.03, 0.05)), poseAt(Vec3(0.0, 0.1, 0.05), 0.4)};
  }

  int node(int i, int j, int k) const { return tissue_.lattice().node(i, j, k); }

  // A contact at a node of the surface.
  Contact atNode(int node, double depth, const Vec3& normal = kInto, int tool = 0) const {
    const Surface& surface = tissue_.surface();
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const int vertex = surface.triangles[i][corner];
        if (surface.carriers[at(vertex)][0].node != node) continue;
        const Vec3 weights = Vec3::Unit(static_cast<Eigen::Index>(corner));
        return contact(static_cast<int>(i), weights, depth, normal, tool);
      }
    }
    ADD_FAILURE() << "node " << node << " is not on the surface";
    return {};
  }

  Contact contact(int triangle, const Vec3& barycentric, double depth, const Vec3& normal = kInto,
                  int tool = 0) const {
    Contact made;
    made.tool = tool;
    made.triangle = triangle;
    made.barycentric = barycentric;
    made.normal = normal;
    made.depth_m = depth;
    made.point = pointOf(made, tissue_.vertices());
    return made;
  }

  Vec3 pointOf(const Contact& contact, const std::vector<Vec3>& vertices) const {
    Vec3 point = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = tissue_.surface().triangles[at(contact.triangle)][at(corner)];
      point += contact.barycentric[corner] * vertices[at(vertex)];
    }
    return point;
  }

  // How far the contact's point went with the patches.
  Vec3 wayOf(const Contact& contact) const {
    std::vector<Vec3> vertices;
    deform(tissue_.surface(), patches_.displacement(), vertices);
    return pointOf(contact, vertices) - contact.point;
  }

  // A triangle that lies in the plane z = `z`.
  int triangleAt(double z) const {
    const Surface& surface = tissue_.surface();
    for (std::size_t i = 0; i < surface.triangles.size(); ++i) {
      bool inside = true;
      for (const int vertex : surface.triangles[i]) {
        inside = inside && std::abs(surface.rest[at(vertex)].z() - z) < 1e-9;
      }
      if (inside) return static_cast<int>(i);
    }
    ADD_FAILURE() << "no triangle at z = " << z;
    return 0;
  }

  void push(const std::vector<Contact>& contacts) {
    patches_.ride(pose_, tissue_);
    ContactSet set;
    set.contacts = contacts;
    patches_.pushOut(set, tissue_.surface(), pose_);
  }

  SolveReport follow() { return tissue_.follow(patches_.loadingPatches(), patches_.left()); }

  Tissue tissue_;
  ToolPatches patches_;
  RobotPose pose_;
};

TEST_F(ToolPatchesTest, WithoutContactThereIsNoPatch) {
  push({});
  EXPECT_TRUE(patches_.empty());
  EXPECT_TRUE(patches_.loadingPatches().empty());
  EXPECT_TRUE(patches_.nodes(0).empty());
  EXPECT_TRUE(patches_.normal(0, pose_.tools[0]).isZero());
  EXPECT_EQ(patches_.displacement(), tissue_.state().displacement);
}

TEST_F(ToolPatchesTest, ContactAtAVertexIsPushedOutByItsDepth) {
  const int middle = node(3, 3, 3);
  const Vec3 normal = Vec3(0.6, 0.0, -0.8);
  push({atNode(middle, 1e-3, normal)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{middle}));
  EXPECT_TRUE(patches_.nodes(1).empty());
  EXPECT_LT((patches_.displacement()[at(middle)] - 1e-3 * normal).norm(), 1e-15);
  EXPECT_LT((patches_.normal(0, pose_.tools[0]) - normal).norm(), 1e-12);
  const auto loads = patches_.loadingPatches();
  ASSERT_EQ(loads.size(), 1u);
  EXPECT_EQ(loads[0].name, "probe");
  EXPECT_EQ(loads[0].drive, LoadingPatch::Drive::kDisplacement);
  EXPECT_EQ(loads[0].nodes, (std::vector<int>{middle}));
  ASSERT_EQ(loads[0].displacement.size(), 1u);
  EXPECT_EQ(loads[0].displacement[0], patches_.displacement()[at(middle)]);
}

TEST_F(ToolPatchesTest, ContactInsideATriangleIsPushedOutByItsDepth) {
  for (const Vec3& weights : {Vec3(1.0, 1.0, 1.0), Vec3(0.1, 0.2, 0.7), Vec3(0.0, 0.5, 0.5)}) {
    patches_.clear();
    const Contact hit = contact(triangleAt(0.03), weights / weights.sum(), 7e-4);
    push({hit});
    EXPECT_LT((wayOf(hit) - 7e-4 * kInto).norm(), 1e-12);
    EXPECT_EQ(patches_.nodes(0).size(), static_cast<std::size_t>((weights.array() > 0.0).count()));
  }
}

TEST_F(ToolPatchesTest, NeighboringContactsAreAllPushedOut) {
  std::vector<Contact> hits;
  const int triangle = triangleAt(0.03);
  hits.push_back(contact(triangle, Vec3(0.8, 0.1, 0.1), 5e-4));
  hits.push_back(contact(triangle, Vec3(0.1, 0.8, 0.1), 9e-4));
  hits.push_back(contact(triangle, Vec3(0.1, 0.1, 0.8), 2e-4));
  hits.push_back(contact(triangle, Vec3(0.3, 0.3, 0.4), 6e-4));
  push(hits);
  for (const Contact& hit : hits) {
    EXPECT_GT(wayOf(hit).dot(kInto), hit.depth_m - 1e-3 * kSpacing);
    EXPECT_LT(wayOf(hit).dot(kInto), 3e-3);
  }
}

TEST_F(ToolPatchesTest, FixedNodesAreNeverTaken) {
  push({contact(triangleAt(0.0), Vec3::Constant(1.0 / 3.0), 1e-3, Vec3::UnitZ())});
  EXPECT_TRUE(patches_.empty());
  // A triangle of a side wall that has a fixed edge: its free nodes alone do it.
  int mixed = -1;
  const Surface& surface = tissue_.surface();
  for (std::size_t i = 0; i < surface.triangles.size() && mixed < 0; ++i) {
    int fixed = 0;
    for (const int vertex : surface.triangles[i]) {
      fixed += tissue_.lattice().isFixed(surface.carriers[at(vertex)][0].node) ? 1 : 0;
    }
    if (fixed == 2) mixed = static_cast<int>(i);
  }
  ASSERT_GE(mixed, 0);
  const Vec3 inwards(0.0, 1.0, 0.0);
  const Contact hit = contact(mixed, Vec3::Constant(1.0 / 3.0), 1e-3, inwards);
  push({hit});
  ASSERT_EQ(patches_.nodes(0).size(), 1u);
  EXPECT_FALSE(tissue_.lattice().isFixed(patches_.nodes(0)[0]));
  EXPECT_LT((wayOf(hit) - 1e-3 * inwards).norm(), 1e-12);
}

TEST_F(ToolPatchesTest, NodesOfNamedLoadsAreNeverTaken) {
  const Box box = nodeBox(kBlock, {2, 2, 3}, {3, 3, 3});
  tissue_.load(loadOf({displacedPatch("named", box, Vec3(0.0, 0.0, -5e-4))}));
  push({atNode(node(3, 3, 3), 1e-3)});
  EXPECT_TRUE(patches_.empty());
  EXPECT_EQ(patches_.displacement(), tissue_.state().displacement);
  push({atNode(node(4, 4, 3), 1e-3)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(4, 4, 3)}));
}

TEST_F(ToolPatchesTest, NodeThatANamedLoadTakesIsLeftToIt) {
  push({atNode(node(3, 3, 3), 5e-4)});
  ASSERT_FALSE(patches_.empty());
  const Box box = nodeBox(kBlock, {2, 2, 3}, {3, 3, 3});
  tissue_.load(loadOf({displacedPatch("named", box, Vec3(0.0, 0.0, -5e-4))}));
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(patches_.empty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{node(3, 3, 3)}));
}

TEST_F(ToolPatchesTest, NodesRideRigidlyWithTheirTool) {
  const std::vector<int> held = {node(3, 3, 3), node(4, 3, 3), node(3, 4, 3)};
  std::vector<Contact> hits;
  for (const int each : held) hits.push_back(atNode(each, 1e-3));
  push(hits);
  follow();
  const Pose before = pose_.tools[0];
  const Pose motion = poseAt(Vec3(2e-3, -1e-3, -3e-3), 0.3, Vec3(0.2, 0.1, 1.0));
  pose_.tools[0] = motion * before;
  patches_.ride(pose_, tissue_);
  ASSERT_EQ(patches_.nodes(0), held);
  for (const int each : held) {
    const Vec3 rest = tissue_.lattice().restPosition(each);
    const Vec3 moved = motion * Vec3(rest + 1e-3 * kInto);
    EXPECT_LT((rest + patches_.displacement()[at(each)] - moved).norm(), 1e-14);
  }
  EXPECT_LT((patches_.normal(0, pose_.tools[0]) - motion.linear() * kInto).norm(), 1e-12);
}

TEST_F(ToolPatchesTest, RidingOfOneToolLeavesTheOther) {
  push({atNode(node(2, 2, 3), 1e-3, kInto, 0), atNode(node(5, 5, 3), 5e-4, kInto, 1)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(2, 2, 3)}));
  EXPECT_EQ(patches_.nodes(1), (std::vector<int>{node(5, 5, 3)}));
  follow();
  pose_.tools[0].translation() += Vec3(0.0, 0.0, -1e-3);
  patches_.ride(pose_, tissue_);
  EXPECT_NEAR(patches_.displacement()[at(node(2, 2, 3))].z(), -2e-3, 1e-14);
  EXPECT_NEAR(patches_.displacement()[at(node(5, 5, 3))].z(), -5e-4, 1e-14);
  const auto loads = patches_.loadingPatches();
  ASSERT_EQ(loads.size(), 2u);
  EXPECT_EQ(loads[0].name, "probe");
  EXPECT_EQ(loads[1].name, "jaw");
}

TEST_F(ToolPatchesTest, NodeLiftedAboveItsRestPlaceIsLetGo) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3)});
  follow();
  ASSERT_GT(tissue_.nodeForce(middle).z(), 0.0);  // the tissue pushes back
  pose_.tools[0].translation().z() += 1.5e-3;     // 0.5 mm above rest
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(patches_.empty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{middle}));
  follow();
  expectAtRest(tissue_);
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(patches_.left().empty());
}

// A blade that leans on the node sideways, below the surface, and then goes back past the node's
// rest place: the node is drawn along until the tissue pulls it off.
TEST_F(ToolPatchesTest, NodePulledAwayOnTheNearSideOfItsRestPlaceIsLetGo) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3, Vec3(0.8, 0.0, -0.6))});
  follow();
  pose_.tools[0].translation().x() -= 2.0e-3;
  patches_.ride(pose_, tissue_);
  ASSERT_EQ(patches_.nodes(0), (std::vector<int>{middle}));  // still pushed against the tool
  follow();
  ASSERT_LT(tissue_.state().displacement[at(middle)].x(), 0.0);
  ASSERT_GT(Vec3(0.8, 0.0, -0.6).dot(tissue_.nodeForce(middle)), 0.0);  // now it is pulled off
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(patches_.empty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{middle}));
  follow();
  expectAtRest(tissue_);
}

TEST_F(ToolPatchesTest, NodeHeldBelowItsRestPlaceStays) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3)});
  follow();
  pose_.tools[0].translation() += Vec3(1e-3, 0.0, 0.5e-3);
  for (int i = 0; i < 3; ++i) {
    patches_.ride(pose_, tissue_);
    follow();
    EXPECT_EQ(patches_.nodes(0), (std::vector<int>{middle}));
  }
  const Vec3 expected(1e-3, 0.0, -0.5e-3);  // it sticks sideways
  EXPECT_LT((tissue_.state().displacement[at(middle)] - expected).norm(), 1e-14);
}

TEST_F(ToolPatchesTest, ClearLetsEveryNodeGo) {
  push({atNode(node(3, 3, 3), 1e-3), atNode(node(5, 5, 3), 5e-4, kInto, 1)});
  ASSERT_FALSE(patches_.empty());
  patches_.clear();
  EXPECT_TRUE(patches_.empty());
  EXPECT_TRUE(patches_.loadingPatches().empty());
}

}  // namespace
}  // namespace robot_tissue
