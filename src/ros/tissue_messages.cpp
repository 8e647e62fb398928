#include "robot_tissue/ros/tissue_messages.h"

#include <algorithm>
#include <cstdint>

#include "robot_tissue/ros/conversions.h"
#include "robot_tissue/ros/tool_forces.h"

namespace robot_tissue {
namespace {

void addBalance(const ForceBalance& balance, TissueState& message) {
  message.force_of_tools = toVector3(balance.tools);
  message.force_of_supports = toVector3(balance.supports);
  message.force_of_loads = toVector3(balance.loads);
  message.force_of_fixed = toVector3(balance.fixed);
  message.weight = toVector3(balance.weight);
  message.unbalanced_force = balance.unbalanced().norm();
}

void addPieces(const Tissue& tissue, TissueState& message) {
  for (const TissuePiece& piece : tissue.restingPieces()) {
    message.piece_numbers.push_back(piece.number);
    message.piece_volumes.push_back(piece.volume);
    message.pieces_held.push_back(piece.held ? 1 : 0);
  }
  message.pieces_dropped = tissue.droppedPieces();
}

Touch touchMessage(const ToolTouch& touch) {
  Touch message;
  message.point = toPoint(touch.point);
  message.normal = toVector3(touch.normal);
  message.depth = touch.depth_m;
  message.normal_force = touch.normal_force;
  message.friction_force = toVector3(touch.friction_force);
  return message;
}

}  // namespace

TissueState stateMessage(const Pipeline& pipeline, const NodeStatus& status) {
  pipeline.findDepths();
  const StepReport& report = pipeline.report();
  const LatticeState& lattice = pipeline.tissue().state();
  TissueState message;
  message.status = status.status;
  message.message = status.message;
  const SolveReport& solve = pipeline.tissue().lastReport();
  message.residual = solve.residual;
  message.error_estimate = solve.error_estimate;
  message.contact_ms = report.contact_ms;
  message.solve_ms = report.solve_ms;
  message.active_nodes = solve.active_nodes;
  message.layers = solve.layers;
  message.volume_ratio = solve.volume_ratio;
  message.inverted_cells = solve.inverted_cells;
  message.pieces = lattice.pieces;
  message.springs_cut = lattice.springs_cut;
  message.topology = static_cast<std::uint32_t>(pipeline.tissue().surface().revision);
  message.substeps = report.substeps;
  for (std::size_t tool = 0; tool < report.tools.size(); ++tool) {
    const ToolReport& met = report.tools[tool];
    message.max_penetration = std::max(message.max_penetration, met.max_penetration);
    message.saturated = message.saturated || met.saturated;
    if (met.grasps) message.grasping.push_back(pipeline.tools()[tool].name);
  }
  for (const SutureReport& suture : pipeline.tissue().sutures()) {
    message.sutures.push_back(suture.name);
    message.suture_tensions.push_back(suture.tension);
    message.sutures_broken.push_back(suture.broken ? 1 : 0);
  }
  addPieces(pipeline.tissue(), message);
  addBalance(pipeline.forceBalance(), message);
  return message;
}

ContactArray contactArray(const Pipeline& pipeline) {
  pipeline.findDepths();
  ContactArray array;
  for (std::size_t tool = 0; tool < pipeline.tools().size(); ++tool) {
    const ToolReport& report = pipeline.report().tools[tool];
    if (report.contacts == 0) continue;
    TissueContact contact;
    contact.tool = pipeline.tools()[tool].name;
    contact.nodes.assign(report.nodes.begin(), report.nodes.end());
    contact.point = toPoint(report.point);
    contact.normal = toVector3(report.normal);
    contact.depth = report.max_penetration;
    contact.force = toVector3(forceOnTissue(pipeline, tool));
    contact.saturated = report.saturated;
    for (const ToolTouch& touch : pipeline.touchesOf(tool)) {
      contact.touches.push_back(touchMessage(touch));
    }
    array.contacts.push_back(contact);
  }
  return array;
}

geometry_msgs::Wrench wrenchOn(const ToolReport& report) {
  geometry_msgs::Wrench wrench;
  wrench.force = toVector3(report.force_on_tool);
  wrench.torque = toVector3(report.torque_on_tool);
  return wrench;
}

}  // namespace robot_tissue
