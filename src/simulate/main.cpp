#include <unistd.h>

#include <csignal>
#include <iostream>
#include <thread>

#include "output_folder.h"
#include "simulate.h"

namespace {

int signal_pipe[2];  // read end, write end

// In any thread: libraries have some of their own.
void tellSignal(int signal) {
  const unsigned char number = static_cast<unsigned char>(signal);
  if (write(signal_pipe[1], &number, 1) != 1) _exit(128 + signal);
}

void handle(int signal) {
  struct sigaction earlier;
  if (sigaction(signal, nullptr, &earlier) != 0 || earlier.sa_handler == SIG_IGN) return;
  struct sigaction action = {};
  action.sa_handler = tellSignal;
  action.sa_flags = SA_RESTART;
  sigaction(signal, &action, nullptr);
}

// SIGINT, SIGTERM and SIGHUP end the program as ever, but leave nothing behind.
void endTidily() {
  if (pipe(signal_pipe) != 0) return;
  std::thread([] {
    unsigned char number = 0;
    while (read(signal_pipe[0], &number, 1) != 1) continue;
    robot_tissue::OutputFolder::discardAll();
    std::signal(number, SIG_DFL);
    raise(number);
  }).detach();
  handle(SIGINT);
  handle(SIGTERM);
  handle(SIGHUP);
}

}  // namespace

int main(int argc, char** argv) {
  endTidily();
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  return robot_tissue::simulate(arguments, std::cout, std::cerr, terminal);
}
