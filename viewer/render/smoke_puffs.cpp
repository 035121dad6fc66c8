#include "viewer/render/smoke_puffs.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/types.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr int tile = 128, slices = 14;

/// A number in 0..1 for each corner of a lattice (the mixing of splitmix64).
float corner_value(int x, int y, int z, uint32_t seed) {
  uint64_t h = uint64_t(uint32_t(x)) * 0x9E3779B97F4A7C15u ^
               uint64_t(uint32_t(y)) * 0xC2B2AE3D27D4EB4Fu ^
               uint64_t(uint32_t(z)) * 0x165667B19E3779F9u ^ (uint64_t(seed) << 32);
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9u;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBu;
  return float((h ^ (h >> 31)) >> 40) / 16777216.0f;
}

float smooth(float t) {
  return t * t * (3 - 2 * t);
}

/// The corners' values of one octave of value noise about the unit ball, each computed once.
class Octave {
 public:
  Octave(float scale, uint32_t seed) : scale_(scale) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low_[axis] = int(std::floor(middle[axis] - scale));
      count_[axis] = int(std::floor(middle[axis] + scale)) + 2 - low_[axis];
    }
    values_.reserve(size_t(count_[0]) * size_t(count_[1]) * size_t(count_[2]));
    for (int i = 0; i < count_[0]; ++i)
      for (int j = 0; j < count_[1]; ++j)
        for (int k = 0; k < count_[2]; ++k)
          values_.push_back(corner_value(low_[0] + i, low_[1] + j, low_[2] + k, seed));
  }

  /// The noise along a line parallel to z.
  class Line {
   public:
    Line(const Octave& of, float x, float y) : of_(of) {
      const float at_x = of.scale_ * x + middle[0], at_y = of.scale_ * y + middle[1];
      const float i = std::floor(at_x), j = std::floor(at_y);
      const float u = smooth(at_x - i), v = smooth(at_y - j);
      for (size_t c = 0; c < 4; ++c) {
        const int dx = int(c & 1), dy = int(c >> 1);
        weight_[c] = (dx ? u : 1 - u) * (dy ? v : 1 - v);
        const int row = (int(i) + dx - of.low_[0]) * of.count_[1] + int(j) + dy - of.low_[1];
        values_[c] = of.values_.data() + row * of.count_[2];
      }
    }
    /// 0..1
    float at(float z) const {
      const float at_z = of_.scale_ * z + middle[2], cell = std::floor(at_z);
      const float w = smooth(at_z - cell);
      const int k = int(cell) - of_.low_[2];
      float sum = 0;
      for (size_t c = 0; c < 4; ++c) sum += weight_[c] * (1 - w) * values_[c][k];
      for (size_t c = 0; c < 4; ++c) sum += weight_[c] * w * values_[c][k + 1];
      return sum;
    }

   private:
    const Octave& of_;
    std::array<float, 4> weight_{};
    std::array<const float*, 4> values_{};  ///< by the number of a corner along z
  };

 private:
  /// Where the ball's centre is among the corners.
  static constexpr std::array<float, 3> middle{7, 13, 19};
  float scale_;  ///< corners by radius of the ball
  std::array<int, 3> low_{}, count_{};
  std::vector<float> values_;  ///< z fastest
};

/// The noise of one puff.
using PuffNoise = std::array<Octave, 3>;

PuffNoise noise_of(uint32_t seed) {
  float size = 1;
  const auto next = [&size](uint32_t octave_seed) {
    const Octave octave(size * 2.3f, octave_seed);
    size *= 2.1f;
    return octave;
  };
  return {next(seed), next(seed + 1), next(seed + 2)};
}

/// Density of the cloud along a line through the unit ball: noise that thins out towards its rim.
class Density {
 public:
  Density(const PuffNoise& noise, float x, float y)
      : x_(x), y_(y), lines_{{{noise[0], x, y}, {noise[1], x, y}, {noise[2], x, y}}} {}
  float at(float z) const {
    float sum = 0, weight = 0.5f;
    for (const Octave::Line& line : lines_) {
      sum += weight * line.at(z);
      weight *= 0.5f;
    }
    const float rim = 1 - Vec3f(x_, y_, z).squaredNorm();
    return std::max(0.f, rim * (sum * 3.4f - 0.95f));
  }

 private:
  float x_, y_;
  std::array<Octave::Line, 3> lines_;
};

struct Column {
  float alpha = 0;
  float height = 0;  ///< mean height from which light leaves it towards the eye, -1..1
};

Column column(const PuffNoise& noise, float x, float y) {
  Column out;
  const float half = std::sqrt(std::max(1 - x * x - y * y, 0.f));
  if (!(half > 0)) return out;
  const Density density(noise, x, y);
  float left = 1, seen = 0;
  for (int s = 0; s < slices; ++s) {
    const float z = half * (1 - 2 * (float(s) + 0.5f) / slices);
    const float some = density.at(z) * 8 * half / slices;
    const float taken = left * some / (1 + some);
    out.height += taken * z;
    seen += taken;
    left -= taken;
  }
  out.alpha = 1 - left;
  out.height = seen > 0 ? out.height / seen : half;
  return out;
}

uint32_t byte(float x) {
  return uint32_t(std::clamp(x, 0.f, 1.f) * 255 + 0.5f);
}

}  // namespace

PuffAtlas make_puff_atlas() {
  PuffAtlas out;
  out.size = 2 * tile;
  out.texels.resize(size_t(out.size) * size_t(out.size));
  std::vector<Column> columns(tile * tile);
  for (uint32_t kind = 0; kind < 4; ++kind) {
    const PuffNoise noise = noise_of(100 * kind + 1);
    const auto place = [](int i) { return (float(i) + 0.5f) / tile * 2 - 1; };
    for (int j = 0; j < tile; ++j)
      for (int i = 0; i < tile; ++i)
        columns[size_t(j * tile + i)] = column(noise, place(i), place(j));
    const auto height = [&](int i, int j) {
      return columns[size_t(std::clamp(j, 0, tile - 1) * tile + std::clamp(i, 0, tile - 1))].height;
    };
    for (int j = 0; j < tile; ++j)
      for (int i = 0; i < tile; ++i) {
        const float x = place(i), y = place(j);
        // Bulges of the noise, and of the puff as a whole.
        Vec3f n(height(i - 2, j) - height(i + 2, j), height(i, j - 2) - height(i, j + 2),
                16.0f / tile);
        n = n.normalized() + Vec3f(x, y, std::sqrt(std::max(1 - x * x - y * y, 0.f)));
        n.normalize();
        const size_t row = size_t(j + int(kind / 2) * tile) * size_t(out.size);
        out.texels[row + size_t(i + int(kind % 2) * tile)] =
            byte(0.5f + 0.5f * n.x()) | byte(0.5f + 0.5f * n.y()) << 8 |
            byte(0.5f + 0.5f * n.z()) << 16 | byte(columns[size_t(j * tile + i)].alpha) << 24;
      }
  }
  return out;
}

}  // namespace tumble
