// Reference: the decoder of stb_image, a different code path than the encoder; the kernel's own
// file size limit as the full disk.
#include "viewer/capture/png.hpp"

#include "engine/core/random.hpp"
#include "tests/support/temp_folder.hpp"
#include "viewer/capture/atomic_file.hpp"
#include "viewer/capture/png_writer.hpp"

#include <csignal>
#include <fstream>

#include <doctest/doctest.h>
#include <sys/resource.h>

using namespace tumble;

namespace {

Image noise(int width, int height, int channels, uint64_t seed) {
  Random random(seed);
  Image image{width, height, channels, {}};
  image.pixels.resize(image.row_bytes() * size_t(height));
  for (uint8_t& v : image.pixels) v = uint8_t(random.next());
  return image;
}

size_t files_in(const std::filesystem::path& folder) {
  size_t n = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) ++n;
  return n;
}

/// Lowers the largest file this process may write, as a full disk would.
struct SmallFiles {
  explicit SmallFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit now = before;
    now.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &now);
    std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SmallFiles() { setrlimit(RLIMIT_FSIZE, &before); }
  rlimit before{};
};

}  // namespace

TEST_CASE("what is written is read back, bit for bit") {
  TempFolder folder;
  for (const int channels : {3, 4})
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 5}, {64, 33}, {300, 200}}) {
      const Image image = noise(w, h, channels, uint64_t(w));
      REQUIRE(write_png(folder / "x.png", image).ok());
      const auto back = read_image(folder / "x.png");
      REQUIRE(back.ok());
      REQUIRE(back->width == w);
      REQUIRE(back->height == h);
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
          for (int c = 0; c < channels; ++c) REQUIRE(back->at(x, y)[c] == image.at(x, y)[c]);
          if (channels == 3) REQUIRE(back->at(x, y)[3] == 255);
        }
    }
}

TEST_CASE("a broken picture is refused with its name") {
  TempFolder folder;
  const auto file = folder / "broken.png";
  CHECK(read_image(file).error().code == ErrorCode::io);
  REQUIRE(write_png(file, noise(40, 40, 3, 1)).ok());
  auto content = *read_file(file);
  for (const size_t keep : {size_t{0}, size_t{8}, size_t{30}, content.size() / 2}) {
    std::ofstream(file, std::ios::trunc) << content.substr(0, keep);
    const auto image = read_image(file);
    REQUIRE_FALSE(image.ok());
    CHECK(image.error().code == ErrorCode::parse);
    CHECK(image.error().place == file.string());
  }
  // A header that claims 2^31 pixels.
  content[16] = content[20] = char(0x7f);
  std::ofstream(file, std::ios::trunc) << content;
  CHECK_FALSE(read_image(file).ok());
}

TEST_CASE("an image without pixels is not written") {
  TempFolder folder;
  CHECK_FALSE(write_png(folder / "x.png", Image{}).ok());
  CHECK(files_in(folder.path()) == 0);
}

TEST_CASE("a file that cannot be finished leaves nothing, and the old one stays") {
  TempFolder folder;
  REQUIRE(write_file(folder / "x.txt", "old").ok());
  {
    SmallFiles limit(1000);
    const auto status = write_file(folder / "x.txt", std::string(5000, 'n'));
    REQUIRE_FALSE(status.ok());
    CHECK(status.error().code == ErrorCode::io);
    CHECK(status.error().place == (folder / "x.txt").string());
  }
  CHECK(*read_file(folder / "x.txt") == "old");
  CHECK(files_in(folder.path()) == 1);
  CHECK_FALSE(write_file(folder / "no/such/folder/x", "a").ok());
  CHECK_FALSE(write_file(folder.path(), "a").ok());
  CHECK_FALSE(make_folder(folder / "x.txt/sub").ok());
  CHECK(write_file("/dev/null", "a").ok());
  CHECK_FALSE(write_file("/dev/full", "a").ok());
}

TEST_CASE("the writer writes every picture once, in order, from recycled buffers") {
  TempFolder folder;
  PngWriter writer(3);
  std::vector<Image> pictures;
  for (uint64_t i = 0; i < 12; ++i) {
    pictures.push_back(noise(64, 48, 4, i));
    Image buffer = writer.take_buffer();
    buffer = pictures.back();
    writer.submit(std::move(buffer), folder / (std::to_string(i) + ".png"), i);
  }
  REQUIRE(writer.finish().ok());
  const auto written = writer.take_written();
  REQUIRE(written.size() == 12);
  for (uint64_t i = 0; i < 12; ++i) {
    CHECK(written[i].index == i);
    CHECK(written[i].hash == image_hash(pictures[i]));
    CHECK_FALSE(written[i].uniform);
    CHECK(written[i].bytes == std::filesystem::file_size(folder / (std::to_string(i) + ".png")));
  }
  CHECK(files_in(folder.path()) == 12);
  CHECK(writer.take_written().empty());
}

TEST_CASE("a full disk stops the writer with whole files only") {
  TempFolder folder;
  SmallFiles limit(20000);
  PngWriter writer(2);
  for (uint64_t i = 0; i < 6; ++i) {
    Image buffer = writer.take_buffer();
    buffer = i < 2 ? Image{8, 8, 4, std::vector<uint8_t>(256, 7)} : noise(200, 200, 4, i);
    writer.submit(std::move(buffer), folder / (std::to_string(i) + ".png"), i);
  }
  const Status status = writer.finish();
  REQUIRE_FALSE(status.ok());
  CHECK(status.error().code == ErrorCode::io);
  CHECK(files_in(folder.path()) == 2);
  const auto written = writer.take_written();
  REQUIRE(written.size() == 2);
  CHECK(written[0].uniform);
}
