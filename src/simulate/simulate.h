// The offline runner as a function: command line in, exit code out.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>
#include <vector>

namespace robot_tissue {

constexpr int kExitOk = 0;
constexpr int kExitFailure = 1;  // unforeseen, nothing written
constexpr int kExitBadInput = 2;
constexpr int kExitNotAllOk = 3;

// What `run` answers, or the exit code of what it throws, which is told on `err` in one line.
int exitCodeOf(const std::string& program, std::ostream& err, const std::function<int()>& run);

// `terminal`: err is watched by someone, show progress there.
int simulate(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err,
             bool terminal);

}  // namespace robot_tissue
