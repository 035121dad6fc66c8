#include "viewer/capture/particles/vtu.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace tumble {
namespace {

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view vtk_head =
    "<?xml version=\"1.0\"?>\n<VTKFile type=\"{}\" version=\"1.0\" byte_order=\"LittleEndian\" "
    "header_type=\"UInt64\">\n";

/// Adds an inline array: its length in bytes and its content, encoded together.
template <class T>
void add_array(std::string& out, std::string_view type, std::string_view name, int components,
               std::span<const T> values) {
  std::string bytes(sizeof(uint64_t) + values.size_bytes(), '\0');
  const uint64_t length = values.size_bytes();
  std::memcpy(bytes.data(), &length, sizeof length);
  if (length > 0) std::memcpy(bytes.data() + sizeof length, values.data(), values.size_bytes());
  out += fmt::format(
      "        <DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">",
      type, name, components);
  out += base64(bytes);
  out += "</DataArray>\n";
}

template <class V>
std::span<const typename V::Scalar> scalars(const std::vector<V>& vectors) {
  static_assert(sizeof(V) == 3 * sizeof(typename V::Scalar));
  return {vectors.empty() ? nullptr : vectors.front().data(), 3 * vectors.size()};
}

void add_numbers(std::string& out, std::string_view name, const std::vector<double>& values) {
  add_array<double>(out, "Float64", name, 1, values);
}

/// Adds a vertex cell for every point, because programs draw cells, not points.
void add_cells(std::string& out, size_t count) {
  constexpr uint8_t vertex_cell = 1;  // VTK_VERTEX
  std::vector<int64_t> point(count), end(count);
  for (size_t i = 0; i < count; ++i) point[i] = int64_t(i), end[i] = int64_t(i) + 1;
  add_array<int64_t>(out, "Int64", "connectivity", 1, point);
  add_array<int64_t>(out, "Int64", "offsets", 1, end);
  add_array<uint8_t>(out, "UInt8", "types", 1, std::vector<uint8_t>(count, vertex_cell));
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view letters =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out((bytes.size() + 2) / 3 * 4, '=');
  const auto byte = [&](size_t i) {
    return i < bytes.size() ? uint32_t{uint8_t(bytes[i])} : uint32_t{0};
  };
  char* at = out.data();
  for (size_t i = 0; i < bytes.size(); i += 3, at += 4) {
    const uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    const size_t used = std::min<size_t>(bytes.size() - i, 3) + 1;
    for (size_t k = 0; k < used; ++k) at[k] = letters[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

std::string vtu_of(const ParticleSample& p, double time) {
  std::string out = fmt::format(fmt::runtime(vtk_head), "UnstructuredGrid");
  out +=
      "  <!-- points [m], velocity [m/s], radius [m], mass [kg], age [s], colour linear RGB -->\n";
  out += fmt::format(
      "  <UnstructuredGrid>\n    <FieldData>\n"
      "      <DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" format=\"ascii\">"
      "{}</DataArray>\n    </FieldData>\n"
      "    <Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">\n",
      time, p.size(), p.size());
  out += "      <PointData>\n";
  add_array(out, "Float64", "velocity", 3, scalars(p.v));
  add_numbers(out, "radius", p.radius);
  add_numbers(out, "mass", p.mass);
  add_numbers(out, "age", p.age);
  add_array<uint64_t>(out, "UInt64", "id", 1, p.id);
  add_array(out, "Float32", "colour", 3, scalars(p.colour));
  out += "      </PointData>\n      <Points>\n";
  add_array(out, "Float64", "Points", 3, scalars(p.x));
  out += "      </Points>\n      <Cells>\n";
  add_cells(out, p.size());
  out += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n</VTKFile>\n";
  return out;
}

std::string pvd_of(std::span<const PvdEntry> entries) {
  std::string out = fmt::format(fmt::runtime(vtk_head), "Collection") + "  <Collection>\n";
  for (const PvdEntry& e : entries)
    out += fmt::format("    <DataSet timestep=\"{}\" group=\"\" part=\"0\" file=\"{}\"/>\n", e.time,
                       e.file);
  return out + "  </Collection>\n</VTKFile>\n";
}

}  // namespace tumble
