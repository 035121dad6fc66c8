#include "viewer/render/image.hpp"

#include "engine/core/hash.hpp"

#include <cstdlib>

namespace tumble {

bool is_uniform(const Image& image, int tolerance) {
  if (image.empty()) return true;
  const size_t step = size_t(image.channels);
  const uint8_t* first = image.pixels.data();
  for (size_t i = 0; i + step <= image.pixels.size(); i += step)
    for (size_t c = 0; c < 3; ++c)
      if (std::abs(int(image.pixels[i + c]) - int(first[c])) > tolerance) return false;
  return true;
}

Image without_alpha(const Image& image) {
  if (image.channels == 3) return image;
  Image out{image.width, image.height, 3, {}};
  const size_t count = size_t(image.width) * size_t(image.height);
  out.pixels.resize(count * 3);
  for (size_t i = 0; i < count; ++i)
    for (size_t c = 0; c < 3; ++c) out.pixels[3 * i + c] = image.pixels[4 * i + c];
  return out;
}

uint64_t image_hash(const Image& image) {
  const Image rgb = without_alpha(image);
  const int32_t size[2] = {rgb.width, rgb.height};
  return hash_bytes(rgb.pixels.data(), rgb.pixels.size(), hash_bytes(size, sizeof size));
}

}  // namespace tumble
