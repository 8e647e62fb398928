#include "rim_touch.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/coupling/fade.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// What takes `share` of the stiffness from a spring.
double complianceLeaving(double share, double stiffness) {
  return stiffness > 0.0 ? share / ((1.0 - share) * stiffness) : 0.0;
}

// Along the friction: of a motion across the edge and along it in equal parts where there is none.
double frictionCompliance(const RimCompliance& of_edge, const Vec3& outward, const Vec3& friction) {
  const double length = friction.norm();
  const double across = length > 0.0 ? outward.dot(friction) / length : std::sqrt(0.5);
  return across * across * of_edge.across + (1.0 - across * across) * of_edge.along;
}

// Those that are infinite are finite.
RimCompliance limited(const RimCompliance& of_edge, double most) {
  return {std::min(of_edge.across, most), std::min(of_edge.along, most),
          std::min(of_edge.normal, most)};
}

// Of the springs between the tool's face and the lattice.
TouchCompliance complianceOf(const SlidingContacts::ContactConstraint& touch,
                             const Tissue& tissue) {
  if (!touch.contact.columns.empty()) return touch.of_columns;
  const Rim& rim = touch.contact.rim;
  TouchCompliance sum;
  if (rim.share <= 0.0 || touch.firm_stiffness <= 0.0) return sum;
  if (rim.edges.empty()) {
    const double friction = tuning::kFrictionStiffness / tuning::kContactStiffness;
    sum.normal = complianceLeaving(rim.share, touch.firm_stiffness);
    sum.friction = complianceLeaving(rim.share, friction * touch.firm_stiffness);
    return sum;
  }
  const double most = 1.0 / (tuning::kSoftestRim * touch.firm_stiffness);
  for (const FaceEdge& edge : rim.edges) {
    const double depth = edge.depth_m / tissue.lattice().spacing();
    const auto found = tissue.rimCompliance(touch.spring.carriers.front().node, depth);
    if (!found) return {};
    const RimCompliance of_edge = limited(*found, most);
    sum.normal += of_edge.normal;
    sum.friction += frictionCompliance(of_edge, edge.outward, touch.spring.friction_force);
  }
  const double part = rim.is_beyond ? 1.0 / rim.share : rim.share;
  sum.normal *= part;
  sum.friction *= part;
  sum.shown = sum.normal * fade(rim.share, 0.0, tuning::kShownShare) * rim.shown;
  return sum;
}

// Where the tool has it; what is beside the face is drawn in its plane at the edge alone.
void showOnTool(SlidingContacts::ContactConstraint& touch) {
  const Rim& rim = touch.contact.rim;
  const bool is_off_edge = rim.is_beyond && rim.drawn_aside.isZero(0.0);
  touch.spring.recess = touch.recess;
  touch.spring.shown_compliance = touch.compliance.shown;
  touch.spring.drawn_compliance = is_off_edge ? 0.0 : touch.compliance.shown;
  touch.spring.drawn_aside = rim.drawn_aside;
  touch.spring.drawn_at = rim.drawn_at;
}

}  // namespace

void soften(const Tissue& tissue, SlidingContacts::ContactConstraint& touch) {
  touch.compliance = complianceOf(touch, tissue);
  touch.spring.stiffness = softened(touch.firm_stiffness, touch.compliance.normal);
  putPlane(touch);
}

void rideEdge(const Pose& moved, SlidingContacts::ContactConstraint& touch) {
  Rim& rim = touch.contact.rim;
  rim.drawn_at = moved * rim.drawn_at;
  rim.drawn_aside = moved.linear() * rim.drawn_aside * moved.linear().transpose();
  for (RimColumn& column : touch.contact.columns) {
    column.friction = moved.linear() * column.friction * moved.linear().transpose();
  }
  showOnTool(touch);
}

double rimRecess(const SlidingContacts::ContactConstraint& touch) {
  return touch.contact.columns.empty() ? touch.compliance.normal * touch.spring.multiplier
                                       : touch.column_recess;
}

void putPlane(SlidingContacts::ContactConstraint& touch) {
  ContactSpring& spring = touch.spring;
  const double inside = touch.entry + touch.recess + rimRecess(touch);
  spring.plane_point = touch.tool_point - inside * spring.normal;
  spring.turning = spring.multiplier * touch.contact.turn;
  showOnTool(touch);
}

void goHalfWay(const Rim& before, Rim& rim) {
  if (before.edges.size() != rim.edges.size()) return;
  for (std::size_t i = 0; i < rim.edges.size(); ++i) {
    const FaceEdge& was = before.edges[i];
    FaceEdge& edge = rim.edges[i];
    if (was.outward.dot(edge.outward) < tuning::kSameEdge) continue;
    edge.depth_m = 0.5 * (was.depth_m + edge.depth_m);
  }
}

double softened(double stiffness, double compliance) {
  return stiffness / (1.0 + stiffness * compliance);
}

}  // namespace robot_tissue
