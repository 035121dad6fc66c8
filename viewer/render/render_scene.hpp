#pragma once
#include "engine/core/result.hpp"
#include "viewer/render/camera.hpp"
#include "viewer/render/colour_legend.hpp"
#include "viewer/render/mesh.hpp"
#include "viewer/render/plate.hpp"
#include "viewer/render/soft_matter.hpp"
#include "viewer/render/ui_draw_list.hpp"

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace tumble {

// One picture as flat data: all that the renderer knows. Lengths in metres, world axes, Y up;
// colours are linear RGB(A) in 0..1 unless a name says srgb.

/// Linear colour of a web colour such as 0xE8743B.
Vec3f linear_from_srgb(uint32_t rgb);

/// Two-tone pattern of a surface, in body coordinates, which makes rotation visible.
enum class Pattern : uint8_t {
  plain,
  quarters,  ///< octants of the body frame in two tones (balls, rollers)
  stripes,   ///< bands along body x, `pattern_size` wide, moved by `pattern_shift` (belts)
  checker,   ///< cubes of `pattern_size`
};

/// Surface look.
struct Paint {
  Vec3f colour = Vec3f(0.6f, 0.6f, 0.6f);  ///< linear
  float opacity = 1;        ///< below 1 the instance is drawn blended and casts no shadow
  float roughness = 0.55f;  ///< 0 polished .. 1 chalk
  float metallic = 0;       ///< 0 plastic .. 1 metal
  float emission = 0;       ///< added light, in multiples of the colour
  Pattern pattern = Pattern::plain;
  float pattern_strength = 0.35f;  ///< how much darker the second tone is, 0..1
  float pattern_size = 0.5f;       ///< [m]
  float pattern_shift = 0;         ///< [m]
};

/// x_world = linear * x_mesh + offset.
struct Transform {
  Mat3f linear = Mat3f::Identity();
  Vec3f offset = Vec3f::Zero();
};
Transform transform_of(const Pose& pose, const Vec3& scale = Vec3::Ones());

/// One drawn body or shape. `linear` must be a rotation times a diagonal scale.
struct MeshInstance {
  MeshRef mesh;
  Transform transform;
  float inflate = 0;  ///< [m] every vertex is moved out along its normal (see builtin_meshes.hpp)
  Paint paint;
  bool selected = false;  ///< drawn with an outline
  bool casts_shadow = true;
};

/// A particle: a lit sphere.
struct SphereInstance {
  Vec3f centre = Vec3f::Zero();
  float radius = 0.05f;
  /// Linear colour, and opacity. An opacity above 1 means opaque and self-luminous: the part above
  /// 1 is the emitted light in units of the colour.
  Vec4f colour = Vec4f(0.6f, 0.6f, 0.6f, 1);
};

/// Whether the sphere is finite and has a positive radius; others are left out of pictures and
/// bounds.
bool drawable(const SphereInstance& sphere);
bool drawable(const FluidParticle& particle);
bool drawable(const SmokePuff& puff);

/// What happens to debug lines and points behind surfaces.
enum class Occlusion : uint8_t {
  hidden,  ///< not drawn
  faint,   ///< drawn at a quarter of its opacity
  none,    ///< drawn over everything
};

struct LineSegment {
  Vec3f a, b;
  Vec4f colour = Vec4f(1, 1, 1, 1);
  float width = 1.5f;  ///< [px] of the picture, times ui_scale
  Occlusion occlusion = Occlusion::faint;
};

struct PointMark {
  Vec3f x;
  Vec4f colour = Vec4f(1, 1, 1, 1);
  float size = 6;  ///< diameter [px], times ui_scale
  Occlusion occlusion = Occlusion::faint;
};

/// Text at a world point (always drawn in front), or at a pixel of the picture.
struct TextLabel {
  std::string text;  ///< UTF-8
  bool in_world = true;
  Vec3f x = Vec3f::Zero();  ///< in_world: world point; else (pixels right, pixels down, unused)
  Vec4f colour = Vec4f(1, 1, 1, 1);
  float size = 13;                ///< line height [px], times ui_scale
  Vec3f anchor = Vec3f(0, 0, 0);  ///< point of the text's box at x: 0,0 top left, .5,.5 centre
  bool shadow = true;             ///< dark edge for contrast
  float plate = 0;  ///< opacity of a dark rectangle behind it, for legibility on any background
};

struct Sun {
  Vec3 to_sun = Vec3(-0.62, 0.8, 0.4);  ///< direction from the scene to the sun; need not be unit
  Vec3f colour = Vec3f(1.0f, 0.93f, 0.82f);
  float intensity = 3.0f;
  bool shadows = true;
};

struct Sky {
  Vec3f zenith = Vec3f(0.13f, 0.27f, 0.52f);
  Vec3f horizon = Vec3f(0.68f, 0.76f, 0.83f);
  Vec3f below = Vec3f(0.23f, 0.21f, 0.19f);  ///< light bounced from the ground
  float ambient = 1.0f;                      ///< scales the light of the sky on surfaces
};

struct Ground {
  bool visible = true;
  double height = 0;  ///< [m]
  Vec3f colour = Vec3f(0.45f, 0.45f, 0.44f);
  bool grid = true;
  Vec3f grid_colour = Vec3f(0.27f, 0.27f, 0.27f);
  double grid_spacing = 1;  ///< [m]; every tenth line is stronger
};

/// Presets of quality. They are fixed, so that a picture does not depend on the machine that draws
/// it.
enum class Quality : uint8_t {
  draft,     ///< no anti-aliasing, small hard shadows, no contact shade
  standard,  ///< 4 samples, 1024 shadow map: the best that a software renderer draws in reasonable
             ///< time
  high,      ///< 4 samples, 2048 shadow map, wider filter
};

/// "draft", "standard", "high", in the order of the enumeration.
std::span<const std::string_view> quality_names();
/// The error for an unknown name lists the known ones.
Result<Quality> parse_quality(std::string_view name);

struct RenderScene {
  std::vector<MeshInstance> instances;
  std::vector<SphereInstance> spheres;
  std::vector<FluidSurface> fluids;
  std::vector<SmokePuff> smoke;
  std::vector<LineSegment> lines;
  std::vector<PointMark> points;
  std::vector<TextLabel> texts;
  std::vector<ColourLegend> legends;
  /// The area free for legends, if other things lie over the rest [px: left, top, right, bottom];
  /// without it the whole picture.
  std::optional<std::array<float, 4>> legend_area;
  std::optional<Plate> plate;
  Camera camera;
  Sun sun;
  Sky sky;
  Ground ground;
  float exposure = 1;
  std::optional<Vec3f> haze_colour;  ///< instead of the sky's colour at the horizon
  float haze = 1;  ///< 0: clear to the horizon; 1: distant ground fades into the sky
  Quality quality = Quality::standard;
  Vec4f selection_colour = Vec4f(1.0f, 0.55f, 0.05f, 1);
  /// Ratio, at most 1, of the pixels along each axis with which the world is drawn to those of the
  /// picture; the result is enlarged. Text, legends and panels are always drawn with all pixels.
  float resolution = 1;
  float ui_scale = 1;  ///< factor on widths of lines, points and text (HiDPI)
  UiDrawList ui;

  /// Whether there is any liquid or smoke.
  bool has_soft_matter() const { return !fluids.empty() || !smoke.empty(); }
  /// Empties the lists but keeps their memory, the camera and the look.
  void clear_content();
  /// Takes over camera, light, ground and quality of another scene, but none of its contents.
  void look_like(const RenderScene& other);
};

/// World bounds; empty for an instance that is not finite or has no mesh.
Aabb bounds_of(const MeshInstance& instance);
/// All of space.
Aabb everywhere();
/// Bounds of the spheres whose centres are within a region.
Aabb bounds_of(const std::vector<SphereInstance>& spheres, const Aabb& within = everywhere());
/// Bounds of liquids and smoke within a region.
Aabb soft_bounds(const RenderScene& scene, const Aabb& within = everywhere());
/// World bounds of the parts of instances, spheres, liquids and smoke that lie within a region.
/// Lines, text and the ground do not count.
Aabb content_bounds(const RenderScene& scene, const Aabb& within = everywhere());
/// The intersection of a box with a region, which may be empty.
Aabb part_within(const Aabb& box, const Aabb& region);

}  // namespace tumble
