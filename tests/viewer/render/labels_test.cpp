// Where labels stand. Reference: positions by hand, and all pairs of boxes.
#include "viewer/render/labels.hpp"

#include "engine/core/random.hpp"

#include <cmath>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Camera camera() {
  Camera c;
  c.eye = Vec3(0, 0, 10);
  c.target = Vec3::Zero();
  return c;
}

TextLabel label(const char* text, const Vec3f& x, const Vec3f& anchor = {0.5f, 1, 0}) {
  TextLabel l;
  l.text = text;
  l.x = x;
  l.shadow = false;
  l.anchor = anchor;
  return l;
}

const FontAtlas& font() {
  static const FontAtlas baked = bake_default_font();
  return baked;
}

}  // namespace

TEST_CASE("a label stands at its point, in whole pixels") {
  TextLabel ab = label("ab", Vec3f::Zero(), {0.5f, 0.5f, 0});
  UiDrawList ui;
  add_labels({ab}, font(), camera(), 200, 100, 1, ui);
  REQUIRE(ui.vertices.size() == 8);
  CHECK(ui.indices.size() == 12);
  float least = 1e9f, most = -1e9f;
  for (const UiVertex& v : ui.vertices) {
    least = std::min(least, v.x);
    most = std::max(most, v.x);
    CHECK(v.x == std::floor(v.x));
  }
  CHECK(least > 90);
  CHECK(most < 110);
  CHECK(text_width("ab", font(), 26) == doctest::Approx(2 * text_width("ab", font(), 13)));

  ab.x = Vec3f(0, 0, 20);  // behind the eye
  UiDrawList none;
  add_labels({ab}, font(), camera(), 200, 100, 1, none);
  CHECK(none.vertices.empty());
}

TEST_CASE("a label makes way for those before it, and a label at a pixel for none") {
  const auto alone = place_labels({label("rolls", Vec3f::Zero())}, font(), camera(), 400, 300, 1);
  std::vector<TextLabel> two = {label("rests", Vec3f::Zero()), label("rolls", Vec3f(0.1f, 0, 0))};
  auto boxes = place_labels(two, font(), camera(), 400, 300, 1);
  REQUIRE((alone[0] && boxes[0] && boxes[1]));
  CHECK(boxes[0]->y == alone[0]->y);
  CHECK_FALSE(boxes[0]->overlaps(*boxes[1]));
  CHECK(boxes[1]->y < alone[0]->y);  // a line higher: nearer than beside
  CHECK(boxes[1]->y >= alone[0]->y - boxes[0]->height);
  CHECK(boxes[1]->x >= boxes[0]->x);

  TextLabel title = label("title", Vec3f(200, 150, 0), {0.5f, 1, 0});
  title.in_world = false;
  two.push_back(title);
  boxes = place_labels(two, font(), camera(), 400, 300, 1);
  REQUIRE((boxes[0] && boxes[2]));
  CHECK(boxes[2]->x + 0.5f * boxes[2]->width == doctest::Approx(200).epsilon(0.01));
  CHECK_FALSE(boxes[0]->overlaps(*boxes[2]));
}

TEST_CASE("labels never overlap, where there is no room they are left out") {
  Random random(7);
  for (const double spread : {0.1, 1.0, 3.0}) {
    std::vector<TextLabel> labels;
    for (int i = 0; i < 200; ++i)
      labels.push_back(label(
          i % 2 ? "one" : "another",
          Vec3{random.uniform(-spread, spread), random.uniform(-spread, spread), 0}.cast<float>()));
    const auto boxes = place_labels(labels, font(), camera(), 800, 600, 1);
    size_t placed = 0, overlaps = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
      placed += boxes[i].has_value();
      for (size_t k = 0; k < i; ++k)
        overlaps += boxes[i] && boxes[k] && boxes[i]->overlaps(*boxes[k]);
    }
    CHECK(overlaps == 0);
    CHECK(placed >= (spread < 1 ? 3 : 30));
    CHECK(placed < 200);
  }
}
