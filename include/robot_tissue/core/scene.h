// What is simulated, as plain data: the meaning of a scene file after every check.
// Lengths in m, in the tissue frame unless said. No defaults are filled in elsewhere.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Stiffness is either a modulus or, with model six_spring only, the constant of one spring.
struct Material {
  double young_modulus = 0.0;              // Pa; unused when spring_stiffness is set
  double poisson_ratio = 0.45;             // 0.25 .. 0.49; model six_spring has none
  double density = 1000.0;                 // kg/m^3
  std::optional<double> spring_stiffness;  // N/m
};

struct Region {
  std::string name;
  Box box;
  Material material;  // the tissue's, with the region's own entries in place
};

struct TissueConfig {
  std::string frame_id = "tissue";
  Box shape;                                 // unused when mesh is set
  std::shared_ptr<const TriangleMesh> mesh;  // without fault (core/mesh_checks.h), facing outwards
  double spacing = 0.0;
  std::string model = "elastic";
  Material material;
  std::vector<Region> regions;  // a later one wins where two overlap
  std::vector<Box> fixed;       // nodes in these never move; none: the block floats in space
  Vec3 gravity = Vec3::Zero();  // m/s^2
};

struct SolverConfig {
  std::string method = "layered";
  double tolerance = 0.01;  // relative, 0 < tolerance < 1
  double max_ms = 0.0;      // budget of one update; 0 = none
  int threads = 1;
};

// The nodes in `box` (of rest positions) move as one hard patch. Exactly one of the two is set.
struct PatchConfig {
  std::string name;
  Box box;
  // Total displacement from rest; an empty component is free (nodes slide along that axis).
  std::optional<std::array<std::optional<double>, 3>> displacement;
  std::optional<Vec3> force;  // N, of the patch on the tissue
  bool turns = false;         // with a force: the patch also turns, until no moment is left
};

struct SettleStep {};
struct LoadStep {
  std::optional<int> increments;  // empty: the solver chooses
  std::vector<PatchConfig> patches;
};
struct CutStep {
  std::vector<Vec3> corners;
};
struct ReleaseStep {
  std::vector<std::string> patches;
};
struct ResetStep {};
using Step = std::variant<SettleStep, LoadStep, CutStep, ReleaseStep, ResetStep>;

// One collision shape of a tool, placed in the frame of its link.
struct ToolShape {
  enum class Type { kSphere, kBox, kCylinder, kMesh };
  Type type = Type::kSphere;
  double radius = 0.0;        // sphere, cylinder
  double length = 0.0;        // cylinder, along its z axis
  Vec3 size = Vec3::Zero();   // box: full edge lengths
  std::string resource;       // mesh: package:// or file://
  Vec3 scale = Vec3::Ones();  // mesh
  Pose pose = Pose::Identity();
};

struct ToolConfig {
  std::string name;               // the link's name when the scene names none
  std::string link;               // URDF link
  double padding = 0.0;           // m, added to every shape
  std::vector<ToolShape> shapes;  // overlay: used instead of the URDF's collision geometry
};

struct Scene {
  TissueConfig tissue;
  SolverConfig solver;
  std::vector<ToolConfig> tools;
  std::vector<Step> steps;
  std::vector<std::string> remarks;  // lines the user should see, e.g. an entry the model ignores
};

}  // namespace robot_tissue
