// Reference: brute force written differently from the library: counts pixel by pixel with double
// loops, clusters by flood fill with an explicit stack. Files: the same images through real PNGs.
#include "viewer/capture/compare.hpp"

#include "engine/core/random.hpp"
#include "tests/support/temp_folder.hpp"
#include "viewer/capture/png.hpp"

#include <fstream>

#include <doctest/doctest.h>

using namespace tumble;

namespace {

Image flat(int width, int height, uint8_t value, int channels = 3) {
  Image image{width, height, channels, {}};
  image.pixels.assign(image.row_bytes() * size_t(height), value);
  return image;
}

struct Reference {
  int max = 0;
  double sum = 0;
  uint64_t differing = 0, cluster = 0;
};

/// Channel differences pixel by pixel; clusters by flood fill.
Reference brute_force(const Image& a, const Image& b, double tolerance) {
  Reference r;
  std::vector<std::vector<bool>> open(size_t(a.height), std::vector<bool>(size_t(a.width)));
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x)
      for (int c = 0; c < a.channels; ++c) {
        const int d = std::abs(int(a.at(x, y)[c]) - int(b.at(x, y)[c]));
        r.sum += d;
        r.max = std::max(r.max, d);
        if (d > tolerance) open[size_t(y)][size_t(x)] = true;
      }
  for (auto& row : open)
    for (const bool o : row) r.differing += o;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      uint64_t n = 0;
      std::vector<std::pair<int, int>> stack{{x, y}};
      while (!stack.empty()) {
        const auto [px, py] = stack.back();
        stack.pop_back();
        if (px < 0 || py < 0 || px >= a.width || py >= a.height) continue;
        if (!open[size_t(py)][size_t(px)]) continue;
        open[size_t(py)][size_t(px)] = false;
        ++n;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) stack.emplace_back(px + dx, py + dy);
      }
      r.cluster = std::max(r.cluster, n);
    }
  return r;
}

}  // namespace

TEST_CASE("differences of random pictures equal the brute-force count") {
  Random random(7);
  int clustered = 0;
  for (int round = 0; round < 60; ++round) {
    const int width = 1 + int(random.next() % 40), height = 1 + int(random.next() % 30);
    const int channels = random.next() % 2 ? 3 : 4;
    Image a = flat(width, height, 100, channels), b = a;
    const uint64_t changes = random.next() % uint64_t(width * height);
    for (uint64_t i = 0; i < changes; ++i) {
      const size_t at = random.next() % b.pixels.size();
      b.pixels[at] = uint8_t(100 + random.next() % 7 - 3);
    }
    const double tolerance = double(random.next() % 4);
    const ImageDifference d = compare_images(a, b, tolerance);
    const Reference r = brute_force(a, b, tolerance);
    CHECK(d.max_difference == r.max);
    CHECK(d.mean_difference == doctest::Approx(r.sum / double(a.pixels.size())));
    CHECK(d.differing == r.differing);
    CHECK(d.largest_cluster == r.cluster);
    clustered += r.cluster > 1 && r.cluster < r.differing;
  }
  CHECK(clustered > 15);
}

TEST_CASE("a spiral is one cluster, a diagonal too, separate dots are not") {
  const Image a = flat(9, 9, 0);
  Image b = a;
  const auto mark = [&](int x, int y) {
    b.pixels[size_t(y) * b.row_bytes() + size_t(x) * 3 + 1] = 200;
  };
  for (int i = 0; i < 9; ++i) mark(i, i);
  CHECK(compare_images(a, b, 2).largest_cluster == 9);
  b = a;
  for (int i = 0; i < 9; i += 2)
    for (int j = 0; j < 9; j += 2) mark(i, j);
  CHECK(compare_images(a, b, 2).largest_cluster == 1);
  CHECK(compare_images(a, b, 2).differing == 25);
}

TEST_CASE("the limits are those of the image rule") {
  const CompareLimits limits;
  ImageDifference d;
  d.pixels = 100000;
  d.differing = 100;
  d.largest_cluster = 15;
  CHECK(within(d, limits));
  d.largest_cluster = 16;
  CHECK_FALSE(within(d, limits));
  d.largest_cluster = 1;
  d.differing = 101;
  CHECK_FALSE(within(d, limits));
  CHECK_FALSE(compare_images(flat(3, 4, 0), flat(4, 3, 0), 255).same_size);
}

TEST_CASE("two steps of 255 are tolerated, three are not") {
  CHECK(compare_images(flat(4, 4, 10), flat(4, 4, 12), 2).differing == 0);
  CHECK(compare_images(flat(4, 4, 10), flat(4, 4, 13), 2).differing == 16);
}

TEST_CASE("folders are compared by name, blessed, and then equal") {
  TempFolder folder;
  const auto expected = folder / "expected", actual = folder / "actual";
  std::filesystem::create_directory(actual);
  REQUIRE(write_png(actual / "a.png", flat(5, 5, 9)).ok());
  REQUIRE(write_png(actual / "b.png", flat(5, 5, 90)).ok());

  CHECK(std::holds_alternative<CompareFailure>(compare_paths(expected, actual, {})));
  CompareOptions bless;
  bless.bless = true;
  auto outcome = compare_paths(expected, actual, bless);
  REQUIRE(std::holds_alternative<ComparisonReport>(outcome));
  CHECK(std::get<ComparisonReport>(outcome).blessed);

  outcome = compare_paths(expected, actual, {});
  CHECK(std::get<ComparisonReport>(outcome).equal());
  CHECK(std::get<ComparisonReport>(outcome).files.size() == 2);

  std::filesystem::remove(actual / "a.png");
  CHECK_FALSE(std::get<ComparisonReport>(compare_paths(expected, actual, {})).equal());

  std::ofstream(actual / "a.png") << "no picture";
  outcome = compare_paths(expected, actual, {});
  // What cannot be read does not keep the others from being compared.
  REQUIRE(std::holds_alternative<ComparisonReport>(outcome));
  const auto& report = std::get<ComparisonReport>(outcome);
  CHECK_FALSE(report.equal());
  CHECK(report.files.size() == 2);
  REQUIRE(report.count(FileComparison::Kind::unreadable) == 1);
  for (const FileComparison& file : report.files) {
    if (file.kind == FileComparison::Kind::unreadable)
      CHECK(file.error.place == (actual / "a.png").string());
    else
      CHECK(file.equal);
  }
}

TEST_CASE("the difference picture marks exactly the differing pixels in red") {
  const Image a = flat(6, 4, 128);
  Image b = a;
  b.pixels[0] = 255;
  b.pixels[3] = 129;
  const Image d = difference_image(a, b, 2);
  REQUIRE(d.width == 6);
  CHECK(d.at(0, 0)[0] == 255);
  CHECK(d.at(0, 0)[1] < 128);
  CHECK(d.at(1, 0)[2] == 255);
  CHECK(d.at(2, 0)[0] == d.at(2, 0)[1]);
}
