#pragma once
#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"
#include "viewer/render/renderer.hpp"

#include <memory>
#include <string>

namespace tumble {

/// A renderer with its device and context; destroyed in reverse order.
struct Drawing {
  std::unique_ptr<GlContext> context;
  std::unique_ptr<Device> device;
  std::unique_ptr<Renderer> renderer;
};

/// Makes the graphics context of this name (`--context`) and a renderer with the program's shaders.
/// The choice is logged; the error says why nothing can be drawn on this machine.
Result<Drawing> make_drawing(const std::string& context, const LogSink& log);

/// Parses WxH, each 1 to 16384.
Status parse_picture_size(const std::string& text, int& width, int& height);

/// Names that `--context` takes, for its help.
std::string context_list();

}  // namespace tumble
