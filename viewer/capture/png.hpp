#pragma once
#include "engine/core/result.hpp"
#include "viewer/render/image.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace tumble {

/// Encodes an image as PNG: 8 bits per channel, filter "up" and deflate level 1, which for rendered
/// frames is seven times faster than stb_image_write's own deflate and still smaller. Thread-safe.
Result<std::vector<std::byte>> encode_png(const Image& image);

/// Encodes and writes a file that appears whole or not at all.
Status write_png(const std::filesystem::path& path, const Image& image);

/// Reads PNG, JPEG, BMP, TGA or PNM as 4 channels. ErrorCode::parse if it is not a picture.
Result<Image> read_image(const std::filesystem::path& path);

}  // namespace tumble
