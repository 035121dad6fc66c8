#include "engine/scene/description/values.hpp"

#include "engine/math/det/det.hpp"

#include <cmath>

namespace tumble {

std::shared_ptr<const TimeCourse> course_of(const Varying& number, double unit) {
  if (!number.course) return nullptr;
  return std::make_shared<const TimeCourse>(number.course->scaled(unit));
}
namespace {

Colour from_rgb(unsigned rgb) {
  return {double((rgb >> 16) & 255u) / 255, double((rgb >> 8) & 255u) / 255,
          double(rgb & 255u) / 255};
}

/// Digits after the point with which every number of single precision from 0 to 1 is told from its
/// neighbours where they are closest in colours: near 1, by 2^-24.
constexpr int most_digits = 9;

double linear_channel(double s) {
  return s <= 0.04045 ? s / 12.92 : det::pow((s + 0.055) / 1.055, 2.4);
}

double shown_channel(float linear) {
  const double c = double(linear);
  const double shown = c <= 0.0031308 ? 12.92 * c : 1.055 * det::pow(c, 1 / 2.4) - 0.055;
  // A byte converted to linear single precision is converted back to the same byte, and any other
  // number to the shortest decimal fraction that gives the same: what was typed has few digits.
  const double byte = std::floor(shown * 255 + 0.5);
  const auto gives_the_same = [&](double s) { return float(linear_channel(s)) == linear; };
  if (gives_the_same(byte / 255)) return byte / 255;
  double parts = 10;
  for (int digits = 1; digits <= most_digits; ++digits, parts *= 10) {
    const double rounded = std::floor(shown * parts + 0.5) / parts;
    if (gives_the_same(rounded)) return rounded;
  }
  return shown;
}

}  // namespace

Vec3f Colour::linear() const {
  return {float(linear_channel(r)), float(linear_channel(g)), float(linear_channel(b))};
}

Colour Colour::from_linear(const Vec3f& rgb) {
  return {shown_channel(rgb[0]), shown_channel(rgb[1]), shown_channel(rgb[2])};
}

const std::vector<std::pair<std::string_view, Colour>>& named_colours() {
  static const std::vector<std::pair<std::string_view, Colour>> colours = {
      {"white", from_rgb(0xf2efe9)},  {"ivory", from_rgb(0xf4ecd8)},
      {"sand", from_rgb(0xd9c39a)},   {"stone", from_rgb(0xa8a29a)},
      {"grey", from_rgb(0x808080)},   {"slate", from_rgb(0x56606b)},
      {"black", from_rgb(0x1c1d20)},  {"steel", from_rgb(0xb4bcc4)},
      {"gold", from_rgb(0xd8a938)},   {"copper", from_rgb(0xb87349)},
      {"brick", from_rgb(0xa6513c)},  {"wood", from_rgb(0xa97b4f)},
      {"red", from_rgb(0xd1453b)},    {"coral", from_rgb(0xee7d61)},
      {"orange", from_rgb(0xe8923a)}, {"yellow", from_rgb(0xf0c94b)},
      {"lime", from_rgb(0xa4c454)},   {"green", from_rgb(0x4e9a57)},
      {"teal", from_rgb(0x2f8f8b)},   {"sky", from_rgb(0x7fb8dc)},
      {"blue", from_rgb(0x3b6fb6)},   {"navy", from_rgb(0x28406b)},
      {"violet", from_rgb(0x7d5ba6)}, {"pink", from_rgb(0xe59ab0)}};
  return colours;
}

std::vector<std::string> palette_names() {
  std::vector<std::string> out;
  for (const auto& [name, colour] : named_colours()) out.emplace_back(name);
  return out;
}

std::optional<Colour> colour_from_text(std::string_view text) {
  for (const auto& [name, colour] : named_colours())
    if (name == text) return colour;
  if (!text.starts_with('#') || (text.size() != 7 && text.size() != 4)) return std::nullopt;
  unsigned rgb = 0;
  for (const char c : text.substr(1)) {
    unsigned digit = 0;
    if (c >= '0' && c <= '9')
      digit = unsigned(c - '0');
    else if (c >= 'a' && c <= 'f')
      digit = unsigned(c - 'a') + 10;
    else if (c >= 'A' && c <= 'F')
      digit = unsigned(c - 'A') + 10;
    else
      return std::nullopt;
    rgb = (rgb << 4) | digit;
    if (text.size() == 4) rgb = (rgb << 4) | digit;
  }
  return from_rgb(rgb);
}

}  // namespace tumble
