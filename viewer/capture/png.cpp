#include "viewer/capture/png.hpp"

#include "viewer/capture/atomic_file.hpp"

#include <cstdlib>
#include <limits>
#include <memory>

#include <libdeflate.h>

namespace {

/// The compressor that stb_image_write calls; stb releases the result with free().
unsigned char* deflate_fast(unsigned char* data, int size, int* out_size, int /*quality*/) {
  struct Free {
    void operator()(libdeflate_compressor* c) const { libdeflate_free_compressor(c); }
  };
  thread_local const std::unique_ptr<libdeflate_compressor, Free> compressor(
      libdeflate_alloc_compressor(1));
  if (!compressor) return nullptr;
  const size_t bound = libdeflate_zlib_compress_bound(compressor.get(), size_t(size));
  auto* out = static_cast<unsigned char*>(std::malloc(bound));
  if (!out) return nullptr;
  const size_t n = libdeflate_zlib_compress(compressor.get(), data, size_t(size), out, bound);
  if (n == 0 || n > size_t(std::numeric_limits<int>::max())) {
    std::free(out);
    return nullptr;
  }
  *out_size = int(n);
  return out;
}

}  // namespace

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBIW_ZLIB_COMPRESS deflate_fast
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>
#define STBI_NO_GIF
#define STBI_NO_PSD
#define STBI_NO_PIC
#define STBI_NO_HDR
#define STBI_NO_STDIO
#define STBI_MAX_DIMENSIONS 32768
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace tumble {

Result<std::vector<std::byte>> encode_png(const Image& image) {
  if (image.width <= 0 || image.height <= 0 || image.channels < 1 || image.channels > 4 ||
      image.pixels.size() != image.row_bytes() * size_t(image.height))
    return Error{ErrorCode::invalid_argument, "the image is empty or its size is wrong", {}, {}};
  // A global variable of stb; it is set to the same constant by every thread before it encodes.
  static const bool filter_chosen = (stbi_write_force_png_filter = 2, true);
  (void)filter_chosen;

  int size = 0;
  unsigned char* png = stbi_write_png_to_mem(image.pixels.data(), int(image.row_bytes()),
                                             image.width, image.height, image.channels, &size);
  if (!png) return Error{ErrorCode::io, "out of memory while encoding a PNG", {}, {}};
  const auto* first = reinterpret_cast<const std::byte*>(png);
  std::vector<std::byte> bytes(first, first + size);
  std::free(png);
  return bytes;
}

Status write_png(const std::filesystem::path& path, const Image& image) {
  auto png = encode_png(image);
  if (!png) return png.error();
  return write_file(path, *png);
}

/// Greatest size of a file to read; stb counts bytes in an int [byte].
constexpr size_t most_picture_bytes = size_t{1} << 30;

Result<Image> read_image(const std::filesystem::path& path) {
  // Devices and pipes may never end, so they are not read.
  std::error_code code;
  if (std::filesystem::exists(path, code) && !std::filesystem::is_regular_file(path, code))
    return Error{ErrorCode::parse, "not a regular file, so no picture", path.string(), {}};
  auto content = read_file(path, most_picture_bytes);
  if (!content) return content.error();
  Image image;
  int channels_in_file = 0;
  unsigned char* pixels = stbi_load_from_memory(
      reinterpret_cast<const unsigned char*>(content->data()), int(content->size()), &image.width,
      &image.height, &channels_in_file, 4);
  if (!pixels) {
    const char* why = stbi_failure_reason();
    return Error{ErrorCode::parse, std::string("not a readable picture: ") + (why ? why : "?"),
                 path.string(), "PNG, JPEG, BMP, TGA and PNM are understood"};
  }
  image.channels = 4;
  image.pixels.assign(pixels, pixels + image.row_bytes() * size_t(image.height));
  stbi_image_free(pixels);
  return image;
}

}  // namespace tumble
