#include "world.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/contact/tool_sizes.h"
#include "tuning.h"

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

std::vector<SlidingContacts::LinkForm> World::linkForms(
    const std::vector<ToolGeometry>& all) const {
  std::vector<SlidingContacts::LinkForm> forms;
  for (const ToolGeometry& tool : all) {
    const std::size_t first_jaw = tool.role.has_jaws ? tool.links.size() - 2 : tool.links.size();
    for (std::size_t number = 0; number < tool.links.size(); ++number) {
      const std::size_t link = forms.size();
      forms.push_back({finder.thicknesses(link), finder.hasMesh(link), {}});
      // What is between jaws is told by where the tissue is.
      if (number < first_jaw) forms.back().indenters = finder.indenters(link);
    }
  }
  return forms;
}

World::World(const TissueConfig& tissue_config, const SolverConfig& solver)
    : tissue(tissue_config, solver), tools({}, {}), finder({}), drills({}), edges({}) {}

void World::setTools(const std::vector<ToolGeometry>& geometry,
                     const std::vector<SupportConfig>& supports) {
  tools = ToolSet(geometry, supports);
  has_supports = !supports.empty();
  const std::vector<ToolGeometry> all = tools.withSupports();
  finder = ContactFinder(
      shapesOf(withEdges(all), [](const ToolRole& role) { return !role.drills && !role.shears; }));
  finder.followPlaces();
  drills = ContactFinder(shapesOf(all, [](const ToolRole& role) { return role.drills; }));
  edges = ContactFinder(edgesOf(all));
  edge_of.assign(tools.linkCount(), Edge::kTouches);
  findSides();
  warnings = finder.warnings();
  warnings.insert(warnings.end(), drills.warnings().begin(), drills.warnings().end());
  warnOfSizes(geometry);
  sticking = StickingContacts(tissue.lattice(), tools.names());
  std::vector<std::optional<double>> friction;
  for (const ToolGeometry& tool : all) {
    const bool sticks = tool.patch == ToolConfig::Patch::kRigid;
    friction.push_back(sticks ? std::nullopt : std::optional<double>(tool.friction));
  }
  sliding = SlidingContacts(friction, linkForms(all));
  asked = pose = tools.complete({});
  sliding.commit(pose, tissue);
  unfinished = false;
  report = StepReport();
  report.tools.resize(tools.size());
}

void World::warnOfSizes(const std::vector<ToolGeometry>& geometry) {
  const double tissue_extent = tissue.lattice().bounds().sizes().maxCoeff();
  std::size_t number = 0;
  for (const ToolGeometry& tool : geometry) {
    for (const LinkGeometry& link : tool.links) {
      const double extent = finder.bounds(number++, Pose::Identity()).sizes().maxCoeff();
      if (link.shapes.empty()) continue;
      const std::string remark = remarkOnSize(tool.name, link.link, extent, tissue_extent);
      if (!remark.empty()) warnings.push_back(remark);
    }
  }
}

bool World::mayEdgeTouch(std::size_t tool) const {
  const ToolGeometry& of = tools[tool];
  return of.role.has_edge && of.patch != ToolConfig::Patch::kRigid && !tissue.hasTime();
}

void World::setEdge(std::size_t tool, Edge edge) {
  if (!mayEdgeTouch(tool)) return;
  const std::size_t link = tools.firstLink(tool);
  const std::size_t sides = tools[tool].links.front().shapes.size();
  const std::size_t bars = tools[tool].blade.edge.size() - 1;
  edge_of[link] = edge;
  finder.useShapes(link, sides + (edge == Edge::kTouches ? bars : 0));
}

void World::forgetSearches() {
  for (ContactFinder* each : {&finder, &drills, &edges}) each->forget();
}

void World::takeBack(const WorldState& state) {
  static_cast<WorldState&>(*this) = state;
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (mayEdgeTouch(tool)) setEdge(tool, edge_of[tools.firstLink(tool)]);
  }
}

bool World::isInWound(std::size_t link) const {
  return link < edge_of.size() && edge_of[link] == Edge::kInside;
}

bool World::anyInWound() const {
  return std::find(edge_of.begin(), edge_of.end(), Edge::kInside) != edge_of.end();
}

// By the shapes of the first links alone, without the bars along their edges.
void World::findSides() {
  sides_.assign(tools.linkCount(), {});
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!mayEdgeTouch(tool)) continue;
    const std::size_t link = tools.firstLink(tool);
    setEdge(tool, Edge::kFar);
    sides_[link] = sidesOf(edgeOn(link), finder.surfacePoints(link));
    setEdge(tool, Edge::kTouches);
  }
}

// Round bars along its edge, as sharp as the lattice can tell.
std::vector<ToolShape> World::barsAlong(const std::vector<Vec3>& edge) const {
  const double radius = tuning::kEdgeRadius * tissue.lattice().spacing();
  std::vector<ToolShape> bars;
  for (std::size_t i = 0; i + 1 < edge.size(); ++i) {
    const Vec3 along = edge[i + 1] - edge[i];
    ToolShape bar;
    bar.type = ToolShape::Type::kCylinder;
    bar.radius = bar.padding = 0.5 * radius;  // round ends, too
    bar.length = along.norm();
    bar.pose.linear() = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), along).toRotationMatrix();
    bar.pose.translation() = edge[i] + 0.5 * along;
    bars.push_back(bar);
  }
  return bars;
}

// Bars after the shapes of the first link. Where edges may not touch, sides do not, either.
std::vector<ToolGeometry> World::withEdges(std::vector<ToolGeometry> all) const {
  for (std::size_t tool = 0; tool < tools.size(); ++tool) {
    if (!all[tool].role.has_edge) continue;
    if (!mayEdgeTouch(tool)) {
      for (LinkGeometry& link : all[tool].links) link.shapes.clear();
      continue;
    }
    std::vector<ToolShape>& shapes = all[tool].links.front().shapes;
    const std::vector<ToolShape> bars = barsAlong(all[tool].blade.edge);
    shapes.insert(shapes.end(), bars.begin(), bars.end());
  }
  return all;
}

std::vector<ToolGeometry> World::edgesOf(std::vector<ToolGeometry> all) const {
  for (ToolGeometry& tool : all) {
    for (LinkGeometry& link : tool.links) link.shapes.clear();
    if (tool.role.has_edge) tool.links.front().shapes = barsAlong(tool.blade.edge);
  }
  return all;
}

bool World::isOutOfTime() const {
  if (tissue.patience().bound().isSpent()) return true;
  return std::isfinite(deadline.leftMs()) && (deadline.isOver() || tissue.isLate());
}

double World::reach(std::size_t link) const {
  double reach = std::max(finder.reach(link), drills.reach(link));
  for (const Vec3& point : edgeOn(link)) reach = std::max(reach, point.norm());
  return reach;
}

std::vector<Vec3> World::corners(std::size_t link) const {
  std::vector<Vec3> corners = finder.corners(link);
  const std::vector<Vec3> of_drill = drills.corners(link);
  const std::vector<Vec3>& of_edge = edgeOn(link);
  corners.insert(corners.end(), of_drill.begin(), of_drill.end());
  corners.insert(corners.end(), of_edge.begin(), of_edge.end());
  return corners;
}

double World::thicknessNear(std::size_t link, const Pose& tissue_T_link, double way) const {
  const Box near = grownBy(tissue.lattice().spacing() + way, tissue.bounds());
  return finder.thicknessIn(near, link, tissue_T_link);
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
    if (tools.firstLink(tool) == link && tools[tool].role.has_edge) return tools[tool].blade.edge;
    if (!tools[tool].role.shears || link < tools.firstJaw(tool) || link >= tools.endLink(tool)) {
      continue;
    }
    return tools[tool].scissors.edges[link - tools.firstJaw(tool)];
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
    patches.push_back(world.sticking.loadingPatch(index, world.tissue));
    patches.back().contacts = springs;
  }
  return patches;
}

Bedding beddingOf(const World& world) {
  return world.has_supports ? Bedding::kSupports : Bedding::kFixedNodes;
}

bool anyToolIn(const std::vector<LoadingPatch>& patches, const World& world) {
  return std::any_of(patches.begin(), patches.end(), [&](const LoadingPatch& patch) {
    return patch.tool && at(*patch.tool) < world.tools.size();
  });
}

bool isFree(const World& world) {
  const std::vector<LoadingPatch>& patches = world.tissue.patches();
  return world.tissue.isMoving() &&
         std::none_of(patches.begin(), patches.end(),
                      [](const LoadingPatch& patch) { return patch.tool.has_value(); });
}

}  // namespace robot_tissue
