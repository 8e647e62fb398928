// Which points of the surface are drawn at the edges of a tool's flat face (own; doc/contact.md,
// "Edges are drawn").
//
// An edge runs anywhere between two columns of vertices; a triangle from one to the other would cut
// it off, by up to a third of the spacing. Of two neighbors on both its sides the nearer one is
// drawn on it, what is that of two edges on their corner, and what is next to a part of a round
// edge that two others leave out on that. On a round edge they are as far outside as the straight
// lines between them are inside. Where nodes are, and what is touched, does not change.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "robot_tissue/contact/contact_finder.h"

namespace robot_tissue {

struct DrawnAt {
  Vec3 place = Vec3::Zero();  // on the edge or corner (m)
  // The part of the way there that it is drawn aside by.
  Eigen::Matrix3d aside = Eigen::Matrix3d::Zero();
  Vec3 outward = Vec3::Zero();  // off the edge, as FaceEdge; zero at a corner
};

// The face under a vertex, with the edges near it; none where there is none.
using FaceUnder = std::function<std::optional<FlatFace>(int vertex)>;

// Depth inside the nearest edge, or beyond all (m); less than zero: outside.
double leastDepth(const FlatFace& face);

// Of those that touch the face; `neighbors`: of every vertex, along edges; places and spacing in m.
std::map<int, DrawnAt> drawnAtEdges(const std::set<int>& touching,
                                    const std::vector<std::vector<int>>& neighbors,
                                    const std::vector<Vec3>& places, const FaceUnder& face_under,
                                    double spacing);

}  // namespace robot_tissue
