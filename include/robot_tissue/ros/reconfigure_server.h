// Numbers and words that may change while the node runs, by the protocol of dynamic_reconfigure:
// service ~set_parameters, latched topics ~parameter_descriptions and ~parameter_updates. That
// package's own server clips what is out of range in silence; here a request is taken as a whole or
// refused as a whole, with one line in the log. Either way the reply and ~parameter_updates have
// what is so.
#pragma once

#include <dynamic_reconfigure/Config.h>
#include <dynamic_reconfigure/Reconfigure.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <ros/service_server.h>

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "robot_tissue/scene/entry.h"

namespace robot_tissue {

class ReconfigureServer {
 public:
  struct Parameter {
    std::string name;
    std::string description;
    Range range;                     // of a number
    double initial = 0.0;            // of words its place among them
    std::vector<std::string> words;  // not empty: it is one of these
  };
  using Values = std::map<std::string, double>;  // by name, as Parameter::initial
  // Given those that are to change, in their ranges; changes all or, throwing InputError, none.
  using Change = std::function<void(const Values&)>;

  ReconfigureServer(ros::NodeHandle& private_node, std::vector<Parameter> parameters,
                    Change change);

 private:
  using Config = dynamic_reconfigure::Config;

  bool onSet(dynamic_reconfigure::Reconfigure::Request& request,
             dynamic_reconfigure::Reconfigure::Response& response);
  Values changesIn(const Config& asked) const;
  void take(const std::string& name, double value, const std::string& text, Values& changes) const;
  Config config(const std::function<double(const Parameter&)>& value_of) const;
  Config present() const;
  void describe(ros::NodeHandle& private_node);

  std::string node_name_;
  std::vector<Parameter> parameters_;
  Values values_;
  Change change_;
  ros::Publisher descriptions_, updates_;
  ros::ServiceServer set_;
};

}  // namespace robot_tissue
