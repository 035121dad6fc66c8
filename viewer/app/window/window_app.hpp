#pragma once
#include "viewer/app/window/application.hpp"

#include <filesystem>
#include <string>

namespace tumble {

struct WindowAppOptions {
  ApplicationOptions application;
  int width = 1280, height = 800;     ///< [window units]
  double scale = 0;                   ///< pixels per UI unit; 0: the monitor's content scale
  std::filesystem::path status_file;  ///< see StatusFile; empty: none
  /// See ScriptedInput; it is played once, then the window stays open.
  std::filesystem::path script;
};

/// Opens the window and runs until it is closed. Returns the exit code of the program: 0; 130 and
/// 143 after a signal; 2 for an invalid script; 4 if no window can be opened or drawing fails
/// (reported on stderr).
int run_window(WindowAppOptions options, OpenedScene scene);

}  // namespace tumble
