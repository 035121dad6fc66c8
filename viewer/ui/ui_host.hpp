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

/// Dear ImGui without a window or a graphics library: takes events and returns a list of triangles.
/// It works the same with a window, EGL, OSMesa and the null device. A UI unit is `scale` pixels.
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

  /// Sets the pixels per UI unit, and bakes the fonts anew if that changes. True if the atlas has
  /// changed.
  bool set_scale(double scale);
  double scale() const { return scale_; }
  /// Sets the colours of all panels from the next frame on.
  void set_theme(Theme theme);
  const UiFonts& fonts() const { return fonts_; }
  /// The font atlas for Renderer::set_font, to be passed on when set_scale() returned true.
  FontAtlas atlas();
  void set_clipboard(Clipboard clipboard);

  /// Starts a frame of width x height UI units, `dt` [s] after the last. With `pointer_elsewhere`
  /// the pointer belongs to a gesture in the scene and is hidden from the panels.
  void begin(double width, double height, double dt, std::span<const InputEvent> events,
             bool pointer_elsewhere);
  /// Whether the panels use the pointer (or the keys) in this frame.
  bool wants_pointer() const;
  bool wants_keys() const;
  /// Releases the keyboard at once after a field has lost the focus; ImGui would do so a frame
  /// later.
  void give_up_keys();
  PointerLook pointer_look() const;
  /// Records the position of the item drawn last under a name, for scripts and tests.
  void mark(std::string_view name);
  void mark(std::string_view name, const UiRect& rect);
  /// Ends the frame and returns its triangles.
  void end(UiDrawList& out);

  /// Position of a named widget in the last finished frame.
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
  int keys_given_up_ = 0;  ///< frames left in which ImGui's claim to the keyboard is ignored
  HeldInput held_;
  /// Releases that are delayed by a frame, so that a key or button pressed and released within one
  /// frame is seen by ImGui, which reads states instead of events.
  std::vector<InputEvent> late_releases_;
  std::map<std::string, UiRect, std::less<>> marks_, shown_;
};

}  // namespace tumble
