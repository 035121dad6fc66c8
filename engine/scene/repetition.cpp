#include "engine/scene/repetition.hpp"

#include "engine/core/hash.hpp"
#include "engine/core/random.hpp"
#include "engine/math/det/det.hpp"
#include "engine/math/expression.hpp"
#include "engine/math/rotation.hpp"
#include "engine/scene/description.hpp"

#include <cmath>
#include <map>

#include <fmt/format.h>

namespace tumble {
namespace {

double count_of(const RepetitionDescription& r) {
  if (const auto* grid = std::get_if<GridRepetition>(&r.kind))
    return double(grid->count[0]) * double(grid->count[1]) * double(grid->count[2]);
  if (const auto* points = std::get_if<PointsRepetition>(&r.kind))
    return double(points->points.size());
  return std::visit(
      [](const auto& kind) {
        if constexpr (requires { double(kind.count); }) return double(kind.count);
        return 1.0;
      },
      r.kind);
}

/// What the functions that make frames of copies have in common.
struct CopyMaker {
  const SceneDescription& scene;
  uint64_t seed;
  std::string path;
  std::vector<std::string>& warnings;
  std::vector<Pose> frames;

  Status make(const GridRepetition& r) {
    const Vec3 n(r.count[0], r.count[1], r.count[2]);
    const Vec3 middle = r.centred ? Vec3(0.5 * (n.x() - 1), 0, 0.5 * (n.z() - 1)) : Vec3::Zero();
    for (int y = 0; y < r.count[1]; ++y)
      for (int z = 0; z < r.count[2]; ++z)
        for (int x = 0; x < r.count[0]; ++x) {
          const Vec3 cell = Vec3(x, y, z) - middle;
          const Vec3 shift = y % 2 == 1 ? r.stagger : Vec3(Vec3::Zero());
          frames.push_back({cell.cwiseProduct(r.spacing) + shift, Quat::Identity()});
        }
    return {};
  }
  Status make(const StackRepetition& r) {
    for (int i = 0; i < r.count; ++i)
      frames.push_back(
          {double(i) * r.step, axis_angle(Vec3::UnitY(), to_radians(double(i) * r.turn_deg))});
    return {};
  }
  Status make(const RingRepetition& r) {
    // On a full circle, the last copy must not coincide with the first.
    const bool full = std::fabs(std::fabs(r.arc_deg) - 360) < 1e-9;
    const double steps = full ? r.count : r.count > 1 ? r.count - 1 : 1;
    const Vec3 axis = r.axis == RingAxis::x   ? Vec3::UnitX()
                      : r.axis == RingAxis::y ? Vec3::UnitY()
                                              : Vec3::UnitZ();
    const Vec3 arm = r.axis == RingAxis::x ? Vec3::UnitY() : Vec3::UnitX();
    for (int i = 0; i < r.count; ++i) {
      const Quat turn = axis_angle(axis, to_radians(r.start_deg + r.arc_deg * double(i) / steps));
      frames.push_back({turn * (r.radius * arm), r.turn ? turn : Quat::Identity()});
    }
    return {};
  }
  Status make(const PointsRepetition& r) {
    for (const Vec3& p : r.points) frames.push_back({p, Quat::Identity()});
    return {};
  }
  Status make(const ScatterRepetition& r);
  Status make(const FormulaRepetition& r);
};

/// Dart throwing with a grid whose cells are as wide as the least distance.
Status CopyMaker::make(const ScatterRepetition& r) {
  Random random(r.seed.value_or(seed));
  std::map<std::array<int64_t, 3>, std::vector<Vec3>> cells;
  const auto cell_of = [&](const Vec3& p) {
    return std::array{int64_t(std::floor(p.x() / r.min_distance)),
                      int64_t(std::floor(p.y() / r.min_distance)),
                      int64_t(std::floor(p.z() / r.min_distance))};
  };
  const auto is_free = [&](const Vec3& p) {
    const auto c = cell_of(p);
    for (int64_t i = 0; i < 27; ++i) {
      const auto it = cells.find({c[0] + i / 9 - 1, c[1] + i / 3 % 3 - 1, c[2] + i % 3 - 1});
      if (it == cells.end()) continue;
      for (const Vec3& q : it->second)
        if ((p - q).squaredNorm() < r.min_distance * r.min_distance) return false;
    }
    return true;
  };
  // If the distance is far below the region's size, cell indices would overflow, and no two points
  // share a cell anyway.
  const bool spaced = r.min_distance > 1e-9 * r.size.maxCoeff();
  // Dense packings need ever more trials; what is not placed within this limit is given up.
  const int64_t most_throws = 2000 + 20 * int64_t{r.count};
  int64_t throws = 0;
  for (int i = 0; i < r.count; ++i) {
    Vec3 p = random_point(random, r.region, r.size);
    for (int attempt = 0; spaced && !is_free(p); ++attempt) {
      if (attempt == 200 || ++throws == most_throws) {
        warnings.push_back(
            fmt::format("{}: room for {} of {} copies at this min_distance", path, i, r.count));
        return {};
      }
      p = random_point(random, r.region, r.size);
    }
    if (spaced) cells[cell_of(p)].push_back(p);
    frames.push_back({p, r.random_orientation ? random_rotation(random) : Quat::Identity()});
  }
  return {};
}

Status CopyMaker::make(const FormulaRepetition& r) {
  std::vector<Expression> expressions;
  for (const auto* texts : {&r.position, &r.euler_deg})
    for (size_t k = 0; k < 3; ++k) {
      auto parsed = Expression::parse(texts->size() == 3 ? std::string_view((*texts)[k]) : "0");
      if (!parsed) return parsed.error();
      expressions.push_back(std::move(*parsed));
    }
  for (int i = 0; i < r.count; ++i) {
    const auto lookup = [&](std::string_view name) -> std::optional<double> {
      if (name == "i") return i;
      if (name == "n") return r.count;
      if (name == "u") return r.count > 1 ? double(i) / double(r.count - 1) : 0;
      if (const auto* p = scene.parameters_.find(name)) return p->value;
      return std::nullopt;
    };
    double values[6];
    for (size_t k = 0; k < 6; ++k) {
      const auto value = expressions[k].evaluate(lookup);
      if (!value || !(std::fabs(*value) <= 1e7)) {
        const std::string place =
            (k < 3 ? "position[" : "euler_deg[") + std::to_string(k % 3) + "]";
        const std::string why = value ? "the value is beyond 1e7" : value.error().message;
        return Error{ErrorCode::parse, fmt::format("{} for copy {}: {}", place, i, why), {}, {}};
      }
      values[k] = *value;
    }
    frames.push_back(
        {{values[0], values[1], values[2]}, euler_deg_to_quat({values[3], values[4], values[5]})});
  }
  return {};
}

/// Adds random shifts and rotations, in the frame of the repetition.
void add_jitter(std::vector<Pose>& frames, const RepetitionDescription& r, uint64_t seed) {
  if (r.jitter.isZero(0) && r.jitter_deg == 0) return;
  Random random(seed, 1);
  for (Pose& frame : frames) {
    Vec3 shift, axis;
    for (int k = 0; k < 3; ++k) shift[k] = r.jitter[k] * random.uniform(-1, 1);
    axis = random_point(random, ScatterRegion::ball, Vec3::Constant(2));
    const double angle = to_radians(r.jitter_deg) * random.uniform(-1, 1);
    frame = {frame.x + shift, axis_angle(axis, angle) * frame.q};
  }
}

}  // namespace

double copy_count(const BodyDescription& body) {
  double count = 1;
  for (const RepetitionDescription& r : body.repeat) count *= count_of(r);
  return count;
}

Result<std::string> counted_name(const std::string& name, int i) {
  const size_t bracket = name.find('[');
  if (bracket == std::string::npos || name.back() != ']') return name;
  const auto value = evaluate(std::string_view(name).substr(bracket + 1, name.size() - bracket - 2),
                              [i](std::string_view variable) -> std::optional<double> {
                                if (variable == "i") return double(i);
                                return std::nullopt;
                              });
  if (!value) return value.error();
  if (!(*value >= 0 && *value <= 1e9 && *value == std::floor(*value)))
    return Error{ErrorCode::invalid_argument,
                 fmt::format("'{}' is no copy for i = {}: {}", name, i, *value),
                 {},
                 {}};
  return fmt::format("{}[{}]", name.substr(0, bracket), int64_t(*value));
}

uint64_t named_seed(uint64_t scene_seed, std::string_view name) {
  return hash_bytes(std::as_bytes(std::span(name.data(), name.size())), scene_seed);
}

bool in_region(const Vec3& p, ScatterRegion region, double room) {
  const double across = p.x() * p.x() + p.z() * p.z();
  if (region == ScatterRegion::box) return true;
  return (region == ScatterRegion::ball ? p.squaredNorm() : across) <= 0.25 * (1 + room);
}

Vec3 random_point(Random& random, ScatterRegion region, const Vec3& size) {
  Vec3 p;
  do {
    for (int k = 0; k < 3; ++k) p[k] = random.uniform(-0.5, 0.5);
  } while (!in_region(p, region));
  return p.cwiseProduct(size);
}

Quat random_rotation(Random& random) {
  const double u = random.uniform(), a = 2 * det::pi * random.uniform(),
               b = 2 * det::pi * random.uniform();
  const double r = std::sqrt(1 - u), s = std::sqrt(u);
  return {s * det::cos(b), r * det::sin(a), r * det::cos(a), s * det::sin(b)};
}

Result<std::vector<Pose>> copy_poses(const SceneDescription& scene, const std::string& body_name,
                                     const BodyDescription& body,
                                     std::vector<std::string>& warnings) {
  std::vector<Pose> frames{Pose{}};
  for (size_t level = 0; level < body.repeat.size(); ++level) {
    const RepetitionDescription& r = body.repeat[level];
    const uint64_t base = named_seed(scene.seed, body_name) + level;
    std::vector<Pose> next;
    next.reserve(frames.size() * size_t(count_of(r)));
    // Each outer copy has its own random numbers, instead of a rotated copy of the same.
    for (size_t outer = 0; outer < frames.size(); ++outer) {
      const uint64_t seed = base + 0x9e3779b97f4a7c15ULL * outer;
      CopyMaker maker{scene, seed, "bodies." + body_name, warnings, {}};
      if (auto ok = std::visit([&](const auto& k) { return maker.make(k); }, r.kind); !ok)
        return Error{ErrorCode::parse,
                     ok.error().message,
                     fmt::format("bodies.{}.repeat[{}]", body_name, level),
                     {}};
      add_jitter(maker.frames, r, seed);
      for (const Pose& inner : maker.frames) next.push_back(frames[outer] * inner);
    }
    frames = std::move(next);
  }
  const Pose own = body.placement.pose();
  for (Pose& frame : frames) frame = {own.x + frame.x, (frame.q * own.q).normalized()};
  return frames;
}

}  // namespace tumble
