#include "world.h"

#include <algorithm>

namespace robot_tissue {
namespace {

// The tools, with shapes only where their role has them.
template <class HasShapes>
std::vector<ToolGeometry> shapesOf(std::vector<ToolGeometry> tools, const HasShapes& has_shapes) {
  for (ToolGeometry& tool : tools) {
    if (has_shapes(tool.role)) continue;
    for (LinkGeometry& link : tool.links) link.shapes.clear();
  }
  return tools;
}

}  // namespace

World::World(const TissueConfig& tissue_config, const SolverConfig& solver)
    : tissue(tissue_config, solver),
      tools({}, {}),
      finder({}),
      drills({}),
      sticking(tissue.lattice(), {}),
      sliding({}, {}) {}

void World::setTools(const std::vector<ToolGeometry>& geometry,
                     const std::vector<SupportConfig>& supports) {
  tools = ToolSet(geometry, supports);
  has_supports = !supports.empty();
  const std::vector<ToolGeometry> all = tools.withSupports();
  finder = ContactFinder(shapesOf(all, [](const ToolRole& role) { return role.touches(); }));
  drills = ContactFinder(shapesOf(all, [](const ToolRole& role) { return role.drills; }));
  warnings = finder.warnings();
  warnings.insert(warnings.end(), drills.warnings().begin(), drills.warnings().end());
  sticking = StickingContacts(tissue.lattice(), tools.names());
  std::vector<std::optional<double>> friction;
  for (const ToolGeometry& tool : all) {
    const bool sticks = tool.patch == ToolConfig::Patch::kRigid;
    friction.push_back(sticks ? std::nullopt : std::optional<double>(tool.friction));
  }
  std::vector<double> thickness;
  for (std::size_t link = 0; link < finder.linkCount(); ++link) {
    thickness.push_back(finder.thickness(link));
  }
  sliding = SlidingContacts(friction, thickness);
  pose = tools.complete({});
  sliding.commit(pose, tissue);
  unfinished = false;
  report = StepReport();
  report.tools.resize(tools.size());
}

double World::reach(std::size_t link) const {
  double reach = std::max(finder.reach(link), drills.reach(link));
  for (const Vec3& point : edgeOn(link)) reach = std::max(reach, point.norm());
  return reach;
}

Box World::bounds(std::size_t link, const Pose& tissue_T_link) const {
  Box bounds = finder.bounds(link, tissue_T_link);
  bounds.extend(drills.bounds(link, tissue_T_link));
  for (const Vec3& point : edgeOn(link)) bounds.extend(tissue_T_link * point);
  return bounds;
}

const std::vector<Vec3>& World::edgeOn(std::size_t link) const {
  static const std::vector<Vec3> none;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (tools.firstLink(tool) == link) return tools[tool].blade.edge;
  }
  return none;
}

PatchAnswer answerOf(const World& world, std::size_t tool) {
  const auto& patches = world.tissue.patches();
  const auto& answers = world.tissue.lastReport().patches;
  for (std::size_t i = 0; i < std::min(patches.size(), answers.size()); ++i) {
    if (patches[i].tool == static_cast<int>(tool)) return answers[i];
  }
  return {};
}

ForceBalance forceBalanceOf(const World& world) {
  ForceBalance balance;
  for (std::size_t tool = 0; tool < world.tools.sizeWithSupports(); ++tool) {
    (tool < world.tools.size() ? balance.tools : balance.supports) += answerOf(world, tool).force;
  }
  const auto& answers = world.tissue.lastReport().patches;
  for (std::size_t i = 0; i < std::min(world.tissue.namedPatches(), answers.size()); ++i) {
    balance.loads += answers[i].force;
  }
  balance.weight = world.tissue.weight();
  balance.fixed = world.tissue.forceOfFixedNodes();
  return balance;
}

std::vector<LoadingPatch> patchesOfTools(const World& world) {
  std::vector<LoadingPatch> patches;
  for (std::size_t tool = 0; tool < world.tools.sizeWithSupports(); ++tool) {
    const int index = static_cast<int>(tool);
    const bool may_push = tool >= world.tools.size() || world.sliding.pushes(index, world.tissue);
    const ContactSprings springs = may_push ? world.sliding.springsOf(index) : ContactSprings();
    if (springs.empty() && !world.sticking.holds(index)) continue;
    patches.push_back(world.sticking.loadingPatch(index));
    patches.back().contacts = springs;
  }
  return patches;
}

bool anyToolIn(const std::vector<LoadingPatch>& patches, const World& world) {
  return std::any_of(patches.begin(), patches.end(), [&](const LoadingPatch& patch) {
    return patch.tool && at(*patch.tool) < world.tools.size();
  });
}

}  // namespace robot_tissue
