// Runs a scene's steps and keeps what the output files hold.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "robot_tissue/core/deadline.h"
#include "robot_tissue/core/scene.h"
#include "robot_tissue/core/tissue.h"

namespace robot_tissue {

struct IncrementRow {
  int step = 0;       // from 0, as in steps[0]
  int increment = 1;  // from 1, anew in every step
  SolveReport report;
  double update_ms = 0.0;  // contacts and solve
  double time = 0.0;       // that went by since the start (s)
};

struct PatchRow {
  int step = 0;
  int increment = 1;
  std::string patch;
  PatchAnswer answer;
};

struct ToolRow {
  int step = 0;
  int increment = 1;
  std::string tool;
  Vec3 force = Vec3::Zero();   // of the tissue on the tool, tissue frame (N)
  Vec3 torque = Vec3::Zero();  // about the tool's origin, tissue frame (N m)
  int contacts = 0;
  double max_penetration = 0.0;  // m
};

struct PieceRow {
  int step = 0;
  int increment = 1;
  TissuePiece piece;
};

struct SutureRow {
  int step = 0;
  int increment = 1;
  SutureReport suture;
};

struct RunResult {
  std::vector<IncrementRow> increments;
  std::vector<PatchRow> patches;
  std::vector<ToolRow> tools;    // of those that stand somewhere
  std::vector<PieceRow> pieces;  // where the scene parts tissue
  std::vector<SutureRow> sutures;
  std::vector<Vec3> rest;          // per node that is there (m, tissue frame)
  std::vector<Vec3> displacement;  // likewise (m)
  std::vector<Vec3> vertices;      // of the deformed surface (m, tissue frame)
  std::vector<std::array<int, 3>> triangles;
  std::map<std::string, std::string> saved;  // states, by file
  std::string cut_off;                       // where the time was over; empty: all was run
  std::vector<std::string> remarks;  // lines the user should see, e.g. a tool that missed its force

  bool allOk() const;  // and all was run
};

// Called after each increment: the row and how many increments its step has.
using OnRow = std::function<void(const IncrementRow& row, int increments)>;

// Called when a step (from 0) has ended, with the tissue as it is then.
using OnStep = std::function<void(int step, const Tissue& tissue)>;

// Whether a step, a blade, a pull or a stretch may part the scene's tissue, or mend it.
bool partsTissue(const Scene& scene);

// `state_folder`: where states are loaded from that no step has saved.
// Throws InputError when a tool's shapes or a step are refused; the message names the step. After
// the deadline it ends with the increment under way.
RunResult runScene(const Scene& scene, const OnRow& on_row = {}, const OnStep& on_step = {},
                   const Deadline& deadline = Deadline(), const std::string& state_folder = ".");

}  // namespace robot_tissue
