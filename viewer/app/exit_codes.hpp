#pragma once
#include "engine/core/error.hpp"

namespace tumble {

/// Exit codes of the program, with the same meaning in every command.
enum ExitCode : int {
  exit_ok = 0,
  exit_negative = 1,       ///< images differ, an assertion fails, a replay diverges
  exit_usage = 2,          ///< bad command line
  exit_bad_input = 3,      ///< bad scene, asset or picture
  exit_no_renderer = 4,    ///< no usable renderer or display
  exit_cannot_write = 5,   ///< output could not be written
  exit_broken_down = 6,    ///< the simulation broke down
  exit_no_memory = 7,      ///< there was not enough memory
  exit_interrupted = 130,  ///< Ctrl-C
  exit_terminated = 143,   ///< SIGTERM
};

/// Writes "tumble: place: message (cure)" to stderr and returns `code`.
int report(const Error& error, ExitCode code);
/// The same for a warning, without a code.
void warn(const Error& warning);
/// The same for a bad_alloc, in any thread; allocates no memory.
ExitCode report_no_memory();

}  // namespace tumble
