#pragma once
#include "viewer/render/device.hpp"

namespace tumble {

/// A device that draws nothing and checks everything: ids, sizes, ranges, states, leaks. Read-back
/// gives a test pattern whose colours depend on the draw-list hash.
std::unique_ptr<Device> make_null_device();

}  // namespace tumble
