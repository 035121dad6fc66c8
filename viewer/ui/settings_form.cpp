#include "viewer/ui/settings_form.hpp"

#include "engine/scene/visitors/known_names.hpp"
#include "viewer/ui/parameter_widgets.hpp"

#include <algorithm>
#include <utility>

namespace tumble {
namespace {

class SettingsWidgets : public ParameterWidgets {
 public:
  SettingsWidgets(PanelContext& context, const char* prefix, std::string stepper)
      : ParameterWidgets(context, prefix), stepper_(std::move(stepper)) {}

  template <class T>
  void object(T& value, const Parameter& p) {
    const std::vector<std::string> steppers = known_names("stepper");
    const bool of_stepper = std::ranges::find(steppers, p.name) != steppers.end();
    if (of_stepper && p.name != stepper_) return;
    heading(p);
    T::parameters(*this, value);
  }

 private:
  std::string stepper_;
};

}  // namespace

bool draw_settings_form(PanelContext& context, const char* prefix, WorldSettings& settings) {
  SettingsWidgets widgets(context, prefix, settings.stepper);
  WorldSettings::parameters(widgets, settings);
  return widgets.changed;
}

}  // namespace tumble
