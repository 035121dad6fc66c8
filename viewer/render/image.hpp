#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tumble {

/// Eight bits per channel, sRGB, top row first, rows without padding.
struct Image {
  int width = 0;
  int height = 0;
  int channels = 4;  ///< 3 RGB, 4 RGBA
  std::vector<uint8_t> pixels;

  bool empty() const { return pixels.empty(); }
  size_t row_bytes() const { return size_t(width) * size_t(channels); }
  const uint8_t* at(int x, int y) const {
    return pixels.data() + size_t(y) * row_bytes() + size_t(x) * size_t(channels);
  }
};

/// Whether all pixels have the same RGB within `tolerance` steps of 1/255, as in the black frame
/// that broken drivers return. An empty image is uniform.
bool is_uniform(const Image& image, int tolerance = 0);
/// The same picture with 3 channels.
Image without_alpha(const Image& image);
/// XXH64 of size and RGB (alpha left out): equal pictures have equal hashes.
uint64_t image_hash(const Image& image);

}  // namespace tumble
