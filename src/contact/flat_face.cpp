#include "flat_face.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "shape_face.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

bool isLessDeep(const FaceEdge& a, const FaceEdge& b) {
  return std::abs(a.depth_m) < std::abs(b.depth_m);
}

bool isOfKnownSide(const Vec3& outward, const std::vector<FaceEdge>& known) {
  return std::any_of(known.begin(), known.end(), [&](const FaceEdge& edge) {
    return edge.outward.dot(outward) >= tuning::kOtherSide;
  });
}

// Of each side the nearest, the nearest of all first.
std::vector<FaceEdge> nearestOfSides(std::vector<FaceEdge> edges) {
  std::stable_sort(edges.begin(), edges.end(), isLessDeep);
  std::vector<FaceEdge> nearest;
  for (const FaceEdge& edge : edges) {
    if (!isOfKnownSide(edge.outward, nearest)) nearest.push_back(edge);
  }
  return nearest;
}

// A shape's face in the tissue's frame.
struct Part {
  std::size_t shape = 0;
  ShapeFace face;
  double inside = 0.0;  // m: how far the point is inside the face's edges; < 0: beside them
};

double leastDepth(const ShapeFace& face) {
  double least = std::numeric_limits<double>::infinity();
  for (const ShapeFace::Edge& edge : face.edges) least = std::min(least, edge.depth_m);
  return least;
}

// Beside a corner the point is farther than from the lines of both edges.
double insideOf(const ShapeFace& face, const Vec3& point) {
  double inside = leastDepth(face);
  if (inside >= 0.0) return inside;
  inside = -std::numeric_limits<double>::infinity();
  for (const ShapeFace::Edge& edge : face.edges) {
    if (edge.depth_m >= 0.0) continue;
    const Vec3 way = point - edge.foot;
    inside = std::max(inside, -(way - face.normal.dot(way) * face.normal).norm());
  }
  return inside;
}

// The faces of a link's shapes at a point, joined where they are parts of one: an edge beyond which
// another shape goes on is none, and the edges of that shape's face, as far as it is in the same
// plane, are looked at in its place.
class JoinedFaces {
 public:
  JoinedFaces(const PlacedLink& link, const Vec3& facing, const Vec3& point, double reach)
      : link_(link), reach_(reach), felt_(tuning::kFeltOfReach * reach) {
    for (std::size_t i = 0; i < link.size(); ++i) addPart(i, facing, point);
    std::stable_sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
      const double difference = std::abs(a.face.height_m) - std::abs(b.face.height_m);
      return difference < 0.0 || (difference == 0.0 && a.inside > b.inside);
    });
  }

  std::optional<FlatFace> nearest() const {
    for (const Part& part : parts_) {
      if (leastDepth(part.face) < -reach_) continue;
      const Part& under = deepestBeside(part);
      FlatFace face{under.face.normal, under.face.height_m, static_cast<int>(under.shape),
                    link_[under.shape].shape->padding(), nearestOfSides(edgesAround(under))};
      if (!face.edges.empty()) return face;
    }
    return std::nullopt;
  }

 private:
  // At a face, from the base or across the edge of another that looks that way.
  struct Look {
    const Part* part = nullptr;
    Vec3 way = Vec3::Zero();  // unit; zero: the base
  };
  // An edge beyond which other faces go on.
  struct Joint {
    FaceEdge edge;
    std::vector<const Part*> parts;
    bool is_seen = false;
  };
  // Of a part.
  struct Ends {
    std::vector<FaceEdge> edges;
    std::vector<Joint> joints;
  };

  void addPart(std::size_t shape, const Vec3& facing, const Vec3& point) {
    const PlacedShape& placed = link_[shape];
    if (!hasFlatFaces(*placed.shape)) return;
    auto face = faceOf(*placed.shape, placed.shape_T_tissue.linear() * facing,
                       placed.shape_T_tissue * point, reach_);
    if (!face || std::abs(face->height_m) > reach_) return;
    face->normal = placed.tissue_T_shape.linear() * face->normal;
    for (ShapeFace::Edge& edge : face->edges) {
      edge.outward = placed.tissue_T_shape.linear() * edge.outward;
      edge.foot = placed.tissue_T_shape * edge.foot;
    }
    const double inside = insideOf(*face, point);
    parts_.push_back({shape, std::move(*face), inside});
  }

  bool areOfOnePlane(const Part& a, const Part& b) const {
    return a.face.normal.dot(b.face.normal) >= tuning::kFaces &&
           std::abs(a.face.height_m - b.face.height_m) <= tuning::kTurnsAway * felt_;
  }

  // Of the faces in the part's plane the one that the point is deepest inside.
  const Part& deepestBeside(const Part& part) const {
    const Part* deepest = &part;
    for (const Part& other : parts_) {
      if (areOfOnePlane(part, other) && other.inside > deepest->inside) {
        deepest = &other;
      }
    }
    return *deepest;
  }

  // Whether the shape is there, a length beyond the edge in the plane of its face.
  bool goesOn(std::size_t shape, const Part& part, const ShapeFace::Edge& edge,
              double beyond) const {
    const PlacedShape& other = link_[shape];
    const double padding = link_[part.shape].shape->padding();
    const Vec3 probe = edge.foot + padding * part.face.normal + (padding + beyond) * edge.outward;
    return other.shape->distanceNear(other.shape_T_tissue * probe, tuning::kTurnsAway * beyond)
        .has_value();
  }

  // Whether the edge is inside the shape, as that of a shaft's end is in a ball on it.
  bool isBuriedIn(std::size_t shape, const Part& part, const ShapeFace::Edge& edge) const {
    const PlacedShape& other = link_[shape];
    const double off = tuning::kJustBeyond * felt_;
    const double padding = link_[part.shape].shape->padding();
    const Vec3 probe = edge.foot + (padding + off) * part.face.normal - off * edge.outward;
    return other.shape->distanceNear(other.shape_T_tissue * probe, 0.0).has_value();
  }

  // Edges of all faces that are one with that of the base, as far as the point sees them from it.
  std::vector<FaceEdge> edgesAround(const Part& base) const {
    std::vector<FaceEdge> edges;
    std::vector<std::optional<Ends>> ends(parts_.size());
    std::vector<Look> looks = {{&base, Vec3::Zero()}};
    while (!looks.empty()) {
      const Look look = looks.back();
      looks.pop_back();
      std::optional<Ends>& here = ends[static_cast<std::size_t>(look.part - parts_.data())];
      if (!here) here = endsOf(*look.part, base);
      for (const FaceEdge& edge : here->edges) {
        if (sees(look, edge)) edges.push_back(edge);
      }
      for (Joint& joint : here->joints) {
        if (joint.is_seen || !sees(look, joint.edge)) continue;
        joint.is_seen = true;
        for (const Part* part : joint.parts) looks.push_back({part, joint.edge.outward});
      }
    }
    return edges;
  }

  static bool sees(const Look& look, const FaceEdge& edge) {
    const bool is_first = look.way.isZero(0.0);
    return is_first || (edge.depth_m >= 0.0 && edge.outward.dot(look.way) > tuning::kSameWay);
  }

  // Edges within reach. Where one ends the face, those behind it are not asked for: of meshes they
  // may be many.
  Ends endsOf(const Part& part, const Part& base) const {
    std::vector<ShapeFace::Edge> near = part.face.edges;
    std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) {
      return std::abs(a.depth_m) < std::abs(b.depth_m);
    });
    Ends ends;
    for (const ShapeFace::Edge& edge : near) {
      if (std::abs(edge.depth_m) > reach_ || isOfKnownSide(edge.outward, ends.edges)) continue;
      const FaceEdge plain{edge.outward, edge.depth_m};
      std::vector<const Part*> joined;
      if (endsAt(part, edge, base, joined)) {
        ends.edges.push_back(plain);
      } else if (!joined.empty()) {
        ends.joints.push_back({plain, std::move(joined)});
      }
    }
    return ends;
  }

  // Whether no other shape goes on beyond the edge, or is around it; else the faces that go on.
  bool endsAt(const Part& part, const ShapeFace::Edge& edge, const Part& base,
              std::vector<const Part*>& joined) const {
    bool ends = true;
    for (std::size_t shape = 0; shape < link_.size(); ++shape) {
      if (shape == part.shape) continue;
      if (isBuriedIn(shape, part, edge)) return false;
      const Part* other = partOf(shape, base);
      const bool goes_on =
          goesOn(shape, part, edge, felt_) ||
          (other != nullptr && goesOn(shape, part, edge, tuning::kJustBeyond * felt_));
      if (!goes_on) continue;
      ends = false;
      if (other != nullptr) joined.push_back(other);
    }
    return ends;
  }

  // The shape's face if it is in the plane of the base.
  const Part* partOf(std::size_t shape, const Part& base) const {
    const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const Part& part) {
      return part.shape == shape && areOfOnePlane(part, base);
    });
    return found == parts_.end() ? nullptr : &*found;
  }

  const PlacedLink& link_;
  const double reach_;
  const double felt_;
  std::vector<Part> parts_;
};

std::optional<FlatFace> faceOfOne(const PlacedShape& placed, const Vec3& facing, const Vec3& point,
                                  double reach) {
  const auto found = faceOf(*placed.shape, placed.shape_T_tissue.linear() * facing,
                            placed.shape_T_tissue * point, reach);
  if (!found || std::abs(found->height_m) > reach) return std::nullopt;
  std::vector<FaceEdge> edges;
  for (const ShapeFace::Edge& edge : found->edges) {
    if (edge.depth_m < -reach) return std::nullopt;  // the point is beside the face
    if (edge.depth_m <= reach) edges.push_back({edge.outward, edge.depth_m});
  }
  edges = nearestOfSides(std::move(edges));
  if (edges.empty()) return std::nullopt;
  for (FaceEdge& edge : edges) edge.outward = placed.tissue_T_shape.linear() * edge.outward;
  return FlatFace{placed.tissue_T_shape.linear() * found->normal, found->height_m, 0,
                  placed.shape->padding(), edges};
}

}  // namespace

std::optional<FlatFace> flatFaceOf(const PlacedLink& link, const Vec3& facing, const Vec3& point,
                                   double reach) {
  if (link.size() == 1) return faceOfOne(link.front(), facing, point, reach);
  return JoinedFaces(link, facing, point, reach).nearest();
}

}  // namespace robot_tissue
