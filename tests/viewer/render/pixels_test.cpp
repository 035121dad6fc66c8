// Pictures of the GL device. References: the null device (draw-list hash), the other backends of
// the same Mesa (equal pixels), and what a scene must look like where that is plain.
#include "tests/support/why_not.hpp"
#include "tests/viewer/render/demo_scene.hpp"
#include "viewer/context/gl_context.hpp"
#include "viewer/render/builtin_meshes.hpp"
#include "viewer/render/gl/average.hpp"
#include "viewer/render/gl/gl_device.hpp"
#include "viewer/render/null/null_device.hpp"
#include "viewer/render/pipelines.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/render/resources.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <vector>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

struct Studio {
  ContextChoice choice;
  std::unique_ptr<Device> device;
  std::unique_ptr<Renderer> renderer;

  explicit Studio(const char* context) {
    auto made = create_context(context);
    REQUIRE_MESSAGE(made.ok(), test::why_not(made));
    choice = std::move(*made);
    auto d = make_gl_device(*choice.context);
    REQUIRE(d.ok());
    device = std::move(*d);
    auto r = Renderer::create(*device, *resource_path("shaders"));
    REQUIRE_MESSAGE(r.ok(), test::why_not(r));
    renderer = std::move(*r);
  }
  ~Studio() {
    renderer.reset();
    device.reset();
  }
  Image picture(const RenderScene& scene, int w = 480, int h = 270) {
    auto report = renderer->render(scene, w, h);
    REQUIRE_MESSAGE(report.ok(), test::why_not(report));
    hash = report->draws.hash;
    Image image;
    REQUIRE(renderer->read_back(image).ok());
    return image;
  }
  uint64_t hash = 0;
};

RenderScene everything() {
  RenderScene scene = test::demo_scene();
  test::add_marks(scene);
  return scene;
}

int brightness(const uint8_t* p) {
  return (p[0] + p[1] + p[2]) / 3;
}

void check_every_backend(const RenderScene& scene) {
  auto null_device = make_null_device();
  auto null_renderer = Renderer::create(*null_device, *resource_path("shaders"));
  REQUIRE(null_renderer.ok());
  auto report = (*null_renderer)->render(scene, 480, 270);
  REQUIRE(report.ok());

  Image first;
  std::string renderer;
  std::vector<const char*> names = {"egl:0", "surfaceless", "osmesa"};
#ifdef TUMBLE_WINDOW
  if (std::getenv("DISPLAY")) names.push_back("window");  // see CMakeLists.txt: under Xvfb
#endif
  for (const char* name : names) {
    CAPTURE(name);
    Studio studio(name);
    const Image image = studio.picture(scene);
    CHECK(studio.hash == report->draws.hash);
    CHECK_FALSE(is_uniform(image, 8));
    const std::string here = studio.device->info().renderer + studio.choice.context->info().version;
    if (first.empty()) {
      first = image;
      renderer = here;
    }
    if (here == renderer) CHECK(image.pixels == first.pixels);
    CHECK(studio.picture(scene).pixels == image.pixels);  // and again
  }
}

}  // namespace

TEST_CASE("every backend draws the same pixels, and the null device the same list") {
  check_every_backend(everything());
}

TEST_CASE("every backend draws the same liquid and smoke") {
  check_every_backend(test::soft_scene());
}

TEST_CASE("a liquid bends and tints what is behind it, and what stands before it hides it") {
  Studio studio("auto");
  RenderScene scene = test::soft_scene();
  scene.smoke.clear();
  scene.fluids[0].colour = Vec3f(0.02f, 0.3f, 0.9f);
  const Image with = studio.picture(scene);
  RenderScene dry = scene;
  dry.fluids.clear();
  const Image without = studio.picture(dry);
  const auto at = [&](const Image& image, const Vec3& x) {
    const Vec3 p = project(scene.camera, x, image.width, image.height);
    return image.at(int(p.x()), int(p.y()));
  };
  const uint8_t* water = at(with, Vec3(-0.5, 0.25, 0.95));
  CHECK(int(water[2]) > int(water[0]) + 40);
  const uint8_t* ground = at(without, Vec3(-0.5, 0.25, 0.95));
  CHECK(std::abs(int(ground[2]) - int(ground[0])) < 30);
  // Sky above, and the ground far from it, are as they were.
  for (const auto& [x, y] : {std::pair{20, 10}, {470, 10}, {20, 260}})
    CHECK(std::abs(brightness(with.at(x, y)) - brightness(without.at(x, y))) < 3);
}

TEST_CASE("smoke covers what is behind it, the more the thicker, and shades the ground") {
  Studio studio("auto");
  RenderScene scene;
  scene.ground.grid = false;
  scene.sun.to_sun = Vec3(-1, 1, 0);
  scene.camera.eye = Vec3(0, 3, 9);
  scene.camera.target = Vec3(0, 1.5, 0);
  const Image clear = studio.picture(scene);
  SmokePuff puff;
  puff.centre = Vec3f(0, 1.5f, 0);
  puff.radius = 1;
  puff.colour = Vec3f(0.7f, 0.05f, 0.05f);
  puff.opacity = 0.5f;
  scene.smoke.assign(2, puff);
  const Image thin = studio.picture(scene);
  scene.smoke.assign(12, puff);
  const Image thick = studio.picture(scene);
  const auto redness = [&](const Image& image) {
    const uint8_t* p = image.at(240, 135);
    return int(p[0]) - int(p[1]);
  };
  CHECK(redness(thin) > redness(clear) + 20);
  CHECK(redness(thick) > redness(thin) + 15);
  const Vec3 shade = project(scene.camera, Vec3(1.5, 0, 0), 480, 270);
  CHECK(brightness(thick.at(int(shade.x()), int(shade.y()))) <
        brightness(clear.at(int(shade.x()), int(shade.y()))) - 20);
}

TEST_CASE("smoke of half the pixels looks as smoke of all of them, also at the edges of bodies") {
  Studio studio("auto");
  RenderScene scene;
  scene.camera.eye = Vec3(0, 1, 7);
  scene.camera.target = Vec3(0, 1, 0);
  // Nothing else depends on the quality.
  scene.ground.visible = false;
  scene.sun.shadows = false;
  for (int k = 0; k < 5; ++k) {
    MeshInstance ball;
    ball.mesh = sphere_mesh();
    ball.transform.offset = Vec3f(-2 + float(k), 1 + 0.3f * float(k % 2), -1 + 0.5f * float(k));
    ball.transform.linear *= 0.25f;
    ball.paint.colour = Vec3f(0.02f, 0.02f, 0.02f);
    scene.instances.push_back(ball);
  }
  const auto picture = [&](Quality quality, bool smoke) {
    scene.quality = quality;
    scene.smoke.clear();
    for (uint32_t k = 0; smoke && k < 12; ++k) {
      SmokePuff puff;
      puff.centre = Vec3f(-2 + 0.37f * float(k), 1, -0.5f + 0.2f * float(k % 5));
      puff.radius = 0.9f;
      puff.colour = Vec3f(0.8f, 0.8f, 0.8f);
      puff.opacity = 0.5f;
      puff.kind = k % 4;
      scene.smoke.push_back(puff);
    }
    return studio.picture(scene);
  };
  const Image clear = picture(Quality::standard, false);
  CHECK(clear.pixels == picture(Quality::high, false).pixels);
  const Image half = picture(Quality::standard, true), all = picture(Quality::high, true);
  double sum = 0;
  size_t covered = 0, far = 0;
  for (size_t i = 0; i < all.pixels.size(); i += 4) {
    const int apart = std::abs(brightness(&half.pixels[i]) - brightness(&all.pixels[i]));
    sum += apart * apart;
    covered += std::abs(brightness(&clear.pixels[i]) - brightness(&all.pixels[i])) > 8;
    far += apart > 16;
  }
  const auto pixels = double(all.pixels.size() / 4);
  CHECK(covered > 10000);
  CHECK(std::sqrt(sum / pixels) < 0.8);
  CHECK(far < covered / 500);
}

TEST_CASE("ground and sky laid under bodies look as drawn among their samples") {
  // Where there are liquids, ground and sky have all samples: here one without a drop.
  Studio studio("auto");
  for (RenderScene scene : {everything(), test::demo_scene(), test::soft_scene()}) {
    scene.fluids.clear();
    scene.smoke.clear();
    const Image under = studio.picture(scene);
    const uint64_t hash = studio.hash;
    scene.fluids.push_back({});
    const Image among = studio.picture(scene);
    CHECK(studio.hash != hash);
    REQUIRE(under.pixels.size() == among.pixels.size());
    int most = 0;
    size_t rounded = 0;
    for (size_t i = 0; i < under.pixels.size(); ++i) {
      const int d = std::abs(int(under.pixels[i]) - int(among.pixels[i]));
      most = std::max(most, d);
      rounded += d > 1;
    }
    CHECK(most <= 4);  // a step for the average, and one for each see-through thing over it
    CHECK(rounded < under.pixels.size() / 200);
  }
}

TEST_CASE("all resources are given back") {
  Studio studio("auto");
  studio.picture(everything());
  studio.picture(test::soft_scene());
  studio.renderer.reset();
  CHECK(studio.device->stats().live_resources == 0);
  CHECK(studio.device->take_faults().empty());
}

TEST_CASE("two contexts in one process draw beside each other") {
  Studio a("egl:0"), b("osmesa");
  const RenderScene scene = everything();
  REQUIRE(a.choice.context->make_current().ok());
  const Image one = a.picture(scene, 200, 100);
  REQUIRE(b.choice.context->make_current().ok());
  const Image two = b.picture(scene, 200, 100);
  CHECK(one.pixels == two.pixels);
  b.renderer.reset();
  b.device.reset();
  REQUIRE(a.choice.context->make_current().ok());
}

TEST_CASE("top row first: sky above, ground below, a red ball is where it projects to") {
  Studio studio("auto");
  RenderScene scene;
  Paint red;
  red.colour = Vec3f(0.8f, 0.02f, 0.02f);
  scene.instances.push_back(sphere_instance({Vec3(-1, 1, 0), Quat::Identity()}, 0.5, red));
  scene.camera.eye = Vec3(0, 1.5, 8);
  const Image image = studio.picture(scene);
  const uint8_t* sky = image.at(400, 5);
  CHECK(sky[2] > sky[0]);  // blue
  const Vec3 p = project(scene.camera, Vec3(-1, 1, 0), image.width, image.height);
  const uint8_t* ball = image.at(int(p.x()), int(p.y()));
  CHECK(int(ball[0]) > 2 * ball[1]);
  CHECK(int(ball[0]) > 2 * ball[2]);
}

TEST_CASE("a ball found by its shader looks as one of many triangles") {
  // A ball squashed by a little more than a rounding error is drawn as triangles.
  Studio studio("auto");
  RenderScene scene;
  Paint paint;
  paint.colour = Vec3f(0.1f, 0.4f, 0.7f);
  paint.pattern = Pattern::quarters;
  scene.camera.eye = Vec3(1.5, 2, 3.4);
  scene.camera.target = Vec3(0, 0.8, 0);
  const Pose turned{Vec3(0, 0.8, 0), Quat(0.8, 0.36, 0.48, 0)};
  // Half sunk into a box: where they meet tells its depth.
  scene.instances = {box_instance({Vec3(0.7, 0.5, 0), Quat::Identity()}, Vec3(0.5, 0.5, 0.5), {}),
                     sphere_instance(turned, 0.8, paint)};
  const Image card = studio.picture(scene);
  scene.instances[1] = mesh_instance(sphere_mesh(), turned, Vec3(0.8, 0.8, 0.8008), paint);
  const Image mesh = studio.picture(scene);
  int different = 0;
  double sum = 0;
  for (size_t i = 0; i < card.pixels.size(); ++i) {
    const int d = std::abs(int(card.pixels[i]) - int(mesh.pixels[i]));
    different += d > 40;
    sum += d;
  }
  CHECK(different < 4 * 480 * 270 / 200);
  CHECK(sum / double(card.pixels.size()) < 0.6);
  CHECK(card.pixels != mesh.pixels);
}

TEST_CASE("ground that nothing shades looks as ground that could be, and is not") {
  // Beads of a fifth of a millimetre have the ground about them look into the maps of shadows, and
  // find none. Four at the corners give both pictures the same haze. Seen flat and steeply, since
  // what the ground mirrors changes with that.
  Studio studio("auto");
  for (const double height : {0.3, 1.5, 6.0}) {
    CAPTURE(height);
    RenderScene scene;
    scene.camera.eye = Vec3(0, height, 8);
    const auto add = [&](double x, double z) {
      scene.instances.push_back(sphere_instance({Vec3(x, 2e-4, z), Quat::Identity()}, 2e-4, {}));
    };
    for (const double x : {-8.0, 8.0})
      for (const double z : {-8.0, 7.5}) add(x, z);
    const Image bare = studio.picture(scene);
    for (int i = -15; i < 16; ++i)
      for (int k = -15; k < 15; ++k) add(0.5 * i, 0.5 * k);
    const Image looked_up = studio.picture(scene);
    size_t different = 0;
    for (size_t i = 0; i < bare.pixels.size(); ++i)
      different += std::abs(int(bare.pixels[i]) - int(looked_up.pixels[i])) > 2;
    CHECK(different < bare.pixels.size() / 2000);
    CHECK(bare.pixels != looked_up.pixels);
  }
}

TEST_CASE("a body darkens the ground in its shadow and nowhere else") {
  Studio studio("auto");
  RenderScene scene;
  scene.ground.grid = false;
  scene.sun.to_sun = Vec3(-1, 1, 0);
  scene.camera.eye = Vec3(0, 8, 8);
  scene.camera.target = Vec3::Zero();
  scene.instances.push_back(
      box_instance({Vec3(0, 2, 0), Quat::Identity()}, Vec3(0.5, 0.5, 0.5), {}));
  const Image image = studio.picture(scene);
  const auto at = [&](const Vec3& x) {
    const Vec3 p = project(scene.camera, x, image.width, image.height);
    return brightness(image.at(int(p.x()), int(p.y())));
  };
  const int shaded = at(Vec3(2, 0, 0)), lit = at(Vec3(3.5, 0, 0)), other = at(Vec3(-2, 0, 0));
  CHECK(shaded < lit * 3 / 4);
  CHECK(std::abs(lit - other) < 8);
  scene.sun.shadows = false;
  const Image flat = studio.picture(scene);
  const Vec3 p = project(scene.camera, Vec3(2, 0, 0), image.width, image.height);
  CHECK(brightness(flat.at(int(p.x()), int(p.y()))) > lit - 8);
}

TEST_CASE("panels: clip rectangles hold to the pixel, colours come through unchanged") {
  Studio studio("auto");
  RenderScene scene;
  test::add_marks(scene = test::demo_scene(30));
  for (UiVertex& v : scene.ui.vertices) v.rgba = 0xFF204060u;
  const Image image = studio.picture(scene);
  const auto is_panel = [&](int x, int y) {
    const uint8_t* p = image.at(x, y);
    return p[0] == 0x60 && p[1] == 0x40 && p[2] == 0x20;
  };
  CHECK(is_panel(10, 10));
  CHECK(is_panel(139, 59));  // the rectangle ends at 150, its clip at 140
  CHECK_FALSE(is_panel(140, 59));
  CHECK_FALSE(is_panel(9, 30));
  CHECK_FALSE(is_panel(30, 60));
}

TEST_CASE("exposure is not blown: a default scene uses the range and clips almost nothing") {
  Studio studio("auto");
  const Image image = studio.picture(test::demo_scene());
  int white = 0, black = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int b = brightness(image.at(x, y));
      white += b > 252;
      black += b < 6;
    }
  const int all = image.width * image.height;
  CHECK(white < all / 200);
  CHECK(black < all / 200);
}

TEST_CASE("what is kept from the picture before is what would be drawn") {
  const RenderScene still = everything();
  RenderScene other = everything();
  other.instances[3].transform.offset.y() += 0.5f;
  RenderScene words = everything();
  words.texts.push_back({"other words", true, Vec3f(0, 1, 0)});
  RenderScene turned = everything();
  turned.camera.eye += Vec3(0.3, 0, 0);
  const RenderScene soft = test::soft_scene();
  const std::vector<const RenderScene*> scenes = {&still, &still,  &words, &still,
                                                  &other, &turned, &soft,  &soft};
  Studio studio("auto");
  std::vector<Image> alone;
  for (const RenderScene* scene : scenes) {
    studio.picture(*scene, 32, 18);  // another size: nothing is kept
    alone.push_back(studio.picture(*scene, 160, 90));
  }
  for (size_t i = 0; i < scenes.size(); ++i) {
    CAPTURE(i);
    CHECK(studio.picture(*scenes[i], 160, 90).pixels == alone[i].pixels);
  }
}

TEST_CASE("words keep all their pixels when the world has fewer") {
  // Over the sky alone, which is smooth: enlarging it changes nothing that can be seen.
  RenderScene scene;
  scene.ground.visible = false;
  scene.texts.push_back({"Sharp as ever", false, Vec3f(100, 100, 0)});
  Studio studio("auto");
  const Image whole = studio.picture(scene);
  scene.texts.clear();
  CHECK(studio.picture(scene).pixels != whole.pixels);
  scene.texts.push_back({"Sharp as ever", false, Vec3f(100, 100, 0)});
  for (const Quality q : {Quality::standard, Quality::draft})
    for (const float resolution : {0.84f, 0.5f}) {
      scene.quality = q;
      scene.resolution = resolution;
      const Image part = studio.picture(scene);
      REQUIRE(part.pixels.size() == whole.pixels.size());
      int most = 0;
      for (size_t i = 0; i < part.pixels.size(); ++i)
        most = std::max(most, std::abs(int(part.pixels[i]) - int(whole.pixels[i])));
      CHECK(most <= 2);
    }
}

TEST_CASE("bodies stay where they are when the world has fewer pixels") {
  RenderScene scene = test::demo_scene();
  Studio studio("auto");
  const Image whole = studio.picture(scene);
  scene.resolution = 0.5f;
  const Image part = studio.picture(scene);
  // The mean of two by two pixels is blurred alike in both.
  double sum = 0;
  for (int y = 0; y + 1 < whole.height; y += 2)
    for (int x = 0; x + 1 < whole.width; x += 2) {
      int a = 0, b = 0;
      for (const auto& [dx, dy] : {std::pair{0, 0}, {1, 0}, {0, 1}, {1, 1}}) {
        a += brightness(whole.at(x + dx, y + dy));
        b += brightness(part.at(x + dx, y + dy));
      }
      sum += std::abs(a - b) / 4.0;
    }
  CHECK(sum / (whole.width * whole.height / 4.0) < 3);
}

TEST_CASE("pictures of any size, and thirty renderers one after the other") {
  Studio studio("auto");
  const RenderScene scene = test::demo_scene(20);
  for (const auto& [w, h] : {std::pair{1, 1}, {3, 200}, {641, 359}}) {
    CHECK(studio.picture(scene, w, h).width == w);
    CHECK(studio.picture(test::soft_scene(), w, h).width == w);
  }
  for (int i = 0; i < 30; ++i) {
    studio.renderer.reset();
    auto again = Renderer::create(*studio.device, *resource_path("shaders"));
    REQUIRE(again.ok());
    studio.renderer = std::move(*again);
    CHECK_FALSE(is_uniform(studio.picture(scene, 64, 36)));
  }
}

TEST_CASE("a shader that does not compile is an error with the driver's words when drawn with") {
  Studio studio("auto");
  PipelineDesc desc;
  desc.name = "broken";
  desc.vertex_source = "#version 330 core\nvoid main() { gl_Position = nothing; }\n";
  desc.fragment_source = "#version 330 core\nvoid main() {}\n";
  const auto pipeline = studio.device->create_pipeline(desc);
  REQUIRE(pipeline.ok());
  TargetDesc shape;
  shape.width = shape.height = 8;
  const auto target = studio.device->create_target(shape);
  REQUIRE(target.ok());
  for (int picture = 0; picture < 2; ++picture) {  // it stays one
    studio.device->begin_frame();
    studio.device->begin_pass({*target, {}, true});
    DrawCall call;
    call.pipeline = *pipeline;
    call.count = 3;
    studio.device->draw(call);
    studio.device->end_pass();
    const Status drawn = studio.device->take_link_failure();
    REQUIRE_FALSE(drawn.ok());
    CHECK(drawn.error().text().find("broken") != std::string::npos);
    CHECK(drawn.error().text().find("nothing") != std::string::npos);
  }
}

TEST_CASE("every shader of the renderer compiles and links, drawn with or not") {
  Studio studio("auto");
  const auto functions = GlFunctions::load(*studio.choice.context);
  REQUIRE(functions.ok());
  GlPrograms programs(*functions);
  Pipelines all;
  const Status made = all.make_all(
      [&](const PipelineDesc& desc) -> Result<PipelineId> {
        const Status linked = programs.link(programs.add(desc));
        CHECK_MESSAGE(linked.ok(), test::why_not(linked));
        return PipelineId{1};
      },
      *resource_path("shaders"));
  CHECK_MESSAGE(made.ok(), test::why_not(made));
}

TEST_CASE("samples are averaged as the driver does it") {
  Studio studio("auto");
  const auto functions = GlFunctions::load(*studio.choice.context);
  REQUIRE(functions.ok());
  GlFunctions gl = *functions;
  constexpr int size = 64;
  // Every sample another colour, as far as sixteen triangles over each other make them.
  PipelineDesc desc;
  desc.name = "fan";
  desc.vertex_source = R"(#version 330 core
flat out vec4 paint;
void main() {
  float turn = float(gl_VertexID / 3) * 0.41 + float(gl_VertexID % 3) * 2.1;
  paint = vec4(fract(float(gl_VertexID / 3) * vec3(0.37, 0.71, 0.23)), fract(turn));
  gl_Position = vec4(1.3 * cos(turn), 1.3 * sin(turn), 0.0, 1.0);
}
)";
  desc.fragment_source =
      "#version 330 core\nflat in vec4 paint;\nout vec4 colour;\nvoid main() { colour = paint; }\n";
  desc.depth_test = DepthTest::none;
  desc.depth_write = false;
  desc.cull = Cull::none;
  GlPrograms programs(gl);
  GLuint texture = 0, names[2] = {}, plain = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D_MULTISAMPLE, texture);
  gl.TexImage2DMultisample(GL_TEXTURE_2D_MULTISAMPLE, 4, GL_RGBA8, size, size, GL_TRUE);
  gl.GenTextures(1, &plain);
  gl.BindTexture(GL_TEXTURE_2D, plain);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
  gl.GenFramebuffers(2, names);
  gl.BindFramebuffer(GL_FRAMEBUFFER, names[1]);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, plain, 0);
  gl.BindFramebuffer(GL_FRAMEBUFFER, names[0]);
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D_MULTISAMPLE, texture,
                          0);
  gl.Viewport(0, 0, size, size);
  gl.Disable(GL_SCISSOR_TEST);
  gl.ClearColor(0.2f, 0.4f, 0.6f, 1);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  const unsigned fan = programs.add(desc);
  REQUIRE(programs.link(fan).ok());
  apply_gl_pipeline(gl, desc, fan);
  gl.DrawArraysInstanced(GL_TRIANGLES, 0, 48, 1);
  const auto pixels = [&] {
    std::vector<uint8_t> out(size_t{4} * size * size);
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, names[1]);
    gl.ReadPixels(0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, out.data());
    return out;
  };
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, names[0]);
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, names[1]);
  gl.BlitFramebuffer(0, 0, size, size, 0, 0, size, size, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  const std::vector<uint8_t> expected = pixels();
  gl.BindFramebuffer(GL_FRAMEBUFFER, names[1]);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  GlAverage average(gl, programs);
  const ScissorRect halves[] = {{0, 0, size, size / 2}, {0, size / 2, size, size / 2}};
  REQUIRE(average.draw(texture, 4, halves).ok());
  CHECK(pixels() == expected);
  // Where edges cross, means are neither of the colours.
  std::set<uint32_t> colours;
  for (size_t i = 0; i < expected.size(); i += 4)
    colours.insert(uint32_t(expected[i]) << 16 | uint32_t(expected[i + 1]) << 8 | expected[i + 2]);
  CHECK(colours.size() > 40);
  gl.BindFramebuffer(GL_FRAMEBUFFER, 0);
  gl.DeleteFramebuffers(2, names);
  gl.DeleteTextures(1, &texture);
  gl.DeleteTextures(1, &plain);
}
