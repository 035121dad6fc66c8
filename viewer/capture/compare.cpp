#include "viewer/capture/compare.hpp"

#include <algorithm>
#include <cstdlib>

namespace tumble {
namespace {

/// Largest channel difference of every pixel [1/255]; a missing alpha counts as opaque.
std::vector<uint8_t> pixel_differences(const Image& a, const Image& b, uint64_t& sum) {
  const size_t n = size_t(a.width) * size_t(a.height);
  const size_t ca = size_t(a.channels), cb = size_t(b.channels);
  const size_t channels = std::max(ca, cb);
  std::vector<uint8_t> worst(n);
  for (size_t i = 0; i < n; ++i) {
    int most = 0;
    for (size_t c = 0; c < channels; ++c) {
      const int va = c < ca ? a.pixels[i * ca + c] : 255;
      const int vb = c < cb ? b.pixels[i * cb + c] : 255;
      const int d = std::abs(va - vb);
      sum += uint64_t(d);
      most = std::max(most, d);
    }
    worst[i] = uint8_t(most);
  }
  return worst;
}

/// Union-find over pixels; roots hold the negative size of their set.
class Clusters {
 public:
  explicit Clusters(size_t n) : parent_(n, -1) {}
  int64_t root(int64_t i) {
    while (parent_[size_t(i)] >= 0) {
      int64_t& up = parent_[size_t(i)];
      if (parent_[size_t(up)] >= 0) up = parent_[size_t(up)];
      i = up;
    }
    return i;
  }
  void join(int64_t a, int64_t b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    if (parent_[size_t(a)] > parent_[size_t(b)]) std::swap(a, b);
    parent_[size_t(a)] += parent_[size_t(b)];
    parent_[size_t(b)] = a;
  }
  uint64_t size(int64_t i) { return uint64_t(-parent_[size_t(root(i))]); }

 private:
  std::vector<int64_t> parent_;
};

uint64_t largest_cluster(const std::vector<uint8_t>& worst, int width, int height,
                         double tolerance) {
  const auto differs = [&](int x, int y) {
    return x >= 0 && x < width && y >= 0 &&
           double(worst[size_t(y) * size_t(width) + size_t(x)]) > tolerance;
  };
  const auto index = [&](int x, int y) { return int64_t(y) * width + x; };
  Clusters clusters(worst.size());
  uint64_t largest = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      if (!differs(x, y)) continue;
      for (const auto& [dx, dy] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}})
        if (differs(x + dx, y + dy)) clusters.join(index(x, y), index(x + dx, y + dy));
      largest = std::max(largest, clusters.size(index(x, y)));
    }
  return largest;
}

}  // namespace

ImageDifference compare_images(const Image& expected, const Image& actual, double tolerance) {
  ImageDifference d;
  d.same_size = expected.width == actual.width && expected.height == actual.height;
  if (!d.same_size) return d;
  d.pixels = uint64_t(expected.width) * uint64_t(expected.height);
  uint64_t sum = 0;
  const std::vector<uint8_t> worst = pixel_differences(expected, actual, sum);
  const int channels = std::max(expected.channels, actual.channels);
  d.mean_difference = d.pixels ? double(sum) / double(d.pixels * uint64_t(channels)) : 0;
  for (const uint8_t w : worst) {
    d.max_difference = std::max(d.max_difference, int(w));
    d.differing += double(w) > tolerance;
  }
  if (d.differing > 0)
    d.largest_cluster = largest_cluster(worst, expected.width, expected.height, tolerance);
  return d;
}

bool within(const ImageDifference& d, const CompareLimits& limits) {
  return d.same_size && d.share() <= limits.max_differing &&
         d.largest_cluster < std::max<uint64_t>(limits.max_cluster, 1);
}

Image difference_image(const Image& expected, const Image& actual, double tolerance) {
  Image out;
  if (expected.width != actual.width || expected.height != actual.height) return out;
  out.width = expected.width;
  out.height = expected.height;
  out.channels = 3;
  uint64_t sum = 0;
  const std::vector<uint8_t> worst = pixel_differences(expected, actual, sum);
  out.pixels.resize(3 * worst.size());
  const size_t stride = size_t(expected.channels);
  for (size_t i = 0; i < worst.size(); ++i) {
    const uint8_t* p = expected.pixels.data() + i * stride;
    const int grey = stride >= 3 ? (p[0] + 2 * p[1] + p[2]) / 4 : p[0];
    uint8_t* o = out.pixels.data() + 3 * i;
    const auto pale = uint8_t(170 + grey / 4);
    if (worst[i] == 0) {
      o[0] = o[1] = o[2] = pale;
    } else if (double(worst[i]) <= tolerance) {
      o[0] = 90, o[1] = 150, o[2] = 255;
    } else {
      o[0] = 255;
      o[1] = o[2] = uint8_t(std::max(0, 140 - int(worst[i])));
    }
  }
  return out;
}

}  // namespace tumble
