#include "viewer/render/smoke_puffs.hpp"

#include "engine/math/det/det.hpp"
#include "engine/math/types.hpp"

#include <algorithm>
#include <cmath>

namespace tumble {
namespace {

constexpr int tile = 128, slices = 14, octaves = 3;

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

/// Value noise, 0..1.
float noise(const Vec3f& x, uint32_t seed) {
  const Vec3f cell = x.array().floor();
  const int i = int(cell.x()), j = int(cell.y()), k = int(cell.z());
  const float u = smooth(x.x() - cell.x()), v = smooth(x.y() - cell.y());
  const float w = smooth(x.z() - cell.z());
  float sum = 0;
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
    sum += (dx ? u : 1 - u) * (dy ? v : 1 - v) * (dz ? w : 1 - w) *
           corner_value(i + dx, j + dy, k + dz, seed);
  }
  return sum;
}

/// Density of the cloud at a point of the unit ball: noise that thins out towards its rim.
float density(const Vec3f& x, uint32_t seed) {
  float sum = 0, size = 1, weight = 0.5f;
  for (int o = 0; o < octaves; ++o) {
    sum += weight * noise(size * 2.3f * x + Vec3f(7, 13, 19), seed + uint32_t(o));
    size *= 2.1f;
    weight *= 0.5f;
  }
  const float rim = 1 - x.squaredNorm();
  return std::max(0.f, rim * (sum * 3.4f - 0.95f));
}

struct Column {
  float alpha = 0;
  float height = 0;  ///< mean height from which light leaves it towards the eye, -1..1
};

Column column(float x, float y, uint32_t seed) {
  Column out;
  const float half = std::sqrt(std::max(1 - x * x - y * y, 0.f));
  float left = 1, seen = 0;
  for (int s = 0; s < slices && half > 0; ++s) {
    const float z = half * (1 - 2 * (float(s) + 0.5f) / slices);
    const float some = density({x, y, z}, seed) * 8 * half / slices;
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
    const auto place = [](int i) { return (float(i) + 0.5f) / tile * 2 - 1; };
    for (int j = 0; j < tile; ++j)
      for (int i = 0; i < tile; ++i)
        columns[size_t(j * tile + i)] = column(place(i), place(j), 100 * kind + 1);
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
