#pragma once
#include "engine/core/error.hpp"

namespace tumble {

/// A fault of a mesh with the cures that the window has: what to choose and press, in place of keys
/// of files and commands of the shell.
Error with_cure_in_window(Error fault);

}  // namespace tumble
