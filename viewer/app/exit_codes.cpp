#include "viewer/app/exit_codes.hpp"

#include <cstdio>

namespace tumble {

int report(const Error& error, ExitCode code) {
  std::fprintf(stderr, "tumble: %s\n", error.text().c_str());
  return code;
}

void warn(const Error& warning) {
  std::fprintf(stderr, "tumble: warning: %s\n", warning.text().c_str());
}

ExitCode report_no_memory() {
  std::fputs(
      "tumble: there is not enough memory for this (use fewer or simpler bodies, meshes and "
      "particles, or a machine with more)\n",
      stderr);
  return exit_no_memory;
}

}  // namespace tumble
