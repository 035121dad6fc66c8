#include "viewer/app/window/comparison_controller.hpp"

#include "viewer/app/verify/differences.hpp"
#include "viewer/render/extract.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include <fmt/format.h>

namespace tumble {
namespace {

/// World B is drawn in transparent blue.
const Vec3f ghost_colour(0.10f, 0.35f, 1.0f);
constexpr float ghost_opacity = 0.38f, ghost_tint = 0.75f;

/// Ghosts are drawn farther from the eye by this share of their distance, about two pixels' width:
/// where B and A nearly coincide, A covers B everywhere, instead of the nearer of two faces at each
/// pixel.
constexpr float ghost_behind = 2e-3f;

void make_ghost(Vec3f& colour) {
  colour = (1 - ghost_tint) * colour + ghost_tint * ghost_colour;
}

/// The exact places (all bits) where things are drawn.
template <class Thing>
class Places {
 public:
  explicit Places(const std::vector<Thing>& things) {
    for (const Thing& thing : things) places_.push_back(place_of(thing));
    std::ranges::sort(places_);
  }
  bool has(const Thing& thing) const {
    return std::ranges::binary_search(places_, place_of(thing));
  }

 private:
  using Place = std::array<uint32_t, 12>;
  static Place place_of(const MeshInstance& instance) {
    Place out{};
    for (int k = 0; k < 9; ++k)
      out[size_t(k)] = std::bit_cast<uint32_t>(instance.transform.linear.data()[k]);
    for (int k = 0; k < 3; ++k)
      out[size_t(9 + k)] = std::bit_cast<uint32_t>(instance.transform.offset[k]);
    return out;
  }
  static Place place_of(const SphereInstance& sphere) {
    Place out{std::bit_cast<uint32_t>(sphere.radius)};
    for (int k = 0; k < 3; ++k) out[size_t(1 + k)] = std::bit_cast<uint32_t>(sphere.centre[k]);
    return out;
  }

  std::vector<Place> places_;
};

/// The body of A that a divergence names.
BodyId body_named(const Frame& frame, const std::string& name) {
  for (size_t slot = 0; slot < frame.body_slots(); ++slot) {
    const BodyId id = frame.body(slot).id;
    if (!id.is_null() && frame.info(slot).name == name) return id;
  }
  return {};
}

}  // namespace

void ComparisonController::begin(Session& session, WorldChoice choice, double trail,
                                 const World* made) {
  opening_.reset();
  second_ = made ? std::make_shared<SecondWorld>(std::move(choice), *made)
                 : std::make_shared<SecondWorld>(std::move(choice));
  seen_ = {};
  trail_ = trail;
  restart_trail();
  session.set_second(second_);
}

void ComparisonController::open(SceneOpener open, OpenRequest wanted, WorldChoice choice) {
  wanted_ = std::move(choice);
  opening_ = std::make_unique<SceneLoader>();
  opening_->start(std::move(open), std::move(wanted));
}

std::optional<ComparisonController::Opened> ComparisonController::take_opened() {
  if (!opening_) return std::nullopt;
  auto loaded = opening_->take();
  if (!loaded) return std::nullopt;
  opening_.reset();
  return Opened{std::move(wanted_), std::move(loaded->scene)};
}

void ComparisonController::end(Session& session) {
  session.set_second(nullptr);
  forget();
}

void ComparisonController::forget() {
  opening_.reset();
  second_.reset();
  seen_ = {};
  comparison_ = {};
}

void ComparisonController::update(const Frame& shown, const WorldChoice& of_a) {
  if (!comparison()) return;
  comparison_ = {};
  comparison_.opening = opening_ != nullptr;
  comparison_.choice = opening_ ? wanted_ : second_->choice();
  comparison_.differences = differences(of_a, comparison_.choice);
  if (!second_) return;
  seen_ = second_->shown();
  if (seen_.to) trails_.see(*seen_.to);
  comparison_.from_start = second_->from_start();
  comparison_.alone = seen_.alone;
  comparison_.behind = seen_.behind;
  for (const SecondWorld::Sample& sample : seen_.samples) {
    comparison_.times.push_back(sample.time);
    comparison_.distances.push_back(float(sample.distance));
  }
  comparison_.distance = seen_.now.distance;
  comparison_.angle = seen_.now.angle;
  comparison_.what = seen_.now.what;
  comparison_.worst = seen_.worst.distance;
  comparison_.fault = seen_.fault;
  if (!seen_.first) return;
  comparison_.first_tick = seen_.first->tick_a;
  comparison_.first_what = seen_.first->what;
  comparison_.first_body = body_named(shown, seen_.first->what);
  comparison_.first_contact = seen_.first_contact;
}

std::optional<SessionView> ComparisonController::view(const SessionView& shown) const {
  if (!second_ || !seen_.to) return std::nullopt;
  // Between the same two ticks as A, if B has them.
  const bool beside = seen_.tick_from == shown.from->tick && seen_.tick_to == shown.to->tick;
  SessionView out = shown;
  out.from = beside ? seen_.from : seen_.to;
  out.to = seen_.to;
  out.s = beside ? shown.s : 1;
  return out;
}

RenderScene& ComparisonController::draw_beside(const SessionView& shown,
                                               const ExtractOptions& options, ShapeMeshes& meshes,
                                               const RenderScene& picture) {
  picture_.look_like(picture);
  const auto seen = view(shown);
  if (!seen) {
    picture_.clear_content();
    return picture_;
  }
  ExtractOptions own = options;
  own.microscope.reset();
  own.before = seen_.from;
  extract(*seen->from, *seen->to, seen->s, own, meshes, picture_);
  trails_.draw(*seen->from, *seen->to, seen->s, picture_);
  return picture_;
}

void ComparisonController::draw_ghost(const SessionView& shown, const ExtractOptions& options,
                                      ShapeMeshes& meshes, RenderScene& picture) {
  const auto seen = view(shown);
  if (!seen) return;
  ExtractOptions bare;
  bare.world_hierarchy = options.world_hierarchy;
  extract(*seen->from, *seen->to, seen->s, bare, meshes, picture_);
  // Where both worlds agree, the transparent copy would only cover the original.
  const Places<MeshInstance> taken(picture.instances);
  const Places<SphereInstance> taken_by_spheres(picture.spheres);
  const Vec3f eye = picture.camera.eye.cast<float>();
  for (MeshInstance instance : picture_.instances) {
    if (taken.has(instance)) continue;
    instance.transform.offset += ghost_behind * (instance.transform.offset - eye);
    make_ghost(instance.paint.colour);
    instance.paint.opacity = ghost_opacity * instance.paint.opacity;
    instance.casts_shadow = false;
    picture.instances.push_back(std::move(instance));
  }
  for (SphereInstance sphere : picture_.spheres) {
    if (taken_by_spheres.has(sphere)) continue;
    sphere.centre += ghost_behind * (sphere.centre - eye);
    const Vec3f c = (1 - ghost_tint) * sphere.colour.head<3>() + ghost_tint * ghost_colour;
    sphere.colour = {c[0], c[1], c[2], ghost_opacity * std::min(sphere.colour[3], 1.0f)};
    picture.spheres.push_back(sphere);
  }
}

}  // namespace tumble
