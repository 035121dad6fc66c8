#include "viewer/ui/assertion_view.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace tumble {
namespace {

struct VerdictLook {
  const char* word;
  uint32_t colour;
};

VerdictLook look_of(const AssertionView& a) {
  switch (a.verdict) {
    case Verdict::holds:
      return {a.always ? "holds" : "passed", palette::green};
    case Verdict::fails:
      return {"failed", palette::red};
    case Verdict::waiting:
      break;
  }
  return {"waiting", palette::dim};
}

void draw_assertion(PanelContext& context, const AssertionView& a, size_t index) {
  ImGui::PushID(int(index));
  const VerdictLook look = look_of(a);
  const float width = ImGui::GetContentRegionAvail().x;
  const std::string& name = a.title.empty() ? a.text : a.title;
  const float word = ImGui::CalcTextSize(look.word).x;
  ImGui::BeginGroup();
  ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + width - word - 12);
  ImGui::TextUnformatted(name.c_str());
  ImGui::PopTextWrapPos();
  ImGui::SameLine(width - word);
  ImGui::PushStyleColor(ImGuiCol_Text, look.colour);
  ImGui::TextUnformatted(look.word);
  ImGui::PopStyleColor();
  small_text(context,
             a.verdict == Verdict::fails ? fmt::format("after {:.2f} s", a.decided) : when_text(a),
             palette::dim);
  ImGui::EndGroup();
  context.host.mark(fmt::format("assertions.{}.{}", index, look.word));
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("%s%s%s", a.text.c_str(), a.values.empty() ? "" : "\n", a.values.c_str());
  ImGui::PopID();
}

}  // namespace

void draw_assertions_panel(PanelContext& context) {
  const std::vector<AssertionView>& all = context.model.assertions;
  if (all.empty()) return note("The scene makes no assertions.");
  for (size_t i = 0; i < all.size(); ++i) draw_assertion(context, all[i], i);
}

}  // namespace tumble
