// Tools of every shape pressed into a block and dragged along it: how deep they are in the surface
// that is shown, how smooth the force is, how long a millimeter takes.
//   contact_press [TOOL|all|ball:RADIUS in mm] [SPEED in m/s at 100 updates a second, 0 =
//   increments of 0.25 mm]
//                 [SPACING in mm] [FRICTION] [METHOD] [TOLERANCE] [PRESS in mm]
//                 [MAX_MS of an update, 0 = none] [X Y in mm: start off the usual one]
//                 [MAX_ITERATIONS of a load step, 0 = any number]
// Writes tool,leg,way_mm,fx,fy,fz,penetration_mm,ms,substeps,status,start: one line an update, ms
// of processor; status of the solve, or LATE, TOO_FAST, LOST as the report has it; start X Y.
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <string>

#include "robot_tissue/pipeline/pipeline.h"
#include "timing.h"

namespace robot_tissue {
namespace {

constexpr double kDrag = 0.030;   // m
constexpr double kTop = 0.05;     // m
constexpr double kClear = 0.001;  // m: above the block at the start

TissueConfig block(double spacing) {
  TissueConfig tissue;
  tissue.shape = {Vec3::Zero(), Vec3(0.1, 0.1, kTop)};
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.material.poisson_ratio = 0.45;
  tissue.fixed.push_back({Vec3(-1.0, -1.0, -1e-6), Vec3(1.0, 1.0, 1e-6)});
  return tissue;
}

// A cup that opens downwards: a ring of boxes would do for contact, this is one mesh.
std::string writeCup() {
  const std::string path =
      std::string(std::getenv("TMPDIR") ? std::getenv("TMPDIR") : "/tmp") + "/robot_tissue_cup.stl";
  constexpr int kSides = 24;
  constexpr double kOuter = 0.012, kInner = 0.008, kHeight = 0.02, kFloor = 0.008;
  std::ofstream stl(path);
  stl << "solid cup\n";
  const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    stl << "facet normal 0 0 0\nouter loop\n";
    for (const Vec3& v : {a, b, c})
      stl << "vertex " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    stl << "endloop\nendfacet\n";
  };
  const auto ring = [&](double radius, double z, int k) {
    const double angle = 2.0 * M_PI * (k % kSides) / kSides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  for (int k = 0; k < kSides; ++k) {
    const auto quad = [&](double r0, double z0, double r1, double z1) {
      const Vec3 a = ring(r0, z0, k), b = ring(r0, z0, k + 1), c = ring(r1, z1, k + 1),
                 d = ring(r1, z1, k);
      facet(a, b, c);
      facet(a, c, d);
    };
    quad(kOuter, 0.0, kOuter, kHeight);                                               // outside
    quad(kInner, 0.0, kOuter, 0.0);                                                   // rim
    quad(kInner, kFloor, kInner, 0.0);                                                // inside
    facet(Vec3(0, 0, kFloor), ring(kInner, kFloor, k + 1), ring(kInner, kFloor, k));  // its ceiling
    facet(Vec3(0, 0, kHeight), ring(kOuter, kHeight, k), ring(kOuter, kHeight, k + 1));
  }
  stl << "endsolid cup\n";
  return "file://" + path;
}

// The lowest point of each tool is at the origin of its frame. `wanted`: a ball, too.
std::map<std::string, ToolShape> toolShapes(const std::string& wanted) {
  using Type = ToolShape::Type;
  const auto turned = [](const Eigen::Quaterniond& turn, double up) {
    Pose pose = Pose::Identity();
    pose.linear() = turn.toRotationMatrix();
    pose.translation().z() = up;
    return pose;
  };
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Eigen::Quaterniond lying(Eigen::AngleAxisd(M_PI / 2, Vec3::UnitY()));
  std::map<std::string, ToolShape> shapes;
  const auto add = [&](const std::string& name, Type type, double radius, double length,
                       const Vec3& size, const Pose& pose) {
    ToolShape shape;
    shape.type = type;
    shape.radius = radius;
    shape.length = length;
    shape.size = size;
    shape.pose = pose;
    shapes[name] = shape;
  };
  const Vec3 none = Vec3::Zero(), cube = Vec3::Constant(0.02);
  add("sphere", Type::kSphere, 0.01, 0.0, none, turned(upright, 0.01));
  add("cylinder_upright", Type::kCylinder, 0.008, 0.05, none, turned(upright, 0.025));
  add("cylinder_lying", Type::kCylinder, 0.008, 0.03, none, turned(lying, 0.008));
  add("box_face", Type::kBox, 0.0, 0.0, cube, turned(upright, 0.01));
  add("box_edge", Type::kBox, 0.0, 0.0, cube,
      turned(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 4, Vec3::UnitY())),
             0.01 * std::sqrt(2.0)));
  add("box_corner", Type::kBox, 0.0, 0.0, cube,
      turned(Eigen::Quaterniond::FromTwoVectors(Vec3::Ones(), Vec3::UnitZ()),
             0.01 * std::sqrt(3.0)));
  add("needle", Type::kCylinder, 0.0005, 0.05, none, turned(upright, 0.025));
  if (wanted.rfind("ball:", 0) == 0) {
    const double radius = 1e-3 * std::stod(wanted.substr(5));
    add(wanted, Type::kSphere, radius, 0.0, none, turned(upright, radius));
  }
  add("cup", Type::kMesh, 0.0, 0.0, none, Pose::Identity());
  shapes["cup"].resource = writeCup();
  return shapes;
}

struct Worst {
  double penetration = 0.0, jump = 0.0, force = 0.0, ms = 0.0;
  int updates = 0, not_ok = 0;
};

std::string statusOf(const StepReport& report, const SolveReport& solve) {
  if (report.lost) return "LOST";
  if (report.too_fast) return "TOO_FAST";
  return report.late ? "LATE" : toString(solve.status);
}

class Trial {
 public:
  Trial(const std::string& name, const ToolShape& shape, double spacing, double friction,
        const std::string& method, double tolerance, double max_ms, const std::string& start,
        int max_iterations)
      : name_(name), start_(start) {
    ToolGeometry tool;
    tool.name = name;
    tool.friction = friction;
    tool.links.push_back({"", {shape}});
    SolverConfig solver;
    solver.method = method;
    solver.tolerance = tolerance;
    pipeline_ = std::make_unique<Pipeline>(block(spacing), solver, std::vector<ToolGeometry>{tool});
    if (max_ms > 0.0) pipeline_->setBudget(1e-3 * max_ms);
    pipeline_->setMostIterations(max_iterations);
  }

  void go(const char* leg, const Vec3& from, const Vec3& to, double increment) {
    const double way = (to - from).norm();
    const int updates = std::max(1, static_cast<int>(std::ceil(way / increment - 1e-9)));
    for (int i = 1; i <= updates; ++i) {
      update(leg, from + (to - from) * (static_cast<double>(i) / updates), way * i / updates);
    }
  }

  const Worst& worst() const { return worst_; }

 private:
  void update(const char* leg, const Vec3& place, double way) {
    RobotPose pose;
    pose.links.push_back(Pose(Eigen::Translation3d(place)));
    const double start = processorMs();
    const StepReport& report = pipeline_->step(pose);
    const double ms = processorMs() - start;
    const ToolReport& tool = report.tools.front();
    const SolveReport& solve = pipeline_->tissue().lastReport();
    std::printf("%s,%s,%.3f,%.5f,%.5f,%.5f,%.4f,%.2f,%d,%s,%s\n", name_.c_str(), leg, 1e3 * way,
                tool.force_on_tool.x(), tool.force_on_tool.y(), tool.force_on_tool.z(),
                1e3 * tool.max_penetration, ms, report.substeps, statusOf(report, solve).c_str(),
                start_.c_str());
    worst_.penetration = std::max(worst_.penetration, tool.max_penetration);
    worst_.jump = std::max(worst_.jump, (tool.force_on_tool - last_).norm());
    worst_.force = std::max(worst_.force, tool.force_on_tool.norm());
    worst_.ms += ms;
    ++worst_.updates;
    if (statusOf(report, solve) != toString(SolveStatus::kOk)) ++worst_.not_ok;
    last_ = tool.force_on_tool;
  }

  std::string name_, start_;
  std::unique_ptr<Pipeline> pipeline_;
  Vec3 last_ = Vec3::Zero();
  Worst worst_;
};

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  using namespace robot_tissue;
  const std::string wanted = argc > 1 ? argv[1] : "all";
  const double speed = argc > 2 ? std::atof(argv[2]) : 0.0;
  const double spacing = 1e-3 * (argc > 3 ? std::atof(argv[3]) : 5.0);
  const double friction = argc > 4 ? std::atof(argv[4]) : 0.3;
  const std::string method = argc > 5 ? argv[5] : "layered";
  const double tolerance = argc > 6 ? std::atof(argv[6]) : 0.01;
  const double press = 1e-3 * (argc > 7 ? std::atof(argv[7]) : 15.0);
  const double max_ms = argc > 8 ? std::atof(argv[8]) : 0.0;
  const std::string x = argc > 9 ? argv[9] : "0", y = argc > 10 ? argv[10] : "0";
  const int max_iterations = argc > 11 ? std::atoi(argv[11]) : 0;
  const double increment = speed > 0.0 ? 0.01 * speed : 0.00025;
  std::printf("tool,leg,way_mm,fx,fy,fz,penetration_mm,ms,substeps,status,start\n");
  for (const auto& [name, shape] : toolShapes(wanted)) {
    if (wanted != "all" && wanted != name) continue;
    Trial trial(name, shape, spacing, friction, method, tolerance, max_ms, x + " " + y,
                max_iterations);
    // Off the nodes, and off the middle between them.
    const Vec3 above(0.0363 + 1e-3 * std::stod(x), 0.0511 + 1e-3 * std::stod(y), kTop + kClear);
    const Vec3 pressed = above - Vec3(0, 0, press + kClear);
    trial.go("appear", above, above, 1.0);
    trial.go("press", above, pressed, increment);
    trial.go("drag", pressed, pressed + Vec3(kDrag, 0, 0), increment);
    trial.go("lift", pressed + Vec3(kDrag, 0, 0), above + Vec3(kDrag, 0, 0), increment);
    const Worst& worst = trial.worst();
    std::fprintf(stderr,
                 "%-17s penetration %.3f mm, force %.2f N, jump %.1f %%, %.1f ms an update, "
                 "%d of %d not OK\n",
                 name.c_str(), 1e3 * worst.penetration, worst.force,
                 100.0 * worst.jump / worst.force, worst.ms / worst.updates, worst.not_ok,
                 worst.updates);
  }
  return 0;
}
