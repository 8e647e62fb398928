// Contacts -> springs in contact, for tools along which the tissue slides (own).
//
// A touch is a point of the surface near a link: a vertex, or a point of a triangle where the link
// is deeper than at its vertices. It is pushed out of a plane (its normal and a point of the link's
// surface, from the contact that the caller finds for it), by a ContactSpring. After each solve
// update() takes Uzawa's step of the augmented Lagrangian (Simo and Laursen 1992):
//
//   multiplier = max(0, multiplier - k gap),   friction_bound = friction * multiplier
//
// and the planes where the touches are now. A load step begins with ride() and meet(), calls
// update() until that says the contacts are settled, and ends with commit(). In: contacts (tissue
// frame, normals from the tool into the tissue), poses of the links. Out: the springs of each tool.
// Points that held nodes carry, but for four tenths of their weight at most, are never taken, and
// by jaws none that hangs on a node that they have grasped.
//
// In time a point that is found deep, as between points that touched before, comes out by and by:
// its plane is in the tool by `entry`, which goes to zero. At once it would have a speed that it
// never had, and viscosity would answer to that.
//
// Under a shape whose contact is narrower than the lattice tells apart the planes are inside it by
// a recess (NarrowContact), which hangs on what it presses with; the surface is shown where it is.
//
// At the rim of a flat face a touch gives way, by a compliance c: its plane is c times the
// multiplier below the tool's, its spring k in series with 1 / c. Then the gap goes to -c f. (With
// f = multiplier - k' (g + c multiplier), k' = k / (1 + k c), f is the multiplier for g = -c f.)
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/contact_spring.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/core/triangle_point.h"
#include "robot_tissue/coupling/plane_drift.h"
#include "robot_tissue/coupling/press_growth.h"
#include "robot_tissue/coupling/surface_crowding.h"

namespace robot_tissue {

class KnownTouches;

// Of a touch at a rim (m/N).
struct TouchCompliance {
  double normal = 0.0;
  double friction = 0.0;
  double shown = 0.0;  // of the normal one what the surface is shown without
};

class SlidingContacts {
 public:
  using Tracked = std::vector<std::optional<Contact>>;  // of each touch, in the order of touches()

  // What is kept of a contact from round to round, and from load step to load step.
  struct ContactConstraint {
    Contact contact;                   // as it was seen in the last update
    int vertex = -1;                   // of the surface; -1: a point of a triangle
    Corners corners;                   // of its triangle, at rest (m)
    ContactSpring spring;              // as the next solve will have it
    ContactSpring solved;              // as the last one had it; without carriers: it had none
    Vec3 solved_at = Vec3::Zero();     // where in the triangle that was, by weights
    Vec3 solved_bulge = Vec3::Zero();  // Contact::bulge there
    double firm_stiffness = 0.0;       // k, without its compliance (N/m)
    double crowding = 1.0;             // touches that share that of one alone
    TouchCompliance compliance;
    Vec3 tool_point = Vec3::Zero();       // of the tool's surface (m)
    Vec3 friction_ratio = Vec3::Zero();   // drag over normal force at the last commit, link's frame
    Vec3 since_normal = Vec3::Zero();     // the plane's normal then, in the link's frame
    PlaneDrift drift;                     // of its plane
    std::optional<double> way, last_way;  // m: its plane's, in this and the last round
    double stiffening = 1.0;              // of the tissue, in the time step under way
    double entry = 0.0;                   // m: in time, how deep it may be yet, as it was found so
    double recess = 0.0;                  // m: of its link
    TouchCompliance of_columns;           // at a rim, of the columns that the point is between
    double column_recess = 0.0;           // m: by what these give way
    double stuck = 1.0;        // share of its link's way in the load step on which it touches (1)
    bool found = false;        // in the last update
    std::optional<Vec3> left;  // where in its triangle it went from in this load step, by weights
  };

  // What is to be known of a link.
  struct LinkForm {
    std::vector<double> thicknesses;      // of its shapes (m)
    bool is_uneven = false;               // a mesh: a triangle may lie on it at several places
    std::vector<ToolIndenter> indenters;  // its shapes but for planes; none: nothing is narrow
  };

  SlidingContacts() = default;  // of no tools
  // Coulomb's friction of each tool (none: tissue sticks to it, see StickingContacts), and the
  // links.
  SlidingContacts(std::vector<std::optional<double>> friction, std::vector<LinkForm> links);

  // What `held` has for a node that this tool has grasped; those far back in the list share one.
  static std::uint8_t graspedBy(int tool) {
    return static_cast<std::uint8_t>(std::min(2 + tool, 255));
  }
  // Whether the tool can push a point with these carriers, or that contact's; `held` as in meet().
  static bool givesWay(const std::vector<NodeWeight>& carriers, int tool,
                       const std::vector<std::uint8_t>& held);
  static bool givesWay(const Contact& contact, const Tissue& tissue,
                       const std::vector<std::uint8_t>& held);

  // The links go to where they are now, and planes and anchors with them; forces go on as they
  // went.
  void ride(const RobotPose& pose, const Tissue& tissue);

  // The tissue has another surface: touches go on where that is as it was, and are forgotten where
  // it is not. From here on tissue and links stick, or slip anew. True: contacts were settled, and
  // all that push go on as the last solve had them; else the links are to be met anew.
  bool takeSurface(const RobotPose& pose, const Tissue& tissue);

  // What the links touch anew where they are now. `held`: per node, not 0 = it does not give way;
  // graspedBy(tool): that tool's jaws have it, and do not push what hangs on it.
  // `wandering`: of touches that wander, as `tracked` in update(); those that have none and are not
  // found hand on their force.
  void meet(const ContactSet& contacts, const RobotPose& pose, const Tissue& tissue,
            const std::vector<std::uint8_t>& held, const Tracked& wandering = {});

  // `tracked`: the contact of each touch in the present shape, in the order of touches(); none when
  // the link is out of reach. `found`: what else is near. False: something changed, solve again.
  bool update(const Tracked& tracked, const ContactSet& found, const RobotPose& pose,
              const Tissue& tissue, const std::vector<std::uint8_t>& held,
              ContactUpdate::Shape shape = ContactUpdate::Shape::kSolved);

  // From here on tissue and links stick, or slip anew. Forgets touches that the tools have left.
  void commit(const RobotPose& pose, const Tissue& tissue);

  // As commit(), but for the tissue, which is as it was at the last one: no tool touches.
  void pass(const RobotPose& pose);

  // Of nothing that was before anything is left, or of a tool alone.
  void clear();
  void clear(int tool);
  // Coulomb's, of a tool that tissue does not stick to; from the next solve on.
  void setFriction(int tool, double friction) {
    if (friction_[at(tool)]) friction_[at(tool)] = friction;
  }

  // Whether a spring in contact pushes harder in the tissue's last solve than any tissue does: the
  // node's stiffness times kMostForce spacings.
  static bool pushesAbsurdly(const Tissue& tissue);
  const std::vector<ContactConstraint>& touches() const { return touches_; }
  // How deep a point that touches the link is in it, where the contact is narrow (m): Recess.
  double recessOf(int link) const;
  // Likewise as these columns give way (m).
  double columnRecess(int link, const std::vector<RimColumn>& columns) const;
  // Whether the tool pushes, did at the last commit, or would in a solve.
  bool pushes(int tool, const Tissue& tissue) const;
  // Where the link pressed to at the last commit, friction included (unit, tissue frame); zero when
  // it did not.
  Vec3 facing(int link, const Pose& tissue_T_link) const;
  // Of its touches, in their order.
  ContactSprings springsOf(int tool) const;

 private:
  using Held = std::vector<std::uint8_t>;

  // What a tool's touches pressed with in the last update.
  struct Pressed {
    double force = 0.0;  // N: their normal forces
    int touches = 0;
  };

  // What an indenter of a link faced the tissue with when that was last looked at.
  struct SeenPart {
    int shape = -1;
    int triangle = -1;
    Vec3 facing = Vec3::Zero();  // frame of the shape
    std::shared_ptr<const IndenterPart> part;
  };

  // How a link is recessed, and was in the last round (m); `last_way`: how far from what was asked.
  struct LinkRecess {
    double depth = 0.0;
    double last_depth = 0.0;
    double last_way = 0.0;
  };

  double slackOf(const ContactConstraint& touch, const Tissue& tissue) const;
  void takeStiffness(const Tissue& tissue, const Held& held, ContactConstraint& touch);
  void stickFirst(const Tissue& tissue);
  void calmPlanes(const RobotPose& pose);
  void growAlongWay(const RobotPose& pose, const Tissue& tissue);
  double thicknessAt(const Contact& contact) const;
  double fineness(const Contact& contact, double spacing) const;
  void add(const Contact& contact, KnownTouches& known, const RobotPose& pose, const Tissue& tissue,
           const Held& held);
  void put(const Contact& contact, const RobotPose& pose, const Tissue& tissue, const Held& held,
           ContactConstraint& touch);
  bool track(const std::optional<Contact>& contact, const RobotPose& pose, const Tissue& tissue,
             ContactConstraint& touch);
  bool driftsEvenly(const ContactConstraint& touch, const Tissue& tissue) const;
  bool isAtRest(const ContactConstraint& touch, const Tissue& tissue) const;
  bool wander(const ContactSet& found, const Tracked& tracked, const RobotPose& pose,
              const Tissue& tissue, const Held& held);
  using Wander = std::tuple<double, std::size_t, std::size_t>;  // m, touch, place
  std::vector<Wander> nearestFirst(const std::vector<const Contact*>& places, double reach);
  bool moveTo(const Contact& contact, const RobotPose& pose, const Tissue& tissue, const Held& held,
              ContactConstraint& touch);
  bool isTaken(const Contact& place) const;
  bool handOn(const ContactConstraint& lost, double reach, const Tissue& tissue);
  bool take(const Contact& contact, KnownTouches& known, const RobotPose& pose,
            const Tissue& tissue, const Held& held);
  bool hopsBack(const ContactConstraint& touch, const Contact& contact, const Tissue& tissue) const;
  std::vector<PressGrowth::Press> presses(std::size_t links) const;
  void takeMeans(const Tissue& tissue);
  bool updateMultipliers(const Tissue& tissue);
  void pressHarder(const Tissue& tissue);
  bool knowsGrowth(std::size_t link, const RobotPose& pose) const;
  void guessRecesses(const RobotPose& pose, const Tissue& tissue);
  void setRecess(int link, double depth);
  static bool tellsRecesses(const Tissue& tissue);
  bool renewRecesses(const RobotPose& pose, const Tissue& tissue);
  using Touches = std::vector<const ContactConstraint*>;
  std::optional<NarrowPress> pressOf(const Touches& touches, const Pose& tissue_T_link,
                                     const Tissue& tissue);
  Recess recessUnder(const NarrowPress& press, const Touches& touches, const Tissue& tissue) const;
  Recess recessAsked(int link, const Pose& tissue_T_link, const Tissue& tissue);
  const ToolIndenter* indenterUnder(const Touches& touches, const Tissue& tissue) const;
  std::shared_ptr<const IndenterPart> partUnder(const ToolIndenter& tool, const Touches& touches,
                                                const Pose& tissue_T_shape, const Vec3& facing,
                                                double spacing);
  void forgetLost(const Held& held);
  void forgetRecesses();
  void softenColumns(const Tissue& tissue);
  void showColumns(const Tissue& tissue, ContactConstraint& touch) const;
  void goOnAsSolved(const TissueSurface& surface);
  void noteFacing(const RobotPose& pose);
  Pose movedSince(std::size_t link, const RobotPose& pose) const;
  double shareOfTouch(const Pose& moved, const ContactConstraint& touch) const;
  void anchor(const RobotPose& pose, ContactConstraint& touch) const;

  std::vector<std::optional<double>> friction_;
  std::vector<LinkForm> forms_;
  std::vector<Pressed> pressed_;      // per tool
  std::vector<double> plane_shares_;  // per link: of the ways of its planes, that they go (1)
  std::map<std::pair<int, NodeColumn>, double> column_ways_;  // of links: as they give way (m)
  std::vector<LinkRecess> recesses_;                          // per link
  std::vector<SeenPart> seen_parts_;                          // likewise
  PressGrowth growth_;
  SurfaceCrowding crowding_;
  bool is_settled_ = false;                   // since the last update
  int cut_rounds_ = 0;                        // updates in a row of shapes on the way to balance
  std::vector<ContactConstraint> touches_;    // in the order in which they were found
  std::vector<Vec3> facing_;                  // per link, of its forces (N, link's frame)
  std::vector<Pose> since_links_;             // at the last commit
  double since_s_ = 0.0;                      // likewise, RobotPose::stamp_s
  Tissue::Displacements since_displacement_;  // likewise (m)
};

}  // namespace robot_tissue
