#include "viewer/render/ground_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {
namespace {

/// Squares of the raster along its longer side: at most this many, and more than half as many.
constexpr int most_squares = 40;
/// Reach of the filters of the two maps beyond the shade of a body [texels].
constexpr double shadow_filter = 3, contact_filter = 8;

/// A rectangle of the plane, x and z [m].
struct Patch {
  std::array<double, 2> low{std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::infinity()};
  std::array<double, 2> high{-std::numeric_limits<double>::infinity(),
                             -std::numeric_limits<double>::infinity()};

  void include(const Patch& p) {
    for (size_t k = 0; k < 2; ++k) {
      low[k] = std::min(low[k], p.low[k]);
      high[k] = std::max(high[k], p.high[k]);
    }
  }
  bool empty() const { return !(low[0] <= high[0] && low[1] <= high[1]); }
};

class GroundPlanner {
 public:
  GroundPlanner(const RenderScene& scene, const FrameSetup& setup)
      : scene_(scene), setup_(setup), ground_(scene.ground.height) {
    const auto& sun = setup.uniforms.to_sun;
    to_sun_ = Vec3(double(sun[0]), double(sun[1]), double(sun[2]));
    const double reach = 1.1 * setup.camera.far;
    const Vec3& eye = setup.view.eye;
    all_.low = {eye.x() - reach, eye.z() - reach};
    all_.high = {eye.x() + reach, eye.z() + reach};
  }

  void run(GroundPlan& plan) {
    for (const MeshInstance& i : scene_.instances)
      if (i.mesh && i.casts_shadow && i.paint.opacity >= 1) add_caster(bounds_of(i));
    for (const SphereInstance& s : scene_.spheres) {
      if (s.colour.w() < 1) continue;
      const Vec3 x = s.centre.cast<double>(), r = Vec3::Constant(double(s.radius));
      Aabb box;
      box.include(Vec3(x - r));
      box.include(Vec3(x + r));
      add_caster(box);
    }
    Patch whole;
    for (const Patch& p : patches_) whole.include(p);
    for (size_t k = 0; k < 2; ++k) cut(k, whole);
    mark();
    emit(plan);
  }

 private:
  void add_caster(const Aabb& box) {
    if (box.empty() || !box.overlaps(setup_.region)) return;
    const double low = std::max(box.min.y() - ground_, 0.0), high = box.max.y() - ground_;
    if (setup_.shadows && to_sun_.y() > 0 && high >= 0)
      add_patch(box, low, high, shadow_filter * setup_.shadow_texel / to_sun_.y());
    if (box.min.y() < setup_.view.contact_below)
      add_patch(box, 0, 0, contact_filter * setup_.contact_texel);
  }

  /// Adds the shade of the part of a box between two heights above the ground, projected along the
  /// rays of the sun.
  void add_patch(const Aabb& box, double low, double high, double rim) {
    Patch p;
    for (size_t k = 0; k < 2; ++k) {
      const int axis = k == 0 ? 0 : 2;
      const double shift = high > 0 ? to_sun_[axis] / to_sun_.y() : 0;
      p.low[k] = box.min[axis] - std::max(shift * low, shift * high) - rim;
      p.high[k] = box.max[axis] - std::min(shift * low, shift * high) + rim;
      p.low[k] = std::max(p.low[k], all_.low[k]);
      p.high[k] = std::min(p.high[k], all_.high[k]);
    }
    if (!p.empty()) patches_.push_back(p);
  }

  /// The raster's lines across an axis.
  void cut(size_t axis, const Patch& whole) {
    std::vector<double>& lines = lines_[axis];
    lines.push_back(all_.low[axis]);
    if (!whole.empty()) {
      const double side =
          std::max({whole.high[0] - whole.low[0], whole.high[1] - whole.low[1], 1e-9});
      int exponent = 0;
      std::frexp(side / (most_squares - 2), &exponent);
      const double square = std::ldexp(1.0, exponent);
      first_[axis] = std::floor(whole.low[axis] / square);
      const double last = std::floor(whole.high[axis] / square) + 1;
      for (double i = first_[axis]; i <= last; ++i)
        lines.push_back(std::clamp(i * square, all_.low[axis], all_.high[axis]));
      square_ = square;
    }
    lines.push_back(all_.high[axis]);
  }

  void mark() {
    const size_t across = lines_[0].size() - 1;
    shaded_.assign(across * (lines_[1].size() - 1), 0);
    for (const Patch& p : patches_) {
      std::array<size_t, 2> from{}, to{};
      for (size_t k = 0; k < 2; ++k) {  // the first line after the rim
        from[k] = size_t(std::floor(p.low[k] / square_) - first_[k]) + 1;
        to[k] = size_t(std::floor(p.high[k] / square_) - first_[k]) + 1;
      }
      for (size_t j = from[1]; j <= to[1]; ++j)
        std::fill_n(shaded_.begin() + std::ptrdiff_t(j * across + from[0]), to[0] - from[0] + 1, 1);
    }
  }

  void emit(GroundPlan& plan) const {
    plan.corners.clear();
    plan.triangles.clear();
    for (const double z : lines_[1])
      for (const double x : lines_[0]) plan.corners.push_back({float(x), float(z)});
    const auto row = uint32_t(lines_[0].size());
    for (const bool shaded : {true, false}) {
      for (uint32_t square = 0; square < shaded_.size(); ++square) {
        if ((shaded_[square] != 0) != shaded) continue;
        const uint32_t a = square / (row - 1) * row + square % (row - 1);
        for (const uint32_t corner : {a, a + 1, a + row, a + row, a + 1, a + row + 1})
          plan.triangles.push_back(corner);
      }
      if (shaded) plan.shaded = uint32_t(plan.triangles.size());
    }
  }

  const RenderScene& scene_;
  const FrameSetup& setup_;
  double ground_;
  Vec3 to_sun_;
  Patch all_;
  std::vector<Patch> patches_;
  std::array<std::vector<double>, 2> lines_;
  std::array<double, 2> first_{};  ///< number of the first line after the rim
  double square_ = 1;              ///< side of a square [m]
  std::vector<uint8_t> shaded_;    ///< of each square, rows along x
};

}  // namespace

void plan_ground(const RenderScene& scene, const FrameSetup& setup, GroundPlan& plan) {
  plan = {std::move(plan.corners), std::move(plan.triangles), 0};
  if (scene.ground.visible) GroundPlanner(scene, setup).run(plan);
}

}  // namespace tumble
