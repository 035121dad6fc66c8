#pragma once
#include "viewer/interact/input.hpp"
#include "viewer/render/font.hpp"
#include "viewer/render/ui_draw_list.hpp"
#include "viewer/ui/fonts.hpp"
#include "viewer/ui/style.hpp"
#include "viewer/ui/ui_rect.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

struct ImGuiContext;
struct ImFontAtlas;

namespace tumble {

enum class PointerLook : uint8_t { arrow, hand, text, resize_x, resize_y };

/// Dear ImGui without a window or a graphics library: events in, flat triangles out. Works the same
/// under a window, EGL, OSMesa and the null device. UI units are pixels divided by `scale`.
class UiHost {
 public:
  struct Clipboard {
    std::function<std::string()> get;
    std::function<void(const std::string&)> set;
  };

  UiHost();
  ~UiHost();
  UiHost(const UiHost&) = delete;
  UiHost& operator=(const UiHost&) = delete;

  /// Pixels per UI unit; bakes the fonts anew when it changes. True when the atlas is another one.
  bool set_scale(double scale);
  double scale() const { return scale_; }
  /// Colours of all panels from the next frame on.
  void set_theme(Theme theme);
  const UiFonts& fonts() const { return fonts_; }
  /// For Renderer::set_font, after set_scale() said so.
  FontAtlas atlas();
  void set_clipboard(Clipboard clipboard);

  /// Starts a frame of width x height UI units. With `pointer_elsewhere` the pointer belongs to a
  /// gesture on the scene and the panels do not see it.
  void begin(double width, double height, double dt, std::span<const InputEvent> events,
             bool pointer_elsewhere);
  /// The panels take the pointer (or keys) in this frame.
  bool wants_pointer() const;
  bool wants_keys() const;
  /// A field that was left has no claim to the keys any more; ImGui would notice a frame later.
  void give_up_keys();
  PointerLook pointer_look() const;
  /// Remembers where the item drawn last is, for scripts and tests.
  void mark(std::string_view name);
  void mark(std::string_view name, const UiRect& rect);
  /// Ends the frame and hands over its triangles.
  void end(UiDrawList& out);

  /// Where a widget was in the last finished frame.
  std::optional<UiRect> find(std::string_view name) const;
  const std::map<std::string, UiRect, std::less<>>& widgets() const { return shown_; }

 private:
  void feed(std::span<const InputEvent> events, bool pointer_elsewhere);

  std::unique_ptr<ImFontAtlas> font_atlas_;
  ImGuiContext* context_ = nullptr;
  UiFonts fonts_;
  double scale_ = 0;
  Theme theme_ = Theme::dark;
  Clipboard clipboard_;
  std::string clipboard_text_;
  int keys_given_up_ = 0;  ///< frames for which ImGui's claim does not count
  HeldInput held_;
  /// A tap shorter than a frame is kept down for one frame: ImGui sees states, not events.
  std::vector<InputEvent> late_releases_;
  std::map<std::string, UiRect, std::less<>> marks_, shown_;
};

}  // namespace tumble
