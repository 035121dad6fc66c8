#include "viewer/capture/particles/ply.hpp"

#include "engine/math/det/det.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include <fmt/format.h>

namespace tumble {
namespace {

static_assert(std::endian::native == std::endian::little);

/// Writes the bytes of a value at `at` and advances it.
template <class T>
void put(char*& at, const T& value) {
  std::memcpy(at, &value, sizeof value);
  at += sizeof value;
}

void put(char*& at, const Vec3& v) {
  for (int k = 0; k < 3; ++k) put(at, v[k]);
}

/// A component of a linear colour as an sRGB byte (IEC 61966-2-1); values above 1 give 255.
uint8_t srgb_byte(float linear) {
  const double c = std::clamp(double(linear), 0.0, 1.0);
  const double coded = c <= 0.0031308 ? 12.92 * c : 1.055 * det::pow(c, 1 / 2.4) - 0.055;
  return uint8_t(255 * coded + 0.5);
}

std::string header_of(double time, std::string_view elements) {
  return fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment Tumble, time {} s\n{}end_header\n", time,
      elements);
}

constexpr size_t bytes_of_particle = 9 * sizeof(double) + sizeof(uint32_t) + 3;
constexpr size_t bytes_of_face = 1 + 3 * sizeof(int32_t);

}  // namespace

Result<std::string> ply_of(const ParticleSample& p, double time) {
  if (!p.id.empty() && p.id.back() > std::numeric_limits<uint32_t>::max())
    return Error{ErrorCode::unsupported,
                 fmt::format("particle {}: PLY has no integers of more than 32 bits", p.id.back()),
                 {},
                 "choose --format vtu"};
  std::string out = header_of(
      time, fmt::format("comment x y z [m], vx vy vz [m/s], radius [m], mass [kg], age [s]\n"
                        "element vertex {}\n"
                        "property double x\nproperty double y\nproperty double z\n"
                        "property double vx\nproperty double vy\nproperty double vz\n"
                        "property double radius\nproperty double mass\nproperty double age\n"
                        "property uint id\n"
                        "property uchar red\nproperty uchar green\nproperty uchar blue\n",
                        p.size()));
  const size_t head = out.size();
  out.resize(head + p.size() * bytes_of_particle);
  char* at = out.data() + head;
  for (size_t i = 0; i < p.size(); ++i) {
    put(at, p.x[i]);
    put(at, p.v[i]);
    for (const double value : {p.radius[i], p.mass[i], p.age[i]}) put(at, value);
    put(at, uint32_t(p.id[i]));
    for (int k = 0; k < 3; ++k) put(at, srgb_byte(p.colour[i][k]));
  }
  return out;
}

std::string ply_of(const TriangleMesh& mesh, double time) {
  std::string out =
      header_of(time, fmt::format("comment x y z [m]\n"
                                  "element vertex {}\n"
                                  "property double x\nproperty double y\nproperty double z\n"
                                  "element face {}\nproperty list uchar int vertex_indices\n",
                                  mesh.vertices.size(), mesh.triangles.size()));
  const size_t head = out.size();
  out.resize(head + mesh.vertices.size() * 3 * sizeof(double) +
             mesh.triangles.size() * bytes_of_face);
  char* at = out.data() + head;
  for (const Vec3& x : mesh.vertices) put(at, x);
  for (const Triangle& t : mesh.triangles) {
    put(at, uint8_t{3});
    for (const uint32_t v : t) put(at, int32_t(v));
  }
  return out;
}

}  // namespace tumble
