#include "touch_spring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tuning.h"

namespace robot_tissue {

double mostForceOf(const ContactSpring& spring, const Tissue& tissue) {
  double stiffness = 0.0;
  for (const NodeWeight& carrier : spring.carriers) {
    stiffness =
        std::max(stiffness, tissue.nodeStiffness(carrier.node) * tissue.stiffening(carrier.node));
  }
  return tuning::kMostForce * stiffness * tissue.lattice().spacing();
}

double frictionStiffness(double stiffness) {
  return tuning::kFrictionStiffness / tuning::kContactStiffness * stiffness;
}

Vec3 planePointOf(const Contact& contact, const Tissue& tissue) {
  // What is at a rim is not to come out.
  const bool is_at_rim = !contact.rim.edges.empty() || !contact.columns.empty();
  const double most = is_at_rim ? std::numeric_limits<double>::infinity()
                                : tuning::kMostPush * tissue.lattice().spacing();
  return contact.point + std::min(contact.depth_m, most) * contact.normal;
}

Vec3 turnedBy(const Vec3& from, const Vec3& to, double most) {
  const double cosine = std::min(1.0, std::max(-1.0, from.dot(to)));
  const Vec3 across = to - cosine * from;
  if (std::acos(cosine) <= most || across.norm() < 1e-9) return to;
  return std::cos(most) * from + std::sin(most) * across.normalized();
}

double carry(const Contact& contact, const Tissue& tissue, const std::vector<std::uint8_t>& held,
             ContactSpring& spring) {
  const auto& surface = tissue.surface();
  SurfacePoint point = contact.place;
  point.barycentric =
      (point.barycentric.array() < tuning::kNoShare).select(0.0, point.barycentric).eval();
  spring.rest = contact.bulge;
  for (int corner = 0; corner < 3; ++corner) {
    const int vertex = surface.triangles[at(point.triangle)][at(corner)];
    spring.rest += point.barycentric[corner] * surface.rest[at(vertex)];
  }
  spring.carriers = carriersAt(surface, point);
  double compliance = 0.0, at_rest = 0.0;  // m/N: in this step, and for slow motions
  for (const auto& [node, weight] : spring.carriers) {
    const double stiffness = tissue.nodeStiffness(node);
    if (!(stiffness > 0.0) || held[at(node)] != 0) continue;
    at_rest += weight * weight / stiffness;
    compliance += weight * weight / (stiffness * tissue.stiffening(node));
  }
  spring.stiffness = compliance > 0.0 ? tuning::kContactStiffness / compliance : 0.0;
  return compliance > 0.0 ? at_rest / compliance : 1.0;
}

}  // namespace robot_tissue
