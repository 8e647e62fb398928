// What is simulated, as plain data: the meaning of a scene file after every check.
// Lengths in m, in the tissue frame unless said. No defaults are filled in elsewhere.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "robot_tissue/core/removed_space.h"
#include "robot_tissue/core/suture.h"
#include "robot_tissue/core/tool_role.h"
#include "robot_tissue/core/triangle_mesh.h"
#include "robot_tissue/core/types.h"

namespace robot_tissue {

// Stiffness is either a modulus or, with model six_spring only, the constant of one spring.
struct Material {
  enum class Law { kNeoHookean, kFung };

  double young_modulus = 0.0;   // Pa, at small strain; unused with spring_stiffness
  double poisson_ratio = 0.45;  // 0.25 .. 0.49; model six_spring has none
  double density = 1000.0;      // kg/m^3
  Law law = Law::kNeoHookean;
  double stiffening = 0.0;  // with kFung b of mu/(2b) (exp(b (I1bar - 3)) - 1); 0 is neo-Hookean
  std::optional<double> spring_stiffness;  // N/m
  double tear_stretch = 0.0;  // > 1: of the rest length, a longer spring severs; 0: none does
  double tear_length = 0.0;   // m: the spacing that tear_stretch is of, to be scaled to others so
                              // that cracks go under the same force; 0: it is of any spacing
};

struct Region {
  std::string name;
  Box box{Vec3::Zero(), Vec3::Zero()};       // the cells whose centers it holds; unused with mesh
  std::shared_ptr<const TriangleMesh> mesh;  // as the tissue's; may reach beyond it
  Material material;                         // the tissue's, with the region's own entries in place
  bool own_modulus = false;                  // its young_modulus is such an entry
};

// A wall too thin for the lattice, on the surface or a part of it: stretches, bends, and may have a
// pressure inside (doc/model.md, "Membranes").
struct MembraneConfig {
  enum class Side { kAll, kOuter, kInner };

  std::string name;
  double thickness = 0.0;       // m
  double young_modulus = 0.0;   // Pa, at small strain
  double poisson_ratio = 0.45;  // 0 .. 0.5
  Side side = Side::kAll;       // of the surface: around the tissue, or around its cavities
  std::vector<Box> boxes;       // at rest; none: everywhere on that side
  double pressure = 0.0;        // Pa, of what that side encloses over what is around the tissue
};

// The tissue moves in time, by its mass; in its stress the rate of strain counts, too:
// stress = elastic + damping_time (2 mu D + lambda tr D), D the rate of strain (doc/time.md).
struct TimeConfig {
  double damping_time = 0.0;  // s
};

// What becomes of a piece that cuts, or tools that let go, leave with nothing that holds it.
enum class FreePieces { kStay, kDrop };

struct TissueConfig {
  std::string frame_id = "tissue";
  Box shape{Vec3::Zero(), Vec3::Zero()};     // unused when mesh is set
  std::shared_ptr<const TriangleMesh> mesh;  // without fault (core/mesh_checks.h), facing outwards
  double spacing = 0.0;
  std::string model = "elastic";
  Material material;
  std::vector<Region> regions;  // a later one wins where two overlap
  std::vector<Box> fixed;       // nodes in these never move; none: the block floats in space
  std::vector<MembraneConfig> membranes;
  Vec3 gravity = Vec3::Zero();     // m/s^2
  std::optional<TimeConfig> time;  // empty: every shape is an equilibrium
  FreePieces free_pieces = FreePieces::kStay;
};

struct SolverConfig {
  std::string method = "layered";
  double tolerance = 0.01;  // relative, 0 < tolerance < 1
  double max_ms = 0.0;      // budget of one update; 0 = none
  // Of a load step of the tools (Pipeline::setMostIterations); empty: as who follows them wants.
  std::optional<int> max_iterations;
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
struct SutureStep {
  SutureConfig suture;  // without a name: the first of s1, s2, ... that is free then
};
struct ReleaseStep {
  std::vector<std::string> patches;
  std::vector<std::string> tools;  // graspers that let go, tools that a push drives
};
struct ResetStep {};
// A tool goes from one pose to another, straight and at an even rate.
struct MoveStep {
  struct Place {
    Pose pose = Pose::Identity();  // tissue_T_tool
    double opening = 0.0;          // of a grasper's jaws, m
  };
  std::string tool;
  std::optional<Place> from;  // empty: from where it stands
  Place to;
  std::optional<int> increments;   // empty: one a load step
  std::optional<double> duration;  // s; empty: no time goes by, each increment comes to balance
};
// Time goes by, tools stand.
struct WaitStep {
  double duration = 0.0;          // s
  std::optional<int> increments;  // empty: 1
};
// A force drives a tool from where it stands, along the force, until the tissue's answer equals it.
struct PushStep {
  std::string tool;
  Vec3 force = Vec3::Zero();      // of the tool on the tissue, tissue frame (N); not zero
  std::optional<int> increments;  // empty: 1
};
// A grasper without joints holds what is between its jaws.
struct GraspStep {
  std::string tool;
};
// Takes what is in the space away, as the shape is now.
struct RemoveStep {
  RemovedSpace space;
};
// Takes cuts and removals back, the latest first.
struct UndoStep {
  int count = 1;
};
// Topology, shape and named loads, to a file and back.
struct SaveStep {
  std::string file;  // a plain name
};
struct LoadStateStep {
  std::string file;
};
using Step =
    std::variant<SettleStep, LoadStep, CutStep, SutureStep, ReleaseStep, ResetStep, MoveStep,
                 WaitStep, PushStep, GraspStep, RemoveStep, UndoStep, SaveStep, LoadStateStep>;

// One collision shape of a tool, placed in the frame of its link.
struct ToolShape {
  enum class Type { kSphere, kBox, kCylinder, kMesh, kPlane };
  Type type = Type::kSphere;
  double radius = 0.0;           // sphere, cylinder
  double length = 0.0;           // cylinder, along its z axis
  Vec3 size = Vec3::Zero();      // box: full edge lengths
  std::string resource;          // mesh: package:// or file://
  Vec3 scale = Vec3::Ones();     // mesh
  Pose pose = Pose::Identity();  // plane: solid below its x-y plane
  double padding = 0.0;          // m, of this shape; added to its link's
};

// A link of the robot that touches the tissue.
struct ToolLink {
  std::string link;      // of the URDF; empty in the runner, where the pose is the tool's
  double padding = 0.0;  // m, added to every shape
  std::map<std::string, double> collision_padding;  // m, by the name of a collision of the URDF
  std::vector<ToolShape> shapes;  // overlay: used instead of the URDF's collision geometry
  std::string path;               // of its entry in the scene, for messages
};

// When a grasper holds. The gap is the distance between its two jaws.
struct GraspConfig {
  double close_gap = 0.0;             // m: jaws nearer than this hold what is between them
  double open_gap = 0.0;              // m: jaws farther than this let go; >= close_gap
  double max_force = 0.0;             // N: a stronger pull ends the grasp; 0 = never
  bool tears_out = false;             // then what is held comes out with it; else it lets go
  Vec3 opening_axis = Vec3::UnitY();  // runner: the jaws move apart along it, tool frame
};

// A blade cuts where its edge goes.
struct BladeConfig {
  std::vector<Vec3> edge;   // a polyline of 2 points or more, in the tool's frame (m)
  double resistance = 0.0;  // of new surface (J/m^2)
};

// Scissors cut where the edges of their jaws have passed each other.
struct ScissorsConfig {
  std::array<std::vector<Vec3>, 2> edges;  // polylines, each in its jaw's frame (m), which pass
                                           // each other at the same lengths from their first points
};

struct ToolConfig {
  // kConforming: each point of the tissue slides along the tool in its friction cone.
  // kRigid: what it touches moves with it as one hard piece (paper, section 4.3).
  enum class Patch { kConforming, kRigid };

  std::string name;  // the first link's name when the scene names none
  std::vector<ToolLink>
      links;  // the first one's frame is the tool's; the last two of a role with jaws: these
  ToolRole role;
  Patch patch = Patch::kConforming;
  double friction = 0.3;    // Coulomb's, >= 0
  double max_force = 0.0;   // N: a stronger wrench is told as this one, and flagged; 0 = none
  GraspConfig grasp;        // roles with jaws
  BladeConfig blade;        // roles with an edge
  ScissorsConfig scissors;  // roles that shear; opening_axis of `grasp` is theirs, too
};

// What the tissue rests on: a box or a plane that never moves.
struct SupportConfig {
  std::string name;
  ToolShape shape;  // kBox or kPlane, in the tissue's frame
  double friction = 0.3;
};

struct Scene {
  TissueConfig tissue;
  SolverConfig solver;
  std::vector<ToolConfig> tools;
  std::vector<SupportConfig> supports;
  std::vector<Step> steps;
  std::vector<std::string> remarks;  // lines the user should see, e.g. an entry the model ignores
};

}  // namespace robot_tissue
