#pragma once
#include "engine/math/types.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace tumble {

/// What a mark of a sketch means; the viewer gives each meaning a colour.
enum class Ink : uint8_t {
  first,   ///< of body A
  second,  ///< of body B
  active,  ///< what the algorithm works on now
  answer,  ///< nearest points, the best answer so far
  test,    ///< what is tested: planes, directions, candidates
  plain,   ///< axes, the origin
  faint,   ///< context
};

/// What one step of an algorithm draws in the world. Lengths in metres, world axes.
struct Sketch {
  struct Point {
    Vec3 x;
    Ink ink = Ink::active;
    float size = 9;  ///< diameter [px]
  };
  struct Line {
    Vec3 a, b;
    Ink ink = Ink::active;
    float width = 2;     ///< [px]
    bool arrow = false;  ///< drawn solid, with an arrowhead at b
  };
  struct Surface {
    std::vector<std::array<Vec3, 3>> triangles;
    Ink ink = Ink::active;
    float opacity = 0.3f;
  };
  struct Label {
    Vec3 x;
    std::string text;  ///< Latin-1 characters only
    Ink ink = Ink::plain;
  };
  /// One of the two bodies, drawn with its shape at this pose.
  struct Ghost {
    size_t body = 0;
    Pose pose;
    float opacity = 0.35f;
    bool wires = true;
  };

  std::vector<Point> points;
  std::vector<Line> lines;
  std::vector<Surface> surfaces;
  std::vector<Label> labels;
  std::vector<Ghost> ghosts;

  void point(const Vec3& x, Ink ink, float size = 9) { points.push_back({x, ink, size}); }
  void line(const Vec3& a, const Vec3& b, Ink ink, float width = 2) {
    lines.push_back({a, b, ink, width, false});
  }
  void arrow(const Vec3& a, const Vec3& b, Ink ink) { lines.push_back({a, b, ink, 2, true}); }
  void label(const Vec3& x, std::string text, Ink ink) {
    labels.push_back({x, std::move(text), ink});
  }
  /// Adds everything of another sketch.
  void add(const Sketch& other);
};

/// Corners of a plane polygon, in order; drawn as a surface with an outline.
void add_polygon(Sketch& out, const std::vector<Vec3>& corners, Ink ink, float opacity);
/// A square in the plane through `centre` with this normal (unit).
void add_plane(Sketch& out, const Vec3& centre, const Vec3& normal, double half_width, Ink ink);

/// A flat picture beside the text of a step: x from 0 to `aspect`, y from 0 to 1, upwards.
struct Diagram {
  struct Line {
    Vec2 a, b;
    Ink ink = Ink::plain;
    float width = 1.5f;
    bool arrow = false;
  };
  struct Box {
    Vec2 min, max;
    Ink ink = Ink::plain;
    float opacity = 1;
  };
  struct Point {
    Vec2 x;
    Ink ink = Ink::active;
    float size = 7;
  };
  struct Label {
    Vec2 x;
    std::string text;
    Ink ink = Ink::plain;
    /// Fraction of the text's box that lies at x: (0, 0) bottom left; (1, 1) top right.
    Vec2 anchor{0.5, 0.5};
  };
  std::string title;
  double aspect = 1.6;
  std::vector<Box> boxes;
  std::vector<Line> lines;
  std::vector<Point> points;
  std::vector<Label> labels;

  bool empty() const { return boxes.empty() && lines.empty() && points.empty(); }
};

}  // namespace tumble
