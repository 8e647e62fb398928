#include "saving/saved_sutures.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "saving/checked_values.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kCarrierBytes = 4 + 8;
constexpr std::size_t kLeastThreadBytes = 4 + 1 + 2 * (2 * 3 * 8 + 4 + kCarrierBytes) + 3 * 8 + 1;
constexpr double kMostWeight = 2.0;  // no point has a greater one, or one below minus that
constexpr double kOffOne = 1e-9;     // of the sum of weights; rounding is far less

void putEnd(const SutureThread::End& end, ByteWriter& out) {
  out.vec3(end.rest);
  out.vec3(end.inside);
  out.count(end.carriers.size());
  for (const NodeWeight& carrier : end.carriers) {
    out.index(carrier.node);
    out.f64(carrier.weight);
  }
}

SutureThread::End takeEnd(int node_count, ByteReader& in) {
  SutureThread::End end;
  end.rest = takeVector(in);
  end.inside = takeVector(in);
  end.carriers.resize(in.count(kCarrierBytes));
  double sum = 0.0;
  int last = -1;
  for (NodeWeight& carrier : end.carriers) {
    carrier.node = takeNode(node_count, in);
    carrier.weight = takeNumber(in);
    if (carrier.node <= last) failAsDamaged("the nodes of a suture are out of order");
    if (carrier.weight == 0.0 || !(std::abs(carrier.weight) <= kMostWeight)) {
      failAsDamaged("a weight of a suture is none");
    }
    sum += carrier.weight;
    last = carrier.node;
  }
  if (!(std::abs(sum - 1.0) <= kOffOne))
    failAsDamaged("the weights of a suture are not one in all");
  return end;
}

SutureThread takeThread(int node_count, ByteReader& in) {
  SutureThread thread;
  thread.name = takeName(in);
  thread.from = takeEnd(node_count, in);
  thread.to = takeEnd(node_count, in);
  thread.rest_length = thread.length = takeNumber(in);
  thread.stiffness = takeNumber(in);
  thread.break_force = takeNumber(in);
  thread.broken = takeTruth(in);
  if (thread.rest_length < 0.0 || thread.break_force < 0.0 || !(thread.stiffness > 0.0) ||
      thread.stiffness > kStiffestSuture) {
    failAsDamaged("a suture's thread is none");
  }
  return thread;
}

}  // namespace

void putSutures(const std::vector<SutureThread>& threads, ByteWriter& out) {
  out.count(threads.size());
  for (const SutureThread& thread : threads) {
    out.text(thread.name);
    putEnd(thread.from, out);
    putEnd(thread.to, out);
    out.f64(thread.rest_length);
    out.f64(thread.stiffness);
    out.f64(thread.break_force);
    out.u8(thread.broken ? 1 : 0);
  }
}

std::vector<SutureThread> takeSutures(int node_count, ByteReader& in) {
  const std::size_t count = in.count(kLeastThreadBytes);
  std::vector<SutureThread> threads;
  std::set<std::string> names;
  for (std::size_t i = 0; i < count; ++i) {
    threads.push_back(takeThread(node_count, in));
    if (!names.insert(threads.back().name).second) failAsDamaged("two sutures have one name");
  }
  return threads;
}

bool haveBites(const std::vector<SutureThread>& threads) {
  return std::any_of(threads.begin(), threads.end(),
                     [](const SutureThread& thread) { return thread.bite > 0.0; });
}

void putBites(const std::vector<SutureThread>& threads, ByteWriter& out) {
  for (const SutureThread& thread : threads) {
    out.f64(thread.bite);
    out.vec3(thread.from.to_middle);
    out.vec3(thread.to.to_middle);
  }
}

void takeBites(std::vector<SutureThread>& threads, ByteReader& in) {
  for (SutureThread& thread : threads) {
    thread.bite = takeNumber(in);
    thread.from.to_middle = takeVector(in);
    thread.to.to_middle = takeVector(in);
    const double farthest = std::max(thread.from.to_middle.norm(), thread.to.to_middle.norm());
    if (!(thread.bite >= 0.0 && farthest <= thread.bite)) {
      failAsDamaged("the middle of a suture's bite is outside it");
    }
  }
}

}  // namespace robot_tissue
