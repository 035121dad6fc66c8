#include "engine/scene/outline/outline_edits.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

using How = EditDescription::How;

constexpr float remove_width = 24;  ///< of the button behind each value
constexpr float move_width = 20;    ///< of each that moves an item of a list
constexpr float key_share = 0.42f;  ///< of a line, that the key takes

std::string description_mark(const Member& what) {
  return "description." +
         (what.name.starts_with('[') ? what.name.substr(1, what.name.size() - 2) : what.name);
}

ScenePath below(const ScenePath& path, const Member& what) {
  if (!what.name.starts_with('[')) return path / what.name;
  return at_index(path, size_t(std::stoul(what.name.substr(1))));
}

/// A key as people write it; names of things stay as they are.
std::string key_label(const Outline& outline, const Member& what) {
  return outline.what.kind == MemberKind::object ? label_of(what.name) : what.name;
}

/// Something with parts in one line: "sphere: radius 0.5 m, position 0, 1, 0 m".
std::string words_of_parts(const OutlineKey& key) {
  std::string out;
  for (const ToldValue& told : key.told) {
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", label_of(told.key),
                       told.choice ? words_of(told.value) : told.value);
    if (!told.unit.empty()) out += " " + unit_words(told.unit);
  }
  const bool object = key.what.kind == MemberKind::object;
  const std::string kind = object ? words_of(key.summary) : key.summary;
  return kind.empty() ? out : out.empty() ? kind : kind + ": " + out;
}

/// What the declaration says, with the range.
std::string help_of(const Member& what) {
  const std::string range = what.range();
  return range.empty() ? what.doc : what.doc.empty() ? range : what.doc + "; " + range;
}

/// Whether all of a value can be seen in a field of this width.
bool fits(const std::string& value, float width) {
  return ImGui::CalcTextSize(value.c_str()).x <= width - 2 * ImGui::GetStyle().FramePadding.x;
}

/// Long text in lines of about this many letters, broken at blanks.
std::string in_lines(std::string text) {
  constexpr size_t longest = 60;
  for (size_t line = 0; text.size() - line > longest;) {
    size_t blank = text.rfind(' ', line + longest);
    if (blank == std::string::npos || blank <= line) blank = text.find(' ', line + longest);
    if (blank == std::string::npos) break;
    text[blank] = '\n';
    line = blank + 1;
  }
  return text;
}

/// The fields of one place of the scene.
class DescriptionForm {
 public:
  DescriptionForm(PanelContext& context, const Outline& outline)
      : context_(context), outline_(outline) {}

  void row(const OutlineKey& key);
  void addition();
  void add_named();
  void name();

 private:
  void ask(const Member& what, How how, std::string value = {}) {
    context_.ask(EditDescription{below(outline_.path, what), how, std::move(value)});
  }
  void set(const ScenePath& path, const Member& what, std::string_view typed);
  void label(const OutlineKey& key);
  /// Share of a line that the keys take: items of lists have short ones.
  float label_share() const;
  void hint(const Member& what, const std::string& value, float width);
  void scalar(const OutlineKey& key, float width);
  void numbers(const OutlineKey& key, float width);
  void truth(const OutlineKey& key);
  void choice(const OutlineKey& key, float width);
  void names(const OutlineKey& key, const std::vector<std::string>& all);
  void swatch(const OutlineKey& key);
  void parts(const OutlineKey& key);
  void into(const OutlineKey& key);
  void remove(const OutlineKey& key);
  void move(const OutlineKey& key);
  /// Whether its items can be put in another order.
  bool ordered() const {
    return outline_.what.kind != MemberKind::object && outline_.what.kind != MemberKind::map &&
           outline_.keys.size() > 1;
  }
  /// Of the buttons behind each value.
  float tail_width() const { return remove_width + (ordered() ? 2 * move_width : 0); }
  void declare(const OutlineKey& key);

  PanelContext& context_;
  const Outline& outline_;
};

void DescriptionForm::set(const ScenePath& path, const Member& what, std::string_view typed) {
  auto value = typed_value(what, typed);
  if (!value) return context_.state.toast(ToastKind::warning, value.error().message);
  context_.ask(EditDescription{path, How::set, *std::move(value)});
}

float DescriptionForm::label_share() const {
  const bool counted = !outline_.keys.empty() && outline_.keys[0].what.name.starts_with('[');
  if (!counted) return key_share;
  const std::string longest = outline_.keys.back().what.name + "  ";
  return std::min(key_share,
                  ImGui::CalcTextSize(longest.c_str()).x / ImGui::GetContentRegionAvail().x);
}

void DescriptionForm::label(const OutlineKey& key) {
  std::string text = key_label(outline_, key.what);
  if (!key.what.unit.empty()) text += fmt::format(" [{}]", unit_words(key.what.unit));
  ImGui::AlignTextToFramePadding();
  const float width = ImGui::GetContentRegionAvail().x, x = ImGui::GetCursorPosX();
  ImGui::PushStyleColor(ImGuiCol_Text, palette::dim);
  const float share = label_share();
  ImGui::TextUnformatted(shortened(text, width * share - 6).c_str());
  ImGui::PopStyleColor();
  ImGui::SameLine(x + width * share);
}

/// Over a field: what it means, and all of its value where the field is too short for that.
void DescriptionForm::hint(const Member& what, const std::string& value, float width) {
  std::string words = help_of(what);
  if (!fits(value, width)) words = in_lines(value) + (words.empty() ? "" : "\n" + words);
  tooltip_with_key(context_, words, {});
}

void DescriptionForm::scalar(const OutlineKey& key, float width) {
  const std::string mark = description_mark(key.what), now = shown_value(key.text);
  if (const auto text = typed_text(context_, mark, now, width))
    set(below(outline_.path, key.what), key.what, *text);
  hint(key.what, now, width);
}

/// Numbers beside each other, each of which may be an expression.
void DescriptionForm::numbers(const OutlineKey& key, float width) {
  FaultList faults;
  const auto now = parse_json(key.text, "", faults);
  if (!now || !now->is(JsonNode::Kind::array) || now->items.size() != key.what.size)
    return scalar(key, width);
  Member number = key.what;
  number.kind = MemberKind::number;
  std::vector<std::string> values;
  for (const JsonNode& item : now->items) values.push_back(shown_value(one_line(item)));
  const auto each_of = [&](float all) {
    return (all - 3 * float(values.size() - 1)) / float(values.size());
  };
  // Beside their name there is room for short ones only; longer ones get a line of their own.
  if (!std::ranges::all_of(values, [&](const auto& v) { return fits(v, each_of(width)); })) {
    ImGui::NewLine();
    width = ImGui::GetContentRegionAvail().x - tail_width() - 2;
  }
  for (size_t k = 0; k < values.size(); ++k) {
    if (k > 0) ImGui::SameLine(0, 3);
    const std::string mark = fmt::format("{}.{}", description_mark(key.what), "xyzw"[k]);
    if (const auto text = typed_text(context_, mark, values[k], each_of(width)))
      set(at_index(below(outline_.path, key.what), k), number, *text);
    hint(key.what, values[k], each_of(width));
  }
}

void DescriptionForm::truth(const OutlineKey& key) {
  bool on = key.text == "true";
  if (toggle(context_, description_mark(key.what), key_label(outline_, key.what).c_str(), on))
    ask(key.what, How::set, on ? "true" : "false");
  tooltip_with_key(context_, key.what.doc, {});
}

void DescriptionForm::choice(const OutlineKey& key, float width) {
  const std::string mark = description_mark(key.what), now = shown_value(key.text);
  ImGui::SetNextItemWidth(width);
  if (ImGui::BeginCombo(("##" + mark).c_str(), words_of(now).c_str())) {
    for (const std::string& name : key.what.names) {
      if (ImGui::Selectable(words_of(name).c_str(), name == now) && name != now)
        set(below(outline_.path, key.what), key.what, name);
      context_.host.mark(mark + "." + name);
    }
    ImGui::EndCombo();
  }
  context_.host.mark(mark);
  tooltip_with_key(context_, key.what.doc, {});
}

/// What a text may be, to be chosen instead of typed.
void DescriptionForm::names(const OutlineKey& key, const std::vector<std::string>& all) {
  if (const auto chosen = name_list(context_, description_mark(key.what), all))
    set(below(outline_.path, key.what), key.what, *chosen);
}

/// The colour itself; pulled, it is given when it is let go.
void DescriptionForm::swatch(const OutlineKey& key) {
  const std::string mark = description_mark(key.what) + ".swatch";
  TypedValue& typing = context_.state.typing;
  const std::string said = typing.field == mark ? typing.text : shown_value(key.text);
  const Colour colour = colour_from_text(said).value_or(Colour{});
  float rgb[3] = {float(colour.r), float(colour.g), float(colour.b)};
  if (ImGui::ColorEdit3(("##" + mark).c_str(), rgb,
                        ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoLabel))
    typing = {mark, fmt::format("#{:02x}{:02x}{:02x}", int(rgb[0] * 255 + 0.5f),
                                int(rgb[1] * 255 + 0.5f), int(rgb[2] * 255 + 0.5f))};
  context_.host.mark(mark);
  if (typing.field == mark && !ImGui::IsAnyItemActive())
    set(below(outline_.path, key.what), key.what, std::exchange(typing, {}).text);
  ImGui::SameLine(0, 4);
}

/// Something with keys of its own: a line that leads to it.
void DescriptionForm::parts(const OutlineKey& key) {
  const std::string mark = description_mark(key.what);
  const float width = ImGui::GetContentRegionAvail().x - tail_width();
  const ImVec2 at = ImGui::GetCursorPos();
  if (ImGui::Selectable(("##" + mark).c_str(), false, 0, ImVec2(width, ImGui::GetFrameHeight())))
    context_.state.described = below(outline_.path, key.what);
  context_.host.mark(mark);
  const std::string words = words_of_parts(key);
  const float room = width - ImGui::GetContentRegionAvail().x * label_share() - 4;
  hint(key.what, words, room);
  const ImVec2 next = ImGui::GetCursorPos();
  ImGui::SetCursorPos(at);
  label(key);
  ImGui::TextUnformatted(shortened(words, room).c_str());
  ImGui::SameLine(at.x + width);
  remove(key);
  ImGui::SetCursorPos(next);
}

/// Behind what is written bare: leads to its name and its other keys.
void DescriptionForm::into(const OutlineKey& key) {
  ImGui::SameLine(0, 2);
  ImGui::PushID(description_mark(key.what).c_str());
  if (ImGui::ArrowButton("more", ImGuiDir_Right))
    context_.state.described = below(outline_.path, key.what);
  ImGui::PopID();
  context_.host.mark(description_mark(key.what) + ".more");
  tooltip_with_key(context_, "its name and what else can be said of it", {});
}

/// Up and down among the items of a list.
void DescriptionForm::move(const OutlineKey& key) {
  const std::string mark = description_mark(key.what);
  const std::pair<const char*, bool> ways[] = {{"up", &key != &outline_.keys.front()},
                                               {"down", &key != &outline_.keys.back()}};
  ImGui::PushID(mark.c_str());
  ImGui::PushStyleColor(ImGuiCol_Button, 0);
  for (const auto& [way, possible] : ways) {
    const bool up = way == ways[0].first;
    const ImVec2 next(ImGui::GetCursorPosX() + move_width, ImGui::GetCursorPosY());
    ImGui::BeginDisabled(!possible);
    if (ImGui::ArrowButton(way, up ? ImGuiDir_Up : ImGuiDir_Down))
      ask(key.what, How::move, up ? "-1" : "1");
    ImGui::EndDisabled();
    context_.host.mark(fmt::format("{}.{}", mark, way));
    tooltip_with_key(context_, up ? "before the one above it" : "behind the one below it", {});
    ImGui::SameLine();
    ImGui::SetCursorPos(next);
  }
  ImGui::PopStyleColor();
  ImGui::PopID();
}

void DescriptionForm::remove(const OutlineKey& key) {
  if (ordered()) move(key);
  const bool stays = key.what.required && outline_.what.kind == MemberKind::object;
  if (stays) return ImGui::Dummy(ImVec2(remove_width, 0));
  ImGui::PushStyleColor(ImGuiCol_Button, 0);
  ImGui::PushID(description_mark(key.what).c_str());
  if (ImGui::Button("×", ImVec2(remove_width - 4, 0))) ask(key.what, How::remove);
  ImGui::PopID();
  ImGui::PopStyleColor();
  context_.host.mark(description_mark(key.what) + ".remove");
  tooltip_with_key(context_,
                   key.what.fallback.empty() ? "leave it out"
                                             : "leave it out: then " + key.what.fallback + " holds",
                   {});
}

void DescriptionForm::declare(const OutlineKey& key) {
  ImGui::SameLine(0, 2);
  ImGui::PushID(description_mark(key.what).c_str());
  if (ImGui::Button("$", ImVec2(remove_width - 4, 0))) ask(key.what, How::declare);
  ImGui::PopID();
  context_.host.mark(description_mark(key.what) + ".declare");
  tooltip_with_key(context_, "a number of the scene from now on, with a slider in Settings", {});
}

void DescriptionForm::row(const OutlineKey& key) {
  const Member& what = key.what;
  if (what.has_parts() && (what.kind != MemberKind::object || key.text.starts_with('{')))
    return parts(key);
  float width = ImGui::GetContentRegionAvail().x * (1 - label_share()) - tail_width() - 2;
  if (what.kind == MemberKind::truth) {
    const float x = ImGui::GetCursorPosX(), all = ImGui::GetContentRegionAvail().x;
    truth(key);
    ImGui::SameLine(x + all - tail_width());
    return remove(key);
  }
  label(key);
  tooltip_with_key(context_, help_of(key.what), {});
  const bool bare = what.kind == MemberKind::object;
  if (bare) width -= ImGui::GetFrameHeight() + 2;
  const std::vector<std::string> all =
      what.kind == MemberKind::colour ? palette_names() : outline_.names_of(what.refers_to);
  const bool number = what.is_number() && !key.text.starts_with('"') &&
                      !key.text.starts_with('[') &&
                      (outline_.path.empty() || outline_.path[0].key != "parameters");
  const float arrow = ImGui::GetFrameHeight();
  if (what.kind == MemberKind::choice) {
    choice(key, width);
  } else if (what.kind == MemberKind::vector) {
    numbers(key, width);
  } else if (what.kind == MemberKind::colour) {
    swatch(key);
    scalar(key, width - 2 * arrow - 4);
    names(key, all);
  } else if (!all.empty()) {
    scalar(key, width - arrow);
    names(key, all);
  } else if (number) {
    scalar(key, width - remove_width);
    declare(key);
  } else {
    scalar(key, width);
  }
  if (bare) into(key);
  ImGui::SameLine(0, 2);
  remove(key);
}

/// One more of a list whose names another file has.
void DescriptionForm::add_named() {
  ImGui::SetNextItemWidth(-1);
  if (ImGui::BeginCombo("##add", "add ...")) {
    for (const std::string& name : outline_.own_names) {
      if (ImGui::Selectable(name.c_str()))
        context_.ask(EditDescription{outline_.path / name, How::add, {}});
      context_.host.mark("description.add." + name);
    }
    ImGui::EndCombo();
  }
  context_.host.mark("description.add");
  tooltip_with_key(context_, outline_.what.doc, {});
}

/// What is not there and could be, with what it does.
void DescriptionForm::addition() {
  if (outline_.what.kind != MemberKind::object) {
    const bool named = outline_.what.kind == MemberKind::map;
    if (named && !outline_.own_names.empty()) return add_named();
    if (ImGui::Button("Add one")) {
      const ScenePath path =
          named ? outline_.path / "" : at_index(outline_.path, outline_.keys.size());
      context_.ask(EditDescription{path, How::add, {}});
    }
    context_.host.mark("description.add");
    return tooltip_with_key(context_, outline_.what.doc, {});
  }
  const bool any = std::ranges::any_of(outline_.keys, [](const auto& k) { return !k.present(); });
  if (!any) return;
  ImGui::SetNextItemWidth(-1);
  ImGui::SetNextWindowSizeConstraints(ImVec2(0, 0), ImVec2(10000, 460));
  if (ImGui::BeginCombo("##add", "add ...")) {
    for (const OutlineKey& key : outline_.keys) {
      if (key.present()) continue;
      std::string label = label_of(key.what.name);
      if (!key.what.unit.empty()) label += fmt::format(" [{}]", unit_words(key.what.unit));
      if (ImGui::Selectable(label.c_str())) ask(key.what, How::add);
      context_.host.mark("description.add." + key.what.name);
      tooltip_with_key(context_, help_of(key.what), {});
      if (!key.what.doc.empty()) {
        ImGui::Indent(10);
        ImGui::PushFont(context_.host.fonts().small);
        wrapped(key.what.doc, palette::faint);
        ImGui::PopFont();
        ImGui::Unindent(10);
      }
    }
    ImGui::EndCombo();
  }
  context_.host.mark("description.add");
}

/// What the scene calls it, here and wherever it is named.
void DescriptionForm::name() {
  ImGui::AlignTextToFramePadding();
  small_text(context_, "name", palette::dim);
  ImGui::SameLine(64);
  const auto& all = outline_.own_names;
  const float arrow = all.empty() ? 0 : ImGui::GetFrameHeight();
  if (const auto text = typed_text(context_, "description.name", outline_.path.back().key,
                                   ImGui::GetContentRegionAvail().x - arrow))
    context_.ask(EditDescription{outline_.path, How::rename, *text});
  tooltip_with_key(context_, "what the scene calls it, wherever it is named", {});
  if (all.empty()) return;
  if (const auto chosen = name_list(context_, "description.name", all))
    context_.ask(EditDescription{outline_.path, How::rename, *chosen});
}

/// From the scene down to what is shown, each step a button that leads back to it.
void draw_way(PanelContext& context, const Outline& outline) {
  ScenePath path;
  const float right = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
  for (size_t depth = 0; depth <= outline.path.size(); ++depth) {
    std::string text = "Scene";
    if (depth > 0) {
      const PathStep& step = outline.path[depth - 1];
      path.push_back(step);
      text = step.index ? fmt::format("[{}]", *step.index) : step.key;
      const float width = ImGui::CalcTextSize(text.c_str()).x + 14;
      ImGui::SameLine(0, 2);
      if (ImGui::GetCursorPosX() + width > right) ImGui::NewLine();
    }
    ImGui::PushID(int(depth));
    if (ImGui::SmallButton(text.c_str())) context.state.described = path;
    ImGui::PopID();
    context.host.mark(fmt::format("description.way.{}", depth));
  }
}

/// What has been changed and does not make a scene yet.
void draw_draft(PanelContext& context, const DescriptionView& view) {
  if (view.draft.empty()) return;
  if (view.opening) return note("The scene is being opened with this change ...");
  wrapped("Not a scene yet: the world is as before until this is mended.", palette::yellow);
  for (const std::string& fault : view.faults) wrapped(fault, palette::red);
  context.host.mark("description.faults");
  if (ImGui::Button("Take back")) context.ask(LeaveDraft{true});
  context.host.mark("description.draft.undo");
  tooltip_with_key(context, view.draft.back(), {});
  ImGui::SameLine();
  if (ImGui::Button("Throw all of it away")) context.ask(LeaveDraft{});
  context.host.mark("description.draft.leave");
  ImGui::Dummy(ImVec2(0, 4));
}

}  // namespace

void draw_description_panel(PanelContext& context) {
  const DescriptionView* view = context.model.description;
  if (!view || !view->outline)
    return note("What is shown has no file of its own whose values could be changed.");
  const Outline& outline = *view->outline;
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(8, 3));
  draw_way(context, outline);
  ImGui::Dummy(ImVec2(0, 1));
  draw_draft(context, *view);
  if (!outline.what.doc.empty()) note(outline.what.doc);
  DescriptionForm form(context, outline);
  ImGui::PushID(text_of(outline.path).c_str());
  if (outline.named) form.name();
  for (const OutlineKey& key : outline.keys)
    if (key.present()) form.row(key);
  ImGui::Dummy(ImVec2(0, 4));
  form.addition();
  ImGui::PopID();
  ImGui::PopStyleVar();
}

std::string undo_step_of(const EditDescription& edit) {
  const ScenePath around = outer_path(edit.path);
  const std::string last = text_of({edit.path.begin() + ptrdiff_t(around.size()), edit.path.end()});
  const std::string of = around.empty() ? std::string() : " of " + text_of(around);
  switch (edit.how) {
    case How::set:
      return fmt::format("Change {}{}", last, of);
    case How::add:
      return fmt::format("Add {}{}", last, of);
    case How::remove:
      return fmt::format("Leave out {}{}", last, of);
    case How::move:
      return fmt::format("Move {}{} {}", last, of, edit.value.starts_with('-') ? "up" : "down");
    case How::rename:
      return fmt::format("Rename {} to {}", last, edit.value);
    case How::declare:
      return fmt::format("Declare {}{}", last, of);
  }
  return {};
}

}  // namespace tumble
