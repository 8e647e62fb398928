// Where flat faces of tools end on the tissue: which points of the surface are at their rims (own;
// doc/contact.md, "The rim").
//
// The tool's edge runs between two columns of vertices. The last that stands firm on the face tells
// where the others would be, did they stick to it: a spacing of the surface at rest farther.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "drawn_edges.h"
#include "rim_columns.h"
#include "rim_link.h"
#include "world.h"

namespace robot_tissue {

// What a look at the rims leaves to the next; of links and vertices.
struct RimState {
  struct AtRim {
    int tool = 0, shape = 0;
    Vec3 normal = Vec3::Zero();  // of the face
    double height = 0.0;         // over it (m)
    Rim rim;
  };
  std::map<std::pair<int, int>, AtRim> at_rims;
  std::map<std::pair<int, int>, DrawnAt> drawn;
  std::map<std::pair<int, int>, double> shares;       // of the load step
  std::map<std::pair<int, int>, double> last_shares;  // of the touches when it began
  std::set<std::pair<int, int>> firm;                 // stood firmly in the load step
  RimColumnState columns;
};

class ToolRims {
 public:
  // The state is kept by the caller.
  ToolRims(const World& world, RimState& state)
      : world_(world), state_(state), columns_(world, state.columns) {}

  // A load step begins: how much rims bear is of the shape that there is.
  void beginStep();
  // In this shape, where the links have these contacts, with their planes.
  void look(const RobotPose& pose, const std::vector<Vec3>& vertices, const ContactSet& contacts);

  // How much a link stands on a flat face (1), as the surface around it looks.
  double flatness(int number, const Pose& tissue_T_link, const ContactSet& contacts,
                  const std::vector<Vec3>& vertices) const;

  // Writes the rim into a contact, and of a vertex at it the face's plane.
  void mark(Contact& contact) const;
  // The vertices beside faces that their rims push.
  ContactSet beyond(const std::vector<Vec3>& vertices) const;
  // The known touch of a vertex at a rim, or beside it, as it is now; none where it is at none.
  std::optional<Contact> atRim(const Contact& known, const std::vector<Vec3>& vertices) const;
  // Of what a contact would push that rims bear (1).
  double shareOf(const Contact& contact) const;
  // Part of a contact's depth (1) that is none, as rims give way.
  double partOfDepth(const Contact& contact) const;
  // Rims bear all that it would.
  static bool isTakenOver(const Contact& contact);
  // The columns of nodes that a contact is between, as far as they give way.
  std::vector<RimColumn> columnsAt(const Contact& contact) const;
  // Whether tissue sticks to the tool, so that it has no rims.
  bool isSticking(int tool) const;

 private:
  using AtRim = RimState::AtRim;
  using Link = RimLink;

  void takeSurface();
  Vec3 inwardsAround(const Link& link, const std::vector<Vec3>& vertices) const;
  std::optional<FlatFace> faceUnder(const Contact& contact, const Link& link,
                                    const Vec3& facing) const;
  void findFirm(const ContactSet& contacts, Link& link);
  bool findTurn(const std::vector<Vec3>& vertices, Link& link) const;
  void lookAround(const std::vector<Vec3>& vertices, const Link& link);
  Vec3 placeOf(int vertex, const Vec3& guess, const std::vector<Vec3>& vertices,
               const Link& link) const;
  void put(int vertex, const Vec3& place, const std::vector<Vec3>& vertices, const Link& link);
  void steadyShares(int link);
  void drawEdges(const std::vector<Vec3>& vertices, const Link& link);
  void markDrawn(int vertex, Contact& contact) const;
  bool hasTissueBeyond(int vertex, const FaceEdge& edge, const Link& link) const;
  Contact contactOf(int link, int vertex, const AtRim& at_rim,
                    const std::vector<Vec3>& vertices) const;

  const World& world_;
  RimState& state_;
  RimColumns columns_;
  // Of the surface with that number.
  std::uint64_t revision_ = 0;
  std::vector<std::vector<int>> neighbors_;  // of vertices, along edges
  std::vector<SurfacePoint> places_;         // of vertices
};

}  // namespace robot_tissue
