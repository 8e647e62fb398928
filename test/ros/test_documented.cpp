// doc/node.md has the node's topics, services and parameters, and no others.
#include <gtest/gtest.h>
#include <ros/ros.h>

#include <algorithm>
#include <cstdio>
#include <set>
#include <sstream>
#include <string>

#include "documents.h"

namespace robot_tissue::test_documented {
namespace {

using Names = std::set<std::string>;

constexpr double kDeadline = 20.0;  // s, wall time; reached only when something is wrong
const std::string kDocument = std::string(ROBOT_TISSUE_SOURCE_DIR) + "/doc/node.md";
const std::string kNode = "/tissue";

// "~<tool>/measured_cf" -> "/tissue/probe/measured_cf"
Names documented(const std::string& column) {
  Names names;
  for (const DocumentedWord& each : documentedWords(kDocument, column)) {
    std::string name = each.word;
    const std::string tool = "<tool>";
    const std::size_t at = name.find(tool);
    if (at != std::string::npos) name.replace(at, tool.size(), "probe");
    if (name.front() == '~') name = kNode + "/" + name.substr(1);
    names.insert(name);
  }
  return names;
}

// What the master knows of the node: 0 for topics that it publishes, 2 for its services.
Names registered(int kind) {
  XmlRpc::XmlRpcValue request, response, state;
  request[0] = ros::this_node::getName();
  Names names;
  if (!ros::master::execute("getSystemState", request, response, state, true)) return names;
  for (int i = 0; i < state[kind].size(); ++i) {
    XmlRpc::XmlRpcValue& nodes = state[kind][i][1];
    for (int j = 0; j < nodes.size(); ++j) {
      if (static_cast<std::string>(nodes[j]) == kNode) names.insert(state[kind][i][0]);
    }
  }
  return names;
}

// Those that every node has are not documented.
Names without(Names names, const Names& of_every_node) {
  for (const std::string& name : of_every_node) names.erase(name);
  return names;
}

template <class Condition>
bool waitFor(const Condition& condition) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(kDeadline);
  while (!condition() && ros::WallTime::now() < end) ros::WallDuration(0.05).sleep();
  return condition();
}

// Asks a node of its own, whose refusal of an unknown parameter lists those that there are.
Names parameters() {
  XmlRpc::XmlRpcValue scene;
  ros::param::get(kNode, scene);
  ros::param::set("/asked", scene);
  ros::param::set("/asked/no_such_parameter", 1);
  const std::string command = std::string("timeout 20 ") + NODE_PATH + " __name:=asked 2>&1";
  FILE* pipe = popen(command.c_str(), "r");
  std::string output;
  char buffer[512];
  while (fgets(buffer, sizeof(buffer), pipe) != nullptr) output += buffer;
  pclose(pipe);
  const std::string lead = "must be one of ";
  const std::size_t begin = output.find(lead);
  Names names;
  if (begin == std::string::npos) return names;
  std::istringstream list(output.substr(begin + lead.size()));
  std::string name;
  // The line may end with the log's color.
  const auto is_other = [](char c) { return c != '_' && (c < 'a' || c > 'z'); };
  while (std::getline(list >> std::ws, name, ',')) {
    names.insert(kNode + "/" +
                 name.substr(0, std::find_if(name.begin(), name.end(), is_other) - name.begin()));
  }
  return names;
}

TEST(Documented, Topics) {
  const Names of_every_node = {"/rosout"};
  const Names expected = documented("topic");
  waitFor([&] { return without(registered(0), of_every_node) == expected; });
  EXPECT_EQ(without(registered(0), of_every_node), expected);
}

TEST(Documented, Services) {
  const Names of_every_node = {kNode + "/get_loggers", kNode + "/set_logger_level"};
  const Names expected = documented("service");
  waitFor([&] { return without(registered(2), of_every_node) == expected; });
  EXPECT_EQ(without(registered(2), of_every_node), expected);
}

TEST(Documented, Parameters) { EXPECT_EQ(parameters(), documented("parameter")); }

}  // namespace
}  // namespace robot_tissue::test_documented
