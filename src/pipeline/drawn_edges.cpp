#include "drawn_edges.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr double kEverywhere = std::numeric_limits<double>::infinity();

// Faces under vertices, each looked for once.
class Faces {
 public:
  Faces(const std::set<int>& touching, const FaceUnder& face_under)
      : touching_(touching), face_under_(face_under) {
    known_.reserve(4 * touching.size());
  }

  bool isTouched(int vertex) const { return touching_.count(vertex) != 0; }

  const std::optional<FlatFace>& under(int vertex) {
    const auto known = known_.find(vertex);
    if (known != known_.end()) return known->second;
    return known_.emplace(vertex, face_under_(vertex)).first->second;
  }

  bool isOnFace(int vertex) {
    const std::optional<FlatFace>& face = under(vertex);
    return face && leastDepth(*face) > 0.0;
  }

  // Inside the edge that another point of the face has, as this vertex sees it; where it sees none
  // that runs alike, it is far inside, or beyond.
  double depthIn(const FaceEdge& of_other, int vertex) {
    const std::optional<FlatFace>& face = under(vertex);
    if (!face) return -kEverywhere;
    const FaceEdge* likest = nullptr;
    double most = tuning::kSameEdge;
    for (const FaceEdge& edge : face->edges) {
      const double cosine = edge.outward.dot(of_other.outward);
      if (cosine <= most) continue;
      most = cosine;
      likest = &edge;
    }
    return likest != nullptr ? likest->depth_m : kEverywhere;
  }

 private:
  const std::set<int>& touching_;
  const FaceUnder& face_under_;
  std::unordered_map<int, std::optional<FlatFace>> known_;
};

// Than a neighbor on the other side of it, or than any that is not touched; of two as near the one
// with the lower number. Beyond a corner neither is on the face.
bool isNearest(int vertex, const FaceEdge& edge, const std::vector<int>& neighbors, Faces& faces) {
  return std::any_of(neighbors.begin(), neighbors.end(), [&](int other) {
    const double depth = faces.depthIn(edge, other);
    if ((depth > 0.0) == (edge.depth_m > 0.0)) return false;
    if (!faces.isTouched(other)) return edge.depth_m > 0.0 || faces.isOnFace(other);
    const double nearer = std::abs(depth) - std::abs(edge.depth_m);
    return nearer > 0.0 || (nearer == 0.0 && vertex < other);
  });
}

// The edges that the vertex is drawn on: one, or two with a corner. None where it is beyond others.
std::vector<FaceEdge> edgesUnder(int vertex, const FlatFace& face,
                                 const std::vector<int>& neighbors, double farthest, Faces& faces) {
  std::vector<FaceEdge> on;
  for (const FaceEdge& edge : face.edges) {
    const bool is_nearest =
        std::abs(edge.depth_m) <= farthest && isNearest(vertex, edge, neighbors, faces);
    if (!is_nearest && edge.depth_m <= 0.0) return {};
    const bool has_corner =
        on.empty() || std::abs(edge.outward.dot(on.front().outward)) < tuning::kParallelEdges;
    if (is_nearest && has_corner && on.size() < 2) on.push_back(edge);
  }
  return on;
}

DrawnAt drawnAt(const Vec3& place, const Vec3& face_normal, const std::vector<FaceEdge>& edges) {
  DrawnAt drawn;
  const FaceEdge& first = edges.front();
  if (edges.size() == 1) {
    drawn.place = place + first.depth_m * first.outward;
    drawn.outward = first.outward;
    drawn.aside = tuning::kDrawnAside * first.outward * first.outward.transpose();
    return drawn;
  }
  const FaceEdge& second = edges.back();
  const double cosine = first.outward.dot(second.outward), sine_squared = 1.0 - cosine * cosine;
  drawn.place = place + (first.depth_m - cosine * second.depth_m) / sine_squared * first.outward +
                (second.depth_m - cosine * first.depth_m) / sine_squared * second.outward;
  drawn.aside =
      tuning::kDrawnAside * (Eigen::Matrix3d::Identity() - face_normal * face_normal.transpose());
  return drawn;
}

// Distance of a point from the straight line between two others (m).
double offLine(const Vec3& point, const Vec3& from, const Vec3& to) {
  const Vec3 along = to - from;
  const double length = along.norm();
  return length > 0.0 ? along.cross(point - from).norm() / length : (point - from).norm();
}

// Whether two neighbors of each other that are drawn on a round edge leave out the part of it
// that is next to the vertex.
bool isLeftOut(int vertex, const Vec3& on_edge, const std::vector<std::vector<int>>& neighbors,
               const std::map<int, DrawnAt>& drawn, double least) {
  std::vector<std::pair<int, Vec3>> around;
  for (const int other : neighbors[at(vertex)]) {
    const auto there = drawn.find(other);
    if (there != drawn.end()) around.emplace_back(other, there->second.place);
  }
  for (std::size_t i = 0; i < around.size(); ++i) {
    const std::vector<int>& beside = neighbors[at(around[i].first)];
    for (std::size_t j = 0; j < i; ++j) {
      if (std::find(beside.begin(), beside.end(), around[j].first) == beside.end()) continue;
      if (offLine(on_edge, around[i].second, around[j].second) > least) return true;
    }
  }
  return false;
}

// Those that the first pass leaves out.
void drawBetween(const std::set<int>& touching, const std::vector<std::vector<int>>& neighbors,
                 const std::vector<Vec3>& places, double spacing, Faces& faces,
                 std::map<int, DrawnAt>& drawn) {
  std::map<int, DrawnAt> between;
  for (const int vertex : touching) {
    const std::optional<FlatFace>& face = faces.under(vertex);
    if (!face || drawn.count(vertex) != 0) continue;
    const FaceEdge& edge = face->edges.front();
    if (edge.depth_m > 0.0 || edge.depth_m < -tuning::kFarthestDrawn * spacing) continue;
    const DrawnAt there = drawnAt(places[at(vertex)], face->normal, {edge});
    const double least = tuning::kLeftOut * spacing;
    if (isLeftOut(vertex, there.place, neighbors, drawn, least)) between[vertex] = there;
  }
  drawn.merge(between);
}

// An arc over a chord of length L, whose normal turns by t, rises by L / 2 tan(t / 4) over it.
void bulgeOnRoundEdges(const std::vector<std::vector<int>>& neighbors,
                       std::map<int, DrawnAt>& drawn) {
  std::map<int, double> rises;
  for (const auto& [vertex, here] : drawn) {
    double sum = 0.0;
    int count = 0;
    for (const int other : neighbors[at(vertex)]) {
      const auto there = drawn.find(other);
      if (there == drawn.end()) continue;
      const double cosine = here.outward.dot(there->second.outward);
      if (cosine < tuning::kSameEdge) continue;
      const double turn = std::acos(std::min(cosine, 1.0));
      sum += 0.5 * (there->second.place - here.place).norm() * std::tan(0.25 * turn);
      ++count;
    }
    if (count > 0) rises[vertex] = sum / count;
  }
  for (const auto& [vertex, rise] : rises)
    drawn[vertex].place += 0.5 * rise * drawn[vertex].outward;
}

}  // namespace

double leastDepth(const FlatFace& face) {
  double least = kEverywhere;
  for (const FaceEdge& edge : face.edges) least = std::min(least, edge.depth_m);
  return least;
}

std::map<int, DrawnAt> drawnAtEdges(const std::set<int>& touching,
                                    const std::vector<std::vector<int>>& neighbors,
                                    const std::vector<Vec3>& places, const FaceUnder& face_under,
                                    double spacing) {
  std::map<int, DrawnAt> all;
  Faces faces(touching, face_under);
  for (const int vertex : touching) {
    const std::optional<FlatFace>& face = faces.under(vertex);
    if (!face) continue;
    const std::vector<FaceEdge> edges =
        edgesUnder(vertex, *face, neighbors[at(vertex)], tuning::kFarthestDrawn * spacing, faces);
    if (!edges.empty()) all[vertex] = drawnAt(places[at(vertex)], face->normal, edges);
  }
  drawBetween(touching, neighbors, places, spacing, faces, all);
  bulgeOnRoundEdges(neighbors, all);
  return all;
}

}  // namespace robot_tissue
