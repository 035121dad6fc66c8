#include "viewer/ui/lesson_view.hpp"
#include "viewer/ui/parameter_widgets.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

namespace tumble {
namespace {

/// Draws a dot for each page; a click shows that page.
void draw_progress(PanelContext& context, const LessonView& lesson) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const size_t count = lesson.steps.size();
  const float width = ImGui::GetContentRegionAvail().x;
  const float gap = std::min(20.0f, (width - 90) / float(std::max<size_t>(count, 1)));
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (size_t i = 0; i < count; ++i) {
    const LessonStepView& step = lesson.steps[i];
    const ImVec2 centre(at.x + 7 + gap * float(i), at.y + 9);
    const bool now = i == lesson.step;
    ImGui::SetCursorScreenPos(ImVec2(centre.x - 0.5f * gap, at.y));
    ImGui::PushID(int(i));
    if (ImGui::InvisibleButton("##page", ImVec2(gap, 18))) context.ask(TurnLessonPage{i});
    context.host.mark(fmt::format("lesson.page.{}", i));
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", step.title.c_str());
    ImGui::PopID();
    const uint32_t colour = step.done() ? palette::green : now ? palette::accent : palette::faint;
    if (step.done() || now)
      list.AddCircleFilled(centre, now ? 6.0f : 4.5f, colour);
    else
      list.AddCircle(centre, 4.5f, colour);
    if (step.question && !step.done()) list.AddCircleFilled(centre, 2, palette::text);
  }
  const std::string text = fmt::format("{} of {}", lesson.step + 1, count);
  list.AddText({at.x + width - ImGui::CalcTextSize(text.c_str()).x, at.y}, palette::dim,
               text.c_str());
  ImGui::SetCursorScreenPos(ImVec2(at.x, at.y + 24));
}

void draw_choices(PanelContext& context, const LessonStepView& step) {
  if (step.choose.empty()) return;
  for (const std::string& choice : step.choose) {
    const size_t is = choice.find('=');
    std::string name = choice.substr(0, is), value = choice.substr(is + 1);
    for (const char* front : {"settings.", "parameters.", "event.", "realtime."})
      if (name.starts_with(front)) name.erase(0, std::string_view(front).size());
    std::erase(value, '"');
    value_row(label_of(name), words_of(value), step.chosen ? palette::green : palette::accent);
  }
  if (step.chosen) {
    small_text(context, "This is what is set now.", palette::dim);
  } else if (ImGui::Button("Set this, from the start")) {
    context.ask(TakeLessonChoice{});
  }
  context.host.mark(step.chosen ? "lesson.chosen" : "lesson.choose");
  ImGui::Dummy(ImVec2(0, 2));
}

void draw_verdict(const LessonQuestionView& q) {
  switch (q.verdict) {
    case AnswerVerdict::none:
      return;
    case AnswerVerdict::unclear:
      return wrapped("This is not a number. Type one, such as 0.5 or 1e-3.", palette::yellow);
    case AnswerVerdict::waiting:
      return wrapped(q.at ? fmt::format("Noted. Let the world run to {:g} s: it decides.", *q.at)
                          : "Noted. The world cannot say it at this moment.",
                     palette::blue);
    case AnswerVerdict::wrong:
      return wrapped("No. Look again, or take the hint.", palette::red);
    case AnswerVerdict::right:
      break;
  }
  std::string text = fmt::format("Right: {:.4g} {}.", *q.right, q.unit);
  if (q.unit.empty()) text = fmt::format("Right: {:.4g}.", *q.right);
  if (q.measured) text += fmt::format(" The world says {:.6g}.", *q.measured);
  wrapped(text, palette::green);
  if (!q.why.empty()) wrapped(q.why, palette::text);
}

void draw_question(PanelContext& context, const LessonStepView& step) {
  if (!step.question) return;
  const LessonQuestionView& q = *step.question;
  UiState& state = context.state;
  ImGui::Separator();
  ImGui::PushFont(context.host.fonts().strong);
  wrapped(q.ask, palette::text);
  ImGui::PopFont();
  const float unit_width = q.unit.empty() ? 0 : ImGui::CalcTextSize(q.unit.c_str()).x + 10;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - 74 - unit_width);
  const bool entered =
      ImGui::InputText("##answer", &state.lesson_typed, ImGuiInputTextFlags_EnterReturnsTrue);
  context.host.mark("lesson.answer");
  if (!q.unit.empty()) {
    ImGui::SameLine();
    ImGui::TextUnformatted(q.unit.c_str());
  }
  ImGui::SameLine();
  const bool pressed = ImGui::Button("Check", ImVec2(ImGui::GetContentRegionAvail().x, 0));
  context.host.mark("lesson.check");
  if (entered || pressed) {
    context.ask(AnswerLesson{state.lesson_typed});
    context.host.give_up_keys();
  }
  draw_verdict(q);
  if (q.verdict == AnswerVerdict::right || q.hint.empty()) return;
  if (state.lesson_hint) {
    wrapped("Hint: " + q.hint, palette::dim);
  } else if (ImGui::SmallButton("Hint")) {
    state.lesson_hint = true;
  }
  context.host.mark("lesson.hint");
}

void draw_turning(PanelContext& context, const LessonView& lesson) {
  const float width = 0.5f * (ImGui::GetContentRegionAvail().x - 8);
  const bool first = lesson.step == 0, last = lesson.step + 1 >= lesson.steps.size();
  const auto button = [&](const char* text, const char* mark, bool off, size_t to) {
    if (off) ImGui::BeginDisabled();
    if (ImGui::Button(text, ImVec2(width, 30))) context.ask(TurnLessonPage{to});
    if (off) ImGui::EndDisabled();
    context.host.mark(mark);
  };
  button("Back", "lesson.back", first, lesson.step - (first ? 0 : 1));
  ImGui::SameLine();
  const bool done = lesson.steps[lesson.step].done();
  ImGui::PushStyleColor(ImGuiCol_Button, done && !last ? palette::accent_soft : palette::raised);
  button(last ? "The end" : "Next", "lesson.next", last, lesson.step + 1);
  ImGui::PopStyleColor();
  if (!last) return;
  small_text(context,
             lesson.questions() == 0 ? "That was the lesson."
                                     : fmt::format("{} of {} questions answered.",
                                                   lesson.answered(), lesson.questions()),
             lesson.answered() == lesson.questions() ? palette::green : palette::dim);
}

}  // namespace

void draw_lesson_panel(PanelContext& context) {
  const LessonView* lesson = context.model.lesson ? &*context.model.lesson : nullptr;
  if (!lesson) return note("This scene teaches nothing. Scenes that do are called lesson_...");
  draw_progress(context, *lesson);
  const LessonStepView& step = lesson->steps[lesson->step];
  ImGui::PushFont(context.host.fonts().strong);
  wrapped(step.title, palette::accent);
  ImGui::PopFont();
  for (const std::string& paragraph : step.text) {
    wrapped(paragraph, palette::text);
    ImGui::Dummy(ImVec2(0, 1));
  }
  draw_choices(context, step);
  draw_question(context, step);
}

void draw_lesson_footer(PanelContext& context) {
  if (context.model.lesson) draw_turning(context, *context.model.lesson);
}

}  // namespace tumble
