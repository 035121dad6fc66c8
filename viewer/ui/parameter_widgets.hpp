#pragma once
#include "engine/core/parameters.hpp"
#include "engine/math/types.hpp"
#include "engine/scene/description/values.hpp"
#include "viewer/ui/widgets.hpp"

#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace tumble {

struct TickRate;

/// "contact_damping_ratio" as people write it: "contact damping ratio". The unit stands beside it.
std::string label_of(std::string_view name);
/// The name of an algorithm or a kind as people write it: "conservative advancement", "GJK".
std::string words_of(std::string_view name);
/// "m/s2" as people write it: "m/s²".
std::string unit_words(std::string_view unit);

/// A widget for each declared parameter (core/parameters.hpp) with its unit, range and help: a
/// visitor over what a definition declares. Values outside the range are not taken, and the line
/// below the field says why for some seconds.
class ParameterWidgets {
 public:
  /// Widgets are marked "PREFIX.NAME" for scripts, the numbers of a vector "PREFIX.NAME.x" too.
  ParameterWidgets(PanelContext& context, std::string prefix)
      : context_(context), prefix_(std::move(prefix)) {}
  bool changed = false;  ///< one of them was edited
  std::string edited;    ///< its name, for people

  void field(double& value, const Parameter& p);
  void field(int& value, const Parameter& p);
  void field(bool& value, const Parameter& p);
  void field(Vec3& value, const Parameter& p);
  void field(TickRate& value, const Parameter& p);
  /// A number, or the expression that it follows over time, and a switch between the two.
  void field(Varying& value, const Parameter& p);
  void field(VaryingVec3& value, const Parameter& p);
  void field(Colour& value, const Parameter& p);
  /// One of the names that are known for this parameter; else it is only shown.
  void field(std::string& value, const Parameter& p);
  /// One of these names; true when another was chosen.
  bool choice(size_t& index, std::span<const std::string_view> names, const Parameter& p);
  /// What is not given is not shown.
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
  /// Whether a value without a fault, or with this one, is taken; it is said if not.
  bool takes(std::string fault, const Parameter& p);
  void note_change(const Parameter& p);
  void begin(const Parameter& p, bool own_line = false);
  void end(const Parameter& p);
  std::string mark_name(const Parameter& p) const;
  const char* id(const Parameter& p);
  /// A switch between a number and an expression; true when it was pressed.
  bool over_time(bool& on, const Parameter& p);
  /// The expression that a number follows; a table is only shown.
  void course(Varying& value, const Parameter& p);

  PanelContext& context_;
  std::string prefix_;

 private:
  std::string id_;
};

}  // namespace tumble
