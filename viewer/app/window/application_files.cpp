// The scene's file: opened, changed by others, saved, and unsaved work.
#include "engine/scene/saving/dependents.hpp"
#include "engine/world/world.hpp"
#include "viewer/app/scenes/load_scene.hpp"
#include "viewer/app/window/application.hpp"
#include "viewer/app/window/folder_browser.hpp"
#include "viewer/capture/atomic_file.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace tumble {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  size_t begin = 0;
  while (begin < text.size()) {
    const size_t end = std::min(text.find('\n', begin), text.size());
    if (end > begin) lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

}  // namespace

/// Opens the file browser; relative paths start at the scene's folder, or else the working folder.
void Application::browse(const std::string& folder) {
  browsed_.reset();
  if (!folder.empty()) browsed_ = look_through(folder);
}

void Application::open(OpenRequest wanted) {
  if (!description_.has_draft()) return open_for({}, std::move(wanted));
  question_.ask({{"Changes of this scene are not in effect yet",
                  {"They are not kept when another scene is opened."},
                  {{"leave", "Open without them"}, {"stay", "Stay"}}},
                 {[this, wanted = std::move(wanted)] {
                    description_.leave_draft();
                    open_for({}, wanted);
                  },
                  [] {}}},
                ui_);
}

void Application::open_for(SceneOpening::Cause cause, OpenRequest wanted) {
  if (!std::exchange(describing_, false) && description_.opening())
    description_.refuse(
        {"Something else was opened meanwhile: change it once more, or take it back."});
  if (options_.own_thread)
    return opening_.start(options_.open, std::move(wanted), std::move(cause));
  auto scene = options_.open(wanted);
  finish_opening({std::move(wanted), std::move(scene), std::move(cause)});
}

/// Finds things by name, since the world is another one.
Application::LookedAt Application::looked_at_in(const OpenedScene& scene) const {
  LookedAt out;
  const World& world = *scene.world;
  const auto name_there = [&](const std::string& name) {
    return renaming_ && renaming_->list == "bodies"
               ? renamed_item(name, renaming_->from, renaming_->to)
               : name;
  };
  for (const BodyId id : selection_.all())
    if (const BodyId there = world.find_body(name_there(name_of(id))); !there.is_null())
      out.selected.push_back(there);
  const auto& named = scene.quantities;
  for (const Measures::Series& curve : instruments_.measures.series()) {
    std::string name = curve.quantity.name;
    if (const size_t owner = name.rfind(": "); owner != std::string::npos)
      name = name_there(name.substr(0, owner)) + name.substr(owner);
    if (auto found = quantity_of_name(*world.frame(), name))
      out.curves.push_back(*std::move(found));
    else if (named && std::ranges::find(*named->names, name) != named->names->end())
      out.curves.push_back(named->find(name));
  }
  return out;
}

/// Keeps the undo history of choices for the scene that was opened.
void Application::keep_choices(SceneOpening::Cause& cause) {
  const bool lost = cause.reloads && (!undo_steps_.choices().empty() || cause.undo_steps_lost);
  auto& choice = cause.choice;
  if (!choice) undo_steps_.choices().forget();
  for (ChoiceHistory::Step& undo_step : cause.undo_steps)
    undo_steps_.choices().gone(std::move(undo_step));
  if (choice) {
    if (choice->way != ChoiceHistory::Way::anew)
      ui_.toast(ToastKind::info,
                (choice->way == ChoiceHistory::Way::back ? "Taken back: " : "Done again: ") +
                    choice->what);
    undo_steps_.choices().gone(*std::move(choice));
  }
  if (!cause.reloads) return;
  std::vector<std::string> lines;
  if (lost) lines.push_back("What was done before that cannot be taken back any more.");
  ui_.toast(ToastKind::info,
            scene_.request.text
                ? "The scene's file has changed: opened anew, with what was changed "
                  "here"
                : "The scene's file has changed: opened anew",
            std::move(lines));
}

void Application::finish_opening(SceneOpening::Opened done) {
  auto& [asked, opened, cause] = done;
  auto& choice = cause.choice;
  if (!opened) {
    finish_description(opened.error());
    renaming_.reset();
    described_camera_ = false;
    const std::string file = std::filesystem::path(asked.scene).filename().string();
    return ui_.toast(ToastKind::error, "'" + file + "' cannot be opened",
                     lines_of(opened.error().text()));
  }
  ui_.toasts.clear();
  finish_description({});
  // The same scene with other numbers or another text is looked at from where one stands, and
  // waits if it did.
  const bool same = asked.scene == scene_.request.scene &&
                    (choice || !asked.overrides.empty() || asked.text || cause.reloads);
  const bool paused = session().paused();
  if (opened->file.unnamed) {
    // The newest changes decide whether the name of the scene shown is still in use.
    undo_steps_.finish(session(), options_.own_thread);
    opened->file.path = !asked.called.empty()         ? asked.called
                        : same && scene_.file.unnamed ? scene_.file.path
                                                      : undo_steps_.unsaved().free_name();
  }
  const LookedAt looked_at = same ? looked_at_in(*opened) : LookedAt{};
  // What does not act on bodies (cameras, light, words) leaves the world as it is, at this moment;
  // but what judges the run has to see all of it.
  const bool judged = opened->assertions || opened->lesson;
  const bool same_world = same && choice && !judged && opened->world_hash == scene_.world_hash &&
                          opened->world_hash != 0;
  const auto moment = same_world ? session().keep() : nullptr;
  if (!same) description_.forget();
  description_.begin_anew();
  if (renaming_) ui_.pins.rename(renaming_->list, renaming_->from, renaming_->to);
  renaming_.reset();
  const SceneCamera camera = camera_;
  // A new scene has nothing to simulate: it stands still from its first tick on.
  const bool empty = !same && opened->file.unnamed;
  if (empty) session().set_paused(true);
  show(std::move(*opened), same);
  keep_choices(cause);
  if (empty) begin_building();
  if (!same) return;
  for (const BodyId id : looked_at.selected) selection_.add(id);
  for (const Quantity& quantity : looked_at.curves)
    instruments_.measures.add(quantity, world_.frame());
  if (!std::exchange(described_camera_, false)) camera_.go_on_from(camera);
  if (same_world)
    session().restore(moment);
  else if (cause.tick > 0)
    session().seek(cause.tick);
  session().set_paused(paused);
}

/// Says how one begins in a new scene.
void Application::begin_building() {
  if (options_.hints)
    ui_.toast(ToastKind::info, "A new scene, standing still",
              {fmt::format("{} has what one builds of, {} lets it run.",
                           shortcut_of(Action::toggle_build), shortcut_of(Action::toggle_pause))});
}

/// Another program has written the scene's file: it is opened anew with the same camera and moment,
/// and with the unsaved changes applied to the new text.
void Application::look_at_files(double dt) {
  // Closed by its button, or by a click beside it.
  if (!ui_.shows(PanelId::question)) question_.decline(ui_);
  undo_steps_.unsaved().update(session(), undo_steps_.edits().file_edits(), dt);
  const bool changed = scene_file_.changed_by_others(dt).has_value();
  if (scene_file_.taken_away())
    ui_.toast(ToastKind::warning, "The scene's file is gone",
              {scene_.file.path.string(), fmt::format("What is shown stays: {} writes it anew.",
                                                      shortcut_of(Action::save_scene))});
  if (!changed) return;
  // The newest change here is to be done to the new text too, when the session has told of it.
  if (!undo_steps_.unsaved().known()) return undo_steps_.unsaved().hurry();
  const std::string now = scene_file_.take_changed_by_others();
  if (recording()) return;
  OpenRequest wanted = scene_.request;
  wanted.text.reset();
  if (undo_steps_.unsaved().any()) {
    auto both = undo_steps_.unsaved().with(now);
    if (!both) {
      std::vector<std::string> lines = lines_of(both.error().text());
      lines.push_back("What was changed here stays as it is: saving replaces the file.");
      return ui_.toast(ToastKind::warning, "The scene's file was changed by somebody else", lines);
    }
    wanted.text = *std::move(both);
  }
  SceneOpening::Cause cause;
  cause.reloads = true;
  cause.tick = world_.frame().tick;
  OpenRequest start = wanted;
  start.text.reset();
  // What is in the text that was opened, and what was done since, is taken back together.
  if (scene_.request.text && wanted.text)
    cause.undo_steps = {{ChoiceHistory::Way::anew, "Change the scene", start, wanted}};
  else
    cause.undo_steps = undo_steps_as_choices(start, now);
  cause.undo_steps_lost = cause.undo_steps.size() < undo_steps_.edits().undo_steps().size();
  open_for(std::move(cause), std::move(wanted));
}

/// Opens the scene with work kept earlier, which can be undone as a whole.
void Application::take_up(const UnsavedWork::Kept& kept, std::filesystem::path called) {
  undo_steps_.unsaved().take_over(kept);
  OpenRequest wanted = scene_.request;
  wanted.text = kept.text;
  wanted.called = std::move(called);
  if (!wanted.called.empty()) return open(std::move(wanted));
  SceneOpening::Cause cause;
  cause.choice = ChoiceHistory::Step{ChoiceHistory::Way::anew, "Go on with unsaved changes",
                                     scene_.request, wanted};
  open_for(std::move(cause), std::move(wanted));
}

/// Offers new scenes that were never saved: each can be continued, and none replaces another.
void Application::offer_unnamed_work() {
  const auto kept = undo_steps_.unsaved().kept_unnamed();
  if (kept.empty()) return;
  QuestionController::Asked open;
  open.question.title = "There are new scenes that were not saved";
  constexpr size_t most = 4;
  for (size_t i = kept.size() - std::min(kept.size(), most); i < kept.size(); ++i) {
    const UnsavedWork::Unnamed& one = kept[i];
    const std::string name = one.path.stem().string();
    open.question.lines.push_back(fmt::format("{}, of {}", name, one.kept.when));
    open.question.choices.push_back({"take_up_" + name, name});
    open.answers.push_back([this, one] { take_up(one.kept, one.path); });
  }
  open.question.lines.push_back("They are kept until they are saved. Go on with one of them?");
  open.question.choices.push_back({"later", "A new one"});
  open.answers.push_back([] {});
  question_.ask(std::move(open), ui_);
}

/// Offers the unsaved work that an earlier run has left for this scene.
void Application::offer_kept_work() {
  if (scene_.request.text) return;
  if (scene_.file.unnamed) return offer_unnamed_work();
  const auto kept = undo_steps_.unsaved().kept();
  if (!kept) return;
  std::vector<std::string> lines = {
      fmt::format("They were made {}, and kept when {}.", kept->when,
                  kept->own ? "this scene was left" : "the program ended")};
  if (kept->older)
    lines.push_back(
        "The scene's file was written after that: saving them replaces what it says now.");
  question_.ask(
      {{"There are changes of this scene that were not saved",
        std::move(lines),
        {{"take_up", "Go on with them"}, {"throw_away", "Throw them away"}, {"later", "Later"}}},
       {[this, kept = *kept] { take_up(kept); },
        [this, file = kept->file] { undo_steps_.unsaved().throw_away(file); }, [] {}}},
      ui_);
}

void Application::ask_to_quit() {
  // Includes the newest change.
  undo_steps_.finish(session(), options_.own_thread);
  const bool draft = description_.has_draft();
  if ((!undo_steps_.unsaved().any() && !draft) || question_.quits()) {
    quit_ = true;
    return;
  }
  std::vector<std::string> lines;
  if (undo_steps_.unsaved().any())
    lines.push_back("It is kept until this scene is opened again, and offered then.");
  if (draft)
    lines.push_back("Changes of the scene that are not in effect yet are neither saved nor kept.");
  question_.ask({{"What was changed in this scene is not saved",
                  std::move(lines),
                  {{"save", "Save ..."}, {"quit", "Quit"}, {"stay", "Stay"}}},
                 {[this] { save_scene(); }, [this] { quit_ = true; }, [] {}},
                 true},
                ui_);
}

void Application::change_parameter(const ChangeParameter& change) {
  const std::vector<std::string> number = {
      fmt::format("parameters.{}={}", change.name, change.value)};
  choose(number, "Change " + change.name, world_.frame().tick);
}

/// The moments stored for undo belong to this world. When another world takes its place, each
/// change becomes a change of the scene's text, which is undone by opening the scene without it.
/// `start`: the scene without the changes, with this text.
std::vector<ChoiceHistory::Step> Application::undo_steps_as_choices(const OpenRequest& start,
                                                                    std::string text) {
  const auto undo_steps = undo_steps_.edits().undo_steps();
  std::vector<UndoStepEdits> edits;
  for (const auto& undo_step : undo_steps) edits.push_back(undo_step.second);
  const std::vector<uint64_t> ticks = undo_steps_.edits().ticks();
  const std::vector<std::string> texts = undo_steps_.unsaved().texts_after(
      text, session(), undo_steps_.edits().forgotten(), edits, options_.own_thread);
  std::vector<ChoiceHistory::Step> out;
  OpenRequest wanted = start;
  for (size_t i = 0; i < texts.size(); ++i) {
    if (texts[i] == text) continue;  // a change that a file cannot represent
    OpenRequest before = wanted;
    wanted.text = text = texts[i];
    out.push_back({ChoiceHistory::Way::anew, undo_steps[i].first, std::move(before), wanted,
                   ticks[i], world_.frame().tick});
  }
  return out;
}

/// The request that opens the scene as it is now, with its changes.
OpenRequest Application::request_of_now() {
  // Includes the newest change.
  undo_steps_.finish(session(), options_.own_thread);
  OpenRequest wanted = scene_.request;
  if (undo_steps_.unsaved().any()) wanted.text = undo_steps_.unsaved().text();
  return wanted;
}

/// Opens the scene anew with other numbers and with its changes, at the tick `tick`.
void Application::choose(const std::vector<std::string>& overrides, std::string what,
                         uint64_t tick) {
  OpenRequest after = request_of_now();
  for (const std::string& one : overrides) {
    const std::string path = one.substr(0, one.find('=') + 1);
    std::erase_if(after.overrides, [&](const std::string& o) { return o.starts_with(path); });
    after.overrides.push_back(one);
  }
  choose(std::move(after), std::move(what), tick);
}

void Application::choose(OpenRequest after, std::string what, uint64_t tick) {
  SceneOpening::Cause cause;
  cause.choice =
      ChoiceHistory::Step{ChoiceHistory::Way::anew, std::move(what), request_of_now(), after};
  cause.choice->leave_at(world_.frame().tick);
  cause.undo_steps = undo_steps_as_choices(scene_.request, scene_.file.text);
  cause.tick = tick;
  open_for(std::move(cause), std::move(after));
}

/// Renames a body and every reference to it: the scene is opened anew at this moment.
void Application::rename_body(const std::string& name, const std::string& to) {
  OpenRequest after = request_of_now();
  auto text = renamed(after.text.value_or(scene_.file.text), "bodies", name, to);
  if (text) {
    if (const Status opens = check_scene_text(*text, scene_.file.path); !opens)
      text = opens.error();
  }
  if (!text)
    return ui_.toast(ToastKind::warning, fmt::format("{} cannot be called {}", name, to),
                     lines_of(text.error().text()));
  after.text = std::move(*text);
  renaming_ = Renaming{"bodies", name, to};
  choose(std::move(after), fmt::format("Rename {} to {}", name, to), world_.frame().tick);
}

/// Undoes or redoes a choice; false if there is none.
bool Application::go_back_on(std::optional<ChoiceHistory::Step> choice) {
  if (!choice) return false;
  SceneOpening::Cause cause;
  cause.tick = choice->tick();
  choice->leave_at(world_.frame().tick);
  OpenRequest wanted = choice->request();
  cause.choice = std::move(choice);
  open_for(std::move(cause), std::move(wanted));
  return true;
}

/// Shows a preview of saving; a second request saves.
void Application::save_scene() {
  if (ui_.shows(PanelId::save) && scene_file_.preview()) return write_scene(ui_.save_file);
  ui_.hidden = false;
  ui_.shows(PanelId::save) = true;
  ui_.save_file.clear();
  ui_.save_fault.clear();
  scene_file_.prepare(session(), undo_steps_.edits().file_edits(), chosen_numbers(scene_),
                      options_.own_thread);
}

void Application::write_scene(const std::string& file) {
  if (const Status done = scene_file_.write(file); !done) {
    // The panel stays open with the typed name, which can be corrected.
    ui_.shows(PanelId::save) = true;
    ui_.save_file = file;
    ui_.save_fault = done.error().text();
    return;
  }
  ui_.shows(PanelId::save) = false;
  ui_.save_fault.clear();
  const std::string before = scene_.file.on_disk;
  scene_.file = scene_file_.file();
  marks_.go_on_as(marked_scene());
  // The scene's file is now that one: opening it anew gives what was saved.
  std::error_code none;
  scene_.request.scene = std::filesystem::absolute(scene_.file.path, none).string();
  scene_.request.text.reset();
  undo_steps_.choices().saved(scene_.request.scene, before);
  undo_steps_.unsaved().saved(scene_.file);
  // Messages about a version that could not be opened are outdated.
  std::erase_if(ui_.toasts, [](const Toast& t) { return t.title.ends_with("cannot be opened"); });
  ui_.toast(ToastKind::info, "Saved to " + file);
}

}  // namespace tumble
