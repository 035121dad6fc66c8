#pragma once
#include "engine/core/result.hpp"
#include "viewer/render/image.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

/// When two pictures count as equal. The defaults are meant for pictures of different renderers.
struct CompareLimits {
  double tolerance = 2;          ///< greatest difference of a channel that is ignored [1/255]
  double max_differing = 0.001;  ///< share of pixels that may differ by more, 0..1
  uint64_t max_cluster = 16;  ///< the largest cluster of such pixels must be smaller than this [px]
};

/// Difference between two pictures of the same size. The difference of a pixel is that of its worst
/// channel; clusters are 8-connected.
struct ImageDifference {
  bool same_size = true;
  int max_difference = 0;      ///< [1/255]
  double mean_difference = 0;  ///< over all pixels and channels [1/255]
  uint64_t pixels = 0;
  uint64_t differing = 0;        ///< pixels beyond the tolerance
  uint64_t largest_cluster = 0;  ///< size of the largest cluster of these [px]
  double share() const { return pixels ? double(differing) / double(pixels) : 0; }
};

ImageDifference compare_images(const Image& expected, const Image& actual, double tolerance);
/// Whether the difference is within the limits; false for pictures of unequal size.
bool within(const ImageDifference& difference, const CompareLimits& limits);

/// The expected picture in pale grey, differences within the tolerance in blue, beyond it in red.
Image difference_image(const Image& expected, const Image& actual, double tolerance);

/// Comparison of a pair of files; one may be missing or unreadable.
struct FileComparison {
  std::string name;
  enum class Kind { compared, only_expected, only_actual, unreadable } kind = Kind::compared;
  ImageDifference difference;
  bool equal = false;
  Error error;  ///< of an unreadable file
};

struct CompareOptions {
  CompareLimits limits;
  /// Difference image, or the folder for them when folders are compared; empty: none.
  std::filesystem::path diff;
  bool bless = false;  ///< replace expected files that differ by the actual ones
};

/// Compares two pictures, or the pictures of two folders by name. An unreadable picture is an error
/// (ErrorCode::parse or io); in a folder it is listed in the report, and the other files are still
/// compared. If a file could not be written, `cannot_write` is set.
struct ComparisonReport {
  std::vector<FileComparison> files;
  bool blessed = false;
  bool equal() const;
  /// The number of files of this kind.
  size_t count(FileComparison::Kind kind) const;
};
struct CompareFailure {
  Error error;
  bool cannot_write = false;
};
using CompareOutcome = std::variant<ComparisonReport, CompareFailure>;
CompareOutcome compare_paths(const std::filesystem::path& expected,
                             const std::filesystem::path& actual, const CompareOptions& options);

}  // namespace tumble
