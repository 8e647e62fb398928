// How much a touch at the rim of a flat face gives way (own; doc/contact.md, "The rim").
#pragma once

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {

// Gives the touch the compliance of its rim: in series with its spring, which has the firm
// stiffness and friction.
void soften(const Tissue& tissue, SlidingContacts::ContactConstraint& touch);

// The edge that the surface is drawn at goes with the tool, and the ways along its face turn.
void rideEdge(const Pose& moved, SlidingContacts::ContactConstraint& touch);

// How deep the plane is in the tool (m): what the multiplier presses the rim together, or those of
// all touches the columns.
double rimRecess(const SlidingContacts::ContactConstraint& touch);

// The spring's plane: below the tool's by that, too.
void putPlane(SlidingContacts::ContactConstraint& touch);

// How deep the point is inside the edges goes half of the way from what it was a round before. The
// push hangs on it, and it on the push: going all of the way, both would go to and fro.
void goHalfWay(const Rim& before, Rim& rim);

// In series with a spring of that stiffness (N/m).
double softened(double stiffness, double compliance);

}  // namespace robot_tissue
