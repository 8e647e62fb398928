// The command line of `fidelity`.
#pragma once

#include <string>
#include <vector>

namespace robot_tissue {

struct FidelityArguments {
  std::string scene;
  double error = 0.05;           // relative, allowed of displacements and forces
  double rate = 100.0;           // updates a second that are wanted (Hz)
  double seconds = 60.0;         // that measuring may take
  double way_an_update = 0.001;  // of a patch or tool (m)
  std::string method = "layered";
  std::string write;  // file for the scene with the choice; empty: none
  std::string csv;    // file for the table; empty: none
  bool quiet = false;
  bool help = false;
};

// Throws InputError, one line.
FidelityArguments parseFidelityArguments(const std::vector<std::string>& words);

std::string fidelityHelp();

}  // namespace robot_tissue
