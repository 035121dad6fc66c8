#include "tests/fuzz/damaged.hpp"

#include "tests/fuzz/random_scene.hpp"

#include <cstring>
#include <iterator>

namespace tumble {

std::string damaged_text(std::string text, Random& random) {
  static const char* numbers[] = {"0",    "-1",    "1e-9", "1e9",    "1e300", "-1e308",    "0.5",
                                  "1e-3", "10000", "3",    "1e-300", "-0.25", "2147483648"};
  const uint32_t changes = 1 + random.below(3);
  for (uint32_t i = 0; i < changes; ++i) {
    size_t at = random.below(uint32_t(text.size()));
    const size_t digit = text.find_first_of("0123456789", at);
    if (random.below(4) != 0 && digit != std::string::npos) {
      size_t end = text.find_first_not_of("0123456789.eE+-", digit);
      if (end == std::string::npos) end = text.size();
      text.replace(digit, end - digit, numbers[random.below(uint32_t(std::size(numbers)))]);
    } else if (random.below(2) == 0) {
      text[at] = char(random.below(256));
    } else {
      text.erase(at, 1 + random.below(30));
    }
  }
  return text;
}

std::string damaged_bytes(std::string bytes, Random& random) {
  // Whole numbers by their bits, and of floating point 1, 1e30, -1e30, infinity and nan.
  static const uint32_t numbers[] = {0,          1,          3,          0xff,       0xffff,
                                     0x7fffffff, 0x80000000, 0xffffffff, 0x3f800000, 0x7149f2ca,
                                     0xf149f2ca, 0x7f800000, 0x7fc00000, 0x01000000};
  const uint32_t changes = 1 + random.below(3);
  for (uint32_t i = 0; i < changes && bytes.size() > 8; ++i) {
    const size_t at = random.below(uint32_t(bytes.size() - 4));
    switch (random.below(6)) {
      case 0:
        bytes[at] = char(random.below(256));
        break;
      case 1:
        bytes.erase(at, 1 + random.below(30));
        break;
      case 2:
        bytes.insert(at, bytes.substr(at, 1 + random.below(30)));
        break;
      case 3:
        if (random.below(4) == 0) bytes.resize(at);
        break;
      default:
        std::memcpy(&bytes[at], &numbers[random.below(uint32_t(std::size(numbers)))], 4);
    }
  }
  return bytes;
}

std::string damaged_scene(uint64_t number) {
  Random random(number, 5);
  return damaged_text(random_scene(1 + random.below(150), "realtime").text, random);
}

}  // namespace tumble
