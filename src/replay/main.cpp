// replay SCENE.yaml IN.bag OUT.bag: see --help.
#include <csignal>
#include <iostream>

#include "replay.h"

namespace {

volatile std::sig_atomic_t stopped = 0;

void stop(int) { stopped = 1; }

// But for what the program was started to ignore, as by nohup.
void handle(int signal) {
  if (std::signal(signal, stop) == SIG_IGN) std::signal(signal, SIG_IGN);
}

}  // namespace

int main(int argc, char** argv) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) handle(signal);
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  return robot_tissue::replay(arguments, std::cout, std::cerr, [] { return stopped != 0; });
}
