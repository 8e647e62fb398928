// Tissues, load steps and snapshots that the tests of Tissue and StickingContacts share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "block_fixtures.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

inline PatchConfig displacedPatch(const std::string& name, const Box& box, const Vec3& way) {
  PatchConfig patch;
  patch.name = name;
  patch.box = box;
  patch.displacement = std::array<std::optional<double>, 3>{{way.x(), way.y(), way.z()}};
  return patch;
}

inline PatchConfig forcedPatch(const std::string& name, const Box& box, const Vec3& force) {
  PatchConfig patch;
  patch.name = name;
  patch.box = box;
  patch.force = force;
  return patch;
}

inline LoadStep loadOf(const std::vector<PatchConfig>& patches,
                       std::optional<int> increments = std::nullopt) {
  LoadStep step;
  step.increments = increments;
  step.patches = patches;
  return step;
}

// Loads, and returns the report of every increment.
inline std::vector<SolveReport> reportsOf(Tissue& tissue, const LoadStep& step) {
  std::vector<SolveReport> reports;
  tissue.load(step, [&](int, int, const SolveReport& report) { reports.push_back(report); });
  return reports;
}

inline std::vector<int> nodesOfPatch(const Tissue& tissue, const std::string& name) {
  for (const LoadingPatch& patch : tissue.patches()) {
    if (patch.name == name) return patch.nodes;
  }
  return {};
}

inline void expectAtRest(const Tissue& tissue) {
  for (const Vec3& moved : tissue.state().displacement) ASSERT_EQ(moved, Vec3(Vec3::Zero()));
  EXPECT_EQ(tissue.vertices(), tissue.surface().rest);
}

inline bool isDeformed(const Tissue& tissue) {
  const auto& displacement = tissue.state().displacement;
  return std::any_of(displacement.begin(), displacement.end(),
                     [](const Vec3& moved) { return moved.norm() > 1e-6; });
}

// What a refused request must leave as it is.
struct Snapshot {
  explicit Snapshot(const Tissue& tissue)
      : state(tissue.state()),
        patches(tissue.patches()),
        vertices(tissue.vertices()),
        triangles(tissue.surface().triangles),
        named(tissue.namedPatches()),
        surface_revision(tissue.surface().revision) {}

  LatticeState state;
  std::vector<LoadingPatch> patches;
  std::vector<Vec3> vertices;
  std::vector<std::array<int, 3>> triangles;
  std::size_t named;
  std::uint64_t surface_revision;
};

inline void expectUnchanged(const Tissue& tissue, const Snapshot& before) {
  EXPECT_EQ(tissue.state().displacement, before.state.displacement);
  EXPECT_EQ(tissue.state().severed, before.state.severed);
  EXPECT_EQ(tissue.state().springs_cut, before.state.springs_cut);
  EXPECT_EQ(tissue.state().pieces, before.state.pieces);
  EXPECT_EQ(tissue.vertices(), before.vertices);
  EXPECT_EQ(tissue.surface().triangles, before.triangles);
  EXPECT_EQ(tissue.namedPatches(), before.named);
  EXPECT_EQ(tissue.surface().revision, before.surface_revision);
  ASSERT_EQ(tissue.patches().size(), before.patches.size());
  for (std::size_t i = 0; i < before.patches.size(); ++i) {
    EXPECT_EQ(tissue.patches()[i].name, before.patches[i].name);
    EXPECT_EQ(tissue.patches()[i].nodes, before.patches[i].nodes);
    EXPECT_EQ(tissue.patches()[i].drive, before.patches[i].drive);
    EXPECT_EQ(tissue.patches()[i].displacement, before.patches[i].displacement);
    EXPECT_EQ(tissue.patches()[i].free_axis, before.patches[i].free_axis);
    EXPECT_EQ(tissue.patches()[i].force, before.patches[i].force);
  }
}

}  // namespace robot_tissue
