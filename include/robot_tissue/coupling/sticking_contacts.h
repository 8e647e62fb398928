// Contacts -> loading patches (own; the paper takes the loading area as given).
//
// The hard part of a tool's patch, for tools with rigid patches and for graspers.
// Rigid: a node that a contact pushed out of the tool rides on it from then on, as part of one hard
// piece, and so sticks sideways. It leaves the patch when the tool has lifted it above the
// surface's rest place, when it is on the near side of its rest place and the tissue pulls it away
// from the tool, or when nothing around it touches the tool. Grasped: nodes ride between two jaws
// until they are let go, so that all that is between them is squeezed alike as they close. In:
// contacts of tools with rigid patches (tissue frame, normals from the tool into the tissue), poses
// of the links. Out: one patch a tool that has nodes, displacements from rest (m). Fixed nodes and
// the nodes of named loads are never taken.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "robot_tissue/core/contact_set.h"
#include "robot_tissue/core/loading_patch.h"
#include "robot_tissue/core/robot_pose.h"
#include "robot_tissue/core/tissue.h"
#include "robot_tissue/coupling/sliding_contacts.h"

namespace robot_tissue {

class StickingContacts {
 public:
  StickingContacts() = default;  // of no tools
  StickingContacts(const Lattice& lattice, std::vector<std::string> tool_names);

  // Moves the patches with their tools; nodes that the tool has left stay behind.
  void ride(const RobotPose& pose, const Tissue& tissue);
  // After a cut, or one was taken back: what it holds has other nodes.
  void takeCells(const Tissue& tissue);
  // Lets go of the nodes that carry no contact.
  void keepTouching(const ContactSet& contacts, const Tissue& tissue);
  // Moves the nodes under the contacts until each contact's depth is gone.
  void pushOut(const ContactSet& contacts, const Tissue& tissue, const RobotPose& pose);
  // A node that goes with the one link and, by a share (1), with the other.
  struct Grip {
    int node = 0;
    int link = 0, other_link = 0;  // indices into RobotPose::links
    double share_of_other = 0.0;
  };
  // Grasped: the nodes ride on the links from where they are.
  void hold(int tool, const std::vector<Grip>& grips, const RobotPose& pose, const Tissue& tissue);
  void letGo(int tool);
  bool holds(int tool) const;

  // Where a node sits on a link, that link's frame.
  struct Attachment {
    int link = 0;  // index into RobotPose::links
    bool grasped = false;
    int other_link = 0;  // likewise; of a grasped node (Grip)
    double share_of_other = 0.0;
    Vec3 point = Vec3::Zero();
    Vec3 point_on_other = Vec3::Zero();  // in the other link's frame
    Vec3 pushed = Vec3::Zero();          // sum of its motions out of the tool (m): its way out
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();           // of the link since it sits there
    Eigen::Matrix3d link_R_tissue = Eigen::Matrix3d::Identity();  // then
    bool knows_edges = false;  // hold() or tellEdges() has been there
    SeatedNode seat;           // as the tissue was when it sat down
  };
  using Attachments =
      std::vector<std::map<int, Attachment>>;  // per tool: node -> seat; ordered, so repeatable

  // Lets go of every node.
  void clear();
  // All that is to be kept of the patches to come back to them.
  const Attachments& attachments() const { return attachments_; }
  // With the tissue in the shape that it had.
  void restore(const Attachments& attachments, const Tissue& tissue);

  // What the law of rims takes of a tool: of the edges of a link's flat face as seen from a point
  // (m), tissue frame; `outward`: from the tissue to the tool. None: it has no face there.
  struct Edges {
    double share = 0.0;  // how much of the law holds (1)
    std::vector<FaceEdge> edges;
  };
  using EdgesAt = std::function<Edges(int link, const Vec3& outward, const Vec3& point)>;
  // To the nodes that sat down lately.
  void tellEdges(const RobotPose& pose, const EdgesAt& edges_at);

  // The tool's patch; without nodes when it holds none.
  LoadingPatch loadingPatch(int tool, const Tissue& tissue) const;
  // Nodes that left a patch in the last ride.
  const std::vector<int>& left() const { return left_; }
  // The tissue's displacements (m), with the patches where they are now.
  std::vector<Vec3> displacement(const Tissue& tissue) const;
  std::vector<int> nodes(int tool) const;
  // Per node, not 0 = it does not give way: fixed, hard in a named load by displacement, or in one
  // of these patches; SlidingContacts::graspedBy(tool): it moves with that grasper.
  std::vector<std::uint8_t> heldNodes(const Tissue& tissue) const;
  // Per node, not 0 = no tool may take it: likewise, but with all nodes of named loads.
  std::vector<std::uint8_t> takenNodes(const Tissue& tissue) const;

 private:
  // A free node that carries a contact's point.
  struct Carrier {
    int node = 0;
    double weight = 0.0;
    double mobility = 1.0;
    double way = 0.0;  // weight of all nodes of its column: they go alike, as the surface does
  };
  // Of the contact with the same number.
  struct Push {
    std::vector<Carrier> support;
    bool evenly = false;      // nodes go by the mean of what the contacts around them need
    double row_sum = 0.0;     // how much all contacts together move this one's point
    double multiplier = 0.0;  // m; > 0: the contact pushes
  };

  static Vec3 placeOf(const Attachment& attachment, const RobotPose& pose);
  Push pushOf(const Contact& contact, const Tissue& tissue) const;
  std::vector<Carrier> supportOf(const Contact& contact, const TissueSurface& surface) const;
  void scale(std::vector<Push>& pushes) const;
  static double deepen(const std::vector<Contact>& contacts, const std::map<int, Vec3>& motion,
                       std::vector<Push>& pushes);
  static std::map<int, Vec3> motionOf(const std::vector<Contact>& contacts,
                                      const std::vector<Push>& pushes);
  void attach(int node, std::size_t tool, int link, const Vec3& moved, const Tissue& tissue,
              const RobotPose& pose);
  const std::vector<std::uint8_t>& fixedNodes(const Tissue& tissue) const;
  std::vector<std::uint8_t> fixedOrLoaded(const Tissue& tissue) const;
  void markAttached(std::vector<std::uint8_t>& nodes) const;
  void findOutwardNormals(const Tissue& tissue);
  bool letsGo(int node, const Vec3& displacement, const Vec3& way_out, const Tissue& tissue);

  const Lattice* lattice_ = nullptr;  // a pointer, so that patches can be assigned
  std::vector<std::string> names_;
  Attachments attachments_;
  std::map<int, Vec3> places_;            // displacement of nodes with a seat (m)
  std::shared_ptr<const CellSet> cells_;  // of the tissue in the last ride
  std::vector<std::uint8_t> taken_;       // per node: fixed, or in a named load
  // Looked up once for each set of cells.
  mutable std::shared_ptr<const CellSet> fixed_of_;
  mutable std::vector<std::uint8_t> fixed_;
  std::vector<int> left_;
  // Per node: normal of the surface it carries, at rest; zero inside. Found when it is asked for.
  std::vector<Vec3> outward_;
  std::uint64_t surface_revision_ = 0;
};

}  // namespace robot_tissue
