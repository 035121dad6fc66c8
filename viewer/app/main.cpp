#include "viewer/app/command.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  // A file beyond `ulimit -f` shall be a reported error (exit 5), not a silent death.
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    const std::vector<std::string> arguments(argv + (argc > 0 ? 1 : 0), argv + argc);
    return tumble::run_command_line(arguments);
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr,
                 "tumble: there is not enough memory for this (use fewer or simpler bodies, "
                 "meshes and particles, or a machine with more)\n");
    return tumble::exit_broken_down;
  } catch (const std::exception& e) {  // a library's own
    std::fprintf(stderr, "tumble: %s\n", e.what());
    return tumble::exit_broken_down;
  }
}
