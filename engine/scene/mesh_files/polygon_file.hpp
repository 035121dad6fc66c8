#pragma once
#include "engine/core/result.hpp"
#include "engine/math/types.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace tumble {

/// The surface in a mesh file as it is stored: polygons, not yet triangles.
struct PolygonFile {
  struct Part {
    std::string name;
    size_t first_vertex = 0, first_polygon = 0;  ///< parts are contiguous and share nothing
  };
  std::vector<Vec3> vertices;     ///< in the file's units and axes, transforms applied
  std::vector<uint32_t> corners;  ///< of all polygons, concatenated
  /// Index of each polygon's first corner; size is polygons + 1.
  std::vector<size_t> polygon_first{0};
  std::vector<Part> parts;
  size_t dropped_polygons = 0;  ///< polygons that refer to missing vertices

  size_t polygon_count() const { return polygon_first.size() - 1; }
  void begin_part(std::string name) {
    parts.push_back({std::move(name), vertices.size(), polygon_count()});
  }
  void end_polygon() { polygon_first.push_back(corners.size()); }
};

/// Greatest number of elements that any file may contain.
constexpr size_t most_mesh_elements = 20'000'000;

/// Text of a file for people: bytes that are no plain character as \xNN, words cut that are longer.
std::string printable(std::string_view text, size_t longest_word = 80);

/// The error for a file that cannot be parsed. Text quoted from the file is made printable.
Error mesh_file_fault(const std::filesystem::path& file, std::string message);
/// The content of a file, after a check that it exists, is not empty and is smaller than a
/// gibibyte.
Result<std::string> read_mesh_bytes(const std::filesystem::path& file);
/// Only that check.
Status check_mesh_file(const std::filesystem::path& file);

// Readers. Ours are used where the library's is not safe against damaged files or loses digits.
Result<PolygonFile> read_obj(const std::filesystem::path& file);
Result<PolygonFile> read_ply(const std::filesystem::path& file);
Result<PolygonFile> read_off(const std::filesystem::path& file);
Result<PolygonFile> read_collada(const std::filesystem::path& file);
Result<PolygonFile> read_gltf(const std::filesystem::path& file);
Result<PolygonFile> read_stl(const std::filesystem::path& file);
Result<PolygonFile> read_with_assimp(const std::filesystem::path& file);

}  // namespace tumble
