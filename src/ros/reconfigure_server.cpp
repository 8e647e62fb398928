#include "robot_tissue/ros/reconfigure_server.h"

#include <dynamic_reconfigure/ConfigDescription.h>
#include <ros/console.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "robot_tissue/scene/map_reader.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

const char* const kGroup = "Default";  // the protocol's name of the one group that there is
constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();  // in no range

}  // namespace

ReconfigureServer::ReconfigureServer(ros::NodeHandle& private_node, std::vector<Number> numbers,
                                     Change change)
    : node_name_(private_node.getNamespace()),
      numbers_(std::move(numbers)),
      change_(std::move(change)) {
  for (const Number& number : numbers_) values_[number.name] = number.initial;
  describe(private_node);
  updates_ = private_node.advertise<Config>("parameter_updates", 1, true);
  updates_.publish(present());
  set_ = private_node.advertiseService("set_parameters", &ReconfigureServer::onSet, this);
}

void ReconfigureServer::describe(ros::NodeHandle& private_node) {
  dynamic_reconfigure::Group group;
  group.name = kGroup;
  for (const Number& number : numbers_) {
    dynamic_reconfigure::ParamDescription description;
    description.name = number.name;
    description.type = "double";
    description.description = number.description;
    group.parameters.push_back(description);
  }
  dynamic_reconfigure::ConfigDescription all;
  all.groups.push_back(group);
  all.min = config([](const Number& number) { return number.range.lowest; });
  all.max = config([](const Number& number) { return number.range.highest; });
  all.dflt = config([](const Number& number) { return number.initial; });
  descriptions_ = private_node.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  descriptions_.publish(all);
}

dynamic_reconfigure::Config ReconfigureServer::config(
    const std::function<double(const Number&)>& value_of) const {
  Config config;
  for (const Number& number : numbers_) {
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = number.name;
    parameter.value = value_of(number);
    config.doubles.push_back(parameter);
  }
  dynamic_reconfigure::GroupState group;
  group.name = kGroup;
  group.state = true;
  config.groups.push_back(group);
  return config;
}

dynamic_reconfigure::Config ReconfigureServer::present() const {
  return config([this](const Number& number) { return values_.at(number.name); });
}

bool ReconfigureServer::onSet(dynamic_reconfigure::Reconfigure::Request& request,
                              dynamic_reconfigure::Reconfigure::Response& response) {
  try {
    const Values changes = changesIn(request.config);
    if (!changes.empty()) change_(changes);
    for (const auto& [name, value] : changes) values_[name] = value;
  } catch (const InputError& error) {
    ROS_WARN_STREAM(node_name_ << ": " << error.what() << "; nothing is changed");
  }
  response.config = present();
  updates_.publish(response.config);
  return true;
}

// Clients may send all values: those that are so already are no change.
ReconfigureServer::Values ReconfigureServer::changesIn(const Config& asked) const {
  Values changes;
  for (const auto& each : asked.doubles) {
    take(each.name, each.value, numberText(each.value), changes);
  }
  for (const auto& each : asked.ints) {
    take(each.name, each.value, std::to_string(each.value), changes);
  }
  for (const auto& each : asked.strs) take(each.name, kNoNumber, each.value, changes);
  for (const auto& each : asked.bools) {
    take(each.name, kNoNumber, each.value != 0 ? "true" : "false", changes);
  }
  for (const auto& [name, value] : values_) {
    const auto found = changes.find(name);
    if (found != changes.end() && found->second == value) changes.erase(found);
  }
  return changes;
}

void ReconfigureServer::take(const std::string& name, double value, const std::string& text,
                             Values& changes) const {
  const Entry entry(YAML::Node(text), name, "");
  const auto number = std::find_if(numbers_.begin(), numbers_.end(),
                                   [&](const Number& each) { return each.name == name; });
  if (number == numbers_.end()) {
    std::vector<std::string> names;
    for (const Number& each : numbers_) names.push_back(each.name);
    entry.fail("cannot be changed here, must be one of " + joined(names));
  }
  if (!number->range.contains(value)) entry.fail("must be " + number->range.text());
  if (!changes.emplace(name, value).second) entry.fail("must be given once");
}

}  // namespace robot_tissue
