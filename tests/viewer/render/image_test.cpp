// Images, fonts and text codes. Reference: small pictures and the UTF-8 table, by hand.
#include "viewer/render/image.hpp"

#include "viewer/render/font.hpp"
#include "viewer/render/render_scene.hpp"

#include <doctest/doctest.h>

using namespace tumble;

TEST_CASE("a frame of one colour is found out") {
  Image image{4, 3, 4, std::vector<uint8_t>(4 * 3 * 4, 17)};
  CHECK(is_uniform(image));
  image.pixels[7] = 200;  // alpha does not count
  CHECK(is_uniform(image));
  image.pixels[4] = 19;
  CHECK_FALSE(is_uniform(image));
  CHECK(is_uniform(image, 2));
  CHECK(is_uniform(Image{}));
}

TEST_CASE("alpha is dropped, and does not change the hash") {
  Image image{2, 1, 4, {1, 2, 3, 4, 5, 6, 7, 8}};
  const Image rgb = without_alpha(image);
  CHECK(rgb.pixels == std::vector<uint8_t>{1, 2, 3, 5, 6, 7});
  CHECK(image_hash(rgb) == image_hash(image));
  image.pixels[3] = 9;
  CHECK(image_hash(rgb) == image_hash(image));
  image.pixels[2] = 9;
  CHECK(image_hash(rgb) != image_hash(image));
  CHECK(image_hash(Image{1, 2, 3, rgb.pixels}) != image_hash(rgb));  // shape counts
}

TEST_CASE("UTF-8 is read, and broken sequences do not end it") {
  const auto codes = [](std::string_view s) {
    std::vector<uint32_t> out;
    while (!s.empty()) out.push_back(next_codepoint(s));
    return out;
  };
  CHECK(codes("a\xC2\xB2\xE2\x82\xAC\xF0\x9F\x98\x80") ==
        std::vector<uint32_t>{'a', 0xB2, 0x20AC, 0x1F600});
  CHECK(codes("\xFFz") == std::vector<uint32_t>{0xFFFD, 'z'});
  CHECK(codes("\xC3") == std::vector<uint32_t>{0xFFFD});
  CHECK(codes("\xE2\x82z") == std::vector<uint32_t>{0xFFFD, 'z'});
}

TEST_CASE("the default font has letters where it says") {
  const FontAtlas font = bake_default_font();
  CHECK(font.coverage.size() == size_t(font.width) * size_t(font.height));
  for (const char c : std::string("Az09.")) {
    const Glyph* g = font.find(uint32_t(c));
    REQUIRE(g);
    CHECK(g->advance > 0);
    int covered = 0;
    for (int y = int(g->v0 * float(font.height)); y < int(g->v1 * float(font.height)); ++y)
      for (int x = int(g->u0 * float(font.width)); x < int(g->u1 * float(font.width)); ++x)
        covered += font.coverage[size_t(y) * size_t(font.width) + size_t(x)] > 128;
    CHECK(covered > 0);
  }
  CHECK(font.find(0x10FFFF) == nullptr);
  const auto x = size_t(font.white_u * float(font.width));
  const auto y = size_t(font.white_v * float(font.height));
  CHECK(font.coverage[y * size_t(font.width) + x] == 255);
}

TEST_CASE("web colours become linear") {
  const Vec3f c = linear_from_srgb(0xFF8000);
  CHECK(c.x() == doctest::Approx(1));
  CHECK(c.y() == doctest::Approx(0.21586).epsilon(1e-4));
  CHECK(c.z() == 0);
}
