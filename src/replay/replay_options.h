// The command line of `replay`.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace robot_tissue {

struct ReplayOptions {
  std::string scene, in, out;
  std::optional<std::string> urdf;     // --urdf FILE
  std::optional<double> rate;          // --rate HZ
  std::optional<std::string> threads;  // --threads N, as typed
  bool surface = false;                // --surface
  bool nodes = false;                  // --nodes
  bool help = false;
};

// Throws InputError, one line.
ReplayOptions parseReplayOptions(const std::vector<std::string>& words);
std::string replayHelp();

}  // namespace robot_tissue
