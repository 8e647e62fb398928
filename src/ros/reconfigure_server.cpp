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

// As Python reads it, in quotes.
std::string pythonText(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text)
    quoted += c == '\'' || c == '\\' ? std::string{'\\', c} : std::string{c};
  return quoted + "'";
}

// What clients offer a choice by: the protocol's form of it is a dictionary as Python writes it.
std::string choiceOf(const ReconfigureServer::Parameter& parameter) {
  std::string choices;
  for (const std::string& word : parameter.words) {
    choices += (choices.empty() ? "" : ", ") +
               ("{'name': " + pythonText(word) + ", 'type': 'str', 'value': " + pythonText(word)) +
               ", 'description': '', 'srcline': 0, 'srcfile': '', " +
               "'cconsttype': 'const char * const', 'ctype': 'std::string'}";
  }
  return "{'enum_description': " + pythonText(parameter.description) + ", 'enum': [" + choices +
         "]}";
}

}  // namespace

ReconfigureServer::ReconfigureServer(ros::NodeHandle& private_node,
                                     std::vector<Parameter> parameters, Change change)
    : node_name_(private_node.getNamespace()),
      parameters_(std::move(parameters)),
      change_(std::move(change)) {
  for (const Parameter& parameter : parameters_) values_[parameter.name] = parameter.initial;
  describe(private_node);
  updates_ = private_node.advertise<Config>("parameter_updates", 1, true);
  updates_.publish(present());
  set_ = private_node.advertiseService("set_parameters", &ReconfigureServer::onSet, this);
}

void ReconfigureServer::describe(ros::NodeHandle& private_node) {
  dynamic_reconfigure::Group group;
  group.name = kGroup;
  for (const Parameter& parameter : parameters_) {
    dynamic_reconfigure::ParamDescription description;
    description.name = parameter.name;
    description.type = parameter.words.empty() ? "double" : "str";
    description.description = parameter.description;
    if (!parameter.words.empty()) description.edit_method = choiceOf(parameter);
    group.parameters.push_back(description);
  }
  dynamic_reconfigure::ConfigDescription all;
  all.groups.push_back(group);
  all.min = config([](const Parameter& of) { return of.words.empty() ? of.range.lowest : 0.0; });
  all.max = config([](const Parameter& of) { return of.words.empty() ? of.range.highest : 0.0; });
  all.dflt = config([](const Parameter& parameter) { return parameter.initial; });
  descriptions_ = private_node.advertise<dynamic_reconfigure::ConfigDescription>(
      "parameter_descriptions", 1, true);
  descriptions_.publish(all);
}

dynamic_reconfigure::Config ReconfigureServer::config(
    const std::function<double(const Parameter&)>& value_of) const {
  Config config;
  for (const Parameter& parameter : parameters_) {
    const double value = value_of(parameter);
    if (parameter.words.empty()) {
      dynamic_reconfigure::DoubleParameter number;
      number.name = parameter.name;
      number.value = value;
      config.doubles.push_back(number);
    } else {
      dynamic_reconfigure::StrParameter word;
      word.name = parameter.name;
      word.value = parameter.words.at(static_cast<std::size_t>(value));
      config.strs.push_back(word);
    }
  }
  dynamic_reconfigure::GroupState group;
  group.name = kGroup;
  group.state = true;
  config.groups.push_back(group);
  return config;
}

dynamic_reconfigure::Config ReconfigureServer::present() const {
  return config([this](const Parameter& parameter) { return values_.at(parameter.name); });
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
  const auto parameter = std::find_if(parameters_.begin(), parameters_.end(),
                                      [&](const Parameter& each) { return each.name == name; });
  if (parameter == parameters_.end()) {
    std::vector<std::string> names;
    for (const Parameter& each : parameters_) names.push_back(each.name);
    entry.fail("cannot be changed here, must be one of " + joined(names));
  }
  if (parameter->words.empty()) {
    if (!parameter->range.contains(value)) entry.fail("must be " + parameter->range.text());
  } else {
    const auto& words = parameter->words;
    const auto word = std::find(words.begin(), words.end(), text);
    if (word == words.end()) entry.fail("must be one of " + joined(words));
    value = static_cast<double>(word - words.begin());
  }
  if (!changes.emplace(name, value).second) entry.fail("must be given once");
}

}  // namespace robot_tissue
