#pragma once
#include "engine/core/result.hpp"
#include "viewer/render/image.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace tumble {

/// When two pictures count as equal. The defaults are the rule for pictures of different renderers.
struct CompareLimits {
  double tolerance = 2;          ///< difference of a channel that does not count [1/255]
  double max_differing = 0.001;  ///< share of pixels that may differ beyond it, 0..1
  uint64_t max_cluster = 16;     ///< the largest cluster must be smaller than this [px]
};

/// How far two pictures of the same size are apart. A pixel's difference is that of its worst
/// channel; clusters are 8-connected.
struct ImageDifference {
  bool same_size = true;
  int max_difference = 0;      ///< [1/255]
  double mean_difference = 0;  ///< over all pixels and channels [1/255]
  uint64_t pixels = 0;
  uint64_t differing = 0;        ///< pixels beyond the tolerance
  uint64_t largest_cluster = 0;  ///< pixels beyond the tolerance that hang together
  double share() const { return pixels ? double(differing) / double(pixels) : 0; }
};

ImageDifference compare_images(const Image& expected, const Image& actual, double tolerance);
/// Within the limits; pictures of unequal size never are.
bool within(const ImageDifference& difference, const CompareLimits& limits);

/// The expected picture in pale grey, differences within the tolerance in blue, beyond it in red.
Image difference_image(const Image& expected, const Image& actual, double tolerance);

/// One pair of files, a file that has no counterpart, or one that cannot be read.
struct FileComparison {
  std::string name;
  enum class Kind { compared, only_expected, only_actual, unreadable } kind = Kind::compared;
  ImageDifference difference;
  bool equal = false;
  Error error;  ///< of an unreadable one
};

struct CompareOptions {
  CompareLimits limits;
  std::filesystem::path diff;  ///< file, or folder when folders are compared; empty: none
  bool bless = false;          ///< copy the actual over the expected where they differ
};

/// Compares two pictures, or the pictures of two folders by name. An unreadable picture is a
/// failure (ErrorCode::parse or io); in folders it is one of the files of the report, and the
/// others are compared nevertheless. What cannot be written has `cannot_write` set.
struct ComparisonReport {
  std::vector<FileComparison> files;
  bool blessed = false;
  bool equal() const;
  /// How many files are of this kind.
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
