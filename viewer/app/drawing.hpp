#pragma once
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"
#include "viewer/render/renderer.hpp"

#include <memory>
#include <string>

namespace tumble {

/// A renderer with what it stands on; destroyed in reverse order.
struct Drawing {
  std::unique_ptr<GlContext> context;
  std::unique_ptr<Device> device;
  std::unique_ptr<Renderer> renderer;
};

/// With the context of this name (`--context`) and the shaders of the program. What is chosen goes
/// to the log; errors say why nothing can draw here.
Result<Drawing> make_drawing(const std::string& context, const LogSink& log);

/// Reads WxH, each 1 to 16384.
Status parse_picture_size(const std::string& text, int& width, int& height);

/// Names that `--context` takes, for its help.
std::string context_list();

}  // namespace tumble
