#pragma once
#include "engine/scene/description/values.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tumble {

/// A key of a camera's path.
struct CameraKeyDescription {
  double time = 0;         ///< [s]
  Vec3 position{6, 4, 8};  ///< [m]
  Vec3 target{0, 1, 0};    ///< [m]
  std::optional<double> fov_deg;

  static constexpr std::string_view schema_name = "camera_key";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.time, {.name = "time",
                     .unit = "s",
                     .min = 0,
                     .max = 1e6,
                     .required = true,
                     .doc = "simulated time at which the camera is here"});
    v.field(d.position, {.name = "position",
                         .unit = "m",
                         .min = -1e7,
                         .max = 1e7,
                         .required = true,
                         .doc = "of the eye"});
    v.field(d.target, {.name = "target",
                       .unit = "m",
                       .min = -1e7,
                       .max = 1e7,
                       .required = true,
                       .doc = "what it looks at"});
    v.field(d.fov_deg, {.name = "fov_deg",
                        .unit = "deg",
                        .min = 1,
                        .max = 150,
                        .doc = "vertical field of view; the camera's unless given"});
  }
  static void check(const CameraKeyDescription& d, Complaints& complaints) {
    if (d.position == d.target) complaints.add("target", "must differ from the position");
  }
};

/// A viewpoint. With `follow`, position and target move with that body; with `path` they follow a
/// smooth curve through the keys.
struct CameraDescription {
  Vec3 position{6, 4, 8};  ///< [m]
  Vec3 target{0, 1, 0};    ///< [m]
  double fov_deg = 45;     ///< vertical [deg]
  std::string follow;
  std::vector<CameraKeyDescription> path;

  static constexpr std::string_view schema_name = "camera";
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.position,
            {.name = "position", .unit = "m", .min = -1e7, .max = 1e7, .doc = "of the eye"});
    v.field(d.target,
            {.name = "target", .unit = "m", .min = -1e7, .max = 1e7, .doc = "what it looks at"});
    v.field(
        d.fov_deg,
        {.name = "fov_deg", .unit = "deg", .min = 1, .max = 150, .doc = "vertical field of view"});
    v.field(d.follow, {.name = "follow", .doc = "name of a body to move along with"});
    v.list(d.path, {.name = "path", .doc = "a flight: where the camera is at which times"});
  }
  static void check(const CameraDescription& d, Complaints& complaints) {
    for (size_t i = 1; i < d.path.size(); ++i)
      if (d.path[i].time <= d.path[i - 1].time)
        complaints.add("path[" + std::to_string(i) + "].time",
                       "must be later than the time of the key before it");
    if (d.position == d.target) complaints.add("target", "must differ from the position");
  }
};

struct SunDescription {
  Vec3 direction{0.62, -0.8, -0.4};
  Colour colour{1, 0.96, 0.89};
  double intensity = 3;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.direction,
            {.name = "direction", .min = -1e6, .max = 1e6, .doc = "in which its light travels"});
    v.field(d.colour, {.name = "colour", .doc = "colour"});
    v.field(d.intensity, {.name = "intensity", .min = 0, .max = 1000, .doc = "strength"});
  }
  static void check(const SunDescription& d, Complaints& complaints) {
    if (d.direction.isZero(1e-9)) complaints.add("direction", "a direction of zeros");
  }
};

struct LightsDescription {
  SunDescription sun;
  double ambient = 1;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.sun, {.name = "sun", .doc = "the light that casts shadows"});
    v.field(d.ambient,
            {.name = "ambient", .min = 0, .max = 100, .doc = "factor of the sky's light"});
  }
};

struct SkyDescription {
  Colour zenith{0.36, 0.53, 0.75};
  Colour horizon{0.84, 0.88, 0.92};
  Colour below{0.52, 0.50, 0.47};
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.zenith, {.name = "zenith", .doc = "colour overhead"});
    v.field(d.horizon, {.name = "horizon", .doc = "colour at the horizon"});
    v.field(d.below, {.name = "below", .doc = "colour of the light from below"});
  }
};

/// The ground as drawn; a ground that bodies fall on is a body of shape half_space.
struct GroundDescription {
  bool visible = true;
  double height = 0;  ///< [m]
  Colour colour{0.70, 0.70, 0.68};
  Colour line_colour{0.56, 0.56, 0.55};
  double grid = 1;  ///< [m]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.visible, {.name = "visible", .doc = "whether it is drawn"});
    v.field(d.height, {.name = "height", .unit = "m", .min = -1e6, .max = 1e6, .doc = "its y"});
    v.field(d.colour, {.name = "colour", .doc = "colour"});
    v.field(d.line_colour, {.name = "line_colour", .doc = "colour of the grid"});
    v.field(d.grid,
            {.name = "grid", .unit = "m", .min = 0, .max = 1e6, .doc = "mesh width; 0 for none"});
  }
};

struct FogDescription {
  double density = 0.008;  ///< [1/m]
  std::optional<Colour> colour;
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.field(d.density,
            {.name = "density", .unit = "1/m", .min = 0, .max = 100, .doc = "0 for none"});
    v.field(d.colour, {.name = "colour", .doc = "instead of the sky's at the horizon"});
  }
};

struct ViewDescription {
  SkyDescription sky;
  GroundDescription ground;
  FogDescription fog;
  double exposure = 1;
  std::vector<std::string> overlays;
  double trail = 0;  ///< [s]
  template <class Visitor, class Self>
  static void parameters(Visitor& v, Self& d) {
    v.object(d.sky, {.name = "sky", .doc = "background and ambient light"});
    v.object(d.ground, {.name = "ground", .doc = "the plane that is drawn"});
    v.object(d.fog, {.name = "fog", .doc = "haze"});
    v.field(d.exposure, {.name = "exposure", .min = 0.001, .max = 1000, .doc = "brightness"});
    v.field(d.overlays, {.name = "overlays",
                         .doc = "what is drawn over the bodies at the start, also by render"});
    v.field(d.trail, {.name = "trail",
                      .unit = "s",
                      .min = 0,
                      .max = 3600,
                      .doc = "how long the path of moving bodies is drawn behind them"});
  }
};

}  // namespace tumble
