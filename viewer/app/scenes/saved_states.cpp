#include "viewer/app/scenes/saved_states.hpp"

#include "engine/core/hash.hpp"
#include "engine/world/particle_frames.hpp"
#include "engine/world/shown_state.hpp"
#include "engine/world/world.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/format.h>

namespace tumble {
namespace {

Error bad_use(std::string message, std::string cure) {
  return {ErrorCode::invalid_argument, std::move(message), {}, std::move(cure)};
}

/// Keys of a body that only affect its look.
constexpr std::array<std::string_view, 9> body_looks = {"colour",  "roughness", "metallic",
                                                        "pattern", "opacity",   "visible",
                                                        "label",   "volumes",   "volumes_level"};

/// The part of a path after the n-th dot; empty if there is none.
std::string_view after_dots(std::string_view path, int n) {
  for (; n > 0; --n) {
    const size_t dot = path.find('.');
    if (dot == path.npos) return {};
    path.remove_prefix(dot + 1);
  }
  return path;
}

/// Whether an override "path=value" only changes looks.
bool changes_looks(std::string_view change) {
  const std::string_view path = change.substr(0, change.find('='));
  const std::string_view key = after_dots(path, 2);
  for (const std::string_view all : {"cameras.", "lights.", "look."})
    if (path.starts_with(all)) return true;
  if (path.starts_with("particles.")) return key == "look" || key.starts_with("look.");
  return path.starts_with("bodies.") && std::ranges::find(body_looks, key) != body_looks.end();
}

/// Rejects colouring by a quantity whose range was not recorded.
Status check_ranges(const Frame& then, const Frame& now) {
  for (size_t i = 0; i < now.particles.size() && i < then.particles.size(); ++i) {
    const ParticleLook &old = then.particles[i]->look, &look = now.particles[i]->look;
    if (!look.finds_range() || (old.finds_range() && old.colour_by == look.colour_by)) continue;
    const std::string& name = now.particles[i]->name;
    return bad_use(
        fmt::format("the least and the greatest {} of '{}' were not noted while the states were "
                    "made",
                    name_of(look.colour_by).name, name),
        fmt::format("give them: --set particles.{}.look.range=[0,1]", name));
  }
  return {};
}

}  // namespace

std::string start_of_run(const World& world, const std::string& version) {
  const Bytes bytes = world.save(false);
  return hash_text(hash_bytes(bytes, hash_bytes(version.data(), version.size())));
}

Result<SavedStates> SavedStates::open(const std::filesystem::path& folder) {
  auto list = read_state_list(folder);
  if (!list) return list.error();
  if (!list->find(0))
    return Error{ErrorCode::not_found, "there is no state to begin with", folder.string(),
                 "tumble simulate --states makes them"};
  SavedStates out;
  out.folder_ = folder;
  out.list_ = *std::move(list);
  return out;
}

Result<LoadedScene> SavedStates::load_scene(SceneRequest request, const std::string& version) {
  for (const std::string& change : request.overrides)
    if (!changes_looks(change))
      return bad_use("--set " + change + ": the states hold how everything moves",
                     "only cameras, lights, look, and looks of bodies and particles can be changed "
                     "afterwards; simulate anew for the rest");
  const std::vector<std::string> changes = std::exchange(request.overrides, list_.overrides);
  request.stepper = list_.stepper;
  auto scene = load_scene_and_world(request);
  if (!scene) return scene.error();
  const Error another = {ErrorCode::invalid_argument,
                         "these are states of another scene, or of another version of it or of "
                         "Tumble",
                         (folder_ / state_list_name).string(),
                         "they were made of '" + list_.scene + "'; simulate it anew"};
  const World& world = *scene->built.world;
  if (start_of_run(world, version) != list_.start || world.settings().tick != list_.rate)
    return another;
  if (changes.empty()) return scene;
  const auto as_simulated = scene->built.world->frame();
  request.overrides.insert(request.overrides.end(), changes.begin(), changes.end());
  auto shown = load_scene_and_world(request);
  if (!shown) return shown.error();
  looks_ = shown->built.world->frame();
  for (const auto& [name, id] : shown->built.emitters)
    if (const Emitter* emitter = shown->built.world->emitter(id); emitter && emitter->def->body)
      emitters_.emplace_back(id, emitter->def);
  if (Status known = check_ranges(*as_simulated, *looks_); !known) return known.error();
  return shown;
}

uint64_t SavedStates::frames_at(Fraction fps) const {
  return frames_until(list_.states.back().tick, fps, list_.rate);
}

Status SavedStates::check_frames(uint64_t frames, Fraction fps, bool each) const {
  uint64_t there = 0;
  for (; there < frames; ++there) {
    const FrameTime at = frame_time(there, fps, list_.rate);
    if (!list_.find(at.tick) || !list_.find(at.last_tick())) break;
  }
  if (there < frames)
    return bad_use(fmt::format("of {} frames at {:g}/s only {} can be drawn from the states",
                               frames, fps.value(), there),
                   fmt::format("they were saved for frames at {:g}/s; simulate with another --fps "
                               "or longer, with --resume",
                               list_.fps.value()));
  const uint64_t last = frame_time(frames - 1, fps, list_.rate).last_tick();
  const bool all = list_.states.size() > last && list_.states[size_t(last)].tick == last;
  if (all || !each) return {};
  return bad_use("trails and arrows are made of every tick, and some were not saved",
                 fmt::format("simulate with --fps {:g}, the rate of ticks", 1 / list_.rate.tick()));
}

Result<std::shared_ptr<const Frame>> SavedStates::begin(World& world) const {
  return frame_at(world, list_.states.front());
}

Result<std::shared_ptr<const Frame>> SavedStates::advance(World& world, uint64_t tick,
                                                          bool each) const {
  auto at = std::ranges::upper_bound(list_.states, world.tick(), {}, &SavedState::tick);
  if (!each)  // the tick before is the other end of the interpolation
    while (at != list_.states.end() && at->tick + 1 < tick) ++at;
  if (at == list_.states.end() || at->tick > tick)
    return Error{ErrorCode::not_found,
                 fmt::format("there is no state of tick {}", tick),
                 folder_.string(),
                 {}};
  return frame_at(world, *at);
}

Result<std::shared_ptr<const Frame>> SavedStates::frame_at(World& world,
                                                           const SavedState& state) const {
  const auto content = read_state(folder_, state);
  if (!content) return content.error();
  auto frame = load_shown(world, std::as_bytes(std::span(*content)));
  if (!frame) {
    Error error = frame.error();
    error.place = (folder_ / state_file_name(state.tick)).string();
    return error;
  }
  if (looks_) take_looks(world, **frame);
  return std::shared_ptr<const Frame>(*std::move(frame));
}

void SavedStates::take_looks_of_copies(const World& world, std::vector<BodyInfo>& infos) const {
  for (const auto& [id, def] : emitters_) {
    const Emitter* emitter = world.emitter(id);
    if (!emitter || emitter->def->name != def->name) continue;
    const bool own_colours = !def->colours.empty() || !def->over_time.colour.empty();
    for (const Emitter::OwnBody& copy : emitter->bodies) {
      if (copy.id.index >= infos.size() || infos[copy.id.index].id != copy.id) continue;
      Look& look = infos[copy.id.index].look;
      const Vec3f drawn = look.colour;
      look = def->body->look;
      if (own_colours) look.colour = drawn;
    }
  }
}

void SavedStates::take_looks(const World& world, Frame& frame) const {
  auto infos = std::make_shared<std::vector<BodyInfo>>(*frame.infos);
  for (size_t slot = 0; slot < infos->size() && slot < looks_->body_slots(); ++slot) {
    BodyInfo& info = (*infos)[slot];
    const BodyInfo& now = looks_->info(slot);
    if (info.id.is_null() || info.id != now.id || info.name != now.name) continue;
    info.look = now.look;
    info.drawn = now.drawn;
  }
  take_looks_of_copies(world, *infos);
  frame.infos = std::move(infos);
  for (auto& shown : frame.particles) {
    const auto now = std::ranges::find_if(looks_->particles, [&](const auto& system) {
      return system->id == shown->id && system->name == shown->name;
    });
    if (now == looks_->particles.end()) continue;
    auto particles = std::make_shared<ParticleFrame>(*shown);
    particles->glow = (*now)->glow;
    show_particles_as((*now)->look, *world.particles(shown->id),
                      [&world](EmitterId id) { return world.emitter(id); }, *particles);
    shown = std::move(particles);
  }
}

}  // namespace tumble
