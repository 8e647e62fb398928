// replay SCENE.yaml IN.bag OUT.bag: see --help.
#include <csignal>
#include <iostream>

#include "replay.h"

namespace {

volatile std::sig_atomic_t stopped = 0;

void stop(int) { stopped = 1; }

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGINT, stop);
  std::signal(SIGTERM, stop);
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  return robot_tissue::replay(arguments, std::cout, std::cerr, [] { return stopped != 0; });
}
