#include "saving/saved_loads.h"

#include <algorithm>
#include <set>

#include "saving/checked_values.h"

namespace robot_tissue {
namespace {

constexpr std::size_t kRimBytes = 4 + 6 * 8;   // of a spring of a rim
constexpr std::size_t kLeastPatchBytes = 100;  // of a patch
constexpr double kUnlikeRotation = 1e-6;       // of R^T R from one

[[noreturn]] void fail(const std::string& what) { failAsDamaged(what); }

Eigen::Matrix3d takeRotation(ByteReader& in) {
  Eigen::Matrix3d rotation;
  for (int row = 0; row < 3; ++row) rotation.row(row) = takeVector(in).transpose();
  const Eigen::Matrix3d off = rotation.transpose() * rotation - Eigen::Matrix3d::Identity();
  if (!(off.cwiseAbs().maxCoeff() <= kUnlikeRotation) || rotation.determinant() < 0.0) {
    fail("a load's rotation is none");
  }
  return rotation;
}

void putPatch(const LoadingPatch& patch, ByteWriter& out) {
  out.text(patch.name);
  out.count(patch.nodes.size());
  for (const int node : patch.nodes) out.index(node);
  out.count(patch.rim.size());
  for (const RimSpring& spring : patch.rim) {
    out.index(spring.node);
    out.vec3(spring.stiffness);
    out.vec3(spring.anchor);
  }
  out.u8(byForce(patch) ? 1 : 0);
  out.u8(patch.turns ? 1 : 0);
  for (const bool free : patch.free_axis) out.u8(free ? 1 : 0);
  for (const Vec3& displacement : patch.displacement) out.vec3(displacement);
  out.vec3(patch.force);
  out.vec3(patch.center);
  out.vec3(patch.place.displacement);
  for (int row = 0; row < 3; ++row) out.vec3(patch.place.rotation.row(row).transpose());
}

// Ascending, so none twice.
std::vector<int> takeNodes(const Lattice& lattice, ByteReader& in) {
  std::vector<int> nodes(in.count(sizeof(std::uint32_t)));
  if (nodes.empty()) fail("a load has no node");
  int last = -1;
  for (int& node : nodes) {
    node = takeNode(lattice.nodeCount(), in);
    if (node <= last) fail("the nodes of a load are out of order");
    if (lattice.isFixed(node)) fail("a load is on a fixed node");
    last = node;
  }
  return nodes;
}

std::vector<RimSpring> takeRim(const Lattice& lattice, ByteReader& in) {
  std::vector<RimSpring> rim(in.count(kRimBytes));
  int last = -1;
  for (RimSpring& spring : rim) {
    spring.node = takeNode(lattice.nodeCount(), in);
    spring.stiffness = takeVector(in);
    spring.anchor = takeVector(in);
    if (spring.node <= last) fail("the rim of a load is out of order");
    if (spring.stiffness.minCoeff() < 0.0) fail("a rim is of negative stiffness");
    last = spring.node;
  }
  return rim;
}

LoadingPatch takePatch(const Lattice& lattice, ByteReader& in) {
  LoadingPatch patch;
  patch.name = takeName(in);
  patch.nodes = takeNodes(lattice, in);
  patch.rim = takeRim(lattice, in);
  patch.drive = takeTruth(in) ? LoadingPatch::Drive::kForce : LoadingPatch::Drive::kDisplacement;
  patch.turns = takeTruth(in);
  for (bool& free : patch.free_axis) free = takeTruth(in);
  if (patch.turns && !byForce(patch)) fail("a load turns without a force");
  if (!byForce(patch)) patch.displacement.resize(patch.nodes.size());
  for (Vec3& displacement : patch.displacement) displacement = takeVector(in);
  patch.force = takeVector(in);
  patch.center = takeVector(in);
  patch.place.displacement = takeVector(in);
  patch.place.rotation = takeRotation(in);
  return patch;
}

}  // namespace

void putLoads(const std::vector<LoadingPatch>& loads, ByteWriter& out) {
  out.count(loads.size());
  for (const LoadingPatch& patch : loads) putPatch(patch, out);
}

std::vector<LoadingPatch> takeLoads(const Lattice& lattice, ByteReader& in) {
  const std::size_t count = in.count(kLeastPatchBytes);
  std::vector<LoadingPatch> loads;
  std::set<std::string> names;
  std::set<int> nodes;
  for (std::size_t i = 0; i < count; ++i) {
    loads.push_back(takePatch(lattice, in));
    if (!names.insert(loads.back().name).second) fail("two loads have one name");
    for (const int node : loads.back().nodes) {
      if (!nodes.insert(node).second) fail("two loads share a node");
    }
  }
  return loads;
}

std::vector<LoadingPatch> takeDueLoads(const Lattice& lattice,
                                       const std::vector<LoadingPatch>& loads, ByteReader& in) {
  std::vector<LoadingPatch> due = takeLoads(lattice, in);
  for (const LoadingPatch& target : due) {
    const bool is_of_one = std::any_of(loads.begin(), loads.end(), [&](const LoadingPatch& load) {
      return load.name == target.name && load.nodes == target.nodes && load.drive == target.drive;
    });
    if (!is_of_one) fail("what is on its way is none of its loads");
  }
  return due;
}

void putReport(const SolveReport& report, ByteWriter& out) {
  out.u8(static_cast<std::uint8_t>(report.status));
  out.f64(report.residual);
  out.f64(report.error_estimate);
  out.count(report.patches.size());
  for (const PatchAnswer& answer : report.patches) {
    out.vec3(answer.force);
    out.vec3(answer.torque);
    out.vec3(answer.displacement);
  }
}

SolveReport takeReport(std::size_t loads, ByteReader& in) {
  SolveReport report;
  const std::uint8_t status = in.u8();
  if (status > static_cast<std::uint8_t>(SolveStatus::kInverted)) fail("its status is none");
  report.status = static_cast<SolveStatus>(status);
  report.residual = takeNumber(in);
  report.error_estimate = takeNumber(in);
  report.patches.resize(in.count(1));
  if (report.patches.size() != loads) fail("it has not one answer for each load");
  for (PatchAnswer& answer : report.patches) {
    answer.force = takeVector(in);
    answer.torque = takeVector(in);
    answer.displacement = takeVector(in);
  }
  return report;
}

}  // namespace robot_tissue
