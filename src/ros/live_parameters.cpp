#include "robot_tissue/ros/live_parameters.h"

#include <XmlRpcValue.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "robot_tissue/core/method_names.h"
#include "robot_tissue/ros/node_ranges.h"
#include "robot_tissue/scene/ranges.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

using Found = std::optional<double>;

// By its name, or by its place in the list where it has none.
std::string called(const std::string& kind, const std::string& name, std::size_t place) {
  return name.empty() ? "tissue." + kind + "s[" + std::to_string(place) + "]"
                      : kind + " '" + shortText(name) + "'";
}

// Regions that have a modulus of their own keep it.
void setModulus(double young_modulus, NodeParameters& parameters) {
  TissueConfig& tissue = parameters.scene.tissue;
  requireContrasts(young_modulus, tissue);
  tissue.material.young_modulus = young_modulus;
  for (Region& region : tissue.regions) {
    if (!region.own_modulus) region.material.young_modulus = young_modulus;
  }
}

bool hasFriction(const ToolConfig& tool) { return tool.patch == ToolConfig::Patch::kConforming; }

void setFriction(double friction, NodeParameters& parameters) {
  for (ToolConfig& tool : parameters.scene.tools) {
    if (hasFriction(tool)) tool.friction = friction;
  }
}

// On the parameter server, so that it tells what is so and a node that is started again has it. A
// preset stands there no more: no number that it sets may stand beside it, so its numbers do.
void keepModulus(const NodeParameters& parameters, ros::NodeHandle& private_node) {
  const std::string path = "tissue/material";
  const Material& material = parameters.scene.tissue.material;
  XmlRpc::XmlRpcValue before, after;
  const bool has_preset = private_node.getParam(path, before) && before.hasMember("preset");
  if (!has_preset) return private_node.setParam(path + "/young_modulus", material.young_modulus);
  for (auto& [key, value] : before) {
    if (key != "preset") after[key] = value;
  }
  const ModelTraits& traits = traitsOfModel(parameters.scene.tissue.model);
  const bool stiffens = material.law == Material::Law::kFung && traits.has_law;
  after["young_modulus"] = material.young_modulus;
  after["density"] = material.density;
  if (traits.has_poisson_ratio) after["poisson_ratio"] = material.poisson_ratio;
  if (stiffens) after["law"] = "fung";
  if (stiffens) after["stiffening"] = material.stiffening;
  private_node.setParam(path, after);
}

void keepFriction(const NodeParameters& parameters, ros::NodeHandle& private_node) {
  XmlRpc::XmlRpcValue tools;
  if (!private_node.getParam("tools", tools)) return;
  const std::vector<ToolConfig>& of_scene = parameters.scene.tools;
  const bool are_same = tools.getType() == XmlRpc::XmlRpcValue::TypeArray &&
                        tools.size() == static_cast<int>(of_scene.size());
  if (!are_same) return;
  for (int tool = 0; tool < tools.size(); ++tool) {
    const bool is_map = tools[tool].getType() == XmlRpc::XmlRpcValue::TypeStruct;
    if (is_map && hasFriction(of_scene[at(tool)])) {
      tools[tool]["friction"] = of_scene[at(tool)].friction;
    }
  }
  private_node.setParam("tools", tools);
}

struct Live {
  const char* name;
  const char* description;
  Range range;
  Found (*get)(const NodeParameters&);  // empty: the scene has none
  void (*set)(double, NodeParameters&);
  const char* path;                               // in the node's namespace; null: see keep
  std::vector<std::string> (*words)() = nullptr;  // what it may be instead of a number
  // Puts it on the parameter server where one path does not.
  void (*keep)(const NodeParameters&, ros::NodeHandle&) = nullptr;
};

Found modulusOf(const NodeParameters& parameters) {
  const Material& material = parameters.scene.tissue.material;
  return material.spring_stiffness ? Found() : Found(material.young_modulus);
}

Found toleranceOf(const NodeParameters& parameters) {
  const SolverConfig& solver = parameters.scene.solver;
  return traitsOf(solver.method).uses_tolerance ? Found(solver.tolerance) : Found();
}

void setTolerance(double tolerance, NodeParameters& parameters) {
  parameters.scene.solver.tolerance = tolerance;
}

Found budgetOf(const NodeParameters& parameters) { return parameters.scene.solver.max_ms; }

void setBudget(double max_ms, NodeParameters& parameters) {
  parameters.scene.solver.max_ms = max_ms;
}

Found coloringOf(const NodeParameters& parameters) { return static_cast<double>(parameters.color); }

void setColoring(double number, NodeParameters& parameters) {
  parameters.color = static_cast<ColorBy>(static_cast<int>(number));
}

template <double NodeParameters::*number>
Found get(const NodeParameters& parameters) {
  return parameters.*number;
}

template <double NodeParameters::*number>
void set(double value, NodeParameters& parameters) {
  parameters.*number = value;
}

const std::vector<Live>& table() {
  static const std::vector<Live> all = {
      {"young_modulus", "Pa; regions with a modulus of their own keep it", ranges::youngModulus(),
       modulusOf, setModulus, nullptr, nullptr, keepModulus},
      {"tolerance", "relative error of displacements that is allowed", ranges::tolerance(),
       toleranceOf, setTolerance, "solver/tolerance"},
      {"max_ms", "ms; time of an update; 0: 100 ms", ranges::budget(), budgetOf, setBudget,
       "solver/max_ms"},
      {"friction", "Coulomb's, of all tools", ranges::friction(), frictionOf, setFriction, nullptr,
       nullptr, keepFriction},
      {"rate", "Hz; updates at most", ranges::rate(), get<&NodeParameters::rate_hz>,
       set<&NodeParameters::rate_hz>, "rate"},
      {"marker_rate", "Hz; markers, surface and nodes at most", ranges::rate(),
       get<&NodeParameters::marker_rate_hz>, set<&NodeParameters::marker_rate_hz>, "marker_rate"},
      {"force_scale", "m/N; length of the force arrows", ranges::forceScale(),
       get<&NodeParameters::force_scale>, set<&NodeParameters::force_scale>, "force_scale"},
      {"color", "what the surface's color tells", {}, coloringOf, setColoring, "color", colorNames},
  };
  return all;
}

std::vector<std::string> wordsOf(const Live& live) {
  return live.words == nullptr ? std::vector<std::string>() : live.words();
}

std::vector<ReconfigureServer::Parameter> presentOf(const NodeParameters& parameters) {
  std::vector<ReconfigureServer::Parameter> present;
  for (const Live& live : table()) {
    const Found value = live.get(parameters);
    if (value) present.push_back({live.name, live.description, live.range, *value, wordsOf(live)});
  }
  return present;
}

}  // namespace

void requireContrasts(double young_modulus, const TissueConfig& tissue) {
  const std::string value = "young_modulus = " + numberText(young_modulus);
  for (std::size_t place = 0; place < tissue.regions.size(); ++place) {
    const Region& region = tissue.regions[place];
    const double contrast = region.material.young_modulus / young_modulus;
    if (!region.own_modulus || std::max(contrast, 1.0 / contrast) <= ranges::kMostContrast)
      continue;
    throw InputError(value + ": must be within a factor of " + numberText(ranges::kMostContrast) +
                     " of " + called("region", region.name, place) + ", " +
                     numberText(region.material.young_modulus) + " Pa");
  }
  for (std::size_t place = 0; place < tissue.membranes.size(); ++place) {
    const MembraneConfig& membrane = tissue.membranes[place];
    const double most =
        ranges::mostMembraneModulus(young_modulus, tissue.spacing, membrane.thickness);
    if (membrane.young_modulus <= most) continue;
    throw InputError(value + ": must be at least " +
                     numberText(young_modulus * membrane.young_modulus / most) + " Pa beside " +
                     called("membrane", membrane.name, place) + " of " +
                     numberText(membrane.young_modulus) + " Pa");
  }
}

std::optional<double> frictionOf(const NodeParameters& parameters) {
  const auto& tools = parameters.scene.tools;
  const auto first = std::find_if(tools.begin(), tools.end(), hasFriction);
  return first == tools.end() ? Found() : Found(first->friction);
}

LiveParameters::LiveParameters(const ros::NodeHandle& private_node,
                               const NodeParameters& parameters, Apply apply)
    : private_node_(private_node),
      parameters_(parameters),
      apply_(std::move(apply)),
      server_(private_node_, presentOf(parameters),
              [this](const ReconfigureServer::Values& values) { change(values); }) {}

void LiveParameters::change(const ReconfigureServer::Values& values) {
  NodeParameters wanted = parameters_;
  for (const Live& live : table()) {
    const auto value = values.find(live.name);
    if (value != values.end()) live.set(value->second, wanted);
  }
  apply_(wanted);
  for (const Live& live : table()) {
    const auto value = values.find(live.name);
    if (value == values.end()) continue;
    const std::vector<std::string> words = wordsOf(live);
    if (live.path == nullptr) {
      live.keep(parameters_, private_node_);
    } else if (words.empty()) {
      private_node_.setParam(live.path, value->second);
    } else {
      private_node_.setParam(live.path, words.at(static_cast<std::size_t>(value->second)));
    }
    ROS_INFO_STREAM(live.name << " is "
                              << (words.empty()
                                      ? numberText(value->second)
                                      : words.at(static_cast<std::size_t>(value->second))));
  }
}

}  // namespace robot_tissue
