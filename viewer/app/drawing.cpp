#include "viewer/app/drawing.hpp"

#include "engine/scene/resources.hpp"

#include <cstdio>

namespace tumble {

Result<Drawing> make_drawing(const std::string& name, const LogSink& log) {
  auto choice = create_context(name, log);
  if (!choice) return choice.error();
  Drawing d;
  d.context = std::move(choice->context);
  auto device = make_gl_device(*d.context);
  if (!device) return device.error();
  d.device = *std::move(device);
  const auto shaders = find_resource("shaders");
  if (!shaders) return shaders.error();
  auto renderer = Renderer::create(*d.device, *shaders);
  if (!renderer) return renderer.error();
  d.renderer = *std::move(renderer);
  return d;
}

Status parse_picture_size(const std::string& text, int& width, int& height) {
  int used = 0;
  const bool fine = std::sscanf(text.c_str(), "%5dx%5d%n", &width, &height, &used) == 2 &&
                    size_t(used) == text.size() && width >= 1 && height >= 1 && width <= 16384 &&
                    height <= 16384;
  if (fine) return {};
  return Error{ErrorCode::invalid_argument,
               "--size: '" + text + "' is not WxH with 1 to 16384 pixels",
               {},
               "e.g. --size 1280x720"};
}

std::string context_list() {
  std::string out;
  for (const std::string& name : context_names()) out += (out.empty() ? "" : ", ") + name;
  return out;
}

}  // namespace tumble
