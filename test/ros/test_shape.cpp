// The shape and the touches as data: what ~surface, ~nodes and ~contacts say, and to whom.
#include <robot_tissue/Surface.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <Eigen/Geometry>
#include <map>
#include <set>
#include <utility>

#include "node_fixture.h"

namespace robot_tissue::test_shape {
namespace {

// All the way through.
const std::vector<std::vector<double>> kHalves = {
    {0.0525, -0.1, -0.1}, {0.0525, 0.2, -0.1}, {0.0525, 0.2, 0.2}, {0.0525, -0.1, 0.2}};

class Shape : public NodeTest {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::service::waitForService("/tissue/reset", ros::Duration(kDeadline)));
    press(-0.01);
    ASSERT_TRUE(reset());
    subscribe<Surface>("surface", surface_);
    subscribe<sensor_msgs::PointCloud2>("nodes", nodes_);
    ASSERT_TRUE(waitFor([this] { return surface_ && nodes_ && lowestOfSurface() == kTop; }));
  }

  // In the middle of its top (m).
  double lowestOfSurface() const {
    double lowest = kTop;
    for (const auto& vertex : surface_->vertices) {
      const bool in_the_middle = std::hypot(vertex.x - 0.05, vertex.y - 0.05) < 0.004;
      if (in_the_middle && vertex.z > 0.001)
        lowest = std::min(lowest, static_cast<double>(vertex.z));
    }
    return std::abs(lowest - kTop) < 1e-7 ? kTop : lowest;
  }

  std::set<unsigned> pieces() const { return {surface_->piece.begin(), surface_->piece.end()}; }

  boost::shared_ptr<const Surface> surface_;
  boost::shared_ptr<const sensor_msgs::PointCloud2> nodes_;
};

// Sum over its triangles of the volume between each and the origin (m^3).
double volumeOf(const Surface& surface) {
  const auto vertex = [&](const shape_msgs::MeshTriangle& triangle, std::size_t corner) {
    const auto& place = surface.vertices[triangle.vertex_indices[corner]];
    return Eigen::Vector3d(place.x, place.y, place.z);
  };
  double volume = 0.0;
  for (const auto& triangle : surface.triangles) {
    volume += vertex(triangle, 0).dot(vertex(triangle, 1).cross(vertex(triangle, 2))) / 6.0;
  }
  return volume;
}

TEST_F(Shape, SurfaceIsClosedAndFollowsTheTool) {
  EXPECT_EQ(surface_->header.frame_id, "tissue");
  EXPECT_EQ(surface_->triangles.size(), surface_->piece.size());
  EXPECT_NEAR(volumeOf(*surface_), 0.1 * 0.1 * 0.05, 1e-9);
  std::map<std::pair<unsigned, unsigned>, int> sides;
  for (const auto& triangle : surface_->triangles) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const unsigned from = triangle.vertex_indices[corner];
      const unsigned to = triangle.vertex_indices[(corner + 1) % 3];
      ASSERT_LT(from, surface_->vertices.size());
      ++sides[{from, to}];
      --sides[{to, from}];
    }
  }
  for (const auto& [side, open] : sides) EXPECT_EQ(open, 0);
  const unsigned topology = surface_->topology;
  press(0.005);
  ASSERT_TRUE(waitFor([this] { return lowestOfSurface() < kTop - 0.0045; }));
  EXPECT_EQ(surface_->topology, topology);
  EXPECT_EQ(pieces(), std::set<unsigned>{0});
}

TEST_F(Shape, CutIsAnotherTopologyWithPieces) {
  const unsigned whole = surface_->topology;
  EXPECT_EQ(cut(kHalves).pieces, 2);
  ASSERT_TRUE(waitFor([&] { return surface_->topology > whole; }));
  EXPECT_EQ(pieces(), (std::set<unsigned>{0, 1}));
  for (std::size_t i = 0; i < surface_->triangles.size(); ++i) {
    double left = 0.0;
    for (const unsigned vertex : surface_->triangles[i].vertex_indices) {
      left += surface_->vertices[vertex].x - 0.0525;
    }
    if (std::abs(left) < 1e-4) continue;  // of the cut's own faces
    EXPECT_EQ(surface_->piece[i], left < 0.0 ? 0U : 1U);
  }
  const unsigned halves = surface_->topology;
  ASSERT_TRUE(reset());
  ASSERT_TRUE(waitFor([&] { return surface_->topology > halves; }));
  EXPECT_EQ(pieces(), std::set<unsigned>{0});
}

TEST_F(Shape, NodesAreTheLatticeWithItsDisplacements) {
  EXPECT_EQ(nodes_->width * nodes_->height, 21U * 21U * 11U);
  press(0.005);
  const auto pressed = [this] {
    for (sensor_msgs::PointCloud2ConstIterator<float> point(*nodes_, "x"), moved(*nodes_, "ux");
         point != point.end(); ++point, ++moved) {
      if (moved[2] < -0.0045F) return true;
    }
    return false;
  };
  ASSERT_TRUE(waitFor(pressed));
  for (sensor_msgs::PointCloud2ConstIterator<float> point(*nodes_, "x"), moved(*nodes_, "ux");
       point != point.end(); ++point, ++moved) {
    for (int axis = 0; axis < 3; ++axis) {
      const double spacings = (point[axis] - moved[axis]) / 0.005;
      ASSERT_NEAR(spacings, std::round(spacings), 1e-4);
    }
  }
}

TEST_F(Shape, TouchesTellWhereAndHowHard) {
  press(0.004);
  ASSERT_TRUE(waitForContacts());
  const TissueContact& contact = contacts_->contacts.front();
  ASSERT_GT(contact.touches.size(), 3U);
  geometry_msgs::Vector3 sum;
  for (const Touch& touch : contact.touches) {
    const auto& normal = touch.normal;
    EXPECT_NEAR(std::hypot(normal.x, normal.y, normal.z), 1.0, 1e-9);
    EXPECT_LT(normal.z, -0.5);  // from the probe into the tissue: down
    EXPECT_GE(touch.normal_force, 0.0);
    EXPECT_NEAR(std::hypot(touch.point.x - 0.05, touch.point.y - 0.05,
                           touch.point.z - kTop - kRadius + depth_),
                kRadius, 5e-4);
    EXPECT_LT(std::abs(touch.depth), 1.5e-4);  // the slack: 3 % of the spacing
    sum.x += touch.normal_force * normal.x + touch.friction_force.x;
    sum.z += touch.normal_force * normal.z + touch.friction_force.z;
  }
  EXPECT_NEAR(sum.z, contact.force.z, 1e-9);
  EXPECT_NEAR(sum.x, contact.force.x, 1e-9);
}

// Who comes late is told at once, also while the tool stands; nothing is sent while nothing
// changes.
TEST_F(Shape, IsSentToWhoComesAndWhereItChanged) {
  press(0.003);
  // A process listens to a topic by one connection: who comes has to be the only one.
  for (ros::Subscriber& one : subscribers_) {
    if (one.getTopic() == "/tissue/surface") one.shutdown();
  }
  int came = 0;
  const auto late = node_.subscribe<Surface>(
      "/tissue/surface", 10, [&](const boost::shared_ptr<const Surface>&) { ++came; });
  ASSERT_TRUE(waitFor([&] { return came > 0; }));
  EXPECT_FALSE(waitFor([&] { return came > 1; }, 0.5)) << "nothing changed";
  press(0.004);
  EXPECT_TRUE(waitFor([&] { return came > 1; }));
}

}  // namespace
}  // namespace robot_tissue::test_shape
