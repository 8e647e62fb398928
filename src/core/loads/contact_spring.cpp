#include "robot_tissue/core/contact_spring.h"

#include <algorithm>
#include <cmath>

#include "robot_tissue/core/carriers.h"

namespace robot_tissue {
namespace {

double pressAt(const ContactSpring& spring, const Vec3& point) {
  const double gap = spring.normal.dot(point - spring.plane_point);
  return std::max(0.0, spring.multiplier - spring.stiffness * gap);
}

// t_0 - k_t (1 - n n^T) (x - anchor): friction before it is cut to its bound (N).
Vec3 trialFriction(const ContactSpring& spring, const Vec3& point) {
  const Vec3 slip = point - spring.anchor;
  return spring.friction_force -
         spring.friction_stiffness * (slip - spring.normal.dot(slip) * spring.normal);
}

Vec3 turningForceAt(const ContactSpring& spring, const Vec3& point) {
  return -spring.turning * (point - spring.turned_from);
}

double tensionAt(const ContactSpring& thread, const Vec3& way) {
  return std::max(0.0, thread.stiffness * (way.norm() - thread.rest_length));
}

// Ends at one place: no direction is the thread's, and no force is left.
Vec3 pullAt(const ContactSpring& thread, const Vec3& way) {
  const double length = way.norm();
  return length > 0.0 ? Vec3(-tensionAt(thread, way) / length * way) : Vec3(Vec3::Zero());
}

// Of T / |x| the limit where the ends come to one place is k, as of a thread of no length, the only
// one that is taut there.
Eigen::Matrix3d threadStiffnessAt(const ContactSpring& thread, const Vec3& way) {
  const double length = way.norm(), tension = tensionAt(thread, way);
  if (length > 0.0 && tension <= 0.0) return Eigen::Matrix3d::Zero();
  if (length <= 0.0) {
    const double stiffness = thread.rest_length > 0.0 ? 0.0 : thread.stiffness;
    return stiffness * Eigen::Matrix3d::Identity();
  }
  const Vec3 along = way / length;
  const double across = tension / length;
  return across * Eigen::Matrix3d::Identity() +
         (thread.stiffness - across) * along * along.transpose();
}

// J. Without stiffness, as where rims bear all of a touch, the force is the same everywhere.
double pressEnergyAt(const ContactSpring& spring, const Vec3& point) {
  const double force = pressAt(spring, point);
  return spring.stiffness > 0.0 ? 0.5 * force * force / spring.stiffness
                                : -force * spring.normal.dot(point - spring.plane_point);
}

// J, likewise.
double frictionEnergyAt(const ContactSpring& spring, const Vec3& point) {
  if (spring.friction_bound <= 0.0) return 0.0;
  const Vec3 trial = trialFriction(spring, point);
  const double length = trial.norm();
  const double most = spring.friction_bound;
  if (spring.friction_stiffness <= 0.0) {
    const double share = length > most ? most / length : 1.0;
    return -share * trial.dot(point - spring.anchor);
  }
  const double squared = length <= most ? 0.5 * length * length : most * (length - 0.5 * most);
  return squared / spring.friction_stiffness;
}

// From the point to the tool's surface (m).
Vec3 offTool(const ContactSpring& spring, double compliance, double force) {
  const double recess = force > 0.0 ? spring.recess : 0.0;
  return (compliance * force + recess) * spring.normal;
}

}  // namespace

Vec3 pointOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return carriedFrom(spring.rest, spring.carriers, displacement);
}

double gapOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return spring.normal.dot(pointOf(spring, displacement) - spring.plane_point);
}

double normalForceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return pressAt(spring, pointOf(spring, displacement));
}

Vec3 shownOff(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  const double force = normalForceOf(spring, displacement);
  return offTool(spring, spring.shown_compliance, force);
}

Vec3 drawnOff(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  const Vec3 point = pointOf(spring, displacement);
  return offTool(spring, spring.drawn_compliance, pressAt(spring, point)) +
         spring.drawn_aside * (spring.drawn_at - point);
}

Vec3 turningForceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return turningForceAt(spring, pointOf(spring, displacement));
}

double tensionOf(const ContactSpring& thread, const std::vector<Vec3>& displacement) {
  return tensionAt(thread, pointOf(thread, displacement));
}

double endsOf(const ContactSpring& spring) {
  bool all_above_zero = true;
  double sum = 0.0;
  for (const NodeWeight& carrier : spring.carriers) {
    all_above_zero = all_above_zero && carrier.weight > 0.0;
    sum += std::abs(carrier.weight);
  }
  return all_above_zero ? 1.0 : sum;  // without the sum's rounding
}

Vec3 forceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return forceAt(spring, pointOf(spring, displacement));
}

Vec3 forceAt(const ContactSpring& spring, const Vec3& point) {
  if (spring.is_thread) return pullAt(spring, point);
  const Vec3 force = pressAt(spring, point) * spring.normal + turningForceAt(spring, point);
  if (spring.friction_bound <= 0.0) return force;
  const Vec3 trial = trialFriction(spring, point);
  const double length = trial.norm();
  return force +
         (length > spring.friction_bound ? Vec3(spring.friction_bound / length * trial) : trial);
}

double energyOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  if (spring.is_thread) {
    const double tension = tensionOf(spring, displacement);
    return 0.5 * tension * tension / spring.stiffness;
  }
  const Vec3 point = pointOf(spring, displacement), slid = point - spring.turned_from;
  const double energy = pressEnergyAt(spring, point) + 0.5 * slid.dot(spring.turning * slid);
  return energy + frictionEnergyAt(spring, point);
}

Eigen::Matrix3d stiffnessOf(const ContactSpring& spring, const std::vector<Vec3>& displacement) {
  return stiffnessAt(spring, pointOf(spring, displacement));
}

Eigen::Matrix3d stiffnessAt(const ContactSpring& spring, const Vec3& point) {
  if (spring.is_thread) return threadStiffnessAt(spring, point);
  const Eigen::Matrix3d along = spring.normal * spring.normal.transpose();
  Eigen::Matrix3d stiffness = spring.turning;
  if (pressAt(spring, point) > 0.0) stiffness += spring.stiffness * along;
  if (spring.friction_bound <= 0.0) return stiffness;
  const Vec3 trial = trialFriction(spring, point);
  const double length = trial.norm();
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - along;
  if (length <= spring.friction_bound) return stiffness + spring.friction_stiffness * across;
  const double share = spring.friction_bound / length;
  return stiffness + spring.friction_stiffness * share *
                         (across - trial * trial.transpose() / (length * length));
}

}  // namespace robot_tissue
