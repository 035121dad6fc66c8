#include "viewer/app/command.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  // A file beyond `ulimit -f` shall be a reported error (exit 5), not a silent death.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    return tumble::run_command_line(arguments);
  } catch (const std::exception& e) {  // out of memory, a library's own
    std::fprintf(stderr, "tumble: %s\n", e.what());
    return tumble::exit_broken_down;
  }
}
