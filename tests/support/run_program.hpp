#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// How a program ended and what it said.
struct ProgramRun {
  int code = -1;  ///< exit code; 128 + signal when a signal ended it
  std::string out, err;
};

struct ProgramOptions {
  std::vector<std::pair<std::string, std::string>> environment;  ///< set; an empty value unsets
  /// Asked every few milliseconds while it runs; a signal number other than 0 is sent, once.
  std::function<int()> signal_when;
  std::filesystem::path stdout_to;  ///< instead of being captured
  unsigned long file_limit = 0;     ///< RLIMIT_FSIZE [bytes]; 0: none
  unsigned cpu_seconds = 0;         ///< ended by SIGXCPU after so much processor time; 0: no limit
  unsigned megabytes = 0;           ///< of address space, as limit_process does; 0: no limit
  double timeout = 120;             ///< killed after this [s]
};

/// Runs a program with arguments, without a shell, and waits for it.
ProgramRun run_program(const std::filesystem::path& program,
                       const std::vector<std::string>& arguments,
                       const ProgramOptions& options = {});

}  // namespace tumble
