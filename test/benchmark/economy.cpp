// What an update costs, and what is held in memory, by what there is to do. Prints CSV, a row a
// scene, for scripts/study economy; doc/economy.md reads it. Not a test: nothing here passes or
// fails.
//
//   economy SPACING        (m, of a block of 100 x 100 x 50 mm)
//
// An update is Pipeline::step, all that the node does but looking poses up and publishing; times
// are the processor's. Heap is what this process holds from malloc, less what it held before the
// scene.
#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "robot_tissue/pipeline/pipeline.h"
#include "timing.h"

namespace {
long allocations = 0;
long allocated_bytes = 0;
}  // namespace

void* operator new(std::size_t bytes) {
  ++allocations;
  allocated_bytes += static_cast<long>(bytes);
  void* const memory = std::malloc(bytes);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void* operator new(std::size_t bytes, std::align_val_t alignment) {
  ++allocations;
  allocated_bytes += static_cast<long>(bytes);
  const auto line = static_cast<std::size_t>(alignment);
  void* const memory = std::aligned_alloc(line, (bytes + line - 1) / line * line);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace robot_tissue {
namespace {

constexpr double kTop = 0.05;                 // of the block (m)
constexpr double kRadius = 0.006;             // of the tools (m)
constexpr int kWarmUp = 100, kUpdates = 200;  // two periods of the motion

using Motion = std::function<double(int update)>;  // height of the tools' lowest points (m)

double heapBytes() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd);
}

TissueConfig block(double spacing) {
  TissueConfig tissue;
  tissue.shape.max() = Vec3(0.1, 0.1, kTop);
  tissue.spacing = spacing;
  tissue.material.young_modulus = 1e4;
  tissue.fixed.push_back({Vec3(-1, -1, -1e-6), Vec3(1, 1, 1e-6)});
  return tissue;
}

std::vector<ToolGeometry> spheres(int count) {
  ToolShape shape;
  shape.radius = kRadius;
  shape.pose.translation().z() = kRadius;
  std::vector<ToolGeometry> tools;
  for (int i = 0; i < count; ++i) {
    ToolGeometry tool;
    tool.name = "tool" + std::to_string(i);
    tool.links.push_back({tool.name, {shape}});
    tools.push_back(tool);
  }
  return tools;
}

// The first in the middle, the others towards the corners, off the nodes.
RobotPose poseOf(int tools, double height, double aside) {
  static const double kPlaces[5][2] = {
      {0.0507, 0.0493}, {0.0257, 0.0243}, {0.0757, 0.0243}, {0.0257, 0.0743}, {0.0757, 0.0743}};
  RobotPose pose;
  for (int i = 0; i < tools; ++i) {
    pose.links.push_back(Pose::Identity());
    pose.links.back().translation() = Vec3(kPlaces[i][0] + aside, kPlaces[i][1], kTop + height);
  }
  return pose;
}

struct Costs {
  std::vector<double> ms;  // per update
  long solves = 0, allocations = 0, bytes = 0;
};

Costs drive(Pipeline& pipeline, int tools, const Motion& height, const Motion& aside) {
  Costs costs;
  for (int update = 0; update < kWarmUp + kUpdates; ++update) {
    const RobotPose pose = poseOf(tools, height(update), aside(update));
    const long allocations_before = allocations, bytes_before = allocated_bytes;
    const double began = processorMs();
    const StepReport& report = pipeline.step(pose);
    const double ended = processorMs();
    if (update < kWarmUp) continue;
    costs.ms.push_back(ended - began);
    costs.solves += report.changed ? report.substeps : 0;
    costs.allocations += allocations - allocations_before;
    costs.bytes += allocated_bytes - bytes_before;
  }
  return costs;
}

void print(const std::string& scene, int nodes, Costs costs, double heap) {
  std::vector<double>& ms = costs.ms;
  double sum = 0.0;
  for (const double one : ms) sum += one;
  std::sort(ms.begin(), ms.end());
  const auto quantile = [&ms](double share) {
    return ms[std::min(ms.size() - 1,
                       static_cast<std::size_t>(share * static_cast<double>(ms.size())))];
  };
  const auto updates = static_cast<double>(ms.size());
  constexpr double kRate = 100.0;  // Hz
  std::printf("%s,%d,%zu,%.4g,%.4g,%.4g,%.4g,%.3g,%.4g,%.4g,%.0f\n", scene.c_str(), nodes,
              ms.size(), quantile(0.5), quantile(0.9), ms.back(), 0.1 * kRate * sum / updates,
              static_cast<double>(costs.solves) / updates,
              static_cast<double>(costs.allocations) / updates,
              static_cast<double>(costs.bytes) / updates, heap);
  std::fflush(stdout);
}

void run(const std::string& scene, double spacing, int tools, const Motion& height,
         const Motion& aside) {
  const double before = heapBytes();
  Pipeline pipeline(block(spacing), {}, spheres(tools));
  const Costs costs = drive(pipeline, tools, height, aside);
  print(scene, pipeline.tissue().lattice().nodeCount(), costs, heapBytes() - before);
}

// What is held at all, then with a tool, then when it has left.
void weigh(double spacing) {
  const double before = heapBytes();
  const auto tell = [&](const char* what, int nodes) {
    std::printf("%s,%d,,,,,,,,,%.0f\n", what, nodes, heapBytes() - before);
  };
  {
    const Lattice lattice(block(spacing));
    tell("memory: lattice", lattice.nodeCount());
  }
  Pipeline pipeline(block(spacing), {}, spheres(5));
  const int nodes = pipeline.tissue().lattice().nodeCount();
  tell("memory: never touched", nodes);
  RobotPose pose = poseOf(5, -0.003, 0.0);
  for (std::size_t tool = 1; tool < 5; ++tool) pose.links[tool].translation().z() = 1.0;
  pipeline.step(pose);
  tell("memory: one tool presses", nodes);
  pipeline.step(poseOf(5, -0.003, 0.0));
  tell("memory: five tools press", nodes);
  pipeline.step(poseOf(5, 1.0, 0.0));
  tell("memory: all have left", nodes);
}

void measure(double spacing) {
  const auto still = [](double height) { return [height](int) { return height; }; };
  const auto press = [](int update) { return -0.002 - 0.001 * std::sin(0.0628 * update); };
  const auto sway = [](int update) { return 0.002 * std::sin(0.0628 * update); };
  const Motion none = still(0.0);
  weigh(spacing);
  run("no tool", spacing, 0, none, none);
  run("far tool stands", spacing, 1, still(0.2), none);
  run("far tool moves", spacing, 1, still(0.2), sway);
  run("near tool stands", spacing, 1, still(0.0005), none);
  run("near tool moves", spacing, 1, still(0.0005), sway);
  run("one tool stands pressed in", spacing, 1, still(-0.002), none);
  run("one tool presses", spacing, 1, press, none);
  run("one tool drags", spacing, 1, still(-0.002), sway);
  run("five far tools move", spacing, 5, still(0.2), sway);
  run("five tools press", spacing, 5, press, none);
}

}  // namespace
}  // namespace robot_tissue

int main(int argc, char** argv) {
  const double spacing = argc == 2 ? std::atof(argv[1]) : 0.0;
  if (!robot_tissue::spacingFits({0.1, 0.1, 0.05}, spacing)) {
    std::fprintf(stderr, "usage: economy SPACING; must divide 100 mm and 50 mm, in m\n");
    return 2;
  }
  robot_tissue::measure(spacing);
}
