// Contacts -> loading patches: nodes are pushed out, ride with their tool, and are let go.
#include <gtest/gtest.h>

#include <cmath>

#include "core/tissue_fixtures.h"
#include "robot_tissue/coupling/sticking_contacts.h"

namespace robot_tissue::test_sticking_contacts {
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

class StickingContactsTest : public ::testing::Test {
 protected:
  StickingContactsTest()
      : tissue_(kBlock, paperSolver()), patches_(tissue_.lattice(), {"probe", "jaw"}) {
    pose_.links = {poseAt(Vec3(0.03, 0.03, 0.05)), poseAt(Vec3(0.0, 0.1, 0.05), 0.4)};
  }

  int node(int i, int j, int k) const { return tissue_.lattice().node(i, j, k); }

  // A contact at a node of the surface.
  Contact atNode(int node, double depth, const Vec3& normal = kInto, int tool = 0) const {
    const TissueSurface& surface = tissue_.surface();
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
    made.tool = made.link = tool;
    made.place = {triangle, barycentric};
    made.normal = normal;
    made.depth_m = depth;
    made.point = pointOf(made, tissue_.vertices());
    return made;
  }

  Vec3 pointOf(const Contact& contact, const std::vector<Vec3>& vertices) const {
    Vec3 point = Vec3::Zero();
    for (int corner = 0; corner < 3; ++corner) {
      const int vertex = tissue_.surface().triangles[at(contact.place.triangle)][at(corner)];
      point += contact.place.barycentric[corner] * vertices[at(vertex)];
    }
    return point;
  }

  // How far the contact's point went with the patches.
  Vec3 wayOf(const Contact& contact) const {
    std::vector<Vec3> vertices;
    deform(tissue_.surface(), patches_.displacement(tissue_), vertices);
    return pointOf(contact, vertices) - contact.point;
  }

  // A triangle that lies in the plane z = `z`.
  int triangleAt(double z) const {
    const TissueSurface& surface = tissue_.surface();
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
    patches_.pushOut(set, tissue_, pose_);
  }

  std::vector<LoadingPatch> loadingPatches() const {
    std::vector<LoadingPatch> patches;
    for (int tool = 0; tool < 2; ++tool) {
      if (patches_.holds(tool)) patches.push_back(patches_.loadingPatch(tool, tissue_));
    }
    return patches;
  }

  SolveReport follow() { return tissue_.follow(loadingPatches(), patches_.left()); }

  // The jaw, tool and link 1, holds nodes from where they are.
  void grasp(const std::vector<int>& nodes) {
    std::vector<StickingContacts::Grip> grips;
    for (const int node : nodes) grips.push_back({node, 1, 1, 0.0});
    patches_.hold(1, grips, pose_, tissue_);
  }
  bool areEmpty() const { return !patches_.holds(0) && !patches_.holds(1); }
  // Sum over its nodes (m).
  Vec3 wayOutOf(std::size_t tool) const {
    Vec3 sum = Vec3::Zero();
    for (const auto& [node, seat] : patches_.attachments()[tool]) {
      sum += pose_.links[at(seat.link)].linear() * seat.pushed;
    }
    return sum;
  }

  Tissue tissue_;
  StickingContacts patches_;
  RobotPose pose_;
};

TEST_F(StickingContactsTest, WithoutContactThereIsNoPatch) {
  push({});
  EXPECT_FALSE(patches_.holds(0));
  EXPECT_TRUE(patches_.loadingPatch(0, tissue_).nodes.empty());
  EXPECT_TRUE(patches_.nodes(0).empty());
  EXPECT_TRUE(wayOutOf(0).isZero());
  EXPECT_EQ(patches_.displacement(tissue_), tissue_.state().displacement);
}

TEST_F(StickingContactsTest, ContactAtAVertexIsPushedOutByItsDepth) {
  const int middle = node(3, 3, 3);
  const Vec3 normal = Vec3(0.6, 0.0, -0.8);
  push({atNode(middle, 1e-3, normal)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{middle}));
  EXPECT_TRUE(patches_.nodes(1).empty());
  EXPECT_LT((patches_.displacement(tissue_)[at(middle)] - 1e-3 * normal).norm(), 1e-15);
  EXPECT_LT((wayOutOf(0) - 1e-3 * normal).norm(), 1e-15);
  const LoadingPatch load = patches_.loadingPatch(0, tissue_);
  EXPECT_EQ(load.name, "probe");
  EXPECT_EQ(load.drive, LoadingPatch::Drive::kDisplacement);
  EXPECT_EQ(load.nodes, (std::vector<int>{middle}));
  ASSERT_EQ(load.displacement.size(), 1u);
  EXPECT_EQ(load.displacement[0], patches_.displacement(tissue_)[at(middle)]);
  EXPECT_FALSE(patches_.holds(1));
}

TEST_F(StickingContactsTest, ContactInsideATriangleIsPushedOutByItsDepth) {
  for (const Vec3& weights : {Vec3(1.0, 1.0, 1.0), Vec3(0.1, 0.2, 0.7), Vec3(0.0, 0.5, 0.5)}) {
    patches_.clear();
    const Contact hit = contact(triangleAt(0.03), weights / weights.sum(), 7e-4);
    push({hit});
    EXPECT_LT((wayOf(hit) - 7e-4 * kInto).norm(), 1e-12);
    EXPECT_EQ(patches_.nodes(0).size(), static_cast<std::size_t>((weights.array() > 0.0).count()));
  }
}

TEST_F(StickingContactsTest, NeighboringContactsAreAllPushedOut) {
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

TEST_F(StickingContactsTest, FixedNodesAreNeverTaken) {
  push({contact(triangleAt(0.0), Vec3::Constant(1.0 / 3.0), 1e-3, Vec3::UnitZ())});
  EXPECT_TRUE(areEmpty());
  // A triangle of a side wall that has a fixed edge: its free nodes alone do it.
  int mixed = -1;
  const TissueSurface& surface = tissue_.surface();
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

TEST_F(StickingContactsTest, NodesOfNamedLoadsAreNeverTaken) {
  const Box box = nodeBox(kBlock, {2, 2, 3}, {3, 3, 3});
  tissue_.load(loadOf({displacedPatch("named", box, Vec3(0.0, 0.0, -5e-4))}));
  push({atNode(node(3, 3, 3), 1e-3)});
  EXPECT_TRUE(areEmpty());
  EXPECT_EQ(patches_.displacement(tissue_), tissue_.state().displacement);
  push({atNode(node(4, 4, 3), 1e-3)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(4, 4, 3)}));
}

TEST_F(StickingContactsTest, NodeThatANamedLoadTakesIsLeftToIt) {
  push({atNode(node(3, 3, 3), 5e-4)});
  ASSERT_FALSE(areEmpty());
  const Box box = nodeBox(kBlock, {2, 2, 3}, {3, 3, 3});
  tissue_.load(loadOf({displacedPatch("named", box, Vec3(0.0, 0.0, -5e-4))}));
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(areEmpty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{node(3, 3, 3)}));
}

TEST_F(StickingContactsTest, NodesRideRigidlyWithTheirTool) {
  const std::vector<int> held = {node(3, 3, 3), node(4, 3, 3), node(3, 4, 3)};
  std::vector<Contact> hits;
  for (const int each : held) hits.push_back(atNode(each, 1e-3));
  push(hits);
  follow();
  const Pose before = pose_.links[0];
  const Pose motion = poseAt(Vec3(2e-3, -1e-3, -3e-3), 0.3, Vec3(0.2, 0.1, 1.0));
  pose_.links[0] = motion * before;
  patches_.ride(pose_, tissue_);
  ASSERT_EQ(patches_.nodes(0), held);
  for (const int each : held) {
    const Vec3 rest = tissue_.lattice().restPosition(each);
    const Vec3 moved = motion * Vec3(rest + 1e-3 * kInto);
    EXPECT_LT((rest + patches_.displacement(tissue_)[at(each)] - moved).norm(), 1e-14);
  }
  const Vec3 way_out = motion.linear() * (3e-3 * kInto);  // the sum over its nodes
  EXPECT_LT((wayOutOf(0) - way_out).norm(), 1e-15);
}

TEST_F(StickingContactsTest, RidingOfOneToolLeavesTheOther) {
  push({atNode(node(2, 2, 3), 1e-3, kInto, 0), atNode(node(5, 5, 3), 5e-4, kInto, 1)});
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(2, 2, 3)}));
  EXPECT_EQ(patches_.nodes(1), (std::vector<int>{node(5, 5, 3)}));
  follow();
  pose_.links[0].translation() += Vec3(0.0, 0.0, -1e-3);
  patches_.ride(pose_, tissue_);
  EXPECT_NEAR(patches_.displacement(tissue_)[at(node(2, 2, 3))].z(), -2e-3, 1e-14);
  EXPECT_NEAR(patches_.displacement(tissue_)[at(node(5, 5, 3))].z(), -5e-4, 1e-14);
  EXPECT_EQ(patches_.loadingPatch(0, tissue_).name, "probe");
  EXPECT_EQ(patches_.loadingPatch(1, tissue_).name, "jaw");
}

TEST_F(StickingContactsTest, NodeLiftedAboveItsRestPlaceIsLetGo) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3)});
  follow();
  ASSERT_GT(tissue_.nodeForce(middle).z(), 0.0);  // the tissue pushes back
  pose_.links[0].translation().z() += 1.5e-3;     // 0.5 mm above rest
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(areEmpty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{middle}));
  follow();
  expectAtRest(tissue_);
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(patches_.left().empty());
}

// A blade that leans on the node sideways, below the surface, and then goes back past the node's
// rest place: the node is drawn along until the tissue pulls it off.
TEST_F(StickingContactsTest, NodePulledAwayOnTheNearSideOfItsRestPlaceIsLetGo) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3, Vec3(0.8, 0.0, -0.6))});
  follow();
  pose_.links[0].translation().x() -= 2.0e-3;
  patches_.ride(pose_, tissue_);
  ASSERT_EQ(patches_.nodes(0), (std::vector<int>{middle}));  // still pushed against the tool
  follow();
  ASSERT_LT(tissue_.state().displacement[at(middle)].x(), 0.0);
  ASSERT_GT(Vec3(0.8, 0.0, -0.6).dot(tissue_.nodeForce(middle)), 0.0);  // now it is pulled off
  patches_.ride(pose_, tissue_);
  EXPECT_TRUE(areEmpty());
  EXPECT_EQ(patches_.left(), (std::vector<int>{middle}));
  follow();
  expectAtRest(tissue_);
}

TEST_F(StickingContactsTest, NodeHeldBelowItsRestPlaceStays) {
  const int middle = node(3, 3, 3);
  push({atNode(middle, 1e-3)});
  follow();
  pose_.links[0].translation() += Vec3(1e-3, 0.0, 0.5e-3);
  for (int i = 0; i < 3; ++i) {
    patches_.ride(pose_, tissue_);
    follow();
    EXPECT_EQ(patches_.nodes(0), (std::vector<int>{middle}));
  }
  const Vec3 expected(1e-3, 0.0, -0.5e-3);  // it sticks sideways
  EXPECT_LT((tissue_.state().displacement[at(middle)] - expected).norm(), 1e-14);
}

TEST_F(StickingContactsTest, ClearLetsEveryNodeGo) {
  push({atNode(node(3, 3, 3), 1e-3), atNode(node(5, 5, 3), 5e-4, kInto, 1)});
  ASSERT_FALSE(areEmpty());
  patches_.clear();
  EXPECT_TRUE(areEmpty());
  EXPECT_TRUE(loadingPatches().empty());
}

TEST_F(StickingContactsTest, GraspedNodesRideOnTheLinkFromWhereTheyAre) {
  const std::vector<int> grasped = {node(3, 3, 3), node(4, 3, 3), node(3, 3, 2)};
  push({atNode(grasped.front(), 1e-3)});
  follow();
  patches_.clear();  // the probe hands over what it pressed
  std::vector<Vec3> places;
  for (const int each : grasped) places.push_back(tissue_.nodePosition(each));
  grasp(grasped);
  EXPECT_TRUE(patches_.holds(1));
  EXPECT_FALSE(patches_.holds(0));
  const Pose motion = poseAt(Vec3(2e-3, -1e-3, 3e-3), 0.2, Vec3(0.2, 0.1, 1.0));
  pose_.links[1] = motion * pose_.links[1];
  patches_.ride(pose_, tissue_);
  const LoadingPatch jaw = patches_.loadingPatch(1, tissue_);
  ASSERT_EQ(jaw.nodes.size(), grasped.size());
  for (std::size_t i = 0; i < grasped.size(); ++i) {
    const Vec3 now =
        tissue_.lattice().restPosition(grasped[i]) + patches_.displacement(tissue_)[at(grasped[i])];
    EXPECT_LT((now - motion * places[i]).norm(), 1e-14);
  }
  EXPECT_TRUE(wayOutOf(1).isZero());  // it was not pushed out of the jaw
}

TEST_F(StickingContactsTest, GraspedNodesStayAlsoWhereTheTissuePullsThemOff) {
  const std::vector<int> grasped = {node(3, 3, 3), node(4, 3, 3)};
  patches_.ride(pose_, tissue_);
  grasp(grasped);
  for (int step = 1; step <= 3; ++step) {
    pose_.links[1].translation() += Vec3(0.0, 0.0, 1e-3);  // above its rest place
    patches_.ride(pose_, tissue_);
    patches_.keepTouching({}, tissue_);  // nothing touches it
    ASSERT_EQ(patches_.nodes(1), grasped);
    EXPECT_TRUE(patches_.left().empty());
    follow();
    EXPECT_LT(tissue_.nodeForce(grasped[0]).z(), 0.0);
    EXPECT_NEAR(tissue_.state().displacement[at(grasped[1])].z(), 1e-3 * step, 1e-14);
  }
}

TEST_F(StickingContactsTest, LetGoLeavesOtherToolsNodes) {
  push({atNode(node(2, 2, 3), 1e-3)});
  grasp({node(5, 5, 3)});
  patches_.letGo(1);
  EXPECT_FALSE(patches_.holds(1));
  EXPECT_TRUE(patches_.nodes(1).empty());
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(2, 2, 3)}));
}

TEST_F(StickingContactsTest, TissueThatIsLetGoComesToRest) {
  patches_.ride(pose_, tissue_);
  grasp({node(3, 3, 3), node(4, 3, 3)});
  pose_.links[1].translation() += Vec3(1e-3, 0.0, 1e-3);
  patches_.ride(pose_, tissue_);
  follow();
  ASSERT_TRUE(isDeformed(tissue_));
  patches_.letGo(1);
  patches_.ride(pose_, tissue_);
  follow();
  expectAtRest(tissue_);
}

TEST_F(StickingContactsTest, FixedLoadedAndSeatedNodesAreNotGrasped) {
  const Box box = nodeBox(kBlock, {1, 1, 3}, {2, 2, 3});
  tissue_.load(loadOf({displacedPatch("named", box, Vec3(0.0, 0.0, -5e-4))}));
  push({atNode(node(4, 4, 3), 1e-3)});
  grasp({node(3, 3, 0), node(1, 1, 3), node(4, 4, 3), node(5, 5, 3)});
  EXPECT_EQ(patches_.nodes(1), (std::vector<int>{node(5, 5, 3)}));
  EXPECT_EQ(patches_.nodes(0), (std::vector<int>{node(4, 4, 3)}));
}

TEST_F(StickingContactsTest, HeldAreFixedNodesThoseOfDisplacedLoadsAndOfTools) {
  tissue_.load(
      loadOf({displacedPatch("way", nodeBox(kBlock, {1, 1, 3}, {1, 2, 3}), Vec3(0.0, 0.0, -5e-4)),
              forcedPatch("force", nodeBox(kBlock, {5, 1, 3}, {5, 2, 3}), Vec3(0.0, 0.0, -1e-3))}));
  push({atNode(node(3, 3, 3), 1e-3)});
  grasp({node(5, 5, 3)});
  const std::vector<std::uint8_t> held = patches_.heldNodes(tissue_);
  ASSERT_EQ(held.size(), at(tissue_.lattice().nodeCount()));
  for (int each = 0; each < tissue_.lattice().nodeCount(); ++each) {
    const bool loaded = each == node(1, 1, 3) || each == node(1, 2, 3);
    const bool of_tool = each == node(3, 3, 3) || each == node(5, 5, 3);
    EXPECT_EQ(held[at(each)] != 0, tissue_.lattice().isFixed(each) || loaded || of_tool)
        << "node " << each;
  }
  EXPECT_EQ(held[at(node(5, 5, 3))], SlidingContacts::graspedBy(1));
  EXPECT_EQ(held[at(node(3, 3, 3))], 1);
}

// A gripper with two jaws: each node goes with the link that holds it.
TEST_F(StickingContactsTest, NodesOfOneToolRideOnDifferentLinks) {
  StickingContacts gripper(tissue_.lattice(), {"gripper"});
  gripper.ride(pose_, tissue_);
  gripper.hold(0, {{node(2, 3, 3), 0, 1, 0.0}, {node(4, 3, 3), 1, 0, 0.0}}, pose_, tissue_);
  pose_.links[0].translation() += Vec3(1e-3, 0.0, 0.0);
  pose_.links[1].translation() += Vec3(-1e-3, 0.0, 0.0);
  gripper.ride(pose_, tissue_);
  EXPECT_EQ(gripper.nodes(0).size(), 2u);
  EXPECT_NEAR(gripper.displacement(tissue_)[at(node(2, 3, 3))].x(), 1e-3, 1e-14);
  EXPECT_NEAR(gripper.displacement(tissue_)[at(node(4, 3, 3))].x(), -1e-3, 1e-14);
}

}  // namespace
}  // namespace robot_tissue::test_sticking_contacts
