// Data between stages, 2 of 4: where the tools touch the deformed surface.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "robot_tissue/core/types.h"

namespace robot_tissue {

// A sharp edge of a flat face, as seen from a point on the face or beside it.
struct FaceEdge {
  Vec3 outward = Vec3::Zero();  // unit, in the face, off it across the edge
  double depth_m = 0.0;         // of the point inside the edge; < 0: beyond it
};

// What the lattice adds at the edges of a flat face is taken back by springs (SlidingContacts).
struct Rim {
  double share = 0.0;           // of the push that goes by these springs; 0: there is no rim
  bool is_beyond = false;       // the point is beside the face
  double shown = 0.0;           // of its way to the face's plane on which it is shown
  std::vector<FaceEdge> edges;  // near the point; none: others bear what it would
  // The surface is drawn with the face's edges in it: the point is drawn at the edge or corner that
  // is there (m), aside by this part of the way to it; zero: at none.
  Vec3 drawn_at = Vec3::Zero();
  Eigen::Matrix3d drawn_aside = Eigen::Matrix3d::Zero();
};

// A column of nodes, one behind the other: the lattice's axis that it runs along, and the grid's
// indices along the next two axes.
using NodeColumn = std::array<int, 3>;

// Where nodes are not on the surface, columns of them stand at a face's edges as vertices do. How
// much one gives way (m/N), and its part in what a point between columns does.
struct RimColumn {
  NodeColumn line{};
  double weight = 0.0;  // bilinear, of the point at rest; all of a point's: 1 in sum
  double share = 0.0;   // as Rim::share
  double normal = 0.0;
  Eigen::Matrix3d friction = Eigen::Matrix3d::Zero();  // in the face, by the way along it
};

// A point of the surface that is inside a tool, or near it: the one form of what was found. What
// is kept of it from solve to solve has it as a part (SlidingContacts::ContactConstraint).
struct Contact {
  int tool = 0;    // index into the scene's tools
  int link = 0;    // index into RobotPose::links
  int shape = -1;  // number in its link; -1: not known
  SurfacePoint place;
  Vec3 point = Vec3::Zero();   // where that is now; tissue frame, m
  Vec3 normal = Vec3::Zero();  // unit, from the tool into the tissue: the way out of the tool
  double depth_m = 0.0;        // penetration depth along the normal; < 0: a gap
  Rim rim;
  std::vector<RimColumn> columns;  // those that give way; none where rim has edges or a share
  Vec3 bulge = Vec3::Zero();       // how far the point is off its triangle (m, CurvedSurface)
  bool wanders = false;  // at a sharp edge or corner of the link, which tissue slides past
  // How fast the hollow that wanders past turns its normal back with the way (1/m): symmetric, of
  // no negative direction.
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();
};

struct ContactSet {
  std::vector<Contact> contacts;
};

// Of the deepest of them (m); 0 when none is inside a tool.
inline double deepest(const ContactSet& contacts) {
  double depth = 0.0;
  for (const Contact& contact : contacts.contacts) depth = std::max(depth, contact.depth_m);
  return depth;
}

}  // namespace robot_tissue
