// What is kept of the end of a load step to come back to.
#pragma once

#include <vector>

#include "grasping.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"
#include "robot_tissue/coupling/sticking_contacts.h"

namespace robot_tissue {

// `shape` is empty where nothing was to be solved and, without rigid patches, once the step is
// over: they alone come back later.
struct Checkpoint {
  RobotPose pose;
  Tissue::Shape shape;
  StickingContacts::Attachments attachments;
  SlidingContacts contacts;
  std::vector<Jaws> jaws;
  std::vector<double> depths;
};

}  // namespace robot_tissue
