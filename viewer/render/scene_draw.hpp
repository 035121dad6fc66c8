#pragma once
#include "engine/geometry/debug_draw.hpp"
#include "viewer/render/render_scene.hpp"

namespace tumble {

/// Turns debug drawing of the engine into lines and points of a picture. Text is left out.
class SceneDraw final : public DebugDraw {
 public:
  explicit SceneDraw(RenderScene& out, float line_width = 1.5f)
      : out_(out), line_width_(line_width) {}

  void line(const Vec3& a, const Vec3& b, const Vec4f& colour) override {
    out_.lines.push_back(
        {.a = a.cast<float>(), .b = b.cast<float>(), .colour = colour, .width = line_width_});
  }
  void point(const Vec3& x, const Vec4f& colour, float pixels) override {
    out_.points.push_back({.x = x.cast<float>(), .colour = colour, .size = pixels});
  }
  void text(const Vec3&, const Vec4f&, std::string_view) override {}

 private:
  RenderScene& out_;
  float line_width_;
};

}  // namespace tumble
