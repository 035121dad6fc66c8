#include "viewer/render/ink.hpp"

#include "viewer/render/render_scene.hpp"

namespace tumble {
namespace {

constexpr uint32_t world_inks[] = {0xE0783C, 0x3E86C8, 0xC2255C, 0x12805C,
                                   0x6B3FC0, 0x23282F, 0x8A93A0};
constexpr uint32_t plate_inks[] = {0xF29B5F, 0x6CB4F5, 0xFF6B9A, 0x54D6A4,
                                   0xB495FF, 0xAEB6C0, 0x69717C};

}  // namespace

Vec3f ink_in_world(Ink ink) {
  return linear_from_srgb(world_inks[size_t(ink)]);
}

uint32_t ink_on_plate(Ink ink, float opacity) {
  const uint32_t rgb = plate_inks[size_t(ink)];
  return uint32_t(opacity * 255 + 0.5f) << 24 | (rgb & 0xff) << 16 | (rgb & 0xff00) |
         (rgb >> 16 & 0xff);
}

}  // namespace tumble
