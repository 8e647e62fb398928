#include "rim_columns.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "drawn_edges.h"
#include "robot_tissue/coupling/fade.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

// Goes half of the way from what it was a look before: the push hangs on it, and it on the push.
void goHalfWay(const std::vector<FaceEdge>& before, std::vector<FaceEdge>& edges) {
  if (before.size() != edges.size()) return;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (before[i].outward.dot(edges[i].outward) < tuning::kParallelEdges) continue;
    edges[i].depth_m = 0.5 * (before[i].depth_m + edges[i].depth_m);
  }
}

// The node with most of what the point hangs on.
int nearestNode(const std::vector<NodeWeight>& carriers) {
  const auto is_less = [](const NodeWeight& a, const NodeWeight& b) { return a.weight < b.weight; };
  return std::max_element(carriers.begin(), carriers.end(), is_less)->node;
}

}  // namespace

void RimColumns::beginStep() {
  state_.shares.clear();
  state_.last_shares.clear();
  for (const SlidingContacts::ContactConstraint& touch : world_.sliding.touches()) {
    for (const RimColumn& column : touch.contact.columns) {
      state_.last_shares[{touch.contact.link, column.line}] = column.share;
    }
  }
}

void RimColumns::begin() {
  state_.axes.clear();
  state_.last_columns = std::move(state_.columns);
  state_.columns.clear();
}

void RimColumns::look(const RimLink& link, const std::vector<Vec3>& vertices,
                      const ContactSet& contacts) {
  int axis = 0;
  (link.turn.transpose() * link.facing).cwiseAbs().maxCoeff(&axis);
  state_.axes[link.number] = axis;
  for (const Contact& contact : contacts.contacts) {
    if (isOnFace(contact, link)) add(contact, link);
  }
  std::vector<int> near;
  for (auto& [key, column] : state_.columns) {
    if (key.first != link.number) continue;
    if (near.empty()) near = verticesNear(link, vertices);
    column.place /= column.weight;
    column.rest /= column.weight;
    column.moduli.stiffness /= column.weight;
    column.moduli.poisson_ratio /= column.weight;
    findEdges(key, link, column);
    soften(link, near, column);
  }
}

// On the face, near an edge, and between vertices one of which is no node: those that are have the
// law themselves.
bool RimColumns::isOnFace(const Contact& contact, const RimLink& link) const {
  if (contact.link != link.number) return false;
  const TissueSurface& surface = world_.tissue.surface();
  const MeshTriangle& corners = surface.triangles[at(contact.place.triangle)];
  if (std::all_of(corners.begin(), corners.end(),
                  [&](int vertex) { return surface.carriers[at(vertex)].size() == 1; })) {
    return false;
  }
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link.number), link.tissue_T_link, link.facing,
                                           contact.point, tuning::kRimReach * spacing);
  if (!face || std::abs(face->height_m) > tuning::kOnFace * spacing) return false;
  const double depth = leastDepth(*face) / spacing;
  return depth > tuning::kBesideFace && depth < tuning::kTellsColumn;
}

// To the columns that it is between.
void RimColumns::add(const Contact& contact, const RimLink& link) {
  const auto moduli =
      world_.tissue.rimModuli(nearestNode(carriersAt(world_.tissue.surface(), contact.place)));
  if (!moduli) return;
  const Vec3 rest = restOf(contact);
  for (const auto& [line, weight] : weightsAt(rest, state_.axes.at(link.number))) {
    const Vec3 there = placeOf(line, rest);
    const Vec3 way = link.turn * (there - rest);
    Column& column = state_.columns[{link.number, line}];
    column.place += weight * (contact.point + way - link.facing.dot(way) * link.facing);
    column.rest += weight * there;
    column.weight += weight;
    column.moduli.stiffness += weight * moduli->stiffness;
    column.moduli.poisson_ratio += weight * moduli->poisson_ratio;
  }
}

// How much of the law holds changes little in a load step, and stays in its rounds, as with
// vertices (ToolRims).
void RimColumns::findEdges(const Key& key, const RimLink& link, Column& column) {
  const double spacing = world_.tissue.lattice().spacing();
  const auto face = world_.finder.flatFace(at(link.number), link.tissue_T_link, link.facing,
                                           column.place, tuning::kRimReach * spacing);
  if (!face) return;
  column.share = rimShare(*face, link, spacing);
  const auto last_share = state_.last_shares.find(key);
  if (last_share != state_.last_shares.end()) {
    column.share = std::max(column.share, last_share->second - tuning::kMostOfShare);
    column.share = std::min(column.share, last_share->second + tuning::kMostOfShare);
  }
  column.share = state_.shares.try_emplace(key, column.share).first->second;
  column.edges = face->edges;
  const auto last = state_.last_columns.find(key);
  if (last != state_.last_columns.end()) goHalfWay(last->second.edges, column.edges);
}

// By its edges in series. Across an edge and along it the law has ways of their own.
void RimColumns::soften(const RimLink& link, const std::vector<int>& near, Column& column) const {
  const double spacing = world_.tissue.lattice().spacing();
  const double most = 1.0 / (tuning::kSoftestColumn * column.moduli.stiffness);
  for (const FaceEdge& edge : column.edges) {
    if (edge.depth_m >= tuning::kFirmDepth * spacing) continue;
    const double part = column.share * tissueBeyond(edge, link, near, column);
    if (part <= 0.0) continue;
    const RimCompliance of_edge = rimCompliance(column.moduli, edge.depth_m / spacing);
    const Vec3 along = link.facing.cross(edge.outward).normalized();
    column.normal += part * std::min(of_edge.normal, most);
    column.friction +=
        part * (std::min(of_edge.across, most) * edge.outward * edge.outward.transpose() +
                std::min(of_edge.along, most) * along * along.transpose());
  }
}

// So near to the link that they tell where the tissue ends.
std::vector<int> RimColumns::verticesNear(const RimLink& link,
                                          const std::vector<Vec3>& vertices) const {
  const Box box = grownBy(tuning::kRimReach * world_.tissue.lattice().spacing(),
                          world_.finder.bounds(at(link.number), link.tissue_T_link));
  std::vector<int> near;
  for (std::size_t vertex = 0; vertex < vertices.size(); ++vertex) {
    if (box.contains(vertices[vertex])) near.push_back(static_cast<int>(vertex));
  }
  return near;
}

// Where the tissue ends with the tool there is no rim (0); it is there in full (1) where the
// surface goes on for a spacing beyond the edge, as level as a face that has rims.
double RimColumns::tissueBeyond(const FaceEdge& edge, const RimLink& link,
                                const std::vector<int>& near, const Column& column) const {
  const double spacing = world_.tissue.lattice().spacing();
  const std::vector<Vec3>& rest = world_.tissue.surface().rest;
  const Vec3 along = link.facing.cross(edge.outward);
  double farthest = 0.0;
  for (const int vertex : near) {
    const Vec3 way = link.turn * (rest[at(vertex)] - column.rest);
    const Vec3 level = way - link.facing.dot(way) * link.facing;
    if (level.norm() < tuning::kLevel * way.norm()) continue;
    const double beyond = edge.outward.dot(way) - edge.depth_m;
    if (beyond > 2.0 * spacing || std::abs(along.dot(way)) > spacing) continue;
    farthest = std::max(farthest, beyond);
  }
  return fade(farthest, 0.0, spacing);
}

Vec3 RimColumns::restOf(const Contact& contact) const {
  const TissueSurface& surface = world_.tissue.surface();
  const MeshTriangle& corners = surface.triangles[at(contact.place.triangle)];
  Vec3 rest = Vec3::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    rest += contact.place.barycentric[static_cast<int>(k)] * surface.rest[at(corners[k])];
  }
  return rest;
}

// Those around a point at rest (m), and its bilinear weights between them.
std::vector<std::pair<NodeColumn, double>> RimColumns::weightsAt(const Vec3& rest, int axis) const {
  const Lattice& lattice = world_.tissue.lattice();
  const std::array<int, 3> index = lattice.gridIndex(0);
  const Vec3 off = (rest - lattice.restPosition(0)) / lattice.spacing();
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const double x = off[u] + index[at(u)], y = off[v] + index[at(v)];
  const int i = static_cast<int>(std::floor(x)), j = static_cast<int>(std::floor(y));
  std::vector<std::pair<NodeColumn, double>> columns;
  for (const auto& [di, dj] : {std::pair(0, 0), {0, 1}, {1, 0}, {1, 1}}) {
    const double weight = (1.0 - std::abs(x - i - di)) * (1.0 - std::abs(y - j - dj));
    if (weight > tuning::kNoWeight) columns.push_back({{axis, i + di, j + dj}, weight});
  }
  return columns;
}

// Of a column at rest (m), as high along it as a point.
Vec3 RimColumns::placeOf(const NodeColumn& column, const Vec3& rest) const {
  const Lattice& lattice = world_.tissue.lattice();
  const std::array<int, 3> index = lattice.gridIndex(0);
  const Vec3 first = lattice.restPosition(0);
  Vec3 place = rest;
  for (int k = 1; k < 3; ++k) {
    const int across = (column[0] + k) % 3;
    const int steps = column[at(k)] - index[at(across)];
    place[across] = first[across] + steps * lattice.spacing();
  }
  return place;
}

std::vector<RimColumn> RimColumns::around(const Contact& contact) const {
  std::vector<RimColumn> columns;
  const auto axis = state_.axes.find(contact.link);
  if (axis == state_.axes.end()) return columns;
  for (const auto& [line, weight] : weightsAt(restOf(contact), axis->second)) {
    const auto found = state_.columns.find({contact.link, line});
    if (found == state_.columns.end() || found->second.normal <= 0.0) continue;
    const Column& column = found->second;
    columns.push_back({line, weight, column.share, column.normal, column.friction});
  }
  return columns;
}

}  // namespace robot_tissue
