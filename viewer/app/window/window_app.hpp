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
  std::filesystem::path script;       ///< see ScriptedInput; played once, then the window stays
};

/// Opens the window and runs until it is closed. Gives the exit code of the program: 0; 130 and 143
/// after a signal; 2 for a bad script; 4 when there is no window to be had or drawing fails (said
/// on stderr).
int run_window(WindowAppOptions options, OpenedScene scene);

}  // namespace tumble
