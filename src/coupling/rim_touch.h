// How much a touch at the rim of a flat face gives way (own; doc/contact.md, "The rim").
#pragma once

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {

// Of the springs between the tool's face and the lattice, by the contact's rim; the touch has its
// carriers, firm stiffness and friction.
TouchCompliance complianceOf(const SlidingContacts::ContactConstraint& touch, const Tissue& tissue);

// In series with a spring of that stiffness (N/m).
double softened(double stiffness, double compliance);

}  // namespace robot_tissue
