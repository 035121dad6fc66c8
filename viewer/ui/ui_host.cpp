#include "viewer/ui/ui_host.hpp"

#include "viewer/ui/style.hpp"

#include <algorithm>
#include <cfloat>
#include <utility>

#include <imgui.h>

namespace tumble {
namespace {

void map_keys(ImGuiIO& io) {
  const std::pair<ImGuiKey_, Key> keys[] = {{ImGuiKey_Tab, Key::tab},
                                            {ImGuiKey_LeftArrow, Key::left},
                                            {ImGuiKey_RightArrow, Key::right},
                                            {ImGuiKey_UpArrow, Key::up},
                                            {ImGuiKey_DownArrow, Key::down},
                                            {ImGuiKey_PageUp, Key::page_up},
                                            {ImGuiKey_PageDown, Key::page_down},
                                            {ImGuiKey_Home, Key::home},
                                            {ImGuiKey_End, Key::end},
                                            {ImGuiKey_Insert, Key::insert},
                                            {ImGuiKey_Delete, Key::del},
                                            {ImGuiKey_Backspace, Key::backspace},
                                            {ImGuiKey_Space, Key::space},
                                            {ImGuiKey_Enter, Key::enter},
                                            {ImGuiKey_Escape, Key::escape},
                                            {ImGuiKey_A, letter_key('A')},
                                            {ImGuiKey_C, letter_key('C')},
                                            {ImGuiKey_V, letter_key('V')},
                                            {ImGuiKey_X, letter_key('X')},
                                            {ImGuiKey_Y, letter_key('Y')},
                                            {ImGuiKey_Z, letter_key('Z')}};
  for (const auto& [imgui, ours] : keys) io.KeyMap[imgui] = int(ours);
}

UiDraw convert(const ImDrawCmd& command, uint32_t index_base, uint32_t vertex_base) {
  UiDraw draw;
  draw.first_index = index_base + command.IdxOffset;
  draw.index_count = command.ElemCount;
  draw.base_vertex = vertex_base + command.VtxOffset;
  draw.clip = {command.ClipRect.x, command.ClipRect.y, command.ClipRect.z, command.ClipRect.w};
  draw.texture = UiTextureId(reinterpret_cast<uintptr_t>(command.GetTexID()));
  return draw;
}

}  // namespace

UiHost::UiHost() : font_atlas_(std::make_unique<ImFontAtlas>()) {
  IMGUI_CHECKVERSION();
  context_ = ImGui::CreateContext(font_atlas_.get());
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // we lay out the panels; ImGui must not save its own settings
  io.LogFilename = nullptr;
  io.BackendFlags |= ImGuiBackendFlags_RendererHasVtxOffset;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  // A click on a number begins editing it; otherwise the keys typed next would trigger shortcuts.
  io.ConfigDragClickToInputText = true;
  map_keys(io);
  apply_ui_style();
  set_scale(1);
}

UiHost::~UiHost() {
  ImGui::DestroyContext(context_);
}

bool UiHost::set_scale(double scale) {
  scale = std::clamp(scale, 0.5, 8.0);
  if (scale == scale_) return false;
  ImGui::SetCurrentContext(context_);
  scale_ = scale;
  fonts_ = bake_ui_fonts(*font_atlas_, scale);
  ImGuiIO& io = ImGui::GetIO();
  io.FontGlobalScale = float(1 / scale);
  io.FontDefault = fonts_.body;
  io.DisplayFramebufferScale = ImVec2(float(scale), float(scale));
  return true;
}

void UiHost::set_theme(Theme theme) {
  if (theme == theme_) return;
  theme_ = theme;
  ImGui::SetCurrentContext(context_);
  apply_ui_style(theme);
}

FontAtlas UiHost::atlas() {
  return renderer_atlas(*font_atlas_, fonts_);
}

void UiHost::set_clipboard(Clipboard clipboard) {
  ImGui::SetCurrentContext(context_);
  clipboard_ = std::move(clipboard);
  ImGuiIO& io = ImGui::GetIO();
  io.ClipboardUserData = this;
  io.GetClipboardTextFn = [](void* self) {
    auto& host = *static_cast<UiHost*>(self);
    host.clipboard_text_ = host.clipboard_.get ? host.clipboard_.get() : std::string();
    return host.clipboard_text_.c_str();
  };
  io.SetClipboardTextFn = [](void* self, const char* text) {
    auto& host = *static_cast<UiHost*>(self);
    if (host.clipboard_.set) host.clipboard_.set(text);
  };
}

void UiHost::feed(std::span<const InputEvent> events, bool pointer_elsewhere) {
  ImGuiIO& io = ImGui::GetIO();
  for (const InputEvent& e : std::exchange(late_releases_, {})) held_.apply(e);
  bool key_down_now[size_t(Key::count)] = {}, button_down_now[3] = {};
  io.MouseWheel = io.MouseWheelH = 0;
  for (const InputEvent& e : events) {
    if (const auto* k = std::get_if<KeyPressed>(&e); k && k->key < Key::count) {
      bool& down_now = key_down_now[size_t(k->key)];
      if (!k->down && down_now) {
        late_releases_.push_back(e);
        continue;
      }
      down_now = down_now || k->down;
    } else if (const auto* p = std::get_if<PointerPressed>(&e)) {
      bool& down_now = button_down_now[size_t(p->button)];
      if (!p->down && down_now) {
        late_releases_.push_back(e);
        continue;
      }
      down_now = down_now || p->down;
    } else if (const auto* w = std::get_if<WheelTurned>(&e)) {
      io.MouseWheel += float(w->dy);
      io.MouseWheelH += float(w->dx);
    } else if (const auto* t = std::get_if<TextTyped>(&e)) {
      io.AddInputCharacter(t->codepoint);
    }
    held_.apply(e);
  }
  for (size_t i = 0; i < size_t(Key::count); ++i) io.KeysDown[i] = held_.keys[i];
  io.KeyCtrl = held_.key(Key::control);
  io.KeyShift = held_.key(Key::shift);
  io.KeyAlt = held_.key(Key::alt);
  io.KeySuper = held_.key(Key::super);
  for (size_t i = 0; i < 3; ++i) io.MouseDown[i] = held_.buttons[i] && !pointer_elsewhere;
  io.MousePos = pointer_elsewhere || held_.x < -1e5 ? ImVec2(-FLT_MAX, -FLT_MAX)
                                                    : ImVec2(float(held_.x), float(held_.y));
  if (pointer_elsewhere) io.MouseWheel = io.MouseWheelH = 0;
}

void UiHost::begin(double width, double height, double dt, std::span<const InputEvent> events,
                   bool pointer_elsewhere) {
  ImGui::SetCurrentContext(context_);
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = ImVec2(float(width), float(height));
  io.DeltaTime = float(std::max(dt, 1e-5));
  feed(events, pointer_elsewhere);
  marks_.clear();
  keys_given_up_ = std::max(keys_given_up_ - 1, 0);
  ImGui::NewFrame();
}

bool UiHost::wants_pointer() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantCaptureMouse;
}
bool UiHost::wants_keys() const {
  ImGui::SetCurrentContext(context_);
  return ImGui::GetIO().WantTextInput && keys_given_up_ == 0;
}
void UiHost::give_up_keys() {
  keys_given_up_ = 2;
}

PointerLook UiHost::pointer_look() const {
  ImGui::SetCurrentContext(context_);
  switch (ImGui::GetMouseCursor()) {
    case ImGuiMouseCursor_TextInput:
      return PointerLook::text;
    case ImGuiMouseCursor_Hand:
      return PointerLook::hand;
    case ImGuiMouseCursor_ResizeEW:
      return PointerLook::resize_x;
    case ImGuiMouseCursor_ResizeNS:
      return PointerLook::resize_y;
    default:
      return PointerLook::arrow;
  }
}

void UiHost::mark(std::string_view name) {
  const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
  // Items that a scroll area hides cannot be clicked.
  if (!ImGui::IsItemVisible()) return;
  mark(name, {a.x, a.y, b.x - a.x, b.y - a.y});
}

void UiHost::mark(std::string_view name, const UiRect& rect) {
  marks_.insert_or_assign(std::string(name), rect);
}

void UiHost::end(UiDrawList& out) {
  ImGui::Render();
  shown_.swap(marks_);
  const ImDrawData& data = *ImGui::GetDrawData();
  out.width = data.DisplaySize.x;
  out.height = data.DisplaySize.y;
  out.vertices.clear();
  out.indices.clear();
  out.draws.clear();
  for (int n = 0; n < data.CmdListsCount; ++n) {
    const ImDrawList& list = *data.CmdLists[n];
    const auto vertex_base = uint32_t(out.vertices.size());
    const auto index_base = uint32_t(out.indices.size());
    for (const ImDrawVert& v : list.VtxBuffer)
      out.vertices.push_back({v.pos.x, v.pos.y, v.uv.x, v.uv.y, v.col});
    out.indices.insert(out.indices.end(), list.IdxBuffer.begin(), list.IdxBuffer.end());
    for (const ImDrawCmd& command : list.CmdBuffer)
      if (command.ElemCount > 0 && !command.UserCallback)
        out.draws.push_back(convert(command, index_base, vertex_base));
  }
}

std::optional<UiRect> UiHost::find(std::string_view name) const {
  const auto it = shown_.find(name);
  if (it == shown_.end()) return std::nullopt;
  return it->second;
}

}  // namespace tumble
