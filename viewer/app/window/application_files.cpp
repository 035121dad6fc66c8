// The scene's file: opened, changed by others, saved, and what was not saved.
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

/// From the folder of the scene, or the working folder, on.
void Application::browse(const std::string& folder) {
  browsed_.reset();
  if (!folder.empty()) browsed_ = look_through(folder);
}

void Application::open(SceneWish wish) {
  open_for({}, std::move(wish));
}

void Application::open_for(SceneOpening::Cause cause, SceneWish wish) {
  if (options_.own_thread) return opening_.start(options_.open, std::move(wish), std::move(cause));
  auto scene = options_.open(wish);
  finish_opening({std::move(wish), std::move(scene), std::move(cause)});
}

void Application::finish_opening(SceneOpening::Opened done) {
  auto& [asked, opened, cause] = done;
  auto& choice = cause.choice;
  if (opened) {
    ui_.toasts.clear();
    // The same scene with other numbers or another text is looked at from where one stands, and
    // waits if it did.
    const bool same = asked.scene == scene_.wish.scene &&
                      (choice || !asked.overrides.empty() || asked.text || cause.reloads);
    const Camera camera = camera_.camera();
    const bool paused = session().paused();
    const uint64_t tick = cause.reloads ? world_.frame().tick : 0;
    if (opened->file.unnamed) {
      // Only with its newest deeds is it known whether the scene that is shown needs its name.
      deeds_.finish(session(), options_.own_thread);
      opened->file.path = !asked.called.empty()         ? asked.called
                          : same && scene_.file.unnamed ? scene_.file.path
                                                        : deeds_.unsaved().free_name();
    }
    show(std::move(*opened));
    if (!choice) {
      deeds_.choices().forget();
    } else {
      if (choice->way != ChoiceHistory::Way::anew)
        ui_.toast(ToastKind::info,
                  (choice->way == ChoiceHistory::Way::back ? "Taken back: " : "Done again: ") +
                      choice->what);
      for (const ChoiceHistory::Step& deed : cause.deeds) deeds_.choices().gone(deed);
      deeds_.choices().gone(*std::move(choice));
    }
    if (cause.reloads)
      ui_.toast(ToastKind::info, asked.text ? "The scene's file has changed: opened anew, with "
                                              "what was changed here"
                                            : "The scene's file has changed: opened anew");
    if (!same && scene_.file.unnamed) begin_building();
    if (!same) return;
    camera_.controller().set(camera);
    if (tick > 0) session().seek(tick);
    return session().set_paused(paused);
  }
  const std::string file = std::filesystem::path(asked.scene).filename().string();
  ui_.toast(ToastKind::error, "'" + file + "' cannot be opened", lines_of(opened.error().text()));
}

/// An empty floor has nothing to show: a new scene stands still until it is to run.
void Application::begin_building() {
  session().set_paused(true);
  if (options_.hints)
    ui_.toast(ToastKind::info, "A new scene, standing still",
              {fmt::format("{} has what one builds of, {} lets it run.",
                           shortcut_of(Action::toggle_build), shortcut_of(Action::toggle_pause))});
}

/// The scene was written by somebody else: shown anew from where one stands, at the moment where
/// one was. What was changed here and not saved is done to the new text as well.
void Application::look_at_files(double dt) {
  // Closed by its button, or by a click beside it.
  if (!ui_.shows(PanelId::question)) question_.decline(ui_);
  deeds_.unsaved().update(session(), deeds_.edits().file_edits(), dt);
  const auto now = scene_file_.changed_by_others(dt);
  if (!now || recording()) return;
  SceneWish wish = scene_.wish;
  wish.text.reset();
  if (deeds_.unsaved().any()) {
    std::vector<SceneEdit> edits = deeds_.unsaved().edits();
    auto both = save_edits(*now, scene_.file.path.string(), edits);
    if (!both || scene_.wish.text)
      return ui_.toast(ToastKind::warning, "The scene's file was changed by somebody else",
                       {"What was changed here does not fit into it, and is kept: saving replaces "
                        "the file."});
    wish.text = std::move(both->text);
  }
  open_for({{}, {}, true}, std::move(wish));
}

void Application::take_up(std::string text, std::filesystem::path called) {
  SceneWish wish = scene_.wish;
  wish.text = std::move(text);
  wish.called = std::move(called);
  open(std::move(wish));
}

/// New scenes that nobody has saved: each can be gone on with, and none is lost by another.
void Application::offer_unnamed_work() {
  const auto kept = deeds_.unsaved().kept_unnamed();
  if (kept.empty()) return;
  QuestionDesk::Asked open;
  open.question.title = "There are new scenes that were not saved";
  constexpr size_t most = 4;
  for (size_t i = kept.size() - std::min(kept.size(), most); i < kept.size(); ++i) {
    const UnsavedWork::Unnamed& one = kept[i];
    const std::string name = one.path.stem().string();
    open.question.lines.push_back(fmt::format("{}, of {}", name, one.kept.when));
    open.question.choices.push_back({"take_up_" + name, name});
    open.answers.push_back([this, one] { take_up(one.kept.text, one.path); });
  }
  open.question.lines.push_back("They are kept until they are saved. Go on with one of them?");
  open.question.choices.push_back({"later", "A new one"});
  open.answers.push_back([] {});
  question_.ask(std::move(open), ui_);
}

/// What an earlier run has left of this scene.
void Application::offer_kept_work() {
  if (scene_.wish.text) return;
  if (scene_.file.unnamed) return offer_unnamed_work();
  const auto kept = deeds_.unsaved().kept();
  if (!kept) return;
  question_.ask(
      {{"There are changes of this scene that were not saved",
        {fmt::format("They were made {}, and kept when the program ended.", kept->when)},
        {{"take_up", "Go on with them"}, {"throw_away", "Throw them away"}, {"later", "Later"}}},
       {[this, text = kept->text] { take_up(text); }, [this] { deeds_.unsaved().throw_away(); },
        [] {}}},
      ui_);
}

void Application::ask_to_quit() {
  // What was done just now counts, too.
  deeds_.finish(session(), options_.own_thread);
  if (!deeds_.unsaved().any() || question_.quits()) {
    quit_ = true;
    return;
  }
  question_.ask({{"What was changed in this scene is not saved",
                  {"It is kept until this scene is opened again, and offered then."},
                  {{"save", "Save ..."}, {"quit", "Quit"}, {"stay", "Stay"}}},
                 {[this] { save_scene(); }, [this] { quit_ = true; }, [] {}},
                 true},
                ui_);
}

void Application::change_parameter(const ChangeParameter& change) {
  choose({fmt::format("parameters.{}={}", change.name, change.value)}, "Change " + change.name);
}

/// The moments that deeds go back to are of this world. Where another comes in its place, the deeds
/// become choices of the scene's text: taken back one by one each opens the scene without it.
std::vector<ChoiceHistory::Step> Application::deeds_as_choices() {
  const auto deeds = deeds_.edits().deeds();
  std::vector<DeedEdits> edits;
  for (const auto& deed : deeds) edits.push_back(deed.second);
  const std::vector<std::string> texts = deeds_.unsaved().texts_after(
      session(), deeds_.edits().forgotten(), edits, options_.own_thread);
  std::vector<ChoiceHistory::Step> out;
  SceneWish wish = scene_.wish;
  for (size_t i = 0; i < texts.size(); ++i) {
    if (texts[i] == wish.text.value_or(scene_.file.text)) continue;  // nothing that a file can say
    SceneWish before = wish;
    wish.text = texts[i];
    out.push_back({ChoiceHistory::Way::anew, deeds[i].first, std::move(before), wish});
  }
  return out;
}

/// The scene anew with other numbers, and with what was changed here.
void Application::choose(const std::vector<std::string>& overrides, std::string what) {
  // What was done just now counts, too.
  deeds_.finish(session(), options_.own_thread);
  SceneWish before = scene_.wish;
  if (deeds_.unsaved().any()) before.text = deeds_.unsaved().text();
  SceneWish after = before;
  for (const std::string& one : overrides) {
    const std::string path = one.substr(0, one.find('=') + 1);
    std::erase_if(after.overrides, [&](const std::string& o) { return o.starts_with(path); });
    after.overrides.push_back(one);
  }
  open_for({ChoiceHistory::Step{ChoiceHistory::Way::anew, std::move(what), before, after},
            deeds_as_choices()},
           after);
}

/// A choice taken back, or made again; false when there is none.
bool Application::go_back_on(std::optional<ChoiceHistory::Step> choice) {
  if (!choice) return false;
  SceneWish wish = choice->wish();
  open_for({std::move(choice)}, std::move(wish));
  return true;
}

/// Shows what saving would write; asked for once more it writes that.
void Application::save_scene() {
  if (ui_.shows(PanelId::save) && scene_file_.preview()) return write_scene(ui_.save_file);
  ui_.hidden = false;
  ui_.shows(PanelId::save) = true;
  ui_.save_file.clear();
  ui_.save_fault.clear();
  scene_file_.prepare(session(), deeds_.edits().file_edits(), chosen_numbers(scene_),
                      options_.own_thread);
}

void Application::write_scene(const std::string& file) {
  if (const Status done = scene_file_.write(file); !done) {
    // The panel stays with what was typed: another name may do.
    ui_.shows(PanelId::save) = true;
    ui_.save_file = file;
    ui_.save_fault = done.error().text();
    return;
  }
  ui_.shows(PanelId::save) = false;
  ui_.save_fault.clear();
  scene_.file = scene_file_.file();
  deeds_.choices().forget();  // the scene without them is no file any more
  marks_.go_on_as(marked_scene());
  // From now on the scene is that file: opened anew it is what was saved.
  std::error_code none;
  scene_.wish.scene = std::filesystem::absolute(scene_.file.path, none).string();
  scene_.wish.text.reset();
  deeds_.unsaved().saved(scene_.file);
  ui_.toast(ToastKind::info, "Saved to " + file);
}

}  // namespace tumble
