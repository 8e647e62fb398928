#include "loads/suture_thread.h"

#include <cmath>
#include <map>

#include "robot_tissue/core/carriers.h"

namespace robot_tissue {
namespace {

// What is left of a node that carries both ends alike is rounding.
constexpr double kNoWeight = 1e-12;

}  // namespace

ContactSpring springOf(const SutureThread& thread) {
  std::map<int, double> weights;
  for (const NodeWeight& carrier : thread.to.carriers) weights[carrier.node] += carrier.weight;
  for (const NodeWeight& carrier : thread.from.carriers) weights[carrier.node] -= carrier.weight;
  ContactSpring spring;
  spring.is_thread = true;
  for (const auto& [node, weight] : weights) {
    if (std::abs(weight) > kNoWeight) spring.carriers.push_back({node, weight});
  }
  spring.rest = (thread.to.rest + thread.to.to_middle) -
                (thread.from.rest + thread.from.to_middle) + thread.offset;
  spring.stiffness =
      thread.softness > 0.0 ? 1.0 / (1.0 / thread.stiffness + thread.softness) : thread.stiffness;
  spring.rest_length = thread.length;
  return spring;
}

Vec3 placeOf(const SutureThread::End& end, const std::vector<Vec3>& displacement) {
  return carriedFrom(end.rest + end.to_middle, end.carriers, displacement);
}

SutureReport reportOf(const SutureThread& thread, const std::vector<Vec3>& displacement) {
  SutureReport report;
  report.name = thread.name;
  report.broken = thread.broken;
  report.from = placeOf(thread.from, displacement);
  report.to = placeOf(thread.to, displacement);
  report.length = (report.to - report.from).norm();
  if (!thread.broken) report.tension = tensionOf(springOf(thread), displacement);
  return report;
}

}  // namespace robot_tissue
