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

}  // namespace tumble
