#include "robot_tissue/pipeline/pipeline.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace robot_tissue {
namespace {

constexpr int kMostSubsteps = 200;
constexpr std::size_t kMostCheckpoints = 64;
constexpr int kPushPasses = 4;         // a curved tool's way out turns as the surface moves
constexpr int kContactRounds = 3;      // nodes that the solve moved into the tool are pushed again
constexpr double kDeepEnough = 0.01;   // of the spacing: penetration that is worth another round
constexpr double kTouches = 0.02;      // of the spacing: a gap that is none
constexpr double kStandsStill = 1e-3;  // of the spacing: a motion that is none

class Stopwatch {
 public:
  explicit Stopwatch(double& total_ms) : total_ms_(total_ms) {}
  ~Stopwatch() {
    const std::chrono::duration<double, std::milli> elapsed =
        std::chrono::steady_clock::now() - start_;
    total_ms_ += elapsed.count();
  }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_ms_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<std::string> namesOf(const std::vector<ToolGeometry>& tools) {
  std::vector<std::string> names;
  for (const ToolGeometry& tool : tools) names.push_back(tool.name);
  return names;
}

double touchMargin(double spacing) { return kTouches * spacing; }

double deepest(const ContactSet& contacts) {
  double depth = 0.0;
  for (const Contact& contact : contacts.contacts) depth = std::max(depth, contact.depth_m);
  return depth;
}

// Longest way (m) that a point of the tool goes between two poses.
double motion(const Pose& from, const Pose& to, double reach) {
  const double angle = Eigen::AngleAxisd(from.linear().transpose() * to.linear()).angle();
  return (to.translation() - from.translation()).norm() + std::abs(angle) * reach;
}

RobotPose between(const RobotPose& from, const RobotPose& to, double share) {
  RobotPose between = to;
  for (std::size_t tool = 0; tool < to.tools.size(); ++tool) {
    const Pose& start = from.tools[tool];
    const Pose& end = to.tools[tool];
    Pose& pose = between.tools[tool];
    pose.linear() = Eigen::Quaterniond(start.linear())
                        .slerp(share, Eigen::Quaterniond(end.linear()))
                        .toRotationMatrix();
    pose.translation() = start.translation() + share * (end.translation() - start.translation());
  }
  return between;
}

Pose farAway() {
  Pose pose = Pose::Identity();
  pose.translation().setConstant(1e6);  // m
  return pose;
}

void requireFinite(const RobotPose& pose) {
  for (const Pose& tool : pose.tools) {
    if (!tool.matrix().allFinite()) {
      throw InputError("pose: a tool's transform is not finite; allowed: finite numbers");
    }
  }
}

}  // namespace

Pipeline::Pipeline(const TissueConfig& tissue, const SolverConfig& solver,
                   const std::vector<ToolGeometry>& tools)
    : tissue_(tissue, solver),
      finder_(tools, touchMargin(tissue.spacing)),
      patches_(tissue_.lattice(), namesOf(tools)) {
  report_.tools.resize(tools.size());
}

void Pipeline::setTools(const std::vector<ToolGeometry>& tools) {
  finder_ = ContactFinder(tools, touchMargin(tissue_.lattice().spacing()));
  patches_ = ToolPatches(tissue_.lattice(), namesOf(tools));
  if (!tissue_.isUntouched()) tissue_.follow({}, {});
  last_pose_.reset();
  checkpoints_.clear();
  touched_ = true;
  report_ = StepReport();
  report_.tools.resize(tools.size());
}

const StepReport& Pipeline::step(const RobotPose& pose) {
  requireFinite(pose);
  report_.changed = touched_;
  report_.too_fast = false;
  report_.contact_ms = 0.0;
  report_.solve_ms = 0.0;
  report_.substeps = 0;
  if (standsStill(pose) && !touched_) {
    if (tissue_.lastReport().status == SolveStatus::kLate) carryOn();
    return report_;
  }
  report_.changed = report_.changed || !tissue_.isUntouched();
  if (checkpoints_.empty()) startAnew(pose);
  goBackTo(pose);
  last_pose_ = walk(pose);
  touched_ = report_.too_fast;  // there is a way left to go
  return report_;
}

// Whole load steps, each kept, and the rest of the way. Returns how far it came in time.
RobotPose Pipeline::walk(const RobotPose& pose) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::duration<double>(budget_s_);
  const RobotPose start = checkpoints_.back().pose;
  const double steps = longestWay(start, pose) / tissue_.stepLength();
  for (int step = 1; step <= static_cast<int>(steps); ++step) {
    const RobotPose on_the_way = between(start, pose, step / steps);
    advance(on_the_way);
    checkIn(on_the_way);
    if (std::chrono::steady_clock::now() > deadline) {
      report_.too_fast = true;
      return on_the_way;
    }
  }
  advance(pose);
  if (tissue_.isUntouched()) checkIn(pose);
  return pose;
}

// One load step, the line of the package. A second round only if the solve moved nodes into a tool.
void Pipeline::advance(const RobotPose& pose) {
  ++report_.substeps;
  ContactSet contacts;
  for (int round = 0; round < kContactRounds; ++round) {
    patches_.ride(pose, tissue_);  // patches move with their tools
    pushToolsOut(pose);            // robot pose -> contacts -> loading patches
    if (tissue_.isUntouched() && patches_.empty()) break;
    solve();  // loading patches -> solve
    contacts = contactsAt(pose, tissue_.state().displacement);
    if (deepest(contacts) <= kDeepEnough * tissue_.lattice().spacing()) break;
  }
  describeTools(pose, contacts);
}

// What the last solve had no time for.
void Pipeline::carryOn() {
  if (!tissue_.isUntouched()) return advance(*last_pose_);
  const Stopwatch watch(report_.solve_ms);
  tissue_.settle();
  report_.changed = true;
}

void Pipeline::solve() {
  const Stopwatch watch(report_.solve_ms);
  tissue_.follow(patches_.loadingPatches(), patches_.left());
  report_.changed = true;
}

void Pipeline::reset() {
  patches_.clear();
  tissue_.reset();
  checkpoints_.clear();
  touched_ = true;
}

ContactSet Pipeline::contactsAt(const RobotPose& pose, const std::vector<Vec3>& displacement) {
  const Stopwatch watch(report_.contact_ms);
  deform(tissue_.surface(), displacement, vertices_);
  return finder_.find(pose, tissue_.surface(), vertices_);
}

void Pipeline::pushToolsOut(const RobotPose& pose) {
  for (int pass = 0; pass < kPushPasses; ++pass) {
    const ContactSet contacts = contactsAt(pose, patches_.displacement());
    if (pass == 0) patches_.keepTouching(contacts, tissue_);
    if (deepest(contacts) <= 0.0) return;
    patches_.pushOut(contacts, tissue_.surface(), pose);
  }
}

void Pipeline::touch() {
  touched_ = true;
  checkpoints_.clear();
  if (last_pose_) checkIn(*last_pose_);
}

void Pipeline::checkIn(const RobotPose& pose) {
  if (tissue_.isUntouched()) checkpoints_.clear();
  if (checkpoints_.size() >= kMostCheckpoints) checkpoints_.erase(checkpoints_.begin());
  checkpoints_.push_back({pose, tissue_.shape(), patches_.seats()});
}

// Takes up the shape at the checkpoint nearest to the pose, and drops the later ones.
void Pipeline::goBackTo(const RobotPose& pose) {
  std::size_t nearest = checkpoints_.size() - 1;
  double shortest = longestWay(checkpoints_[nearest].pose, pose);
  for (std::size_t earlier = nearest; earlier-- > 0;) {
    const double way = longestWay(checkpoints_[earlier].pose, pose);
    if (way < shortest) {
      shortest = way;
      nearest = earlier;
    }
  }
  checkpoints_.erase(checkpoints_.begin() + static_cast<std::ptrdiff_t>(nearest) + 1,
                     checkpoints_.end());
  tissue_.restore(checkpoints_.back().shape);
  patches_.restore(checkpoints_.back().seats);
  if (shortest > kMostSubsteps * tissue_.stepLength()) {
    report_.too_fast = true;
    startAnew(pose);
  }
}

// The tools let go, and come in from outside.
void Pipeline::startAnew(const RobotPose& pose) {
  patches_.clear();
  if (!tissue_.isUntouched()) tissue_.follow({}, {});
  checkpoints_.clear();
  checkIn(outside(pose));
}

// Each tool drawn back from the pose, step by step, until it is out of the tissue.
RobotPose Pipeline::outside(const RobotPose& pose) {
  RobotPose drawn_back = pose;
  for (std::size_t tool = 0; tool < pose.tools.size(); ++tool) {
    Vec3 way = wayOut(tool, pose.tools[tool]);
    for (int step = 0; step < kMostSubsteps && !way.isZero(); ++step) {
      drawn_back.tools[tool].translation() += tissue_.stepLength() * way;
      if (wayOut(tool, drawn_back.tools[tool]).isZero()) break;
    }
  }
  return drawn_back;
}

// Unit direction out of the tissue for a tool that is in it; zero for one that is outside. Against
// the contacts' normals; for a tool wholly beneath the surface, to the nearest side.
Vec3 Pipeline::wayOut(std::size_t tool, const Pose& tissue_T_tool) {
  RobotPose alone;
  alone.tools.assign(report_.tools.size(), farAway());
  alone.tools[tool] = tissue_T_tool;
  Vec3 way = Vec3::Zero();
  for (const Contact& contact :
       finder_.find(alone, tissue_.surface(), tissue_.vertices()).contacts) {
    way -= std::max(0.0, contact.depth_m) * contact.normal;
  }
  if (way.norm() > 0.0) return way.normalized();
  const Box box = tissue_.lattice().bounds();
  const Vec3 center = tissue_T_tool * finder_.center(tool);
  const Vec3 below = center - box.min, above = box.max - center;
  if (finder_.reach(tool) <= 0.0 ||
      !encloses(tissue_.vertices(), tissue_.surface().triangles, center)) {
    return way;
  }
  Eigen::Index low = 0, high = 0;
  const bool downwards = below.minCoeff(&low) < above.minCoeff(&high);
  return downwards ? Vec3(-Vec3::Unit(low)) : Vec3(Vec3::Unit(high));
}

bool Pipeline::standsStill(const RobotPose& pose) const {
  return last_pose_ && longestWay(*last_pose_, pose) <= kStandsStill * tissue_.lattice().spacing();
}

double Pipeline::longestWay(const RobotPose& from, const RobotPose& to) const {
  double longest = 0.0;
  for (std::size_t tool = 0; tool < to.tools.size(); ++tool) {
    longest = std::max(longest, motion(from.tools[tool], to.tools[tool], finder_.reach(tool)));
  }
  return longest;
}

void Pipeline::describeTools(const RobotPose& pose, const ContactSet& contacts) {
  for (std::size_t tool = 0; tool < report_.tools.size(); ++tool) {
    ToolReport report;
    const Pose& tissue_T_tool = pose.tools[tool];
    report.nodes = patches_.nodes(static_cast<int>(tool));
    report.normal = patches_.normal(static_cast<int>(tool), tissue_T_tool);
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const int node : report.nodes) {
      const Vec3 position = tissue_.nodePosition(node);
      const Vec3 node_force = tissue_.nodeForce(node);
      report.point += position / static_cast<double>(report.nodes.size());
      force += node_force;
      torque += (position - tissue_T_tool.translation()).cross(node_force);
    }
    report.force_on_tool = tissue_T_tool.linear().transpose() * force;
    report.torque_on_tool = tissue_T_tool.linear().transpose() * torque;
    for (const Contact& contact : contacts.contacts) {
      if (contact.tool != static_cast<int>(tool)) continue;
      report.max_penetration = std::max(report.max_penetration, contact.depth_m);
    }
    report_.tools[tool] = std::move(report);
  }
}

}  // namespace robot_tissue
