// The picture of `tumble mesh --render`. Reference: what a person would see: the object in the
// middle of the picture and clear of its edges, other volumes in another picture, red at a hole.
#include "tests/viewer/cli/program.hpp"
#include "viewer/capture/png.hpp"

#include <algorithm>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

using namespace tumble;

namespace {

const std::filesystem::path mesh_assets =
    std::filesystem::path(TUMBLE_SOURCE_DIR) / "assets/meshes";

Image mesh_picture(const TempFolder& folder, const std::string& file,
                   std::vector<std::string> more = {}) {
  const std::string out = (folder / "out.png").string();
  std::vector<std::string> arguments = {"mesh", file, "--render", out, "--size", "320x200"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const ProgramRun run = tumble_program(arguments);
  REQUIRE_MESSAGE(run.code == 0, run.err);
  auto image = read_image(out);
  REQUIRE(image.ok());
  CHECK(image->width == 320);
  CHECK(image->height == 200);
  return *image;
}

/// Share of pixels for which `is(r, g, b)` within a rectangle of the picture, in parts of it.
template <class Is>
double share_of(const Image& image, double left, double top, double right, double bottom,
                const Is& is) {
  size_t all = 0, hits = 0;
  for (int y = int(top * image.height); y < int(bottom * image.height); ++y)
    for (int x = int(left * image.width); x < int(right * image.width); ++x) {
      const uint8_t* p = image.at(x, y);
      ++all;
      hits += is(p[0], p[1], p[2]);
    }
  return double(hits) / double(all);
}

bool colourful(int r, int g, int b) {
  return std::max({r, g, b}) - std::min({r, g, b}) > 70;
}

}  // namespace

TEST_CASE("every kind and level of hierarchy is another picture, coloured where the mesh is") {
  TempFolder folder;
  const std::string knot = (mesh_assets / "trefoil_knot.obj").string();
  const Image plain = mesh_picture(folder, knot);
  CHECK(share_of(plain, 0, 0, 1, 1, colourful) < 0.01);
  std::vector<std::vector<uint8_t>> seen{plain.pixels};
  for (const char* kind : {"aabb", "obb", "sphere", "convex_hull"})
    for (const char* level : {"0", "3", "50"}) {
      CAPTURE(kind);
      CAPTURE(level);
      const Image image = mesh_picture(folder, knot, {"--hierarchy", kind, "--level", level});
      CHECK(share_of(image, 0.3, 0.3, 0.7, 0.8, colourful) > 0.1);
      CHECK(share_of(image, 0, 0.2, 0.02, 1, colourful) == 0);
      CHECK(share_of(image, 0.98, 0.2, 1, 1, colourful) == 0);
      CHECK(std::find(seen.begin(), seen.end(), image.pixels) == seen.end());
      seen.push_back(image.pixels);
    }
}

TEST_CASE("the picture does not depend on the size of the mesh, and shows holes in red") {
  TempFolder folder;
  const std::string open = write_text(folder / "open.obj",
                                      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\n"
                                      "f 2 3 4\n");
  const auto red = [](int r, int g, int b) { return r > 180 && g < 90 && b < 90; };
  const Image image = mesh_picture(folder, open);
  CHECK(share_of(image, 0.2, 0.2, 0.8, 1, red) > 0.005);
  for (const char* scale : {"1e-6", "1e6"}) {
    const Image other = mesh_picture(folder, open, {"--scale", scale});
    CHECK(share_of(other, 0.2, 0.2, 0.8, 1, red) ==
          doctest::Approx(share_of(image, 0.2, 0.2, 0.8, 1, red)).epsilon(0.05));
  }
}

TEST_CASE("with a picture stdout still has the facts, no renderer is 4, no file 5") {
  TempFolder folder;
  const std::string part = (mesh_assets / "l_part.obj").string();
  const std::string out = (folder / "out.png").string();
  const ProgramRun run =
      tumble_program({"mesh", part, "--json", "--render", out, "--size", "64x48"});
  CHECK(run.code == 0);
  const auto json = nlohmann::json::parse(run.out, nullptr, false);
  REQUIRE(json.is_object());
  CHECK(json["picture"] == out);
  const std::string file = write_text(folder / "file", "x");
  const ProgramRun unwritten = tumble_program({"mesh", part, "--render", file + "/out.png"});
  CHECK(unwritten.code == 5);
  CHECK(unwritten.out.empty());
  write_text(folder / "libOSMesa.so.8", "not a library");
  ProgramOptions bare;
  bare.environment = {{"__EGL_VENDOR_LIBRARY_DIRS", "/nonexistent"},
                      {"LIBGL_DRIVERS_PATH", "/nonexistent"},
                      {"LD_LIBRARY_PATH", folder.path().string()}};
  const ProgramRun nowhere = tumble_program({"mesh", part, "--render", out}, bare);
  CHECK(nowhere.code == 4);
  CHECK(nowhere.out.empty());
}
