#include "tool_rims.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/coupling/fade.h"
#include "tuning.h"

namespace robot_tissue {

void ToolRims::beginStep() {
  state_.shares.clear();
  state_.last_shares.clear();
  state_.firm.clear();
  columns_.beginStep();
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    if (touch.contact.rim.edges.empty()) continue;
    state_.last_shares[{touch.contact.link, touch.vertex}] = touch.contact.rim.share;
  }
}

void ToolRims::takeSurface() {
  const TissueSurface& surface = world_.tissue.surface();
  if (revision_ == surface.revision && neighbors_.size() == surface.rest.size()) return;
  revision_ = surface.revision;
  neighbors_.assign(surface.rest.size(), {});
  places_.resize(surface.rest.size());
  for (std::size_t triangle = 0; triangle < surface.triangles.size(); ++triangle) {
    const MeshTriangle& corners = surface.triangles[triangle];
    for (std::size_t k = 0; k < 3; ++k) {
      neighbors_[at(corners[k])].push_back(corners[(k + 1) % 3]);  // each edge runs both ways
      places_[at(corners[k])] = {static_cast<int>(triangle), Vec3::Unit(static_cast<int>(k))};
    }
  }
}

void ToolRims::look(const RobotPose& pose, const std::vector<Vec3>& vertices,
                    const ContactSet& contacts) {
  state_.at_rims.clear();
  state_.drawn.clear();
  columns_.begin();
  std::map<int, Link> links;
  for (const Contact& contact : contacts.contacts) {
    const std::size_t number = at(contact.link);
    if (links.count(contact.link) != 0 || world_.isInWound(number)) continue;
    if (!world_.finder.hasFlatFaces(number) || isSticking(contact.tool)) continue;
    Link& link = links[contact.link];
    link.tool = contact.tool;
    link.number = contact.link;
    link.tissue_T_link = pose.links[number];
  }
  if (links.empty()) return;
  takeSurface();
  for (auto& [number, link] : links) {
    link.inwards = inwardsAround(link, vertices);
    link.facing = world_.sliding.facing(number, link.tissue_T_link);
    if (link.facing.isZero(0.0)) link.facing = link.inwards;  // it only meets the tissue
    if (link.facing.isZero(0.0)) continue;
    findFirm(contacts, link);
    if (!findTurn(vertices, link)) continue;
    columns_.look(link, vertices, contacts);
    lookAround(vertices, link);
    steadyShares(number);
    drawEdges(vertices, link);
  }
}

// As much as the rims bear: where triangles touch, they bring the surface to the edge themselves.
// What such a touch does not push is off the face's plane.
void ToolRims::drawEdges(const std::vector<Vec3>& vertices, const Link& link) {
  const TissueSurface& surface = world_.tissue.surface();
  const double spacing = world_.tissue.lattice().spacing();
  std::set<int> touching;
  for (const int vertex : link.firm) {
    if (surface.carriers[at(vertex)].size() == 1) touching.insert(vertex);
  }
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    const auto at_rim = state_.at_rims.find({link.number, touch.vertex});
    if (touch.contact.link != link.number || at_rim == state_.at_rims.end()) continue;
    if (!touch.contact.rim.edges.empty() || !at_rim->second.rim.is_beyond) {
      touching.insert(touch.vertex);
    }
  }
  const FaceUnder face_under = [&](int vertex) {
    return world_.finder.flatFace(at(link.number), link.tissue_T_link, link.facing,
                                  vertices[at(vertex)], tuning::kRimReach * spacing);
  };
  for (auto& [vertex, drawn] : drawnAtEdges(touching, neighbors_, vertices, face_under, spacing)) {
    const auto at_rim = state_.at_rims.find({link.number, vertex});
    const double share = at_rim != state_.at_rims.end()
                             ? at_rim->second.rim.share
                             : rimShare(*face_under(vertex), link, spacing);
    drawn.aside *= fade(share, 0.0, tuning::kSomeOfIt);
    state_.drawn[{link.number, vertex}] = drawn;
  }
}

// How much rims bear changes little in a load step, and stays in its rounds.
void ToolRims::steadyShares(int link) {
  const auto first = state_.at_rims.lower_bound({link, 0}),
             last = state_.at_rims.lower_bound({link + 1, 0});
  for (auto at_rim = first; at_rim != last; ++at_rim) {
    double& share = at_rim->second.rim.share;
    const auto last_share = state_.last_shares.find(at_rim->first);
    if (last_share != state_.last_shares.end()) {
      share = std::max(share, last_share->second - tuning::kMostOfShare);
      share = std::min(share, last_share->second + tuning::kMostOfShare);
    }
    share = state_.shares.try_emplace(at_rim->first, share).first->second;
  }
}

double ToolRims::flatness(int number, const Pose& tissue_T_link, const ContactSet& contacts,
                          const std::vector<Vec3>& vertices) const {
  if (!world_.finder.hasFlatFaces(at(number))) return 0.0;
  Link link;
  link.number = number;
  link.tissue_T_link = tissue_T_link;
  const Vec3 inwards = inwardsAround(link, vertices);
  if (inwards.isZero(0.0)) return 0.0;
  const double spacing = world_.tissue.lattice().spacing();
  double flatness = 0.0;
  for (const Contact& contact : contacts.contacts) {
    const auto face = faceUnder(contact, link, inwards);
    if (!face) continue;
    const double wide =
        fade(faceWidth(*face), tuning::kNarrowFace * spacing, tuning::kWideFace * spacing);
    flatness = std::max(
        flatness, wide * fade(face->normal.dot(inwards), tuning::kTiltedFace, tuning::kLevelFace));
  }
  return flatness;
}

bool ToolRims::isSticking(int tool) const {
  return at(tool) < world_.tools.size() && world_.tools.isRigid(tool);
}

// The sum of the areas of a surface is that of any other with the same border: it knows no dent.
Vec3 ToolRims::inwardsAround(const Link& link, const std::vector<Vec3>& vertices) const {
  const Box near = grownBy(world_.tissue.lattice().spacing(),
                           world_.finder.bounds(at(link.number), link.tissue_T_link));
  Vec3 sum = Vec3::Zero();
  for (const MeshTriangle& corners : world_.tissue.surface().triangles) {
    const Vec3 center =
        (vertices[at(corners[0])] + vertices[at(corners[1])] + vertices[at(corners[2])]) / 3.0;
    if (near.contains(center)) sum -= doubleArea(vertices, corners);
  }
  return sum.normalized();
}

// The face of the link, looking there, that a vertex in contact with it stands on.
std::optional<FlatFace> ToolRims::faceUnder(const Contact& contact, const Link& link,
                                            const Vec3& facing) const {
  if (contact.link != link.number) return std::nullopt;
  if (vertexAt(world_.tissue.surface(), contact.place) < 0) return std::nullopt;
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link.number), link.tissue_T_link, facing,
                                           contact.point, tuning::kRimReach * spacing);
  if (!face || std::abs(face->height_m) > tuning::kOnFace * spacing) return std::nullopt;
  return face;
}

// Vertices that are on the face, and farther from its edges than any shift. In the rounds of a load
// step they stay so up to the edge: where others stand is told by them, and what comes and goes
// moves these by up to half a spacing, to and fro for ever.
void ToolRims::findFirm(const ContactSet& contacts, Link& link) {
  const double spacing = world_.tissue.lattice().spacing();
  for (const Contact& contact : contacts.contacts) {
    const auto face = faceUnder(contact, link, link.facing);
    if (!face) continue;
    const int vertex = vertexAt(world_.tissue.surface(), contact.place);
    const bool was_firm = state_.firm.count({link.number, vertex}) != 0;
    const double least = was_firm ? 0.0 : tuning::kFirmDepth * spacing;
    if (leastDepth(*face) >= least) link.firm.insert(vertex);
  }
  for (const int vertex : link.firm) state_.firm.emplace(link.number, vertex);
}

// Rotation that takes them from rest to where they are (Kabsch 1976). False: they are on a line.
bool ToolRims::findTurn(const std::vector<Vec3>& vertices, Link& link) const {
  const std::vector<Vec3>& rest = world_.tissue.surface().rest;
  const double count = static_cast<double>(link.firm.size());
  if (link.firm.size() < 3) return false;
  Vec3 middle = Vec3::Zero(), rest_middle = Vec3::Zero();
  for (const int vertex : link.firm) {
    middle += vertices[at(vertex)] / count;
    rest_middle += rest[at(vertex)] / count;
  }
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const int vertex : link.firm) {
    sum += (vertices[at(vertex)] - middle) * (rest[at(vertex)] - rest_middle).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> parts(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
  if (parts.singularValues()[1] < tuning::kOnALine * parts.singularValues()[0]) return false;
  const double sign = (parts.matrixU() * parts.matrixV().transpose()).determinant();
  link.turn = parts.matrixU() * Vec3(1.0, 1.0, sign).asDiagonal() * parts.matrixV().transpose();
  return true;
}

// Three columns from the firm vertices on, each of neighbors of those before: at corners of faces,
// and where the last column on the face is not firm, none is nearer.
void ToolRims::lookAround(const std::vector<Vec3>& vertices, const Link& link) {
  const TissueSurface& surface = world_.tissue.surface();
  struct Guess {
    Vec3 sum = Vec3::Zero();
    int count = 0;
  };
  std::map<int, Vec3> places;  // of the columns found so far
  for (const int vertex : link.firm) places[vertex] = vertices[at(vertex)];
  for (int column = 0; column < 3; ++column) {
    std::map<int, Guess> guesses;
    for (const auto& [from, place] : places) {
      for (const int vertex : neighbors_[at(from)]) {
        if (places.count(vertex) != 0 || surface.carriers[at(vertex)].size() != 1) continue;
        const Vec3 way = link.turn * (surface.rest[at(vertex)] - surface.rest[at(from)]);
        const Vec3 level = way - link.facing.dot(way) * link.facing;
        if (level.norm() < tuning::kLevel * way.norm()) continue;
        Guess& guess = guesses[vertex];
        guess.sum += place + level;
        ++guess.count;
      }
    }
    for (const auto& [vertex, guess] : guesses) {
      places[vertex] = placeOf(vertex, guess.sum / guess.count, vertices, link);
      put(vertex, places[vertex], vertices, link);
    }
  }
}

// Where the vertex would be, did it stick to the face: what stands on it inside its edges is there.
Vec3 ToolRims::placeOf(int vertex, const Vec3& guess, const std::vector<Vec3>& vertices,
                       const Link& link) const {
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link.number), link.tissue_T_link, link.facing,
                                           vertices[at(vertex)], tuning::kRimReach * spacing);
  if (!face) return guess;
  const double stands = fade(std::abs(face->height_m), tuning::kOnFace * spacing, 0.0) *
                        fade(leastDepth(*face), 0.0, tuning::kFirmDepth * spacing);
  return guess + stands * (vertices[at(vertex)] - guess);
}

// `place`: where the vertex would be, did it stick to the face.
void ToolRims::put(int vertex, const Vec3& place, const std::vector<Vec3>& vertices,
                   const Link& link) {
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link.number), link.tissue_T_link, link.facing, place,
                                           tuning::kRimReach * spacing);
  if (!face) return;
  AtRim at_rim;
  at_rim.tool = link.tool;
  at_rim.shape = face->shape;
  at_rim.normal = face->normal;
  at_rim.height = face->height_m + face->normal.dot(vertices[at(vertex)] - place);
  at_rim.rim.share = rimShare(*face, link, spacing);
  const double least_depth = leastDepth(*face) / spacing;
  if (least_depth <= tuning::kNotShown) return;
  at_rim.rim.shown = fade(least_depth, tuning::kNotShown, tuning::kShown);
  at_rim.rim.is_beyond = least_depth < 0.0;
  for (const FaceEdge& edge : face->edges) {
    if (edge.depth_m >= tuning::kFirmDepth * spacing) continue;
    if (hasTissueBeyond(vertex, edge, link)) at_rim.rim.edges.push_back(edge);
  }
  if (at_rim.rim.edges.empty()) return;
  const int node = world_.tissue.surface().carriers[at(vertex)].front().node;
  if (!world_.tissue.rimCompliance(node, 0.0)) return;  // here it has none
  state_.at_rims[{link.number, vertex}] = at_rim;
}

// Where the tissue ends with the tool there is no rim.
bool ToolRims::hasTissueBeyond(int vertex, const FaceEdge& edge, const Link& link) const {
  const std::vector<Vec3>& rest = world_.tissue.surface().rest;
  return std::any_of(neighbors_[at(vertex)].begin(), neighbors_[at(vertex)].end(), [&](int other) {
    const Vec3 way = link.turn * (rest[at(other)] - rest[at(vertex)]);
    return edge.outward.dot(way) > tuning::kLevel * way.norm();
  });
}

void ToolRims::mark(Contact& contact) const {
  contact.rim = {};
  contact.columns.clear();
  const int vertex = vertexAt(world_.tissue.surface(), contact.place);
  if (vertex < 0) {
    contact.rim.share = shareOf(contact);
    contact.columns = columnsAt(contact);
    return;
  }
  const auto found = state_.at_rims.find({contact.link, vertex});
  if (found != state_.at_rims.end()) {
    const AtRim& at_rim = found->second;
    if (at_rim.rim.is_beyond || at_rim.rim.share <= 0.0) return;
    contact.rim = at_rim.rim;
    contact.normal = at_rim.normal;
    contact.depth_m = -at_rim.height;
  }
  contact.columns = columnsAt(contact);
  markDrawn(vertex, contact);
}

std::vector<RimColumn> ToolRims::columnsAt(const Contact& contact) const {
  if (shareOf(contact) > 0.0) return {};
  return columns_.around(contact);
}

void ToolRims::markDrawn(int vertex, Contact& contact) const {
  const auto drawn = state_.drawn.find({contact.link, vertex});
  if (drawn == state_.drawn.end()) return;
  contact.rim.drawn_at = drawn->second.place;
  contact.rim.drawn_aside = drawn->second.aside;
}

double ToolRims::shareOf(const Contact& contact) const {
  if (state_.at_rims.empty()) return 0.0;
  const TissueSurface& surface = world_.tissue.surface();
  double share = 0.0, weight = 0.0;
  for (int corner = 0; corner < 3; ++corner) {
    const int vertex = surface.triangles[at(contact.place.triangle)][at(corner)];
    const auto found = state_.at_rims.find({contact.link, vertex});
    if (found == state_.at_rims.end()) continue;
    const double part = std::max(0.0, contact.place.barycentric[corner]);
    share += part * found->second.rim.share;
    weight += part;
  }
  return weight > 0.0 ? share / weight : 0.0;
}

double ToolRims::partOfDepth(const Contact& contact) const {
  return fade(shareOf(contact), 0.0, tuning::kSomeOfIt);
}

bool ToolRims::isTakenOver(const Contact& contact) {
  return contact.rim.edges.empty() && contact.rim.share > tuning::kAllOfIt;
}

Contact ToolRims::contactOf(int link, int vertex, const AtRim& at_rim,
                            const std::vector<Vec3>& vertices) const {
  Contact contact;
  contact.tool = at_rim.tool;
  contact.link = link;
  contact.shape = at_rim.shape;
  contact.place = places_[at(vertex)];
  contact.point = vertices[at(vertex)];
  contact.normal = at_rim.normal;
  contact.depth_m = -at_rim.height;
  contact.rim = at_rim.rim;
  markDrawn(vertex, contact);
  return contact;
}

ContactSet ToolRims::beyond(const std::vector<Vec3>& vertices) const {
  ContactSet contacts;
  const double near = tuning::kNearGap * world_.tissue.lattice().spacing();
  for (const auto& [key, at_rim] : state_.at_rims) {
    if (!at_rim.rim.is_beyond || at_rim.rim.share <= 0.0 || at_rim.height > near) continue;
    contacts.contacts.push_back(contactOf(key.first, key.second, at_rim, vertices));
  }
  return contacts;
}

// It may have come from one side of the edge to the other: what it bears, it bears on.
std::optional<Contact> ToolRims::atRim(const Contact& known,
                                       const std::vector<Vec3>& vertices) const {
  const int vertex = vertexAt(world_.tissue.surface(), known.place);
  const auto found = state_.at_rims.find({known.link, vertex});
  if (found == state_.at_rims.end() || found->second.rim.share <= 0.0) return std::nullopt;
  return contactOf(known.link, vertex, found->second, vertices);
}

}  // namespace robot_tissue
