#include "trial_press.h"

#include <time.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "robot_tissue/contact/contact_finder.h"
#include "robot_tissue/core/body_load.h"
#include "robot_tissue/core/deadline.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "robot_tissue/scene/memory.h"
#include "robot_tissue/scene/value_text.h"

namespace robot_tissue {
namespace {

constexpr double kDepth = 0.001;          // m
constexpr int kUpdates = 4;               // that the way in is told in
constexpr double kRadiusSpacings = 2.0;   // of the sphere: it touches some nodes. Chosen
constexpr double kSameHeight = 1e-3;      // of a link's extent (1): points of its flat end. Chosen
constexpr double kLongestUpdate = 100.0;  // ms: the node leaves what takes longer to later updates

std::string roundedText(double value) {
  if (value == 0.0) return "0";
  const double unit = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  return numberText(std::round(value / unit) * unit);
}

struct Place {
  Vec3 top = Vec3::Zero();      // of the surface (m)
  Vec3 inwards = Vec3::Zero();  // unit
};

// Outwards from the middle of what is fixed to that of the tissue; without: up.
Vec3 outwardsOf(const Tissue& tissue, const Vec3& middle) {
  Vec3 held = Vec3::Zero();
  int count = 0;
  for (int node = 0; node < tissue.lattice().nodeCount(); ++node) {
    if (!tissue.lattice().isFixed(node)) continue;
    held += tissue.lattice().restPosition(node);
    ++count;
  }
  const Vec3 away = count > 0 ? Vec3(middle - held / count) : Vec3::Zero();
  return away.norm() > 1e-6 * tissue.bounds().sizes().norm() ? away.normalized() : Vec3::UnitZ();
}

// The farthest vertex that way, in the middle rather than at the rim.
Place placeOn(const Tissue& tissue) {
  const Vec3 middle = tissue.bounds().center();
  const Vec3 outwards = outwardsOf(tissue, middle);
  Place place{middle, -outwards};
  double best = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : tissue.vertices()) {
    const Vec3 from_middle = vertex - middle;
    const double along = from_middle.dot(outwards);
    const double aside = (from_middle - along * outwards).norm();
    if (along - 2.0 * aside <= best) continue;
    best = along - 2.0 * aside;
    place.top = vertex;
  }
  return place;
}

// What is pressed: one link, touching as its tool does.
struct Body {
  std::string name;  // of the messages
  ToolGeometry tool;
  Vec3 forwards = Vec3::UnitZ();  // unit, link's frame: goes in this way
  Vec3 tip = Vec3::Zero();        // of the link that way (m), link's frame
};

// Its tip and which way it points: from the link's origin to the middle of its shapes.
void findTip(std::vector<Vec3> points, Body& body) {
  Box box;
  for (const Vec3& point : points) box.extend(point);
  const double same = kSameHeight * box.diagonal().norm();
  if (box.center().norm() > same) body.forwards = box.center().normalized();
  for (const ToolShape& shape : body.tool.links.front().shapes) {
    if (shape.type != ToolShape::Type::kSphere) continue;
    points.push_back(shape.pose.translation() + (shape.radius + shape.padding) * body.forwards);
  }
  double farthest = -std::numeric_limits<double>::infinity();
  for (const Vec3& point : points) farthest = std::max(farthest, point.dot(body.forwards));
  Vec3 sum = Vec3::Zero();
  int count = 0;
  for (const Vec3& point : points) {
    if (point.dot(body.forwards) < farthest - same) continue;
    sum += point;
    ++count;
  }
  body.tip = sum / count;
}

std::optional<Body> bodyOf(const ToolGeometry& tool) {
  for (const LinkGeometry& link : tool.links) {
    if (link.shapes.empty()) continue;
    Body body;
    body.name = "tool '" + tool.name + "'";
    if (!link.link.empty()) body.name += ", its link '" + link.link + "' with the far end first,";
    body.tool.name = tool.name;
    body.tool.patch = tool.patch;
    body.tool.friction = tool.friction;
    body.tool.links = {link};
    const ContactFinder finder({body.tool});
    const std::vector<Vec3> points = finder.surfacePoints(0);
    if (points.empty()) continue;
    findTip(points, body);
    return body;
  }
  return std::nullopt;
}

Body sphereOf(const Scene& scene) {
  ToolShape sphere;
  sphere.radius = kRadiusSpacings * scene.tissue.spacing;
  Body body;
  body.name = "a sphere of " + roundedText(1e3 * sphere.radius) + " mm radius";
  body.tool.name = "press";
  body.tool.links = {{"press", {sphere}}};
  body.tip = sphere.radius * body.forwards;
  if (scene.tissue.model == "six_spring") body.tool.patch = ToolConfig::Patch::kRigid;
  return body;
}

std::vector<Body> bodiesOf(const Scene& scene, const std::vector<ToolGeometry>& tools) {
  std::vector<Body> bodies;
  for (const ToolGeometry& tool : tools) {
    if (std::optional<Body> body = bodyOf(tool)) bodies.push_back(std::move(*body));
  }
  if (bodies.empty()) bodies.push_back(sphereOf(scene));
  return bodies;
}

RobotPose poseAt(const Place& place, const Body& body, double depth) {
  Pose pose = Pose::Identity();
  pose.linear() =
      Eigen::Quaterniond::FromTwoVectors(body.forwards, place.inwards).toRotationMatrix();
  pose.translation() = place.top + depth * place.inwards - pose.linear() * body.tip;
  RobotPose robot;
  robot.links = {pose};
  return robot;
}

// Of this thread, which shares what there is to solve: what else runs on the machine does not
// count.
double processorMs() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

TrialPress press(Pipeline& pipeline, const Place& place, const Body& body,
                 const Deadline& deadline) {
  TrialPress press;
  press.what = body.name;
  press.nodes = pipeline.tissue().lattice().nodeCount();
  pipeline.setTools({body.tool});
  pipeline.step(poseAt(place, body, -0.1 * kDepth));
  for (int update = 1; update <= kUpdates; ++update) {
    const double start_ms = processorMs();
    const StepReport& report = pipeline.step(poseAt(place, body, kDepth * update / kUpdates));
    press.update_ms += (processorMs() - start_ms) / kUpdates;
    press.ended = press.ended && !report.late && !deadline.isOver();
    press.converged = press.converged && pipeline.tissue().lastReport().status == SolveStatus::kOk;
  }
  const Eigen::Matrix3d turn = pipeline.pose()->links[0].linear();
  press.force_n = -(turn * pipeline.report().tools[0].force_on_tool).dot(place.inwards);
  pipeline.step(poseAt(place, body, -0.1 * kDepth));  // out of the next one's way
  return press;
}

Finding noteOf(const TrialPress& press) {
  return {Finding::Level::kNote,
          press.what + " pressed 1 mm into " + std::to_string(press.nodes) + " nodes takes " +
              roundedText(press.update_ms) + " ms of the processor an update, " +
              roundedText(press.memory_mb) + " MB and " + roundedText(press.force_n) + " N",
          ""};
}

}  // namespace

std::vector<TrialPress> pressEach(const Scene& scene, const std::vector<ToolGeometry>& tools,
                                  double most_seconds) {
  const double before = residentMemory();
  SolverConfig solver = scene.solver;
  solver.max_ms = 0.0;  // so that an update is timed to its end
  Pipeline pipeline(scene.tissue, solver, {}, scene.supports);
  const Deadline deadline(most_seconds);
  pipeline.setEnd(deadline);
  if (hasBodyLoad(scene.tissue) || !scene.supports.empty()) pipeline.settle();
  const Place place = placeOn(pipeline.tissue());
  std::vector<TrialPress> presses;
  for (const Body& body : bodiesOf(scene, tools)) {
    presses.push_back(press(pipeline, place, body, deadline));
    presses.back().memory_mb = std::max(0.0, 1e-6 * (residentMemory() - before));
    if (!presses.back().ended) break;
  }
  return presses;
}

Findings checkPress(const Scene& scene, const std::vector<ToolGeometry>& tools,
                    double most_seconds) {
  Findings findings;
  double slowest_ms = 0.0;
  for (const TrialPress& press : pressEach(scene, tools, most_seconds)) {
    if (!press.ended) {
      findings.push_back({Finding::Level::kWarning,
                          "solver.method: " + press.what + " pressed 1 mm into " +
                              std::to_string(press.nodes) + " nodes is not done in " +
                              roundedText(most_seconds) + " s",
                          "a larger tissue.spacing, or method layered"});
      return findings;
    }
    findings.push_back(noteOf(press));
    slowest_ms = std::max(slowest_ms, press.update_ms);
    if (press.converged) continue;
    findings.push_back({Finding::Level::kWarning, "solver: that press did not come to balance",
                        "more of the tissue fixed, or a larger solver.tolerance"});
  }
  const double longest_ms = scene.solver.max_ms > 0.0 ? scene.solver.max_ms : kLongestUpdate;
  if (slowest_ms > longest_ms) {
    findings.push_back({Finding::Level::kWarning,
                        "tissue.spacing: an update longer than " + roundedText(longest_ms) +
                            " ms is carried on in later ones, and the shape lags (LATE)",
                        "a larger tissue.spacing, solver.tolerance or solver.threads"});
  }
  return findings;
}

}  // namespace robot_tissue
