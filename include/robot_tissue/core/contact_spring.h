// A point of the surface that a tool may push: a spring that never pulls, with friction (own; the
// augmented Lagrangian of Simo and Laursen 1992, with Tresca's bound on friction).
//
//   point of the surface    x = sum of weight * (rest + displacement) over its carriers
//   gap                     g = n . (x - plane_point)
//   normal force            f = max(0, multiplier - k g)
//   friction                t = t_0 - k_t (1 - n n^T) (x - anchor), cut to friction_bound
//   turning                 -M (x - turned_from): as a curved surface slides under the tool's edge,
//                           its normal turns, and with it the force
//   force on the tissue     f n + t - M (x - turned_from), at x
//
// Between solves the multiplier takes f and friction_bound the friction's share of f: then the gap
// goes to zero whatever k is, and friction obeys Coulomb's law. In a solve both are constant, so
// that the spring has an energy, convex in x.
//
// Or a thread that joins two points. Its "point" is then the way between them, x = to - from, its
// carriers' weights are 1 in all for `to` and -1 for `from`, and it only pulls:
//
//   tension                 T = max(0, k (|x| - L))
//   force on x              -T x / |x|        at `to`; the opposite one at `from`
//   stiffness               k n n^T + T / |x| (1 - n n^T),   n = x / |x|
#pragma once

#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

struct ContactSpring {
  std::vector<NodeWeight> carriers;    // weights, also below zero, sum to 1, of a thread to 0
  Vec3 rest = Vec3::Zero();            // of the point (m)
  Vec3 normal = Vec3::Zero();          // unit, from the tool into the tissue
  Vec3 plane_point = Vec3::Zero();     // a point of the tool's surface (m)
  double stiffness = 0.0;              // k (N/m)
  double multiplier = 0.0;             // N
  Vec3 anchor = Vec3::Zero();          // where the point would be, did it stick (m)
  Vec3 friction_force = Vec3::Zero();  // t_0: across the normal, when it was at the anchor (N)
  double friction_stiffness = 0.0;     // k_t (N/m)
  double friction_bound = 0.0;         // N; 0: slides freely
  // Symmetric, of no negative direction: M (N/m), and where the normal is as it is taken (m).
  Eigen::Matrix3d turning = Eigen::Matrix3d::Zero();
  Vec3 turned_from = Vec3::Zero();
  // Of the plane in the load step under way (m): known to methods that go through a time step in
  // steps of their own; the law above is of its end.
  Vec3 plane_way = Vec3::Zero();
  // At a tool's rim the surface is shown where the tool has it: off the spring's point by so much
  // times the normal force, along the normal (m/N).
  double shown_compliance = 0.0;
  // Likewise the surface that is drawn, and aside by a part of the way to an edge of the tool (m).
  double drawn_compliance = 0.0;
  Eigen::Matrix3d drawn_aside = Eigen::Matrix3d::Zero();
  Vec3 drawn_at = Vec3::Zero();
  // Both likewise by so much, as long as it pushes (m): the plane is so deep in the tool.
  double recess = 0.0;
  // Likewise its carriers, each by a way of its own along the normal (m); none: by none.
  std::vector<double> carrier_ways;
  bool is_thread = false;    // has carriers, rest, stiffness and, besides:
  double rest_length = 0.0;  // L (m)
};

// The springs of a patch as a solve has them. Copies share them: patches, the shapes that are kept
// to come back to, and the levels of a multigrid hierarchy have the same ones, by their numbers.
class ContactSprings {
 public:
  ContactSprings() = default;
  ContactSprings(std::vector<ContactSpring> springs)
      : springs_(std::make_shared<const std::vector<ContactSpring>>(std::move(springs))) {}
  ContactSprings(std::initializer_list<ContactSpring> springs)
      : ContactSprings(std::vector<ContactSpring>(springs)) {}

  std::size_t size() const { return springs_ ? springs_->size() : 0; }
  bool empty() const { return size() == 0; }
  const ContactSpring& operator[](std::size_t number) const { return (*springs_)[number]; }
  const ContactSpring* begin() const { return springs_ ? springs_->data() : nullptr; }
  const ContactSpring* end() const { return begin() + size(); }

 private:
  std::shared_ptr<const std::vector<ContactSpring>> springs_;  // null: none
};

// Deformed place of the point (m).
Vec3 pointOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);

double gapOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);  // m

double normalForceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);  // N

// Off the point (m): where its displacement is shown, and where the surface is drawn.
Vec3 shownOff(const ContactSpring& spring, const std::vector<Vec3>& displacement);
Vec3 drawnOff(const ContactSpring& spring, const std::vector<Vec3>& displacement);

Vec3 turningForceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);  // N

double tensionOf(const ContactSpring& thread, const std::vector<Vec3>& displacement);  // T (N)

// Of a spring that counts with the sizes of its weights, |w|: their sum; 1 where none is below
// zero.
double endsOf(const ContactSpring& spring);

// On the tissue (N): of the shape, or of the point where it would be.
Vec3 forceAt(const ContactSpring& spring, const Vec3& point);
Vec3 forceOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);

double energyOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);  // J

// Second derivative of the energy in x (N/m); not negative in any direction.
Eigen::Matrix3d stiffnessAt(const ContactSpring& spring, const Vec3& point);
Eigen::Matrix3d stiffnessOf(const ContactSpring& spring, const std::vector<Vec3>& displacement);

}  // namespace robot_tissue
