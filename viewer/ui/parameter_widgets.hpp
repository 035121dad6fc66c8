#pragma once
#include "engine/core/parameters.hpp"
#include "engine/math/types.hpp"
#include "engine/scene/description/values.hpp"
#include "viewer/ui/pins.hpp"
#include "viewer/ui/widgets.hpp"

#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace tumble {

struct TickRate;

/// A parameter's name as text: "contact_damping_ratio" gives "contact damping ratio". The unit is
/// shown separately.
std::string label_of(std::string_view name);
/// A pinned value as text with what it belongs to: "ball: shape 0 friction".
std::string label_of_pin(const Pin& pin);
/// The name of an algorithm or a kind as text: "conservative advancement", "GJK".
std::string words_of(std::string_view name);
/// A unit as text: "m/s2" gives "m/s²".
std::string unit_words(std::string_view unit);

/// A field for a text of any length; the text that was typed, once, when the field is left with
/// another one than `now`, but for Esc. Its widget is called `mark`.
std::optional<std::string> typed_text(PanelContext& context, const std::string& mark,
                                      const std::string& now, float width);
/// Behind such a field: an arrow that opens the list of what it may say; what was chosen there.
/// Its widget is called "MARK.names", each entry "MARK.NAME".
std::optional<std::string> name_list(PanelContext& context, const std::string& mark,
                                     std::span<const std::string> names);

/// A vector for display: components that are 0 beside the longest one, or beside `size` for
/// lengths and velocities, are shown as 0.
Vec3 shown_vector(const Vec3& v, std::string_view unit, double size);

/// A widget for each declared parameter (core/parameters.hpp) with its unit, range and help: a
/// visitor of a definition's declaration. Values outside the range are rejected, and the reason is
/// shown below the field for some seconds.
class ParameterWidgets {
 public:
  /// Widgets are named "PREFIX.NAME" for scripts, the components of a vector "PREFIX.NAME.x".
  ParameterWidgets(PanelContext& context, std::string prefix)
      : context_(context), prefix_(std::move(prefix)) {}
  /// Each number gets a button that pins it.
  void let_pin(PinOwner place) { place_ = std::move(place); }
  /// Draws only this value of that place, under a line that says whose it is.
  void draw_only(const Pin& pin) { only_ = pin; }
  /// Size of what the values are of: lengths far below it are shown as 0 [m].
  void set_size(double size) { size_ = size; }
  bool changed = false;  ///< a value was edited
  bool drawn = false;    ///< a value was drawn
  std::string edited;    ///< the name of that value for display

  void field(double& value, const Parameter& p);
  void field(int& value, const Parameter& p);
  void field(bool& value, const Parameter& p);
  void field(Vec3& value, const Parameter& p);
  void field(TickRate& value, const Parameter& p);
  /// A number, or an expression over time, with a switch between the two.
  void field(Varying& value, const Parameter& p);
  void field(VaryingVec3& value, const Parameter& p);
  void field(Colour& value, const Parameter& p);
  /// A choice, if the possible names for this parameter are known; otherwise the value is only
  /// shown.
  void field(std::string& value, const Parameter& p);
  /// A choice of one of these names; true if it was changed. `words`: what people read for each,
  /// where that is not the name itself.
  bool choice(size_t& index, std::span<const std::string_view> names, const Parameter& p,
              std::span<const std::string_view> words = {});
  /// Values that are not given are not shown.
  template <class T>
  void field(std::optional<T>& value, const Parameter& p) {
    if (value) field(*value, p);
  }
  template <class E>
  requires std::is_enum_v<E>
  void field(E& value, const Parameter& p) {
    std::vector<std::string_view> names;
    size_t index = 0;
    for (const auto& [name, v] : EnumNames<E>::values) {
      if (v == value) index = names.size();
      names.push_back(name);
    }
    if (choice(index, names, p)) value = EnumNames<E>::values[index].second;
  }
  template <class T>
  void object(T& value, const Parameter& p) {
    heading(p);
    T::parameters(*this, value);
  }
  void heading(const Parameter& p);

 protected:
  /// Whether a value with this fault ("": none) is accepted; if not, the fault is shown.
  bool takes(std::string fault, const Parameter& p);
  void note_change(const Parameter& p);
  /// `number`: it can be pinned, where values can.
  void begin(const Parameter& p, bool own_line = false, bool number = false);
  void end(const Parameter& p);
  std::string mark_name(const Parameter& p) const;
  const char* id(const Parameter& p);
  /// A switch between a number and an expression; true if it was pressed.
  bool over_time(bool& on, const Parameter& p);
  /// A field for the expression of a number over time; a table is only shown.
  void course(Varying& value, const Parameter& p);

  /// Whether a value is not the only one that is to be drawn.
  bool skips(const Parameter& p) const;

  PanelContext& context_;
  std::string prefix_;

 private:
  Pin pin_of(const Parameter& p) const;
  void pin_button(const Parameter& p);
  bool slider(double& value, const Parameter& p, const char* format);

  std::optional<PinOwner> place_;  ///< none: values are not pinned here
  std::optional<Pin> only_;
  double size_ = 0;  ///< 0: not known
  std::string id_;
};

}  // namespace tumble
