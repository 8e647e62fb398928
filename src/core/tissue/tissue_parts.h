// The classes behind Tissue, each on those before it.
#pragma once

#include "tissue/load_program.h"
#include "tissue/load_step_solver.h"
#include "tissue/surgery.h"
#include "tissue/suturing.h"
#include "tissue/time_stepping.h"
#include "tissue/tissue_data.h"
#include "tissue/tissue_forces.h"
#include "tissue/tissue_states.h"

namespace robot_tissue {

struct TissueParts {
  TissueParts(const TissueConfig& tissue, const SolverConfig& config)
      : data(tissue, config),
        surgery(tissue, data, solver),
        states(tissue, config, data, solver, surgery, suturing, program) {}

  TissueData data;
  TissueForces forces{data};
  LoadStepSolver solver{data};
  Surgery surgery;
  Suturing suturing{data, solver, surgery};
  LoadProgram program{data, forces, solver, surgery, suturing};
  TimeStepping time{data, solver, surgery};
  TissueStates states;
};

}  // namespace robot_tissue
