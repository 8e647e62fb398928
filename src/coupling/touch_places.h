// Touches go on when another surface follows, as after a cut (own): a vertex where there is one and
// no more at its place at rest, on a cut there are two; else a point where its triangle has the
// same corners at rest, in their order, which tells the sides of a cut apart.
#pragma once

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/surface.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {

// Gives the touch its contact, with what tells its place on another surface.
void putContact(const Contact& contact, const TissueSurface& surface,
                SlidingContacts::ContactConstraint& touch);

// Its spring is as the last solve had it.
void noteSolved(SlidingContacts::ContactConstraint& touch);

}  // namespace robot_tissue
