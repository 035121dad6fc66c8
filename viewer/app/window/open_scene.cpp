#include "viewer/app/window/open_scene.hpp"

#include "engine/core/hash.hpp"
#include "engine/scene/build/live_parts.hpp"
#include "engine/scene/catalogue.hpp"
#include "engine/scene/pack/pack.hpp"
#include "engine/scene/resources.hpp"
#include "engine/scene/robot_files/robot_parts.hpp"
#include "engine/scene/saving/json_text_edit.hpp"
#include "engine/scene/visitors/object_writer.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/editing/unsaved_work.hpp"
#include "viewer/app/scenes/quantities.hpp"
#include "viewer/app/scenes/scene_assertions.hpp"
#include "viewer/app/scenes/scene_lesson.hpp"
#include "viewer/app/scenes/scene_look.hpp"
#include "viewer/app/scenes/scene_replay.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <cctype>
#include <cmath>

#include <fmt/format.h>

namespace tumble {
namespace {

constexpr const char* template_of_new = "assets/new_scene.json";

/// Whether two paths lead to the same file.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code none;
  return std::filesystem::equivalent(a, b, none);
}

/// Scenes that come with Tumble are not overwritten: changed versions are saved to the working
/// folder.
SceneFile file_of(const LoadedScene& loaded, const SceneRequest& request) {
  SceneFile file;
  if (is_mesh_file(loaded.file) || is_robot_file(loaded.file)) return file;
  if (auto text = read_file(loaded.file)) file.on_disk = std::move(*text);
  file.text = request.text.value_or(file.on_disk);
  file.read_from = loaded.file;
  if (same_file(loaded.file, new_scene_file())) {
    file.path = unnamed_scene(1);
    file.unnamed = true;
    return file;
  }
  // Files unpacked from a pack belong to the cache and are not overwritten.
  const std::string packs = pack_folder().string() + "/";
  std::error_code none;
  if (loaded.file.string().starts_with(packs) && is_pack_file(request.scene)) {
    file.pack = file.path = std::filesystem::absolute(request.scene, none);
    file.ours = true;
    return file;
  }
  file.ours = request.scene != loaded.name && !loaded.file.string().starts_with(packs);
  const auto here = std::filesystem::current_path(none);
  file.path =
      file.ours ? std::filesystem::absolute(loaded.file, none) : here / loaded.file.filename();
  return file;
}

/// Limits for a number to which the file gives none: from its magnitude; a count stays a count.
void limit_by_magnitude(SceneParameter& p) {
  if (p.value == 0) {
    p.min = -1;
    p.max = 1;
    return;
  }
  const double decade = std::pow(10.0, std::floor(std::log10(std::abs(p.value))));
  const bool count = p.value >= 2 && p.value == std::round(p.value);
  const double least = count ? 1 : 0.1 * decade, most = 10 * decade;
  p.min = p.value > 0 ? least : -most;
  p.max = p.value > 0 ? most : -least;
}

/// The numbers that can be changed. Those given by an expression depend on the others and are left
/// out.
std::vector<SceneParameter> parameters_of(const SceneDescription& scene, const std::string& text) {
  const JsonTextEdit file(text);
  const auto is_number = [&](const std::string& name) {
    if (text.empty()) return false;
    const auto said = file.value(JsonTextEdit::Path{} / "parameters" / name);
    return said && !said->empty() &&
           (std::isdigit(static_cast<unsigned char>(said->front())) != 0 || said->front() == '-');
  };
  std::vector<SceneParameter> out;
  for (const auto& [name, p] : scene.parameters_.items) {
    const bool declared = !p.doc.empty() || p.min || p.max;
    if (!declared && !is_number(name)) continue;
    SceneParameter& number = out.emplace_back(SceneParameter{name, p.doc, p.value, p.min, p.max});
    if (!declared) limit_by_magnitude(number);
  }
  return out;
}

/// Of what the scene says about bodies and all that acts on them. Words, cameras, light and what is
/// checked or taught leave the world as it is.
uint64_t hash_of_world(const SceneDescription& scene) {
  Json said = write_object(scene);
  for (const char* beside : {"title", "description", "category", "assertions", "cameras", "lights",
                             "look", "microscope", "lesson"})
    said.erase(beside);
  const std::string text = said.dump();
  return hash_bytes(text.data(), text.size());
}

std::shared_ptr<const NamedQuantities> named_quantities(std::shared_ptr<const BuiltScene> names,
                                                        const Frame& frame) {
  auto out = std::make_shared<NamedQuantities>();
  out->names = std::make_shared<const std::vector<std::string>>(quantity_names(*names, frame));
  out->find = [names](const std::string& name) {
    return Quantity{name, unit_of_quantity(name),
                    [names, name](const Frame& now) { return quantity(*names, now, name); }};
  };
  out->with = [names](const Frame& now) { return named_quantities(names_with(*names, now), now); };
  return out;
}

}  // namespace

std::string new_scene_file() {
  const auto found = find_resource(template_of_new);
  return found ? found->string() : template_of_new;
}

Result<OpenedScene> open_scene(const SceneRequest& request, double aspect) {
  auto loaded = load_scene_and_world(request);
  if (!loaded) return loaded.error();
  OpenedScene out;
  const std::shared_ptr<const SceneDescription> description = loaded->built.description;
  out.name = loaded->name;
  out.request = {request.scene, request.overrides, request.text};
  out.file = file_of(*loaded, request);
  out.world_hash = hash_of_world(*description);
  out.parameters = parameters_of(*description, out.file.text);
  out.title = description->title;
  out.doc = description->description;
  out.warnings = loaded->built.warnings;
  // A replay that was requested must exist and fit; if only the pack has one that does not, the
  // scene is shown without it.
  auto replay = replay_of(request, *loaded);
  if (!replay && !request.replay.file.empty()) return replay.error();
  if (replay)
    out.replay = *std::move(replay);
  else
    out.warnings.push_back("The pack's replay is not played: " + replay.error().message);
  if (out.replay) out.replay_words = replay_words(request, *loaded, *out.replay);
  if (auto view = find_view_point(loaded->built, "", aspect)) out.view = std::move(*view);
  out.notes = body_notes(loaded->built);
  out.overlays = overlays_of(*description);
  out.trail = description->look.trail;
  out.microscope = loaded->built.microscope;
  out.look = [description](RenderScene& scene) { apply_look(*description, scene); };
  out.assertions = SceneAssertions::make(loaded->built);
  out.lesson = SceneLesson::make(loaded->built, aspect);
  out.quantities = named_quantities(names_of(loaded->built), *loaded->built.world->frame());
  out.parts = std::make_shared<const SceneDescription>(parts_of(*description));
  out.live_parts = std::make_shared<LiveParts>(loaded->built);
  out.world = std::move(loaded->built.world);
  return out;
}

}  // namespace tumble
