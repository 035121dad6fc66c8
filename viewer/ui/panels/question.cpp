#include "viewer/ui/widgets.hpp"

#include <imgui.h>

namespace tumble {

void draw_question_panel(PanelContext& context) {
  const Question* question = context.model.question;
  if (!question) {
    context.state.shows(PanelId::question) = false;
    return;
  }
  ImGui::PushFont(context.host.fonts().strong);
  ImGui::TextWrapped("%s", question->title.c_str());
  ImGui::PopFont();
  for (const std::string& line : question->lines) note(line);
  ImGui::Dummy(ImVec2(0, 4));
  for (size_t i = 0; i < question->choices.size(); ++i) {
    if (i) ImGui::SameLine();
    if (ImGui::Button(question->choices[i].text.c_str())) context.ask(AnswerQuestion{i});
    context.host.mark("question." + question->choices[i].name);
  }
}

}  // namespace tumble
