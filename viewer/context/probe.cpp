#include "viewer/context/probe.hpp"

#include "viewer/context/gl_context.hpp"
#include "viewer/render/gl/gl_device.hpp"

#include <fmt/format.h>

namespace tumble {
namespace {

const char* vertex_source = R"(#version 330 core
void main() {
  vec2 p = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
  gl_Position = vec4(2.0 * p - 1.0, 0.0, 1.0);
}
)";
const char* fragment_source = R"(#version 330 core
out vec4 colour;
void main() { colour = gl_FragCoord.x < 8.0 ? vec4(1.0, 0.0, 0.0, 1.0) : vec4(0.0, 0.0, 1.0, 1.0); }
)";

/// Draws the left half red and the right half blue, multisampled if supported, and checks the
/// pixels.
Status draw_and_look(Device& device) {
  PipelineDesc desc;
  desc.name = "probe";
  desc.vertex_source = vertex_source;
  desc.fragment_source = fragment_source;
  desc.depth_test = DepthTest::none;
  desc.depth_write = false;
  desc.cull = Cull::none;
  auto pipeline = device.create_pipeline(desc);
  if (!pipeline) return pipeline.error();
  TargetDesc shape;
  shape.width = shape.height = 16;
  auto picture = device.create_target(shape);
  if (!picture) return picture.error();
  shape.samples = 4;
  auto canvas = device.create_target(shape);
  if (!canvas) return canvas.error();

  device.begin_frame();
  device.begin_pass({*canvas, std::array<float, 4>{0, 1, 0, 1}, true});
  DrawCall call;
  call.pipeline = *pipeline;
  call.count = 3;
  device.draw(call);
  device.end_pass();
  device.resolve(*canvas, *picture);
  std::vector<uint8_t> pixels(size_t(16) * 16 * 4);
  device.read_pixels(*picture, pixels);
  const auto faults = device.take_faults();
  const Status linked = device.take_link_failure();
  device.destroy(*canvas);
  device.destroy(*picture);
  device.destroy(*pipeline);
  if (!linked) return Error{ErrorCode::unsupported, linked.error().text(), "", ""};
  if (!faults.empty()) return Error{ErrorCode::unsupported, faults.front(), "", ""};
  for (size_t i = 0; i < pixels.size(); i += 4) {
    const bool left = (i / 4) % 16 < 8;
    if (pixels[i] == (left ? 255 : 0) && pixels[i + 1] == 0 && pixels[i + 2] == (left ? 0 : 255))
      continue;
    return Error{ErrorCode::unsupported,
                 fmt::format("drew a wrong pixel ({}, {}, {}) in the test picture", pixels[i],
                             pixels[i + 1], pixels[i + 2]),
                 "", ""};
  }
  return {};
}

void set_fault(DoctorEntry& entry, const Error& error) {
  entry.cause = error.place.empty() || error.place == entry.name
                    ? error.message
                    : error.place + ": " + error.message;
  entry.cure = error.cure.empty() ? "update the driver, or use another --context" : error.cure;
}

}  // namespace

DoctorEntry probe_context(const std::string& name) {
  DoctorEntry entry;
  entry.name = name;
  auto choice = create_context(name);
  if (!choice) {
    set_fault(entry, choice.error());
    return entry;
  }
  const ContextInfo& info = choice->context->info();
  entry.detail = info.detail;
  entry.renderer = info.renderer;
  entry.version = info.version;
  entry.software = info.software;
  auto device = make_gl_device(*choice->context);
  if (!device) {
    set_fault(entry, device.error());
    return entry;
  }
  if (Status s = draw_and_look(**device); !s)
    set_fault(entry, s.error());
  else
    entry.ok = true;
  return entry;
}

}  // namespace tumble
