// Between Eigen and geometry_msgs; both in the same frame and unit.
#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Vector3.h>

#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

inline Vec3 toVec3(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }
inline Vec3 toVec3(const geometry_msgs::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

inline geometry_msgs::Point toPoint(const Vec3& vector) {
  geometry_msgs::Point point;
  point.x = vector.x();
  point.y = vector.y();
  point.z = vector.z();
  return point;
}

inline std::vector<geometry_msgs::Point> toPoints(const std::vector<Vec3>& vectors) {
  std::vector<geometry_msgs::Point> points;
  points.reserve(vectors.size());
  for (const Vec3& vector : vectors) points.push_back(toPoint(vector));
  return points;
}

inline geometry_msgs::Vector3 toVector3(const Vec3& vector) {
  geometry_msgs::Vector3 message;
  message.x = vector.x();
  message.y = vector.y();
  message.z = vector.z();
  return message;
}

}  // namespace robot_tissue
