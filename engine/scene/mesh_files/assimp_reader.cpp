#include "engine/math/matrix4.hpp"
#include "engine/scene/mesh_files/limited_reader.hpp"
#include "engine/scene/mesh_files/polygon_file.hpp"

#include <array>
#include <fstream>
#include <new>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <fmt/format.h>

// Only the library's file readers are used, none of its post-processing: some of those steps abort
// or read out of bounds on scenes from damaged files. The result is checked completely.
namespace tumble {
namespace {

constexpr size_t most_nodes = 1'000'000;

Vec3 mapped(const Mat4& m, const aiVector3D& v) {
  const Vec4 p = m * Vec4(double(v.x), double(v.y), double(v.z), 1);
  return p.head<3>();
}

Mat4 matrix(const aiMatrix4x4& m) {
  Mat4 out;
  for (unsigned r = 0; r < 4; ++r) {
    for (unsigned c = 0; c < 4; ++c) out(int(r), int(c)) = double(m[r][c]);
  }
  return out;
}

/// Adds a mesh with the transform `m`; false if the file contains too much.
bool add_mesh(const aiMesh& mesh, const std::string& name, const Mat4& m, PolygonFile& out) {
  if (!mesh.mVertices || !mesh.mFaces || mesh.mNumVertices == 0) return true;
  if (out.vertices.size() + mesh.mNumVertices > most_mesh_elements) return false;
  const bool mirrored = m.linear().determinant() < 0;
  out.begin_part(name);
  const auto base = uint32_t(out.vertices.size());
  for (unsigned i = 0; i < mesh.mNumVertices; ++i) {
    out.vertices.push_back(mapped(m, mesh.mVertices[i]));
  }
  for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
    const aiFace& face = mesh.mFaces[f];
    if (face.mNumIndices < 3 || !face.mIndices) continue;  // points and lines
    if (out.corners.size() + face.mNumIndices > 4 * most_mesh_elements) return false;
    for (unsigned k = 0; k < face.mNumIndices; ++k) {
      const unsigned v = face.mIndices[mirrored ? face.mNumIndices - 1 - k : k];
      out.corners.push_back(v < mesh.mNumVertices ? base + v : 0xffffffffu);
    }
    out.end_polygon();
  }
  return true;
}

/// Adds the meshes as placed by the nodes; if no node places any, the meshes themselves.
bool add_scene(const aiScene& scene, PolygonFile& out) {
  struct Place {
    const aiNode* node;
    Mat4 parent;
  };
  const auto mesh_at = [&](unsigned i) {
    return scene.mMeshes && i < scene.mNumMeshes ? scene.mMeshes[i] : nullptr;
  };
  std::vector<Place> places;
  if (scene.mRootNode) places.push_back({scene.mRootNode, Mat4::Identity()});
  size_t visited = 0;
  while (!places.empty()) {
    const Place place = places.back();
    places.pop_back();
    if (++visited > most_nodes) return false;
    const Mat4 here = place.parent * matrix(place.node->mTransformation);
    for (unsigned i = 0; place.node->mMeshes && i < place.node->mNumMeshes; ++i) {
      const aiMesh* mesh = mesh_at(place.node->mMeshes[i]);
      if (mesh && !add_mesh(*mesh, place.node->mName.C_Str(), here, out)) return false;
    }
    for (unsigned i = place.node->mChildren ? place.node->mNumChildren : 0; i-- > 0;) {
      if (place.node->mChildren[i]) places.push_back({place.node->mChildren[i], here});
    }
  }
  for (unsigned i = 0; out.parts.empty() && i < scene.mNumMeshes; ++i) {
    const aiMesh* mesh = mesh_at(i);
    if (mesh && !add_mesh(*mesh, mesh->mName.C_Str(), Mat4::Identity(), out)) {
      return false;
    }
  }
  return true;
}

/// Reads in this process; throws if there is not enough memory.
Result<PolygonFile> read_here(const std::filesystem::path& file) {
  try {
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFile(file.string(), 0);
    if (!scene) {
      return mesh_file_fault(file,
                             std::string("cannot be read as a mesh: ") + importer.GetErrorString());
    }
    PolygonFile out;
    if (!add_scene(*scene, out)) {
      return mesh_file_fault(file, fmt::format("the file holds more than {} vertices or {} nodes",
                                               most_mesh_elements, most_nodes));
    }
    return out;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    return mesh_file_fault(file, std::string("cannot be read as a mesh: ") + e.what());
  }
}

}  // namespace

Result<PolygonFile> read_with_assimp(const std::filesystem::path& file) {
  if (const Status ok = check_mesh_file(file); !ok) return ok.error();
  std::error_code error;
  return read_limited(file, read_here, reading_limits(std::filesystem::file_size(file, error)));
}

/// If no JSON object begins there, the library searches for its end without bound; so that is
/// checked first.
Result<PolygonFile> read_gltf(const std::filesystem::path& file) {
  if (const Status ok = check_mesh_file(file); !ok) return ok.error();
  std::ifstream in(file, std::ios::binary);
  std::string start(64, '\0');
  in.read(start.data(), std::streamsize(start.size()));
  start.resize(size_t(in.gcount()));
  if (start.starts_with("\xef\xbb\xbf")) start.erase(0, 3);  // UTF-8 byte order mark
  const size_t first = start.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || (start[first] != '{' && !start.starts_with("glTF")))
    return Error{ErrorCode::parse, "is no glTF file: it starts neither with '{' nor with 'glTF'",
                 file.string(),
                 "files are read by the ending of their names: name it by its format"};
  return read_with_assimp(file);
}

/// A text file begins with `solid`. A binary one has a header of 80 bytes, the number of its
/// triangles, and 50 bytes for each; one that was cut short is told by that.
Result<PolygonFile> read_stl(const std::filesystem::path& file) {
  if (const Status ok = check_mesh_file(file); !ok) return ok.error();
  constexpr size_t header = 80, before_triangles = header + sizeof(uint32_t), triangle = 50;
  std::ifstream in(file, std::ios::binary);
  std::array<unsigned char, before_triangles> start{};
  in.read(reinterpret_cast<char*>(start.data()), std::streamsize(start.size()));
  const std::string_view text(reinterpret_cast<const char*>(start.data()), size_t(in.gcount()));
  std::error_code error;
  const uint64_t size = std::filesystem::file_size(file, error);
  uint64_t triangles = 0;  // little endian
  for (size_t byte = sizeof(uint32_t); byte-- > 0;)
    triangles = triangles << 8 | start[header + byte];
  const uint64_t whole = before_triangles + triangle * triangles;
  const size_t first = text.find_first_not_of(" \t\r\n");
  const bool is_text = first != std::string_view::npos && text.substr(first).starts_with("solid");
  if (is_text || size == whole) return read_with_assimp(file);
  if (size < before_triangles)
    return mesh_file_fault(file,
                           fmt::format("is no STL file: it does not start with 'solid', and a "
                                       "binary one has at least {} bytes",
                                       before_triangles));
  return mesh_file_fault(file,
                         fmt::format("is no whole STL file: it does not start with 'solid', and "
                                     "a binary one of {} triangles has {} bytes, not {}",
                                     triangles, whole, size));
}

}  // namespace tumble
