// The classes behind Pipeline, each on those before it.
#pragma once

#include "blades.h"
#include "burrs.h"
#include "force_drive.h"
#include "grasping.h"
#include "load_stepper.h"
#include "overlap_resolver.h"
#include "robot_tissue/pipeline/pipeline.h"
#include "scissors.h"
#include "shape_judge.h"
#include "tool_contact_update.h"
#include "tool_motion.h"
#include "touch_finder.h"
#include "unfinished_load_step.h"
#include "way_lengths.h"
#include "world.h"

namespace robot_tissue {

// What steps change, but for the world's and the tissue: what a trial does is undone by taking a
// copy back. The classes below keep here what they remember from one step to the next, and have
// nothing else that later steps depend on.
struct Pipeline::State {
  ForceDrive drive;
  TouchState touches;
  std::vector<Jaws> jaws;
  UnfinishedLoadStep under_way;
  std::vector<BladeState> blades;
  std::vector<BurrState> burrs;
  std::vector<ScissorsState> scissors;
  WayBehind way_behind;
  RobotPose told;             // in the last step: tools that a force drives are farther
  int late_iterations = 0;    // of the method, where the tools stand
  bool gave_up = false;       // a solve that did not converge while they stood
  bool touched = true;        // the reports are to be brought up to date
  bool was_near = false;      // a tool, in the last step in which nothing was solved
  double reporting_ms = 0.0;  // that the last reports on the tools took
};

struct Pipeline::Parts {
  Parts(const TissueConfig& tissue, const SolverConfig& solver) : world(tissue, solver) {}

  World world;
  State state;
  WayLengths ways{world};
  TouchFinder touch_finder{world, state.touches, world.report.contact_ms};
  ToolContactUpdate contact_update{world, touch_finder};
  Grasping grasping{world, state.jaws};
  OverlapResolver overlap{world};
  ShapeJudge judge{world, touch_finder, contact_update};
  LoadStepper load_step{world, touch_finder, judge, grasping, state.under_way};
  Blades blades{world, load_step, state.blades};
  Burrs burrs{world, state.burrs};
  Scissors scissors{world, state.scissors};
  ToolMotion motion{world, ways, overlap, grasping, judge, load_step, state.way_behind};
};

}  // namespace robot_tissue
