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
#include "tool_contact_update.h"
#include "tool_motion.h"
#include "touch_finder.h"
#include "way_lengths.h"
#include "world.h"

namespace robot_tissue {

struct Pipeline::Parts {
  Parts(const TissueConfig& tissue, const SolverConfig& solver) : world(tissue, solver) {}

  World world;
  ForceDrive drive;
  WayLengths ways{world};
  TouchFinder touch_finder{world};
  ToolContactUpdate contact_update{world, touch_finder};
  Grasping grasping{world};
  OverlapResolver overlap{world};
  LoadStepper load_step{world, touch_finder, contact_update, grasping};
  Blades blades{world, load_step};
  Burrs burrs{world};
  Scissors scissors{world};
  ToolMotion motion{world, ways, overlap, grasping, load_step};
};

}  // namespace robot_tissue
