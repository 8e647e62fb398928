#include "landing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "robot_tissue/core/carriers.h"
#include "tuning.h"

namespace robot_tissue {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

// From the point along the unit direction to the support's solid side (m), kNowhere: past it; both
// in the support's frame.
double wayToPlane(const Vec3& point, const Vec3& direction) {
  if (point.z() <= 0.0) return 0.0;
  return direction.z() < 0.0 ? -point.z() / direction.z() : kNowhere;
}

// Where the line is in all three pairs of the box's planes (slabs: Kay and Kajiya 1986).
double wayToBox(const Vec3& size, const Vec3& point, const Vec3& direction) {
  double enters = 0.0;
  double leaves = kNowhere;
  for (int axis = 0; axis < 3; ++axis) {
    const double half = 0.5 * size[axis];
    if (direction[axis] == 0.0) {
      if (std::abs(point[axis]) > half) return kNowhere;
      continue;
    }
    const double to_low = (-half - point[axis]) / direction[axis];
    const double to_high = (half - point[axis]) / direction[axis];
    enters = std::max(enters, std::min(to_low, to_high));
    leaves = std::min(leaves, std::max(to_low, to_high));
  }
  return enters <= leaves ? enters : kNowhere;
}

// Of the elastic waves (s): what damps the tissue's own swings within one of them.
double dampingTime(const TissueConfig& tissue, double extent) {
  const double wave_speed = std::sqrt(tissue.material.young_modulus / tissue.material.density);
  return tuning::kLandingDamping * extent / wave_speed;
}

double farthestBetween(const std::vector<Vec3>& one, const std::vector<Vec3>& other) {
  double farthest = 0.0;
  for (std::size_t node = 0; node < one.size(); ++node) {
    farthest = std::max(farthest, (one[node] - other[node]).squaredNorm());
  }
  return std::sqrt(farthest);
}

}  // namespace

std::unique_ptr<const Landing> Landing::ofScene(const TissueConfig& tissue,
                                                const SolverConfig& solver,
                                                const std::vector<SupportConfig>& supports) {
  const bool falls = !tissue.gravity.isZero(0.0) && !supports.empty();
  const bool may_go_in_time = !tissue.time && tissue.membranes.empty();
  return falls && may_go_in_time ? std::make_unique<const Landing>(tissue, solver, supports)
                                 : nullptr;
}

Landing::Landing(const TissueConfig& tissue, const SolverConfig& solver,
                 std::vector<SupportConfig> supports)
    : tissue_(tissue), solver_(solver), supports_(std::move(supports)) {
  tissue_.time = TimeConfig();
  tissue_.free_pieces = FreePieces::kStay;
  tissue_.material.tear_stretch = 0.0;
  for (Region& region : tissue_.regions) region.material.tear_stretch = 0.0;
  solver_.method = "layered";
  solver_.max_ms = 0.0;
  solver_.tolerance = std::max(solver_.tolerance, tuning::kLandingTolerance);
}

Landing::End Landing::from(const Tissue& tissue, const Deadline& end, const Lies& lies) const {
  const Tissue::Displacements start = lowered(tissue);
  if (start == nullptr) return End::kNothingBelow;
  const double extent = tissue.bounds().sizes().maxCoeff();
  TissueConfig config = tissue_;
  config.time->damping_time = dampingTime(config, extent);
  Pipeline in_time(config, solver_, {}, supports_);
  in_time.limitPatience(tuning::kLandingPatience);
  in_time.startClock(0.0);
  in_time.setEnd(end);
  in_time.takeOver(tissue, start);
  const Vec3 middle = in_time.tissue().bounds().center();
  const auto is_near = [&] {
    return (in_time.tissue().bounds().center() - middle).norm() < tuning::kFarthestLanding * extent;
  };
  // What is about to topple grows by e in about the time in which it falls its extent.
  double next_look = tuning::kFirstLook * std::sqrt(extent / tissue_.gravity.norm());
  double last_way = 0.0;
  for (double gone = 0.0; gone < tuning::kLongestLanding && is_near() && !end.isOver();) {
    const Tissue::Displacements before = in_time.tissue().displacements();
    in_time.wait(tuning::kLandingPause);
    gone += tuning::kLandingPause;
    const Tissue::Displacements now = in_time.tissue().displacements();
    const bool rests = !in_time.tissue().isMoving();
    const bool ends = rests || in_time.report().hopeless;
    const double way = farthestBetween(*before, *now);
    const bool may_lie = gone >= next_look && way < std::min(slowWay(), last_way);
    if (rests || ends || may_lie) {
      const Look look = rests ? Look::kAtRest : ends ? Look::kLast : Look::kOnItsWay;
      if (lies(now, look)) return End::kLies;
      next_look = tuning::kLaterLook * gone;
    }
    if (ends) break;
    last_way = way;
  }
  return End::kGoesOn;
}

// m, in a pause: so fast is what fell a share of the spacing.
double Landing::slowWay() const {
  const double height = tuning::kSlowLanding * tissue_.spacing;
  return tuning::kLandingPause * std::sqrt(2.0 * tissue_.gravity.norm() * height);
}

// Whether there is tissue below one of these pieces: it would fall through that, as tissue is not
// looked for on tissue. By boxes that stand upright, less half a spacing where cuts parted them.
bool Landing::anyLiesOnTissue(const Tissue& tissue, const std::map<int, double>& pieces) const {
  const Eigen::Matrix3d upright =
      Eigen::Quaterniond::FromTwoVectors(tissue_.gravity, -Vec3::UnitZ()).toRotationMatrix();
  std::map<int, Box> boxes;
  const std::vector<int>& piece_of = tissue.pieceOfNodes();
  for (std::size_t node = 0; node < piece_of.size(); ++node) {
    if (piece_of[node] < 0) continue;
    boxes[piece_of[node]].extend(upright * tissue.nodePosition(static_cast<int>(node)));
  }
  const double slack = 0.5 * tissue_.spacing;
  const auto is_below = [&](const Box& lower, const Box& upper) {
    const Vec3 overlap = lower.max().cwiseMin(upper.max()) - lower.min().cwiseMax(upper.min());
    return overlap.x() > slack && overlap.y() > slack && lower.min().z() < upper.min().z() - slack;
  };
  for (const auto& [number, clearance] : pieces) {
    for (const auto& [other, box] : boxes) {
      if (other != number && is_below(box, boxes[number])) return true;
    }
  }
  return false;
}

// Pieces that hang, down to where one of their vertices is a spacing above a support: what falls
// from high up is fast, and soft tissue that meets a table so is crushed. Null: one has none below.
Tissue::Displacements Landing::lowered(const Tissue& tissue) const {
  std::map<int, double> clearances;  // by the number of the piece
  for (const TissuePiece& piece : tissue.restingPieces()) {
    if (!piece.held) clearances[piece.number] = kNowhere;
  }
  if (anyLiesOnTissue(tissue, clearances)) return nullptr;
  const std::vector<int>& piece_of = tissue.pieceOfNodes();
  const TissueSurface& surface = tissue.surface();
  for (std::size_t vertex = 0; vertex < surface.carriers.size(); ++vertex) {
    const int node = surface.carriers[vertex].front().node;
    const auto found = clearances.find(piece_of[at(node)]);
    if (found == clearances.end()) continue;
    found->second = std::min(found->second, clearance(tissue.vertices()[vertex]));
  }
  for (const auto& [piece, clearance] : clearances) {
    if (clearance == kNowhere) return nullptr;
  }
  auto lowered = std::make_shared<std::vector<Vec3>>(*tissue.displacements());
  const Vec3 down = tissue_.gravity.normalized();
  for (std::size_t node = 0; node < piece_of.size(); ++node) {
    const auto found = clearances.find(piece_of[node]);
    if (found == clearances.end()) continue;
    (*lowered)[node] += std::max(0.0, found->second - tissue_.spacing) * down;
  }
  return lowered;
}

// How far the point may fall (m).
double Landing::clearance(const Vec3& point) const {
  double nearest = kNowhere;
  for (const SupportConfig& support : supports_) {
    const Pose support_T_tissue = support.shape.pose.inverse();
    const Vec3 from = support_T_tissue * point;
    const Vec3 down = support_T_tissue.linear() * tissue_.gravity.normalized();
    const double way = support.shape.type == ToolShape::Type::kPlane
                           ? wayToPlane(from, down)
                           : wayToBox(support.shape.size, from, down);
    nearest = std::min(nearest, way);
  }
  return nearest;
}

}  // namespace robot_tissue
