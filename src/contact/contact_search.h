// What ContactFinder keeps: the links, the tissue's tree, and what the last search found.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "broad_phase.h"
#include "link_contacts.h"
#include "placed_link.h"
#include "robot_tissue/contact/contact_finder.h"
#include "surface_tree.h"
#include "touching_link.h"

namespace robot_tissue {

// Throws InputError: the pose has another number of links.
void requireLinks(const RobotPose& pose, std::size_t links);

// Of triangles beside a mesh: where they are deepest.
enum class Places { kFollowed, kAnew };

// What the last find() met, so that neither it nor penetrations() look for the same again.
struct Found {
  std::uint64_t move = 0;  // SurfaceTree::moves() then
  RobotPose pose;
  double margin = 0.0;
  ContactSet contacts;
};

struct ContactFinder::Kept {
  Found found;
  std::vector<std::vector<KeptFacePairs>> face_pairs;  // per link
  std::vector<std::vector<KnownMinima>> known_minima;  // likewise
  std::uint64_t known_minima_of = 0;
  bool is_found_of_tree = false;
};

struct ContactFinder::Impl {
  std::vector<TouchingLink> links;
  std::vector<std::string> warnings;
  BroadPhase broad_phase;

  std::vector<PlacedLink> placedAt(const RobotPose& pose) const;
  // Of one link, some of whose shapes are near the surface.
  void addContacts(const PlacedLink& here, std::size_t link,
                   const std::vector<std::size_t>& near_shapes, const TissueSurface& surface,
                   const std::vector<Vec3>& vertices, double margin, Places places,
                   ContactSet& contacts);
  double penetration(const PlacedLink& here, std::size_t link, const Pose& tissue_T_link,
                     const TissueSurface& surface, const std::vector<Vec3>& vertices,
                     const Bulge& bulge);
  // Box around the surface. Without a tree, which is made once a link comes near, from all
  // vertices.
  Box boundsOf(const TissueSurface& surface, const std::vector<Vec3>& vertices) {
    return surface_tree.exists() ? surface_tree.of(surface, vertices).bounds()
                                 : robot_tissue::boundsOf(vertices);
  }

  // The last find() was of that link there, and of the surface that the tree is of.
  bool knows(std::size_t link, const Pose& tissue_T_link) const {
    return link < found.pose.links.size() && found.move == surface_tree.moves() &&
           found.pose.links[link].matrix() == tissue_T_link.matrix();
  }

  // Likewise of all links, but for a way that each may have gone since (m).
  bool knowsPlaces(const RobotPose& pose, double margin, double way) const {
    if (!surface_tree.exists() || found.margin != margin || found.move != surface_tree.moves() ||
        found.pose.links.size() != links.size()) {
      return false;
    }
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (!(links[link].longestWay(found.pose.links[link], pose.links[link]) <= way)) return false;
    }
    return true;
  }

  void forgetMinima() {
    known_minima_of = surface_tree.trees();
    for (TouchingLink& link : links) {
      for (KnownMinima& minima : link.known_minima) minima.forget();
    }
  }

  bool knowsAll(const RobotPose& pose, double margin) const {
    if (!surface_tree.exists() || found.margin != margin) return false;
    for (std::size_t link = 0; link < links.size(); ++link) {
      if (!knows(link, pose.links[link])) return false;
    }
    return true;
  }

  // Kept from call to call, to spare allocations and to answer the same question once.
  LinkContacts link_contacts;
  SurfaceTree surface_tree;
  bool follows_places = false;
  std::uint64_t known_minima_of = 0;  // SurfaceTree::trees()
  Found found;
};

}  // namespace robot_tissue
