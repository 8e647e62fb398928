// What a touch's spring is made of: its plane, the nodes that carry it, the most that it pushes.
#pragma once

#include <cstdint>
#include <vector>

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

// The greatest force that a touch's multiplier takes on (N).
double mostForceOf(const ContactSpring& spring, const Tissue& tissue);

// Of the friction of a touch whose spring has that stiffness, at most (N/m).
double frictionStiffness(double stiffness);

// A point of the plane that the touch is pushed out to: the tool's surface, or for a deep contact a
// plane kMostPush spacings from the point, so that it comes out over several updates.
Vec3 planePointOf(const Contact& contact, const Tissue& tissue);

// The unit vector `to`, or one that is as far as `most` (rad) from `from` on the way to it.
Vec3 turnedBy(const Vec3& from, const Vec3& to, double most);

// The spring's carriers, and its stiffness k: kContactStiffness times that of the tissue at the
// point, 1 / sum of weight^2 / node stiffness over the carriers that give way. `held`: per node,
// not 0 = it does not. Returns how much stiffer the tissue is there in the time step under way
// (Tissue::stiffening).
double carry(const Contact& contact, const Tissue& tissue, const std::vector<std::uint8_t>& held,
             ContactSpring& spring);

}  // namespace robot_tissue
