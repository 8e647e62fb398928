// Finds the cheapest lattice and tolerance that meet an error and a rate, as a function: command
// line in, exit code out.
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace robot_tissue {

constexpr int kExitNoneMeetsBoth = 3;  // beside those of simulate.h

// `terminal`: err is watched by someone, show progress there.
int fidelity(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
             bool terminal);

}  // namespace robot_tissue
