// The tools and supports of a pipeline, by their numbers and those of their links.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "robot_tissue/contact/tool_geometry.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/scene.h"

namespace robot_tissue {

// Numbers of links, from `first` up to before `end`.
struct Links {
  std::size_t first = 0;
  std::size_t end = 0;
};

// Each once.
void addOnce(std::size_t tool, std::vector<std::size_t>& tools);

class ToolSet {
 public:
  // Numbers of supports follow those of tools.
  ToolSet(const std::vector<ToolGeometry>& tools, const std::vector<SupportConfig>& supports);

  void setFriction(double friction);                                    // not of supports
  const std::vector<ToolGeometry>& geometry() const { return tools_; }  // without supports
  std::vector<ToolGeometry> withSupports() const;
  std::size_t size() const { return tools_.size(); }
  std::size_t sizeWithSupports() const { return names_.size(); }
  const ToolGeometry& operator[](std::size_t tool) const { return tools_[tool]; }
  const std::vector<std::string>& names() const { return names_; }  // with supports
  const std::string& nameOf(std::size_t tool) const { return names_[tool]; }
  bool isRigid(int tool) const;  // its patch
  bool anyRigid() const { return any_rigid_; }

  std::size_t firstLink(std::size_t tool) const { return first_link_[tool]; }
  std::size_t endLink(std::size_t tool) const { return first_link_[tool + 1]; }
  Links linksOf(std::size_t tool) const { return {firstLink(tool), endLink(tool)}; }
  std::size_t firstJaw(std::size_t tool) const { return endLink(tool) - 2; }  // of a grasper
  std::size_t linkCount() const { return first_link_[tools_.size()]; }        // without supports
  std::size_t allLinks() const { return first_link_.back(); }

  // Where a link is that stands nowhere.
  static Pose away();
  static bool isAway(const Pose& pose);
  RobotPose complete(const RobotPose& pose) const;
  RobotPose withTool(std::size_t tool, const RobotPose& pose, RobotPose others) const;

 private:
  std::vector<ToolGeometry> tools_;
  std::vector<ToolGeometry> supports_;
  std::vector<std::string> names_;
  std::vector<std::size_t> first_link_;  // per tool and support, and the end
  bool any_rigid_ = false;
};

}  // namespace robot_tissue
