// Pipeline: the touches of a tool, each by itself. Found when they are asked for: an update needs
// none of it.
#include <limits>

#include "pipeline_parts.h"
#include "tool_reports.h"

namespace robot_tissue {
namespace {

// Of the tool that holds it on the tissue (N): what balances the tissue and what others push there.
Vec3 forceOnHeldNode(const Tissue& tissue, int node) {
  Vec3 force = -tissue.nodeForce(node);
  for (const LoadingPatch& patch : tissue.patches()) {
    for (const ContactSpring& spring : patch.contacts) {
      for (const NodeWeight& carrier : spring.carriers) {
        if (carrier.node != node) continue;
        force -= carrier.weight * forceOf(spring, tissue.state().displacement);
      }
    }
  }
  return force;
}

ToolTouch heldTouch(const World& world, int node, const StickingContacts::Attachment& seat) {
  ToolTouch touch;
  touch.point = world.tissue.nodePosition(node);
  touch.normal = wayOutOfTool(world, node, seat).normalized();
  const auto out = world.finder.wayOut(at(seat.link), world.pose.links[at(seat.link)], touch.point,
                                       std::numeric_limits<double>::infinity());
  if (out) touch.depth_m = out->depth_m;
  const Vec3 force = forceOnHeldNode(world.tissue, node);
  touch.normal_force = force.dot(touch.normal);
  touch.friction_force = force - touch.normal_force * touch.normal;
  return touch;
}

ToolTouch slidingTouch(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  ToolTouch touch;
  touch.point = pointOf(spring, displacement);
  touch.normal = spring.normal;
  touch.depth_m = -gapOf(spring, displacement);
  touch.normal_force = normalForceOf(spring, displacement);
  touch.friction_force = forceOf(spring, displacement) - touch.normal_force * touch.normal;
  return touch;
}

}  // namespace

std::vector<ToolTouch> Pipeline::touchesOf(std::size_t tool) const {
  std::vector<ToolTouch> touches;
  for (const auto& [node, seat] : world_.sticking.attachments().at(tool)) {
    touches.push_back(heldTouch(world_, node, seat));
  }
  const std::vector<LoadingPatch>& patches = world_.tissue.patches();
  for (std::size_t i = world_.tissue.namedPatches(); i < patches.size(); ++i) {
    if (patches[i].tool != static_cast<int>(tool)) continue;
    for (const ContactSpring& spring : patches[i].contacts) {
      const ToolTouch touch = slidingTouch(spring, world_.tissue.state().displacement);
      const bool acts = touch.normal_force > 0.0 || !touch.friction_force.isZero(0.0);
      if (acts) touches.push_back(touch);
    }
  }
  return touches;
}

}  // namespace robot_tissue
