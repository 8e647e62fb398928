#include "robot_tissue/ros/shape_publisher.h"

#include <sensor_msgs/PointCloud2.h>

#include <utility>

#include "robot_tissue/ros/shape_messages.h"

namespace robot_tissue {

ShapePublisher::ShapePublisher(ros::NodeHandle& private_node, std::string frame_id, double rate_hz)
    : frame_id_(std::move(frame_id)), pace_(rate_hz) {
  surface_ = private_node.advertise<Surface>(
      "surface", 1, [this](const ros::SingleSubscriberPublisher&) { surface_due_ = true; });
  nodes_ = private_node.advertise<sensor_msgs::PointCloud2>(
      "nodes", 1, [this](const ros::SingleSubscriberPublisher&) { nodes_due_ = true; });
}

void ShapePublisher::publish(const Tissue& tissue, const ros::Time& stamp) {
  const bool tells_surface = isWanted(surface_, surface_due_);
  const bool tells_nodes = isWanted(nodes_, nodes_due_);
  if (!tells_surface && !tells_nodes) return;
  const double now = ros::Time::now().toSec();
  if (!pace_.isDue(now)) return;
  pace_.take(now);
  takeTopology(tissue);
  if (tells_surface) {
    message_.header.stamp = stamp;
    message_.header.frame_id = frame_id_;
    setVertices(tissue, message_);
    surface_.publish(message_);
    surface_due_ = false;
  }
  if (tells_nodes) {
    sensor_msgs::PointCloud2 cloud = nodeCloud(tissue, piece_of_node_);
    cloud.header.stamp = stamp;
    cloud.header.frame_id = frame_id_;
    nodes_.publish(cloud);
    nodes_due_ = false;
  }
}

void ShapePublisher::takeTopology(const Tissue& tissue) {
  const auto topology = static_cast<std::uint32_t>(tissue.surface().revision);
  if (topology_ == topology) return;
  topology_ = topology;
  piece_of_node_ = tissue.pieceOfNodes();
  message_.topology = topology_;
  setTriangles(tissue, piece_of_node_, message_);
}

}  // namespace robot_tissue
