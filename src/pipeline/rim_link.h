// A link whose flat face is pressed into the tissue, as the law of rims has it (own).
#pragma once

#include <set>

#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

struct RimLink {
  int tool = 0, number = 0;
  Pose tissue_T_link;
  Vec3 facing = Vec3::Zero();   // where it presses to
  Vec3 inwards = Vec3::Zero();  // of the surface around it, as if there were no dent
  std::set<int> firm;           // vertices that stand on the face
  Eigen::Matrix3d turn;         // of these, from rest
};

// Of the face at the point (m); infinite where it ends on one side only, as far as is seen.
double faceWidth(const FlatFace& face);

// How much of the law holds there (1): it is of sharp edges, of a wide face that lies flat on the
// tissue. Spacing in m.
double rimShare(const FlatFace& face, const RimLink& link, double spacing);

}  // namespace robot_tissue
