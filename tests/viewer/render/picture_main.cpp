// Draws the demo scene to a PNG and prints what it cost: a tool for looking, not a test.
// usage: demo_picture OUT.png [bodies] [context] [frames] [variant] [WxH]
// variants, by their names in any order: cubes or balls (nothing else, tumbling), particles
// (20000), marks, low, draft, high, noshadow, noground, back, top, close, tiny, huge
#include "engine/core/random.hpp"
#include "tests/viewer/render/demo_scene.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/gl/gl_device.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/render/resources.hpp"

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>

#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb_image_write.h>
#pragma GCC diagnostic pop

using namespace tumble;

namespace {

double milliseconds(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) * 1e3 + double(t.tv_nsec) * 1e-6;
}

/// Nothing but `count` bodies of one shape, tumbling in a cloud that fills the picture.
void add_cloud(RenderScene& s, size_t count, bool cubes) {
  s.instances.clear();
  Random random(3);
  while (s.instances.size() < count) {
    std::array<double, 7> r;
    for (double& v : r) v = random.uniform(-1, 1);
    const Vec3 x(6 * r[0], 3.2 + 2.9 * r[1], 5 * r[2]);
    const Quat q = Quat(r[3], r[4], r[5], r[6]).normalized();
    Paint paint;
    paint.colour = linear_from_srgb(cubes ? 0xC8553D : 0x2E7F86);
    s.instances.push_back(cubes ? box_instance({x, q}, Vec3(0.2, 0.2, 0.2), paint)
                                : sphere_instance({x, q}, 0.25, paint));
  }
  s.camera.target = Vec3(0, 2.5, 0);
}

void vary(RenderScene& s, const std::string& variant) {
  if (variant.find("cubes") != variant.npos) add_cloud(s, s.instances.size(), true);
  if (variant.find("balls") != variant.npos) add_cloud(s, s.instances.size(), false);
  if (variant.find("marks") != variant.npos) test::add_marks(s);
  if (variant.find("particles") != variant.npos)
    for (int i = 0; i < 20000; ++i)
      s.spheres.push_back({Vec3f(0.1f * float(i % 40) - 2, 0.05f + 0.1f * float(i / 1600),
                                 0.1f * float(i / 40 % 40) - 2),
                           0.05f, Vec4f(0.05f, 0.3f, 0.7f, 1)});
  if (variant.find("low") != variant.npos) s.sun.to_sun = Vec3(0.9, 0.22, 0.2);
  if (variant.find("draft") != variant.npos) s.quality = Quality::draft;
  if (variant.find("high") != variant.npos) s.quality = Quality::high;
  if (variant.find("noshadow") != variant.npos) s.sun.shadows = false;
  if (variant.find("noground") != variant.npos) s.ground.visible = false;
  if (variant.find("back") != variant.npos) s.camera.eye = Vec3(-7.5, 2.2, -8.5);
  if (variant.find("top") != variant.npos) s.camera.eye = Vec3(0.1, 16, 3);
  if (variant.find("close") != variant.npos) {
    s.camera.eye = Vec3(3.4, 1.3, 5.2);
    s.camera.target = Vec3(1.5, 0.4, 2);
  }
  const double scale = variant.find("tiny") != variant.npos   ? 0.02
                       : variant.find("huge") != variant.npos ? 20
                                                              : 1;
  if (scale == 1) return;
  s.camera.eye *= scale;
  s.camera.target *= scale;
  for (MeshInstance& i : s.instances) {
    i.transform.linear *= float(scale);
    i.transform.offset *= float(scale);
    i.inflate *= float(scale);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double begin = milliseconds(CLOCK_MONOTONIC);
  const auto arg = [&](int i, const char* fallback) { return argc > i ? argv[i] : fallback; };
  const std::string variant = arg(5, "");
  int width = 1280, height = 720;
  std::sscanf(arg(6, "1280x720"), "%dx%d", &width, &height);
  RenderScene scene = test::demo_scene(std::atoi(arg(2, "200")));
  vary(scene, variant);
  auto context = create_context(arg(3, "auto"), stderr_log());
  if (!context) return std::fprintf(stderr, "%s\n", context.error().text().c_str()), 4;
  auto device = make_gl_device(*context->context);
  if (!device) return std::fprintf(stderr, "%s\n", device.error().text().c_str()), 4;
  auto shaders = resource_path("shaders");
  auto renderer = Renderer::create(**device, *shaders);
  if (!renderer) return std::fprintf(stderr, "%s\n", renderer.error().text().c_str()), 4;
  Image image;
  const int frames = std::atoi(arg(4, "1"));
  double wall = 0, cpu = 0;
  for (int i = 0; i < frames; ++i) {
    auto report = (*renderer)->render(scene, width, height);
    if (!report) return std::fprintf(stderr, "%s\n", report.error().text().c_str()), 1;
    if (Status s = (*renderer)->read_back(image); !s) return 1;
    if (i == 0) {
      std::fprintf(stderr,
                   "first frame after %.0f ms; %u draws, %lu triangles, %u seen, %u culled\n",
                   milliseconds(CLOCK_MONOTONIC) - begin, report->draws.draws,
                   (unsigned long)report->draws.triangles, report->visible_instances,
                   report->culled_instances);
      wall = milliseconds(CLOCK_MONOTONIC);
      cpu = milliseconds(CLOCK_PROCESS_CPUTIME_ID);
    }
  }
  if (frames > 1)
    std::fprintf(stderr, "%.1f ms a frame, %.1f ms of processor\n",
                 (milliseconds(CLOCK_MONOTONIC) - wall) / (frames - 1),
                 (milliseconds(CLOCK_PROCESS_CPUTIME_ID) - cpu) / (frames - 1));
  stbi_write_png(arg(1, "demo.png"), width, height, 4, image.pixels.data(), width * 4);
}
