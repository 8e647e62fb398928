#include <unistd.h>

#include <iostream>

#include "fidelity.h"

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  return robot_tissue::fidelity(arguments, std::cout, std::cerr, terminal);
}
