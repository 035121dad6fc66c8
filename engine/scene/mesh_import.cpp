#include "engine/scene/mesh_import.hpp"

#include "engine/geometry/mass_properties/mass_properties.hpp"
#include "engine/geometry/mesh_topology.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

namespace tumble {
namespace {

Error fault(const std::filesystem::path& file, std::string message) {
  return {ErrorCode::parse, std::move(message), file.string(), {}};
}

/// All triangles of all parts; node transforms are already applied.
TriangleMesh joined(const aiScene& scene) {
  TriangleMesh out;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& part = *scene.mMeshes[m];
    const auto base = uint32_t(out.vertices.size());
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      out.vertices.emplace_back(double(v.x), double(v.y), double(v.z));
    }
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;
      const auto* k = face.mIndices;
      if (std::max({k[0], k[1], k[2]}) >= part.mNumVertices) continue;
      out.triangles.push_back({base + k[0], base + k[1], base + k[2]});
    }
  }
  return out;
}

Vec3 turned(const Vec3& v, UpAxis up) {
  switch (up) {
    case UpAxis::z:
      return {v.x(), v.z(), -v.y()};
    case UpAxis::x:
      return {-v.y(), v.x(), v.z()};
    case UpAxis::y:
      break;
  }
  return v;
}

/// Equal positions become one vertex, numbered in order of first use; triangles that collapse and
/// vertices that nobody uses go.
TriangleMesh welded(const TriangleMesh& mesh) {
  std::vector<uint32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](uint32_t a, uint32_t b) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::stable_sort(order.begin(), order.end(), less);
  std::vector<uint32_t> same(order.size());
  for (size_t i = 0; i < order.size(); ++i)
    same[order[i]] = i > 0 && !less(order[i - 1], order[i]) ? same[order[i - 1]] : order[i];
  TriangleMesh out;
  std::vector<uint32_t> number(order.size(), no_index);
  for (Triangle t : mesh.triangles) {
    for (uint32_t& k : t) k = same[k];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (uint32_t& k : t) {
      if (number[k] == no_index) {
        number[k] = uint32_t(out.vertices.size());
        out.vertices.push_back(mesh.vertices[k]);
      }
      k = number[k];
    }
    out.triangles.push_back(t);
  }
  return out;
}

Result<TriangleMesh> read_file(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    return Error{ErrorCode::not_found, "there is no such file", file.string(), {}};
  constexpr uintmax_t most = uintmax_t{1} << 30;
  const uintmax_t size = std::filesystem::file_size(file, error);
  if (error || size == 0) return fault(file, error ? "cannot be read" : "the file is empty");
  if (size > most)
    return fault(file, fmt::format("the file has {} bytes; at most {} are read", size, most));
  try {
    Assimp::Importer importer;
    // Only positions and faces count; without the rest equal positions can be joined.
    importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS,
                                aiComponent_NORMALS | aiComponent_TANGENTS_AND_BITANGENTS |
                                    aiComponent_COLORS | aiComponent_TEXCOORDS |
                                    aiComponent_BONEWEIGHTS | aiComponent_ANIMATIONS |
                                    aiComponent_TEXTURES | aiComponent_LIGHTS |
                                    aiComponent_CAMERAS | aiComponent_MATERIALS);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                                aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const aiScene* scene = importer.ReadFile(
        file.string(), aiProcess_RemoveComponent | aiProcess_Triangulate |
                           aiProcess_PreTransformVertices | aiProcess_SortByPType |
                           aiProcess_ValidateDataStructure);
    if (!scene)
      return fault(file, std::string("cannot be read as a mesh: ") + importer.GetErrorString());
    return joined(*scene);
  } catch (const std::exception& e) {
    return fault(file, std::string("cannot be read as a mesh: ") + e.what());
  }
}

}  // namespace

Result<ImportedMesh> import_mesh(const std::filesystem::path& file, const ImportOptions& options) {
  auto read = read_file(file);
  if (!read) return read.error();
  ImportedMesh out;
  const size_t raw = read->triangles.size();
  if (raw == 0) return fault(file, "the file has no triangles");
  for (Vec3& v : read->vertices) {
    if (!v.allFinite()) return fault(file, "a vertex is not finite");
    v = options.scale * turned(v, options.up);
  }
  out.mesh = welded(*read);
  if (out.mesh.triangles.empty()) return fault(file, "all triangles are without area");
  if (out.mesh.triangles.size() < raw)
    out.notes.push_back(
        fmt::format("{} triangles without area were left out", raw - out.mesh.triangles.size()));
  out.mesh = scaled(out.mesh, options.stretch);
  if (options.centre) {
    const Vec3 middle = bounds(out.mesh).centre();
    for (Vec3& v : out.mesh.vertices) v -= middle;
  }
  if (auto ok = validate(out.mesh); !ok) return fault(file, ok.error().message);
  if (build_topology(out.mesh).closed_and_oriented() && mesh_integrals(out.mesh).mass < 0) {
    flip(out.mesh);
    out.notes.push_back("the surface was inside out and has been turned");
  }
  return out;
}

}  // namespace tumble
