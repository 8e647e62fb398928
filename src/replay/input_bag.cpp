#include "input_bag.h"

#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <filesystem>
#include <vector>

#include "robot_tissue/core/types.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const std::vector<std::string> kMoving = {"/tf", "tf"};
const std::vector<std::string> kStatic = {"/tf_static", "tf_static"};
const std::vector<std::string> kRobot = {"/robot_description", "robot_description"};

bool isOneOf(const std::vector<std::string>& topics, const std::string& topic) {
  return topic == topics.front() || topic == topics.back();
}

}  // namespace

InputBag::InputBag(const std::string& path) : path_(path) {
  // A folder opens like a file, and a pipe waits for ever.
  if (!std::filesystem::is_regular_file(path_)) refuse("is no file");
  try {
    bag_.open(path_, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    refuse("has no index, as where recording was cut off; 'rosbag reindex' mends it");
  } catch (const std::exception& error) {
    refuse(error.what());
  }
}

std::optional<std::string> InputBag::robotDescription() const {
  try {
    rosbag::View view(bag_, rosbag::TopicQuery(kRobot));
    for (const rosbag::MessageInstance& message : view) {
      if (const auto text = message.instantiate<std_msgs::String>()) return text->data;
    }
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  return std::nullopt;
}

void InputBag::forTransforms(const OnTransforms& on_transforms) const {
  rosbag::View view;
  try {
    view.addQuery(bag_, rosbag::TopicQuery(kMoving));
    view.addQuery(bag_, rosbag::TopicQuery(kStatic));
  } catch (const std::exception& error) {
    refuse(error.what());
  }
  if (view.size() == 0) refuse("has neither /tf nor /tf_static");
  for (const rosbag::MessageInstance& message : view) {
    tf2_msgs::TFMessageConstPtr transforms;
    try {
      transforms = message.instantiate<tf2_msgs::TFMessage>();
    } catch (const std::exception& error) {
      refuse(error.what());
    }
    if (!transforms) refuse(message.getTopic() + " is of type " + message.getDataType());
    on_transforms(*transforms,
                  isOneOf(kStatic, message.getTopic()) ? TransformIntake::Kind::kStatic
                                                       : TransformIntake::Kind::kMoving,
                  message.getTime());
  }
}

void InputBag::refuse(const std::string& why) const {
  throw InputError(onOneLine(path_) + ": " + onOneLine(why) +
                   "; allowed: a whole bag with /tf, of tf2_msgs/TFMessage");
}

}  // namespace robot_tissue
